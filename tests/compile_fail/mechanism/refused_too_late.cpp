// refused: a square has four sides
// Must be reported: the sentence comes after ten errors of other kinds.
int const a = one;
int const b = two;
int const c = three;
int const d = four;
int const e = five;
int const f = six;
int const g = seven;
int const h = eight;
int const i = nine;
int const j = ten;

template <int sides>
struct Square {
  static_assert(sides == 4, "a square has four sides");
};

int main() { Square<3> s; }
