// accepted
// The accepted counterpart of self_refused.cpp.
template <int sides>
struct Square {
  static_assert(sides == 4, "a square has four sides, not 3");
};

int main() { [[maybe_unused]] Square<4> s; }
