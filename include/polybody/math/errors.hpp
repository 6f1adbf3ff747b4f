#pragma once
/// \file
/// Exceptions of the library. Each message names the object, the time if it is known, and the remedy.

#include <charconv>
#include <concepts>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Text of `x` in messages: up to `digits` digits, with a decimal point in every locale.
inline std::string number(double x, int digits = 9) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, digits).ptr};
}

/// Part of a message: a number, or a text that must outlive the part.
class MessagePart {
 public:
  ///@{
  /// Part with the `text` or the `letter`, which must outlive the part.
  MessagePart(char const* text) : text_(text) {}          // NOLINT(google-explicit-constructor)
  MessagePart(std::string_view text) : text_(text) {}     // NOLINT(google-explicit-constructor)
  MessagePart(std::string const& text) : text_(text) {}   // NOLINT(google-explicit-constructor)
  MessagePart(char const& letter) : text_(&letter, 1) {}  // NOLINT(google-explicit-constructor)
  ///@}
  /// The number `x`: an integer with all digits, a floating-point number with up to nine digits.
  template <class Number>
    requires std::convertible_to<Number const&, double>
  MessagePart(Number const& x) {  // NOLINT(google-explicit-constructor)
    if constexpr (std::integral<Number>)
      kind_ = Kind::count, count_ = static_cast<long long>(x);
    else
      kind_ = Kind::real, real_ = x;
  }

  /// Appends the part to `message`.
  [[gnu::cold]] void write_to(std::string& message) const {
    if (kind_ == Kind::text)
      message += text_;
    else
      message += kind_ == Kind::real ? number(real_) : std::to_string(count_);
  }

 private:
  enum class Kind { text, real, count };
  Kind kind_ = Kind::text;
  union {
    std::string_view text_;
    double real_;
    long long count_;
  };
};

/// Joins the parts of a message. A chain of `+` would compile to three times as much code.
[[gnu::cold]] inline std::string sentence_of(std::initializer_list<MessagePart> parts) {
  std::string all;
  for (MessagePart const& part : parts) part.write_to(all);
  return all;
}

/// Base class of all exceptions that polybody throws. It is constructed from a text or from the parts of a text:
/// `throw InvalidInput{"The mass must be positive, but is ", mass, "."}`.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// Constructs the exception from the parts of its text, which `sentence_of` joins.
  Error(std::initializer_list<MessagePart> parts) : std::runtime_error(sentence_of(parts)) {}

  /// Appends `sentences` to the message, for code that catches the exception by reference and rethrows it.
  [[gnu::cold]] void append(std::string const& sentences) {
    std::runtime_error::operator=(std::runtime_error(what() + (' ' + sentences)));
  }
};

/// Invalid number, name or combination: negative mass, zero axis, s outside the body.
class InvalidInput : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// Initial state that violates a constraint equation; `assemble` corrects it.
class InconsistentInitialConditions : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// Newton's method did not converge; the state is the one at the start of the step.
class NewtonConvergenceFailure : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// The step converged, but constraint equations are violated or the energy changed without work. The state is the one
/// at the start of the step.
class Diverged : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// A point that slides along a body has passed the end of the body.
class SliderOutOfRange : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// The step control requires a step below the smallest allowed step.
class MinimumStepReached : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// A force, mass or coordinate is NaN or infinite.
class NonFiniteValue : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// The matrix of a linear system is singular.
class SingularMatrix : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

/// A file could not be read or written.
class IoError : public Error {
 public:
  using Error::Error;  ///< constructors from a text or its parts, as `Error`
};

}  // namespace polybody
