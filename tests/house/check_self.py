"""Tests of check.py: each rule reports all violations, and nothing else."""

import tempfile
import unittest
from pathlib import Path

import check
import cpp_reader

GOOD = {
    "polybody/polybody.hpp": "#include <polybody/bodies/rigid/rigid.hpp>\n",
    "polybody/bodies/rigid/rigid.hpp": '#include "polybody/math/so3.hpp"\n#include "mass.hpp"\n',
    "polybody/bodies/rigid/mass.hpp": "#include <Eigen/Dense>\n#include <vector>\n#include <polybody/math/compiler.hpp>\n",
    "polybody/math/compiler.hpp": "#if __cplusplus < 202002L\n#error\n#endif\n",
    "polybody/math/so3.hpp": '#include <polybody/math/compiler.hpp>\n// no #define, virtual work\n/* virtual */ auto s = "virtual";\n',
}


class Check(unittest.TestCase):
    def setUp(self):
        self.lists = tempfile.TemporaryDirectory()
        self.addCleanup(self.lists.cleanup)
        list_of, folder = check.list_of, Path(self.lists.name)
        self.addCleanup(setattr, check, "list_of", list_of)
        check.list_of = lambda rule: folder / f"{rule}_allowed.txt"
        for rule in check.OFFENDERS:
            self.allow(rule)

    def allow(self, rule, *lines):
        check.list_of(rule).write_text("\n".join(("# of old", *lines)) + "\n", encoding="utf-8")

    def found(self, rule, **changes):
        renamed = {f"polybody/{k.replace('__', '/')}.hpp": v for k, v in changes.items()}
        return list(check.RULES[rule](GOOD | renamed))

    def test_good_tree_passes(self):
        for rule in check.RULES:
            self.assertEqual(self.found(rule), [], rule)

    def test_floors(self):
        for line in ('#include "polybody/bodies/rigid/rigid.hpp"', "#  include <polybody/bodies/rigid/rigid.hpp>",
                     '#include "../bodies/rigid/rigid.hpp"', '#include "polybody/math/none.hpp"'):
            self.assertEqual(len(self.found("floors", math__so3=line)), 1, line)
        self.assertEqual(len(self.found("floors", cellar__x="")), 1)
        self.assertEqual(self.found("floors", math__so3="// #include <polybody/bodies/rigid/rigid.hpp>"), [])

    def test_compiler(self):
        for text in ("", "#include <vector>\n", "// #include <polybody/math/compiler.hpp>"):
            self.assertEqual(len(self.found("compiler", math__so3=text)), 1, text)
        self.assertEqual(self.found("compiler", math__so3='#include "mass.hpp"\n#include <polybody/bodies/rigid/mass.hpp>'), [])
        self.assertEqual(self.found("compiler", version=""), [])

    def test_words(self):
        self.assertEqual(len(self.found("words", math__so3="int a;\n# define PI 3\n")), 1)
        self.assertEqual(len(self.found("words", math__so3="struct A { virtual void f(); };")), 1)
        self.assertEqual(self.found("words", system__coordinates="struct A { virtual void f(); };"), [])
        self.assertEqual(len(self.found("words", system__coordinates="struct A {};")), 1)

    def test_length(self):
        self.assertEqual(len(self.found("length", math__so3="//\n" * 401)), 1)
        self.assertEqual(self.found("length", math__so3="//\n" * 400), [])

    def test_umbrella(self):
        self.assertEqual(len(self.found("umbrella", math__lonely="")), 1)
        self.assertEqual(self.found("umbrella", math__lonely="", stress="#include <polybody/math/lonely.hpp>\n"), [])

    def test_repeats(self):
        lines = lambda n: "".join(f"f({i});  // {i}\n" for i in range(n))
        self.assertEqual(self.found("repeats", math__so3=lines(11), math__a=lines(11)), [])
        self.assertEqual(len(self.found("repeats", math__so3=lines(14), math__a=lines(14).replace("//", "\n//"))), 1)

    def test_functions(self):
        long = lambda n: "int f() {\n" + "  ++a;\n" * n + "}\n"
        self.assertEqual(self.found("functions", math__so3=long(58)), [])
        self.assertEqual(len(self.found("functions", math__so3=long(59))), 1)
        self.assertEqual(len(self.found("functions", math__so3="int f(int, int, int, int, int, int, int) {}")), 1)
        for text in ("int f(A<int, 2> a, int, int, int, int, int g = h(1, 2)) {}",
                     "int f(int, int, int, int, int, int, int);",
                     "namespace a {\nstruct B {\n" + "int c;\n" * 90 + "};\n}\n"):
            self.assertEqual(self.found("functions", math__so3=text), [], text)

    def test_waist(self):
        door = lambda n: "template <class M>\nvoid f(M const& model) {\n" + "  g(model);\n" * n + "}"
        for text in ("for_each_body(f);", "m.body_pools();", "detail::BodyPool<B> p;", "void f(System<M>&);",
                     "template <class B, class M>\nvoid f(M const& model);", door(6),
                     "template <class M>\nstruct A {\n  M const& m;\n  void f() {}\n};"):
            self.assertEqual(len(self.found("waist", integrators__x=text)), 1, text)
            self.assertEqual(self.found("waist", system__x=text), [], text)
        mass = "namespace polybody::detail {\nint mass();\n}"
        self.assertEqual(len(self.found("waist", system__y=mass, solvers__x="int a = detail::mass();")), 1)
        self.assertEqual(self.found("waist", solvers__y=mass, solvers__x="int a = detail::mass();"), [])
        good = "// for_each_body, System<M>\ntemplate <int M> struct A;\nBasicSystem<S>& s;"
        self.assertEqual(self.found("waist", solvers__x=good), [])
        for text in (door(5), "struct A {\n  template <class M>\n  explicit A(M const& m)\n      : a_(m) {}\n};",
                     "template <class M>\nstruct A {\n  M model;\n  std::function<void(M const&)> f = {};\n};"):
            self.assertEqual(self.found("waist", run__x=text), [], text)

    def test_comments(self):
        for line in ("/// Of a run.", "int a;  ///< … in its own", "  // Of it", "/* Of it */"):
            self.assertEqual(len(self.found("comments", math__so3=line)), 1, line)
        for line in ("/// Offers a run.", "/// …}; ends", 'auto a = "// Of it";', "/// A part of it."):
            self.assertEqual(self.found("comments", math__so3=line), [], line)

    def test_lists_only_shrink(self):
        bad = "void f(int, int, int, int, int, int, int) {}\n"
        self.allow("functions", "math/so3.hpp:f")
        self.assertEqual(self.found("functions", math__so3=bad), [])
        self.assertEqual(len(self.found("functions", math__so3=bad * 2)), 3)  # two overloads, one more than allowed
        self.assertIn("take it off", self.found("functions")[0])
        self.allow("functions", "math/so3.hpp:f 2")
        self.assertIn("lower it", self.found("functions", math__so3=bad)[0])
        check.shrink("functions", check.offending_functions({"polybody/math/so3.hpp": bad}))
        self.assertEqual(check.list_of("functions").read_text(encoding="utf-8"), "# of old\nmath/so3.hpp:f\n")

    def test_system(self):
        body = lambda n: ("template <class M>\nclass BasicSystem {\n public:\n  BasicSystem();\n"
                          + "".join(f"  int f{i}() const;\n" for i in range(n)) + " private:\n  int c();\n};")
        self.assertEqual(self.found("system", system__basic_system=body(25)), [])
        self.assertEqual(len(self.found("system", system__basic_system=body(26))), 1)


class Reader(unittest.TestCase):
    def functions(self, text):
        return [(d.name, d.first, d.last, d.parameters)
                for d in cpp_reader.declarations(text) if d.kind == "function" and d.body]

    def test_finds_functions(self):
        for text, *expected in (
            ("int f(int a) {\n  return a;\n}", ("f", 1, 3, 1)),
            ("template <class T = int, int n = (1 < 2)>\n  requires(n > 1) && A<T>\n"
             "[[nodiscard]] inline auto f(T... a) -> B<T> {\n}",
             ("f", 1, 4, 1)),
            ("template <class T>\n  requires requires(T t) { t.f(); }\nvoid g(T a, std::map<int, int> b) {}",
             ("g", 1, 3, 2)),
            ("struct A {\n  A(int a, int b)\n      : a{a}, b_(b), C<int>{1} {\n  }\n};", ("A::A", 2, 4, 2)),
            ("struct A { bool operator()(int a) const noexcept(x(1)) { return {}; } operator T() const { return {}; }"
             " ~A() {} };",
             ("A::operator()", 1, 1, 1), ("A::operator T", 1, 1, 0), ("A::~A", 1, 1, 0)),
            ("int operator_of(int a) { return a; } void operators_in() {}", ("operator_of", 1, 1, 1), ("operators_in", 1, 1, 0)),
            ("struct A { friend auto operator<=>(A const& a, A const& b) { return 0; } A& operator++() {} };",
             ("A::operator<=>", 1, 1, 2), ("A::operator++", 1, 1, 0)),
            ("void A<B<C...>>::f(std::function<void(int, int)> g = [](int a, int b) { return a; })\n"
             "  requires(n == 1)\n{}",
             ("A::f", 1, 3, 1)),
            ("decltype(auto) f() {}\nextern \"C\" { void g(void) {} }\n"
             "namespace a::b { inline namespace c { void h() {} } }",
             ("f", 1, 1, 0), ("g", 2, 2, 0), ("h", 3, 3, 0)),
            ("void f() {\n  auto g = [](int a) { if constexpr (requires { a.b(); }) { } };\n"
             "  struct A { void h() {} };\n}",
             ("f", 1, 4, 0)),
            ("char c = '{'; int n = 1'000; auto s = R\"(})\"; // {\nvoid f() {}", ("f", 2, 2, 0)),
        ):
            self.assertEqual(self.functions(text), expected, text)

    def test_leaves_the_rest(self):
        for text in ("template <class S> concept A = requires(S s) { s.f(); } && B<S>;", "enum class E { a, b };", "enum { a };",
                     "inline constexpr std::array<int, 2> a{1, 2};", "using F = std::function<void(int)>;",
                     "struct A { std::vector<int> a{f(1)}; B b = f({1}); };",
                     "constexpr auto f = [](int a) { return a; };",
                     "struct A;\nstruct B : C<decltype(f())> { int a; } b;", "static_assert(A<B>{}(1));",
                     "void f();\nA() = default;\nvirtual void g() = 0;"):
            self.assertEqual(self.functions(text), [], text)

    def test_knows_who_may_call(self):
        text = "class A { int a(); public: int b(); protected: int c(); }; struct B { int d(); private: int e(); };"
        self.assertEqual([d.name for d in cpp_reader.declarations(text) if d.kind == "function" and d.public], ["A::b", "B::d"])

    def test_names_what_is_not_closed(self):
        with self.assertRaisesRegex(ValueError, "line 2"):
            list(cpp_reader.declarations("int a;\nvoid f() {\n"))


if __name__ == "__main__":
    unittest.main()
