#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

#include <gtest/gtest.h>

#include <concepts>
#include <string>

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

// A program distinguishes errors by their data, without reading the text.
TYPED_TEST(EveryError, CarriesCodeObjectValueAndTime) {
  std::string const name = "pin";
  TypeParam const error("joint.open", {"joint \"", ErrorObject{name}, "\" is open by ", ErrorValue{0.25},
                                       " m at t = ", ErrorTime{1.5}, " s."});
  EXPECT_STREQ(error.what(), "joint \"pin\" is open by 0.25 m at t = 1.5 s.");
  EXPECT_EQ(error.code(), "joint.open");
  EXPECT_EQ(error.object(), "pin");
  EXPECT_EQ(error.value(), 0.25);
  EXPECT_EQ(error.time(), 1.5);
}

TYPED_TEST(EveryError, HasNoDataIfMadeFromATextAlone) {
  TypeParam const error("pin: broken");
  EXPECT_EQ(error.code(), "");
  EXPECT_EQ(error.object(), "");
  EXPECT_FALSE(error.value().has_value());
  EXPECT_FALSE(error.time().has_value());
}

TEST(Error, KeepsItsDataInACopy) {
  InvalidInput error("a.b", {ErrorObject{"rod"}, ": ", ErrorValue{3}});
  Error const copy = error;
  error = InvalidInput("other");
  EXPECT_STREQ(copy.what(), "rod: 3");
  EXPECT_EQ(copy.code(), "a.b");
  EXPECT_EQ(copy.object(), "rod");
  EXPECT_EQ(copy.value(), 3.0);
}

// An integer is written with all digits.
TEST(Error, TakesAnIntegerAsItsValue) {
  InvalidInput const error{"count ", ErrorValue{1234567890123LL}};
  EXPECT_STREQ(error.what(), "count 1234567890123");
  EXPECT_EQ(error.value(), 1234567890123.0);
}

// The object is the name in double quotes, or the text up to the colon; the scope operator is part of a name.
TEST(Error, FindsTheObjectInTheSubjectOfTheMessage) {
  EXPECT_EQ(InvalidInput{ErrorObject{"joint \"pin\": the radius"}}.object(), "pin");
  EXPECT_EQ(InvalidInput{ErrorObject{"\"pin\""}}.object(), "pin");
  EXPECT_EQ(InvalidInput{ErrorObject{"Rattle: the tolerance"}}.object(), "Rattle");
  EXPECT_EQ(InvalidInput{ErrorObject{"planar::Rigid: the mass"}}.object(), "planar::Rigid");
  EXPECT_EQ((InvalidInput{"body ", ErrorObject{"planar::ffr::Body"}, ": x"}.object()), "planar::ffr::Body");
  EXPECT_EQ(InvalidInput{ErrorObject{""}}.object(), "");
}

// The outer error names the object, the inner error gives the rest.
TEST(Error, TakesTheDataOfItsCause) {
  InvalidInput const inner("bar.length", {ErrorObject{"Bar"}, ": s = ", ErrorValue{2.0}});
  InvalidInput const outer{"\"", ErrorObject{"rod"}, "\": ", ErrorCause{inner}, "."};
  EXPECT_STREQ(outer.what(), "\"rod\": Bar: s = 2.");
  EXPECT_EQ(outer.object(), "rod");
  EXPECT_EQ(outer.code(), "bar.length");
  EXPECT_EQ(outer.value(), 2.0);
  InvalidInput const unnamed{"file: ", ErrorCause{inner}};
  EXPECT_EQ(unnamed.object(), "Bar");
}

// Helper functions mark the object and the value by themselves.
TEST(Error, OfAHelperFunctionHasCodeObjectAndValue) {
  try {
    require_positive(-2.0, "\"spring\"", ": the stiffness");
    FAIL();
  } catch (InvalidInput const& error) {
    EXPECT_EQ(error.code(), "value.not_positive");
    EXPECT_EQ(error.object(), "spring");
    EXPECT_EQ(error.value(), -2.0);
  }
}

TEST(Number, IsReadableAtAnySize) {
  EXPECT_EQ(number(-1e-9), "-1e-09");
  EXPECT_EQ(number(0.1 + 0.2), "0.3");
  EXPECT_EQ(number(-5.0), "-5");
  EXPECT_EQ(number(123456.789), "123456.789");
}

}  // namespace errors_test
