// accepted
// Must be reported: it does not compile, but only if its template is instantiated.
template <class T>
int sides(T t) {
  return t.sides;
}

int main() { return sides(4); }
