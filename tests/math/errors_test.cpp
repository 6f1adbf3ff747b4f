#include <polybody/math/errors.hpp>

#include <gtest/gtest.h>

#include <concepts>

using namespace polybody;

namespace errors_test {

template <template <class...> class List>
using All = List<InvalidInput, InconsistentInitialConditions, NewtonConvergenceFailure, MinimumStepReached,
                 NonFiniteValue, SingularMatrix, IoError>;

/// Number of types Es that E derives from, itself included.
template <class... Es>
struct Kinds {
  template <class E>
  static constexpr int of = (int(std::derived_from<E, Es>) + ...);
};

template <class E>
struct EveryError : testing::Test {};
using Errors = All<testing::Types>;
TYPED_TEST_SUITE(EveryError, Errors);

TYPED_TEST(EveryError, IsCaughtAsErrorAndKeepsItsMessage) {
  try {
    throw TypeParam("pin: broken");
  } catch (Error const& error) {
    EXPECT_STREQ(error.what(), "pin: broken");
  }
}

TYPED_TEST(EveryError, IsAStandardRuntimeError) { EXPECT_THROW(throw TypeParam("x"), std::runtime_error); }

// A handler of one kind never catches another.
TYPED_TEST(EveryError, DerivesFromNoOtherKind) { EXPECT_EQ(All<Kinds>::template of<TypeParam>, 1); }

TEST(Number, IsReadableAtAnySize) {
  EXPECT_EQ(number(-1e-9), "-1e-09");
  EXPECT_EQ(number(0.1 + 0.2), "0.3");
  EXPECT_EQ(number(-5.0), "-5");
  EXPECT_EQ(number(123456.789), "123456.789");
}

}  // namespace errors_test
