#pragma once
/// \file
/// The exceptions of the library. Each message names the object, where known the time, and the remedy.

#include <charconv>
#include <concepts>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace polybody {

/// The text of `x` in messages: up to `digits` digits, with a decimal point in every locale.
inline std::string number(double x, int digits = 9) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, digits).ptr};
}

/// A part of a message: a text that outlives it, or a number.
class MessagePart {
 public:
  ///@{
  /// A text or a letter, which must outlive the part.
  MessagePart(char const* text) : text_(text) {}          // NOLINT(google-explicit-constructor)
  MessagePart(std::string_view text) : text_(text) {}     // NOLINT(google-explicit-constructor)
  MessagePart(std::string const& text) : text_(text) {}   // NOLINT(google-explicit-constructor)
  MessagePart(char const& letter) : text_(&letter, 1) {}  // NOLINT(google-explicit-constructor)
  ///@}
  /// The number `x`: an integer as it is, any other one with up to nine digits.
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

/// The parts of a message, one after the other. A chain of `+` compiles to three times as much code.
[[gnu::cold]] inline std::string sentence_of(std::initializer_list<MessagePart> parts) {
  std::string all;
  for (MessagePart const& part : parts) part.write_to(all);
  return all;
}

/// Base of every exception that polybody throws. It is made of a text, or of the parts of one:
/// `throw InvalidInput{"The mass must be positive, but is ", mass, "."}`.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// From the parts of its text, which `sentence_of` puts together.
  Error(std::initializer_list<MessagePart> parts) : std::runtime_error(sentence_of(parts)) {}
};

/// A number, name or combination that cannot be meant: negative mass, zero axis, s outside the body.
class InvalidInput : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// A start that violates a joint; `assemble` repairs it.
class InconsistentStart : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// Newton's method did not converge; the state is as it was before the step.
class NewtonStalled : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// A step that converged, but left joints open or energy that no work explains; the state is as it was before the step.
class Diverged : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// A point that slides along a body has gone off its end.
class OffTheEnd : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// The step control asks for a step below the smallest one allowed.
class StepTooSmall : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// A force, mass or coordinate became NaN or infinite.
class NonFinite : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// The linear solver met a matrix without inverse.
class LinearSolverSingular : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

/// A file could not be read or written.
class IoError : public Error {
 public:
  using Error::Error;  ///< from a text or its parts, as `Error`
};

}  // namespace polybody
