#pragma once
/// \file
/// Law tests: a law is a property of many types, and each law is a test of GoogleTest. The suites in this folder test
/// the types of the library: `BodyLaws`, `FlexibleBodyLaws`, `JointLaws`, `PolicyLaws`, `ForceLaws`, `ContactLaws`,
/// `ContactShapeLaws`, `IntegratorLaws`, `LinearSolvers`, `UserSystemLaws`. To test another type, write a case that
/// creates an object of this type, and one line:
///
///     bool const bead_obeys = polybody::laws::obeys<BeadCase, polybody::laws::JointLaws>("Bead");
///
/// The program links `polybody::testing`, which includes GoogleTest and its main function. The namespace is not
/// `testing`, because `using namespace polybody` would then hide the namespace of GoogleTest.
///
/// A suite is a class template with member functions that test its laws, and with a list of these laws. A law may have
/// a condition: a case that does not satisfy it has no test of this law.
///
///     template <class Case>
///     struct SpringLaws {
///       void force_falls_with_length();
///       void damping_takes_power();
///       static constexpr Law<SpringLaws> laws[] = {
///           {"ForceFallsWithLength", &SpringLaws::force_falls_with_length},
///           {"DampingTakesPower", &SpringLaws::damping_takes_power, Case::damped}};
///     };
///     bool const steel_obeys = obeys<SteelCase, SpringLaws>("Steel");  // registers the tests
///     // names of the tests: Steel/SpringLaws.ForceFallsWithLength, …
///
/// Typed tests of GoogleTest require a class for each law and type, which takes longer to compile.
///
/// Requires GoogleTest.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include <polybody/math/compiler.hpp>

namespace polybody::laws {

/// Law: its name, the member function of its suite that tests it, and its condition.
template <class Laws>
struct Law {
  char const* name;       ///< name of the test, for example "MassIsSymmetric"
  void (Laws::*holds)();  ///< the member function that tests the law
  bool applies = true;    ///< false if the law has no meaning for the case; the case then has no test of the law
};

/// Test of one law. Each test creates its own suite object, so that laws are independent.
class LawTest : public ::testing::Test {
 public:
  explicit LawTest(std::function<void()> law) : law_(std::move(law)) {}  ///< test that calls `law`

 private:
  void TestBody() override { law_(); }
  std::function<void()> law_;
};

/// Registers one law of `suite` as a test of GoogleTest. `holds()` tests the law. `file` and `line` are the source
/// location that GoogleTest reports.
inline void register_law(std::string const& suite, char const* law, char const* file, int line,
                         std::function<void()> holds) {
  ::testing::RegisterTest(suite.c_str(), law, nullptr, nullptr, file, line,
                          [holds = std::move(holds)]() -> LawTest* { return new LawTest(holds); });
}

/// Registers every law of a suite that applies. `file` and `line` are the source location that GoogleTest reports.
template <class Laws>
void register_laws(std::string const& suite, char const* file, int line) {
  for (Law<Laws> const& law : Laws::laws)
    if (law.applies)
      register_law(suite, law.name, file, line, [holds = law.holds] {
        Laws laws;
        (laws.*holds)();
      });
}

/// Registers the laws of each suite that apply to a case, as tests named `name/Suite.Law`. `file` and `line` are the
/// source location that GoogleTest reports. Initialise a global variable with the result, so that the registration runs
/// before `main`.
template <class Case, template <class> class... Suites>
bool obeys(std::string const& name, char const* file = __builtin_FILE(), int line = __builtin_LINE()) {
  (register_laws<Suites<Case>>(name + "/" + Suites<Case>::suite, file, line), ...);
  return true;
}

}  // namespace polybody::laws
