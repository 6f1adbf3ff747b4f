#pragma once
/// \file
/// Laws that many types obey, each a test of GoogleTest. The suites beside this header are those of the library's own
/// types: `BodyLaws`, `FlexibleBodyLaws`, `JointLaws`, `PolicyLaws`, `ForceLaws`, `ContactLaws`, `IntegratorLaws`,
/// `LinearSolvers`, `UserSystemLaws`. A type of your own is tested by one line beside a case that makes it:
///
///     bool const bead_obeys = polybody::laws::obeys<BeadCase, polybody::laws::JointLaws>("Bead");
///
/// The program links `polybody::testing`, which brings GoogleTest and its main. The namespace is not `testing`, as
/// `using namespace polybody` would then hide GoogleTest's own.
///
/// A suite is a template with its laws as members and a list of them:
///
///     template <class Case>
///     struct SpringLaws {
///       void force_falls_with_length();
///       static constexpr Law<SpringLaws> laws[] = {{"ForceFallsWithLength", &SpringLaws::force_falls_with_length}};
///     };
///     bool const steel_obeys = obeys<SteelCase, SpringLaws>("Steel");  // registers the test
///     Steel/SpringLaws.ForceFallsWithLength
///
/// GoogleTest's typed tests do the same with a class for each law and type, which takes longer to compile.
///
/// Not in polybody.hpp: needs GoogleTest.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

namespace polybody::laws {

/// A law: its name, and the member of its suite that tests it.
template <class Laws>
struct Law {
  char const* name;       ///< name of the test, such as "MassIsSymmetric"
  void (Laws::*holds)();  ///< the member function that tests the law
};

/// A test of one law: made anew, so that laws do not see one another.
class LawTest : public ::testing::Test {
 public:
  explicit LawTest(std::function<void()> law) : law_(std::move(law)) {}  ///< a test that calls `law`

 private:
  void TestBody() override { law_(); }
  std::function<void()> law_;
};

/// Registers one law, of `suite`, as a test of GoogleTest: holds() checks it; `file` and `line` are where it is asked
/// for.
inline void register_law(std::string const& suite, char const* law, char const* file, int line,
                         std::function<void()> holds) {
  ::testing::RegisterTest(suite.c_str(), law, nullptr, nullptr, file, line,
                          [holds = std::move(holds)]() -> LawTest* { return new LawTest(holds); });
}

/// Registers every law of a suite, asked for at `line` of `file`.
template <class Laws>
void register_laws(std::string const& suite, char const* file, int line) {
  for (Law<Laws> const& law : Laws::laws)
    register_law(suite, law.name, file, line, [holds = law.holds] {
      Laws laws;
      (laws.*holds)();
    });
}

/// Registers the laws of each suite for a case, as tests named `name/Suite.Law`, asked for at `line` of `file`. For the
/// initialiser of a variable, so that it runs before `main`.
template <class Case, template <class> class... Suites>
bool obeys(std::string const& name, char const* file = __builtin_FILE(), int line = __builtin_LINE()) {
  (register_laws<Suites<Case>>(name + "/" + Suites<Case>::suite, file, line), ...);
  return true;
}

}  // namespace polybody::laws
