// accepted
// Must be reported: it does not compile, and only when its template is instantiated.
template <class T>
int sides(T t) {
  return t.sides;
}

int main() { return sides(4); }
