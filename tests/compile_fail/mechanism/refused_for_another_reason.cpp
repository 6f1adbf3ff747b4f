// refused: a square has four sides
// Must be reported: the compiler refuses it, for another reason.
// (The words "a square has four sides" in the source must not count.)
int main() { return undeclared; }  // a square has four sides
