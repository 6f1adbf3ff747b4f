#pragma once
/// \file
/// Tape and scalar type for reverse differentiation.

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>

#include <polybody/math/dual.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Tape for reverse differentiation: sequence of operations, each with its two arguments and its partial derivatives
/// [Griewank & Walther 2008, §3.2]. If z = f(x, y) is recorded and z̄ = ∂J/∂z for a result J, then
///   x̄ += z̄ ∂f/∂x,   ȳ += z̄ ∂f/∂y,
/// in the reverse order of the operations. One backward sweep yields all derivatives of one result.
///
/// Constants are not recorded. Sums with constants and products with one or zero add no operations to the tape.
class Tape {
 public:
  /// Number of an operation on the tape; zero for all constants.
  using Number = std::int32_t;

  /// Removes all operations and keeps the memory.
  void clear() { size_ = 1; }
  /// Number of operations, including one that represents the constants.
  std::size_t size() const { return size_; }

  /// Records an independent variable.
  Number variable() { return record(0, 0.0, 0, 0.0); }
  /// Records an operation with the arguments `a` and `b`. Its result has the partial derivatives `by_a` and `by_b` with
  /// respect to the arguments.
  Number record(Number a, double by_a, Number b, double by_b) {
    if (size_ >= operations_.size()) [[unlikely]]
      grow();
    operations_[size_] = {by_a, by_b, a, b};
    return Number(size_++);
  }

  /// Prepares a backward sweep: sets the derivatives of J with respect to the first `count` operations to zero.
  void clear_derivatives(std::size_t count) {
    if (derivatives_.size() < count) derivatives_.resize(operations_.size());
    std::fill(derivatives_.begin(), derivatives_.begin() + std::ptrdiff_t(count), 0.0);
  }
  /// Derivative ∂J/∂x of a result J with respect to operation x. Before a sweep, add the seed (1 if x is J); after the
  /// sweep, read the derivative.
  double& slope(Number x) { return derivatives_[std::size_t(x)]; }
  /// Backward sweep over the first `count` operations.
  void sweep(std::size_t count) { sweep(count, 1); }
  /// Backward sweep over the operations from `end` − 1 down to `begin`, with `begin` ≥ 1.
  void sweep(std::size_t end, std::size_t begin) {
    double* const derivatives = derivatives_.data();
    for (std::size_t i = end; i-- > begin;) {
      double const s = derivatives[i];
      if (s == 0.0) continue;
      Operation const& o = operations_[i];
      derivatives[o.a] += o.by_a * s;
      derivatives[o.b] += o.by_b * s;
    }
  }

  /// Current tape of the calling thread.
  static Tape& current() { return *current_; }
  /// Guard that makes a tape current in the calling thread during the lifetime of the guard. The constructor clears the
  /// tape.
  class On {
   public:
    explicit On(Tape& recording) : before_(current_) {  ///< uses the tape `recording`
      recording.clear();
      current_ = &recording;
    }
    On(On const&) = delete;
    On& operator=(On const&) = delete;
    ~On() { current_ = before_; }

   private:
    Tape* before_;
  };

 private:
  struct Operation {
    double by_a = 0.0, by_b = 0.0;  ///< partial derivatives with respect to both arguments: factors of ∂J/∂z
    Number a = 0, b = 0;            ///< numbers of the arguments
  };
  [[gnu::cold]] void grow() {
    if (this == &none_)
      throw InvalidInput("tape.not_recording", {"A ReverseVar was calculated while no tape was active. Keep a "
                                                "Tape::On object alive during the calculation."});
    operations_.resize(std::max<std::size_t>(2 * operations_.size(), 4096));
  }

  static Tape none_;
  static thread_local Tape* current_;

  Sequence<Operation> operations_;
  Sequence<double> derivatives_;
  std::size_t size_ = 0;
};
inline Tape Tape::none_;
inline thread_local constinit Tape* Tape::current_ = &Tape::none_;

/// Scalar for reverse differentiation: a value, and the number of the operation on the current tape that computed it.
struct ReverseVar {
  double v = 0.0;           ///< value, in the unit of the quantity
  Tape::Number number = 0;  ///< number of the operation that computed the value; zero for a constant

  ReverseVar() = default;
  /// The constant `value`.
  ReverseVar(double value) : v(value) {}  // NOLINT(google-explicit-constructor): a constant is a ReverseVar
  ReverseVar(double value, Tape::Number of) : v(value), number(of) {}  ///< value with the number `of` on the tape

  /// Independent variable with the value `value`.
  static ReverseVar variable(double value) { return {value, Tape::current().variable()}; }
  /// Result f(a) with the value `value` and the derivative `by_a` = f′(a).
  static ReverseVar of(double value, ReverseVar const& a, double by_a) {
    return {value, a.number == 0 || by_a == 0.0 ? 0 : Tape::current().record(a.number, by_a, 0, 0.0)};
  }
  /// Result f(a, b) with the value `value` and the partial derivatives `by_a` and `by_b`.
  static ReverseVar of(double value, ReverseVar const& a, double by_a, ReverseVar const& b, double by_b) {
    if (b.number == 0) return of(value, a, by_a);
    if (a.number == 0) return of(value, b, by_b);
    return {value, Tape::current().record(a.number, by_a, b.number, by_b)};
  }

  friend ReverseVar operator+(ReverseVar const& a, ReverseVar const& b) {
    if (b.number == 0) return {a.v + b.v, a.number};
    if (a.number == 0) return {a.v + b.v, b.number};
    return {a.v + b.v, Tape::current().record(a.number, 1.0, b.number, 1.0)};
  }
  friend ReverseVar operator-(ReverseVar const& a, ReverseVar const& b) {
    if (b.number == 0) return {a.v - b.v, a.number};
    return of(a.v - b.v, a, 1.0, b, -1.0);
  }
  friend ReverseVar operator*(ReverseVar const& a, ReverseVar const& b) {
    if (b.number == 0) return a.times(b.v);
    if (a.number == 0) return b.times(a.v);
    return {a.v * b.v, Tape::current().record(a.number, b.v, b.number, a.v)};
  }
  friend ReverseVar operator/(ReverseVar const& a, ReverseVar const& b) {
    double const inverse = 1.0 / b.v, quotient = a.v * inverse;
    return of(quotient, a, inverse, b, -quotient * inverse);
  }
  friend ReverseVar operator-(ReverseVar const& a) { return of(-a.v, a, -1.0); }
  friend ReverseVar operator+(ReverseVar const& a) { return a; }
  ReverseVar& operator+=(ReverseVar const& b) { return *this = *this + b; }  ///< assigns the sum
  ReverseVar& operator-=(ReverseVar const& b) { return *this = *this - b; }  ///< assigns the difference
  ReverseVar& operator*=(ReverseVar const& b) { return *this = *this * b; }  ///< assigns the product
  ReverseVar& operator/=(ReverseVar const& b) { return *this = *this / b; }  ///< assigns the quotient

  friend bool operator==(ReverseVar const& a, ReverseVar const& b) { return a.v == b.v; }
  friend auto operator<=>(ReverseVar const& a, ReverseVar const& b) { return a.v <=> b.v; }

  friend ReverseVar sqrt(ReverseVar const& a) {
    double const s = std::sqrt(a.v);
    return of(s, a, 0.5 / s);
  }
  friend ReverseVar sin(ReverseVar const& a) { return of(std::sin(a.v), a, std::cos(a.v)); }
  friend ReverseVar cos(ReverseVar const& a) { return of(std::cos(a.v), a, -std::sin(a.v)); }
  friend ReverseVar tan(ReverseVar const& a) {
    double const t = std::tan(a.v);
    return of(t, a, 1.0 + t * t);
  }
  friend ReverseVar asin(ReverseVar const& a) { return of(std::asin(a.v), a, 1.0 / std::sqrt(1.0 - a.v * a.v)); }
  friend ReverseVar acos(ReverseVar const& a) { return of(std::acos(a.v), a, -1.0 / std::sqrt(1.0 - a.v * a.v)); }
  friend ReverseVar atan(ReverseVar const& a) { return of(std::atan(a.v), a, 1.0 / (1.0 + a.v * a.v)); }
  friend ReverseVar atan2(ReverseVar const& y, ReverseVar const& x) {
    double const r2 = x.v * x.v + y.v * y.v;
    return of(std::atan2(y.v, x.v), y, x.v / r2, x, -y.v / r2);
  }
  friend ReverseVar exp(ReverseVar const& a) {
    double const e = std::exp(a.v);
    return of(e, a, e);
  }
  friend ReverseVar log(ReverseVar const& a) { return of(std::log(a.v), a, 1.0 / a.v); }
  friend ReverseVar pow(ReverseVar const& a, double p) { return of(std::pow(a.v, p), a, p * std::pow(a.v, p - 1.0)); }
  friend ReverseVar tanh(ReverseVar const& a) {
    double const t = std::tanh(a.v);
    return of(t, a, 1.0 - t * t);
  }
  friend ReverseVar abs(ReverseVar const& a) { return a.v < 0.0 ? -a : a; }
  friend ReverseVar abs2(ReverseVar const& a) { return a * a; }
  friend ReverseVar hypot(ReverseVar const& a, ReverseVar const& b) { return sqrt(a * a + b * b); }
  friend ReverseVar max(ReverseVar const& a, ReverseVar const& b) { return a.v < b.v ? b : a; }
  friend ReverseVar min(ReverseVar const& a, ReverseVar const& b) { return b.v < a.v ? b : a; }
  friend bool isfinite(ReverseVar const& a) { return std::isfinite(a.v); }

 private:
  ReverseVar times(double c) const {
    if (c == 1.0) return *this;
    return of(v * c, *this, c);
  }
};

/// Value of `x` without its number on the tape.
inline double value_of(ReverseVar const& x) { return x.v; }

}  // namespace polybody

template <>
struct Eigen::NumTraits<polybody::ReverseVar> : Eigen::NumTraits<double> {
  using Real = polybody::ReverseVar;
  using NonInteger = polybody::ReverseVar;
  using Nested = polybody::ReverseVar;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 6,
    MulCost = 6
  };
};

template <class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<polybody::ReverseVar, double, BinaryOp> {
  using ReturnType = polybody::ReverseVar;
};
template <class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<double, polybody::ReverseVar, BinaryOp> {
  using ReturnType = polybody::ReverseVar;
};
