// refused: a square has four sides, not 3
// Test of the mechanism: the message of a static_assert in a template is found.
template <int sides>
struct Square {
  static_assert(sides == 4, "a square has four sides, not 3");
};

int main() { Square<3> s; }
