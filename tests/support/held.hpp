#pragma once
/// \file A number that a case compares. It is asserted like EXPECT_NEAR, and recorded for the tables of
/// docs/validated.
///
///     Claim const tip{"S1", "x of the tip [m]", By::closed_form, "(L/θ) sin θ", "Lrvf, 10 elements"};
///     held(tip, x, 0.0, 1e-10, {.at = "full circle", .scale = 2.0});
///
/// The record is a line of the file that POLYBODY_CLAIMS names; without that variable nothing is written.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <source_location>
#include <string>

namespace polybody {

/// Source of a reference value.
enum class By {
  published,    ///< printed in a publication
  closed_form,  ///< exact to its last digit
  independent,  ///< computed by a method that shares no code with this project
  itself        ///< another method of polybody; agreement proves neither result
};

/// Claim of a case. Comparisons of one claim form one row of the tables.
struct Claim {
  std::string case_id;  ///< as in the tables: "S1"
  std::string what;     ///< the quantity, with its unit
  By by;
  std::string source;       ///< the publication, the formula, the method
  std::string formulation;  ///< body, mesh, integrator, step
};

/// Identification of one comparison of a claim.
struct Instance {
  std::string at = {};  ///< the time, the load, the mesh
  double scale = 0.0;   ///< size of the quantity, if the reference passes through zero
};

/// "t = 2.5", a name for an instance.
inline std::string equals(char const* name, double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%s = %g", name, value);
  return text;
}

namespace detail {
/// Writes one comparison: test, file, claim, instance, numbers, separated by tabs.
inline void record(Claim const& c, Instance const& i, char const* kind, double reference, double value,
                   double tolerance) {
  char const* const path = std::getenv("POLYBODY_CLAIMS");
  auto const* const test = testing::UnitTest::GetInstance()->current_test_info();
  if (!path || !test) return;
  if (std::FILE* const file = std::fopen(path, "a")) {
    std::fprintf(file, "%s.%s\t%s\t%s\t%s\t%d\t%s\t%s\t%s\t%s\t%.17g\t%.17g\t%.17g\t%.17g\n", test->test_suite_name(),
                 test->name(), test->file(), c.case_id.c_str(), c.what.c_str(), int(c.by), c.source.c_str(),
                 c.formulation.c_str(), i.at.c_str(), kind, reference, value, tolerance, i.scale);
    std::fclose(file);
  } else {
    ADD_FAILURE() << "POLYBODY_CLAIMS names " << path << ", which cannot be written";
  }
}
}  // namespace detail

/// |value − reference| ≤ tolerance.
inline void held(Claim const& claim, double value, double reference, double tolerance, Instance const& instance = {},
                 std::source_location const& where = std::source_location::current()) {
  detail::record(claim, instance, "value", reference, value, tolerance);
  double const error = std::abs(value - reference);
  if (!(error <= tolerance))
    ADD_FAILURE_AT(where.file_name(), int(where.line()))
        << claim.case_id << ", " << claim.what << ", " << claim.formulation << ' ' << instance.at << ": " << value
        << " is " << error << " off " << reference << ", above the tolerance " << tolerance;
}

/// error ≤ tolerance. The error is a distance from a reference of size `instance.scale`.
inline void held_within(Claim const& claim, double error, double tolerance, Instance const& instance,
                        std::source_location const& where = std::source_location::current()) {
  detail::record(claim, instance, "distance", 0.0, error, tolerance);
  if (!(error <= tolerance))
    ADD_FAILURE_AT(where.file_name(), int(where.line()))
        << claim.case_id << ", " << claim.what << ", " << claim.formulation << ' ' << instance.at << ": an error of "
        << error << ", above the tolerance " << tolerance;
}

}  // namespace polybody
