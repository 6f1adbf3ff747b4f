#pragma once
/// \file
/// Reverse-mode numbers: a value that a recording remembers with the partial derivatives of the operation that made it.
/// For z = f(x, y) recorded, z̄ = ∂J/∂z of a result J gives x̄ += z̄ ∂f/∂x, ȳ += z̄ ∂f/∂y, the operations taken
/// backwards [Griewank & Walther 2008, §3.2]: all derivatives of one result by one sweep.
///
/// Constants are recorded nowhere: sums with them and products with one or zero add nothing.
///
/// Not in polybody.hpp: only derivatives of whole runs record (gradients/gradient.hpp).

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>

#include <polybody/math/dual.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Operations on recorded numbers in their order, each with its two arguments and the derivatives by them.
class Recording {
 public:
  /// Number of an operation in the recording; that of all constants is zero.
  using Number = std::int32_t;

  /// Forgets all operations; the memory stays.
  void clear() { size_ = 1; }
  /// How many operations there are, with the one that stands for constants.
  std::size_t size() const { return size_; }

  /// An independent variable.
  Number variable() { return record(0, 0.0, 0, 0.0); }
  /// A result of numbers `a` and `b`; `by_a` and `by_b` are its partial derivatives.
  Number record(Number a, double by_a, Number b, double by_b) {
    if (size_ >= operations_.size()) [[unlikely]]
      grow();
    operations_[size_] = {by_a, by_b, a, b};
    return Number(size_++);
  }

  /// Before a sweep: J changes with none of the first `count` operations.
  void clear_slopes(std::size_t count) {
    if (slopes_.size() < count) slopes_.resize(operations_.size());
    std::fill(slopes_.begin(), slopes_.begin() + std::ptrdiff_t(count), 0.0);
  }
  /// ∂J/∂x of the operation with this number, to be added to before a sweep and read after it.
  double& slope(Number x) { return slopes_[std::size_t(x)]; }
  /// Takes the first `count` operations backwards.
  void sweep(std::size_t count) { sweep(count, 1); }
  /// Takes operations backwards from the one before `end` to `begin`, one at least.
  void sweep(std::size_t end, std::size_t begin) {
    double* const slopes = slopes_.data();
    for (std::size_t i = end; i-- > begin;) {
      double const s = slopes[i];
      if (s == 0.0) continue;
      Operation const& o = operations_[i];
      slopes[o.a] += o.by_a * s;
      slopes[o.b] += o.by_b * s;
    }
  }

  /// The recording of this thread that operations go to.
  static Recording& current() { return *current_; }
  /// While it lives, operations of its thread go to a recording, which it clears first.
  class On {
   public:
    explicit On(Recording& recording) : before_(current_) {  ///< to `recording`
      recording.clear();
      current_ = &recording;
    }
    On(On const&) = delete;
    On& operator=(On const&) = delete;
    ~On() { current_ = before_; }

   private:
    Recording* before_;
  };

 private:
  struct Operation {
    double by_a = 0.0, by_b = 0.0;  ///< derivatives by both arguments: factors of the slope
    Number a = 0, b = 0;            ///< the arguments
  };
  [[gnu::cold]] void grow() {
    if (this == &none_)
      throw InvalidInput(
          "A recorded number was made while no recording was on. Let Recording::On live around the calculation.");
    operations_.resize(std::max<std::size_t>(2 * operations_.size(), 4096));
  }

  static Recording none_;
  static thread_local Recording* current_;

  Sequence<Operation> operations_;
  Sequence<double> slopes_;
  std::size_t size_ = 0;
};
inline Recording Recording::none_;
inline thread_local constinit Recording* Recording::current_ = &Recording::none_;

/// A value, and its number in the recording of its thread.
struct Recorded {
  double v = 0.0;                ///< value, in the unit of the quantity that it stands for
  Recording::Number number = 0;  ///< zero: a constant

  Recorded() = default;
  /// A constant of this value.
  Recorded(double value) : v(value) {}  // NOLINT(google-explicit-constructor): a constant is a recorded number
  Recorded(double value, Recording::Number of) : v(value), number(of) {}  ///< a value with the number `of`

  /// An independent variable of this value.
  static Recorded variable(double value) { return {value, Recording::current().variable()}; }
  /// f(a) of this value and with the derivative `by_a` = f′(a).
  static Recorded of(double value, Recorded const& a, double by_a) {
    return {value, a.number == 0 || by_a == 0.0 ? 0 : Recording::current().record(a.number, by_a, 0, 0.0)};
  }
  /// f(a, b) of this value and with its partial derivatives `by_a` and `by_b`.
  static Recorded of(double value, Recorded const& a, double by_a, Recorded const& b, double by_b) {
    if (b.number == 0) return of(value, a, by_a);
    if (a.number == 0) return of(value, b, by_b);
    return {value, Recording::current().record(a.number, by_a, b.number, by_b)};
  }

  friend Recorded operator+(Recorded const& a, Recorded const& b) {
    if (b.number == 0) return {a.v + b.v, a.number};
    if (a.number == 0) return {a.v + b.v, b.number};
    return {a.v + b.v, Recording::current().record(a.number, 1.0, b.number, 1.0)};
  }
  friend Recorded operator-(Recorded const& a, Recorded const& b) {
    if (b.number == 0) return {a.v - b.v, a.number};
    return of(a.v - b.v, a, 1.0, b, -1.0);
  }
  friend Recorded operator*(Recorded const& a, Recorded const& b) {
    if (b.number == 0) return a.times(b.v);
    if (a.number == 0) return b.times(a.v);
    return {a.v * b.v, Recording::current().record(a.number, b.v, b.number, a.v)};
  }
  friend Recorded operator/(Recorded const& a, Recorded const& b) {
    double const inverse = 1.0 / b.v, quotient = a.v * inverse;
    return of(quotient, a, inverse, b, -quotient * inverse);
  }
  friend Recorded operator-(Recorded const& a) { return of(-a.v, a, -1.0); }
  friend Recorded operator+(Recorded const& a) { return a; }
  Recorded& operator+=(Recorded const& b) { return *this = *this + b; }  ///< the sum takes its place
  Recorded& operator-=(Recorded const& b) { return *this = *this - b; }  ///< the difference takes its place
  Recorded& operator*=(Recorded const& b) { return *this = *this * b; }  ///< the product takes its place
  Recorded& operator/=(Recorded const& b) { return *this = *this / b; }  ///< the quotient takes its place

  friend bool operator==(Recorded const& a, Recorded const& b) { return a.v == b.v; }
  friend auto operator<=>(Recorded const& a, Recorded const& b) { return a.v <=> b.v; }

  friend Recorded sqrt(Recorded const& a) {
    double const s = std::sqrt(a.v);
    return of(s, a, 0.5 / s);
  }
  friend Recorded sin(Recorded const& a) { return of(std::sin(a.v), a, std::cos(a.v)); }
  friend Recorded cos(Recorded const& a) { return of(std::cos(a.v), a, -std::sin(a.v)); }
  friend Recorded tan(Recorded const& a) {
    double const t = std::tan(a.v);
    return of(t, a, 1.0 + t * t);
  }
  friend Recorded asin(Recorded const& a) { return of(std::asin(a.v), a, 1.0 / std::sqrt(1.0 - a.v * a.v)); }
  friend Recorded acos(Recorded const& a) { return of(std::acos(a.v), a, -1.0 / std::sqrt(1.0 - a.v * a.v)); }
  friend Recorded atan(Recorded const& a) { return of(std::atan(a.v), a, 1.0 / (1.0 + a.v * a.v)); }
  friend Recorded atan2(Recorded const& y, Recorded const& x) {
    double const r2 = x.v * x.v + y.v * y.v;
    return of(std::atan2(y.v, x.v), y, x.v / r2, x, -y.v / r2);
  }
  friend Recorded exp(Recorded const& a) {
    double const e = std::exp(a.v);
    return of(e, a, e);
  }
  friend Recorded log(Recorded const& a) { return of(std::log(a.v), a, 1.0 / a.v); }
  friend Recorded pow(Recorded const& a, double p) { return of(std::pow(a.v, p), a, p * std::pow(a.v, p - 1.0)); }
  friend Recorded tanh(Recorded const& a) {
    double const t = std::tanh(a.v);
    return of(t, a, 1.0 - t * t);
  }
  friend Recorded abs(Recorded const& a) { return a.v < 0.0 ? -a : a; }
  friend Recorded abs2(Recorded const& a) { return a * a; }
  friend Recorded hypot(Recorded const& a, Recorded const& b) { return sqrt(a * a + b * b); }
  friend Recorded max(Recorded const& a, Recorded const& b) { return a.v < b.v ? b : a; }
  friend Recorded min(Recorded const& a, Recorded const& b) { return b.v < a.v ? b : a; }
  friend bool isfinite(Recorded const& a) { return std::isfinite(a.v); }

 private:
  Recorded times(double c) const {
    if (c == 1.0) return *this;
    return of(v * c, *this, c);
  }
};

/// The value alone.
inline double value_of(Recorded const& x) { return x.v; }

}  // namespace polybody

template <>
struct Eigen::NumTraits<polybody::Recorded> : Eigen::NumTraits<double> {
  using Real = polybody::Recorded;
  using NonInteger = polybody::Recorded;
  using Nested = polybody::Recorded;
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
struct Eigen::ScalarBinaryOpTraits<polybody::Recorded, double, BinaryOp> {
  using ReturnType = polybody::Recorded;
};
template <class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<double, polybody::Recorded, BinaryOp> {
  using ReturnType = polybody::Recorded;
};
