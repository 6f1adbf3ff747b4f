#pragma once
/// \file
/// Function of time that interpolates measured or planned points.

#include <algorithm>
#include <optional>

#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Cubic spline through points (t, value) with continuous value, rate and acceleration [de Boor 1978, ch. IV]. The
/// first and the last rate may be prescribed; an end without a prescribed rate has zero acceleration (natural spline).
/// Beyond the ends the spline is continued linearly with the rate at the end.
class SmoothTable {
 public:
  /// Point of the table.
  struct Point {
    double time;   ///< time [s]
    double value;  ///< value [m] or [rad]
  };
  /// Prescribed rates at the ends of the table.
  struct Ends {
    std::optional<double> first_rate = {};  ///< rate at the first point [m/s] or [rad/s]
    std::optional<double> last_rate = {};   ///< rate at the last point [m/s] or [rad/s]
  };

  /// Natural spline through `points`: zero acceleration at both ends.
  /// \throws InvalidInput for fewer than two points, for times that do not increase, and for points or coefficients of
  /// the spline that are not finite or exceed `largest_number`.
  explicit SmoothTable(std::vector<Point> const& points) : SmoothTable(points, Ends{}) {}
  /// Spline with prescribed rates at the ends. \throws InvalidInput if the points, the rates or the coefficients are
  /// not valid; `what` begins the message.
  SmoothTable(std::vector<Point> const& points, Ends const& ends, std::string const& what = "SmoothTable")
      : knots_(points.size()) {
    check_points(points, ends, what);
    std::size_t const last = points.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) knots_[i] = {.time = points[i].time, .value = points[i].value};
    solve(ends);
    for (std::size_t i = 0; i < last; ++i) {
      Knot &k = knots_[i], &next = knots_[i + 1];
      double const h = next.time - k.time;
      k.rate = (next.value - k.value) / h - h * (2.0 * k.second + next.second) / 6.0;
      k.third = (next.second - k.second) / h;
      next.integral = integral_to(k, next.time);
      next.rate = k.rate + 0.5 * h * (k.second + next.second);
    }
    check_knots(what);
    for (Knot const& end : {knots_.front(), knots_.back()})
      if (end.second != 0.0) breakpoints_.push_back(end.time);
    knots_.back().second = 0.0;
  }

  /// Value, rate and acceleration at t [s].
  Motion operator()(double t) const {
    Knot const k = piece(t);
    double const x = t - k.time;
    return {k.value + x * (k.rate + x * (k.second / 2.0 + x * k.third / 6.0)),
            k.rate + x * (k.second + x * k.third / 2.0), k.second + x * k.third};
  }
  /// Integral ∫ value dt from the first point to t: [m s] or [rad s].
  double integral(double t) const { return integral_to(piece(t), t); }
  /// Times of the ends at which the acceleration is discontinuous [s].
  std::vector<double> breakpoints() const { return breakpoints_; }

 private:
  /// Point with value and derivatives of the spline piece that begins there: [m], [m/s], [m/s²], [m/s³], or [rad] for
  /// [m].
  struct Knot {
    double time = 0.0, value = 0.0, rate = 0.0, second = 0.0, third = 0.0;
    double integral = 0.0;  ///< ∫ value dt from the first point to this one
  };

  static void check_points(std::vector<Point> const& points, Ends const& ends, std::string const& what) {
    if (points.size() < 2)
      throw InvalidInput("table.too_few_points", {ErrorObject{what}, ": at least two points are needed, but there are ",
                                                  ErrorValue{points.size()}, "."});
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!std::isfinite(points[i].time) || !std::isfinite(points[i].value))
        throw InvalidInput("value.not_finite", {ErrorObject{what}, ": point ", i + 1, " must be finite, but has t = ",
                                                points[i].time, " s and the value ", points[i].value, "."});
      if (i > 0 && !(points[i].time > points[i - 1].time))
        throw InvalidInput(
            "table.not_increasing",
            {ErrorObject{what}, ": the times must increase, but point ", i + 1, " at t = ", ErrorValue{points[i].time},
             " s follows a point at ", points[i - 1].time, " s. Sort the points and remove repeated times."});
    }
    require_finite(ends.first_rate.value_or(0.0), what, ": the rate at the first point");
    require_finite(ends.last_rate.value_or(0.0), what, ": the rate at the last point");
  }

  /// Checks that no value, derivative or integral exceeds `largest_number`. Rates are large if neighbouring times
  /// differ only in the last digit of a double. The bound of the value in a piece of length h is |v| + h (|v′| + h
  /// (|v″| + h |v‴|)).
  void check_knots(std::string const& what) const {
    for (std::size_t i = 0; i < knots_.size(); ++i) {
      Knot const& k = knots_[i];
      std::size_t const piece = std::min(i, knots_.size() - 2);
      double const h = knots_[piece + 1].time - knots_[piece].time, rate = std::abs(k.rate);
      double const second = std::abs(k.second), third = std::abs(k.third);
      double const value = std::abs(k.value) + h * (rate + h * (second + h * third));
      for (double const x : {rate, second, third, value, h * value, std::abs(k.integral)})
        if (!(x <= largest_number))
          throw InvalidInput("table.magnitude",
                             {ErrorObject{what}, ": a value, rate, acceleration or integral of the spline at point ",
                              i + 1, ", t = ", k.time, " s, is beyond ", largest_number,
                              ". Give smaller values, or times that are farther apart."});
    }
  }

  /// Computes the second derivatives mᵢ for which the rates are continuous. Piece i has the length hᵢ; its chord has
  /// the slope sᵢ:
  ///   hᵢ₋₁ mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 (sᵢ − sᵢ₋₁).
  /// At an end, the prescribed rate replaces the missing slope s, and the missing h is zero.
  void solve(Ends const& ends) {
    std::size_t const n = knots_.size();
    std::vector<double> upper(n, 0.0);
    double slope = ends.first_rate.value_or(0.0), lower = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      bool const first = i == 0, last = i + 1 == n;
      double const h = last ? 0.0 : knots_[i + 1].time - knots_[i].time;
      double const next = last ? ends.last_rate.value_or(0.0) : (knots_[i + 1].value - knots_[i].value) / h;
      if ((first && !ends.first_rate) || (last && !ends.last_rate)) {
        knots_[i].second = upper[i] = 0.0;
      } else {
        double const pivot = 2.0 * (lower + h) - (first ? 0.0 : lower * upper[i - 1]);
        upper[i] = h / pivot;
        knots_[i].second = (6.0 * (next - slope) - (first ? 0.0 : lower * knots_[i - 1].second)) / pivot;
      }
      slope = next;
      lower = h;
    }
    for (std::size_t i = n - 1; i-- > 0;) knots_[i].second -= upper[i] * knots_[i + 1].second;
  }

  /// Spline piece that contains t; a straight line outside the table.
  Knot piece(double t) const {
    auto const after =
        std::upper_bound(knots_.begin(), knots_.end(), t, [](double x, Knot const& k) { return x < k.time; });
    if (after != knots_.begin()) return *(after - 1);
    Knot before = knots_.front();
    before.second = before.third = 0.0;
    return before;
  }
  static double integral_to(Knot const& k, double t) {
    double const x = t - k.time;
    return k.integral + x * (k.value + x * (k.rate / 2.0 + x * (k.second / 6.0 + x * k.third / 24.0)));
  }

  std::vector<Knot> knots_;
  std::vector<double> breakpoints_;
};

}  // namespace polybody
