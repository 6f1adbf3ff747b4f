// refused: a square has four sides
// Must be reported: it compiles.
int main() {}
