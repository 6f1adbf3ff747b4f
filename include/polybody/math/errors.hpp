#pragma once
/// \file
/// Exceptions of the library and their data: code, object, value and time.

#include <charconv>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <polybody/math/compiler.hpp>

namespace polybody {

namespace detail {
struct Message;
}  // namespace detail

/// Text of the number `x` for messages, with up to `digits` significant digits and a decimal point in every locale.
inline std::string number(double x, int digits = 9) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, digits).ptr};
}

class Error;

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

 protected:
  /// Role of the part in the data of an error.
  enum class Role : unsigned char { text, object, value, time, cause };
  /// Copy of `part` with the role `role`.
  MessagePart(MessagePart const& part, Role role) : MessagePart(part) { role_ = role; }
  /// Part with the message of the error `cause`, which must outlive the part.
  explicit MessagePart(Error const& cause) : kind_(Kind::error), role_(Role::cause), cause_(&cause) {}

 private:
  friend struct detail::Message;
  enum class Kind : unsigned char { text, real, count, error };
  Kind kind_ = Kind::text;
  Role role_ = Role::text;
  union {
    std::string_view text_;
    double real_;
    long long count_;
    Error const* cause_;
  };
};

/// Part of a message that names the object of the error: a body, joint, force, file, type or option. A name in double
/// quotes is the object. Without quotes, the object is the text before the first single colon.
struct ErrorObject : MessagePart {
  /// Part with the text `part`, which names the object.
  explicit ErrorObject(MessagePart const& part) : MessagePart(part, Role::object) {}
};

/// Part of a message that is the refused number.
struct ErrorValue : MessagePart {
  /// Refused number `part`.
  explicit ErrorValue(MessagePart const& part) : MessagePart(part, Role::value) {}
};

/// Part of a message that is the time of the error [s].
struct ErrorTime : MessagePart {
  /// Time `part` [s].
  explicit ErrorTime(MessagePart const& part) : MessagePart(part, Role::time) {}
};

/// Part of a message that contains the message of another error. The code, object, value and time of the other error
/// are used if no earlier part sets them.
struct ErrorCause : MessagePart {
  /// Message and data of `cause`, which must outlive the part.
  explicit ErrorCause(Error const& cause) : MessagePart(cause) {}
};

namespace detail {
/// Text and data of an error. The object is a part of the text.
struct Message {
  std::string text;             ///< joined parts
  char const* code = "";        ///< identifier of the error, or an empty string
  std::size_t object_begin{};   ///< position of the first letter of the object in `text`
  std::size_t object_size{};    ///< number of letters of the object, or zero
  std::optional<double> time;   ///< time [s]
  std::optional<double> value;  ///< refused number

  /// Joins the parts. `identifier` must be a string literal.
  [[gnu::cold]] Message(char const* identifier, std::initializer_list<MessagePart> parts) : code(identifier) {
    for (MessagePart const& part : parts) add(part);
  }

 private:
  using Kind = MessagePart::Kind;
  using Role = MessagePart::Role;

  [[gnu::cold]] void add(MessagePart const& part) {
    std::size_t const begin = text.size();
    if (part.role_ == Role::cause) return add(*part.cause_);
    if (part.kind_ == Kind::text)
      text += part.text_;
    else
      text += part.kind_ == Kind::real ? number(part.real_) : std::to_string(part.count_);
    if (part.role_ == Role::object)
      find_object(begin);
    else if (part.kind_ != Kind::text)
      keep(part, part.kind_ == Kind::real ? part.real_ : double(part.count_));
  }
  [[gnu::cold]] void keep(MessagePart const& part, double x) {
    if (part.role_ == Role::value && !value) value = x;
    if (part.role_ == Role::time && !time) time = x;
  }
  /// Finds the object in the text after position `begin`, if no object is set yet.
  [[gnu::cold]] void find_object(std::size_t begin) {
    if (object_size > 0) return;
    std::string_view name = std::string_view(text).substr(begin);
    if (std::size_t const open = name.find('"'); open < name.size()) {
      begin += open + 1;
      name = name.substr(open + 1, name.find('"', open + 1) - open - 1);
    } else {
      for (std::size_t k = name.find(':'); k < name.size(); k = name.find(':', k)) {  // "planar::Rigid: the mass"
        if (name.substr(k, 2) != "::") name = name.substr(0, k);
        k += 2;
      }
    }
    object_begin = begin;
    object_size = name.size();
  }
  [[gnu::cold]] inline void add(Error const& cause);
};
}  // namespace detail

/// Joins the parts of a message. A chain of `+` would compile to three times as much code.
[[gnu::cold]] inline std::string sentence_of(std::initializer_list<MessagePart> parts) {
  return detail::Message("", parts).text;
}

/// Base class of the exceptions of polybody. It is constructed from a code and the parts of its text:
/// `throw InvalidInput("rigid.mass", {"The mass must be positive, but is ", ErrorValue{mass}, " kg."})`.
/// The code, the object, the value and the time let a program distinguish errors without reading the text.
class Error : public std::runtime_error {
 public:
  /// Constructs the exception from its `text`, without data.
  explicit Error(std::string const& text) : Error(detail::Message("", {text})) {}
  /// Constructs the exception from the parts of its text. An `ErrorCause` among the parts provides the code.
  Error(std::initializer_list<MessagePart> parts) : Error(detail::Message("", parts)) {}
  /// Constructs the exception from its `code`, a string literal, and the parts of its text.
  Error(char const* code, std::initializer_list<MessagePart> parts) : Error(detail::Message(code, parts)) {}

  /// Stable identifier `<area>.<fault>`, listed in the guide. Empty if the error was constructed without a code.
  std::string_view code() const noexcept { return code_; }
  /// Name of the body, joint, force, file, type or option in the message, as a view into `what()`. Empty if there is
  /// none.
  std::string_view object() const noexcept { return {what() + object_begin_, object_size_}; }
  /// Time of the error in the run [s], if the error has one.
  std::optional<double> time() const noexcept { return time_; }
  /// Refused number, in the unit that the message names, if the error has one.
  std::optional<double> value() const noexcept { return value_; }

  /// Appends `sentences` to the message and keeps the data. Code can catch an exception by reference, append to its
  /// message and rethrow it.
  [[gnu::cold]] void append(std::string const& sentences) {
    std::runtime_error::operator=(std::runtime_error(what() + (' ' + sentences)));
  }

 private:
  explicit Error(detail::Message const& m)
      : std::runtime_error(m.text),
        code_(m.code),
        object_begin_(m.object_begin),
        object_size_(m.object_size),
        time_(m.time),
        value_(m.value) {}

  char const* code_;
  std::size_t object_begin_;
  std::size_t object_size_;
  std::optional<double> time_;
  std::optional<double> value_;
};

inline void detail::Message::add(Error const& cause) {
  std::size_t const begin = text.size();
  text += cause.what();
  if (*code == '\0') code = cause.code().data();
  if (object_size == 0 && !cause.object().empty()) {
    object_begin = begin + std::size_t(cause.object().data() - cause.what());
    object_size = cause.object().size();
  }
  if (!time) time = cause.time();
  if (!value) value = cause.value();
}

/// Invalid argument, such as a negative mass, a zero axis or a point outside the body.
class InvalidInput : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// The initial state violates a constraint equation, or constraint equations contradict each other. `assemble` corrects
/// a violation.
class InconsistentInitialConditions : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// Newton's method did not converge, or a step jumps over a contact or gains energy without work. The run keeps the
/// state at the start of the step.
class NewtonConvergenceFailure : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// The step converged, but constraint equations are violated or the energy increased without work. The run keeps the
/// state at the start of the step.
class Diverged : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// A slider is more than one element length beyond an end of its body.
class SliderOutOfRange : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// The step control requires a step below the smallest allowed step.
class MinimumStepReached : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// A computed number, such as a force, coordinate or output, is NaN, infinite or beyond `largest_number`.
class NonFiniteValue : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// The matrix of a linear system is singular.
class SingularMatrix : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

/// A file could not be read or written, or another program or rank failed.
class IoError : public Error {
 public:
  using Error::Error;  ///< same constructors as `Error`
};

}  // namespace polybody
