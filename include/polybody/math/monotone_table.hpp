#pragma once
/// \file
/// Interpolation of given points with a continuous derivative and without overshoot.
/// Theory: Eqs. 9.13, 9.14.

#include <algorithm>
#include <vector>

#include <polybody/math/dual.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Piecewise cubic Hermite polynomial through given points, monotone wherever the points are monotone [Fritsch &
/// Carlson 1980]. It is linear beyond the first and the last point. For points on a straight line, it is this line.
class MonotoneTable {
 public:
  /// Point of the table.
  struct Point {
    double x, y;  ///< abscissa and ordinate, in any units [x] and [y]
  };

  /// Table through `points`: at least two, finite, with strictly increasing x.
  /// \throws InvalidInput for other points, and if a value, derivative or area exceeds `largest_number`; `what` begins
  /// the message.
  explicit MonotoneTable(std::vector<Point> const& points, std::string const& what = "MonotoneTable") {
    if (points.size() < 2)
      throw InvalidInput("table.too_few_points", {ErrorObject{what}, ": a table needs at least two points, but has ",
                                                  ErrorValue{points.size()}, "."});
    for (std::size_t i = 0; i < points.size(); ++i) {
      Point const& p = points[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y))
        throw InvalidInput("value.not_finite", {ErrorObject{what}, ": point ", i + 1,
                                                " of the table must be finite, but is (", p.x, ", ", p.y, ")."});
      if (i > 0 && !(p.x > points[i - 1].x))
        throw InvalidInput("table.not_increasing",
                           {ErrorObject{what}, ": the abscissae of the table must increase, but point ", i + 1,
                            " has x = ", ErrorValue{p.x}, " after x = ", points[i - 1].x,
                            ". Sort the points and remove repeated ones."});
      knots_.push_back({p.x, p.y, 0.0, 0.0});
    }
    set_derivatives();
    for (std::size_t i = 1; i < knots_.size(); ++i)
      knots_[i].area = area(knots_[i - 1], knots_[i].x - knots_[i - 1].x, i);
    double const to_zero = integral(0.0);
    for (Knot& k : knots_) k.area -= to_zero;
    check_pieces(what);
  }

  /// Value at x, a double or a dual number.
  template <StateScalar T>
  T operator()(T const& x) const {
    double const at = value_of(x);
    Local const f = local(at);
    return f.value + (x - at) * f.slope;
  }
  double slope(double x) const { return local(x).slope; }  ///< dy/dx at x
  /// Integral ∫ y dx of the function from 0 to x.
  double integral(double x) const {
    if (x <= knots_.front().x) return line_area(knots_.front(), x);
    if (x >= knots_.back().x) return line_area(knots_.back(), x);
    std::size_t const i = after(x);
    return area(knots_[i - 1], x - knots_[i - 1].x, i);
  }

 private:
  struct Knot {
    double x, y, slope, area;  ///< point [x], [y]; derivative dy/dx [y/x]; area ∫ y dx from 0 to x [x y]
  };
  struct Local {
    double value, slope;  ///< [y] and [y/x]
  };

  /// Computes the derivatives at the points. At an inner point the derivative is the weighted harmonic mean of the
  /// secant slopes δ on both sides, or zero if they differ in sign [Fritsch & Butland 1984]. At the first and the last
  /// point it is the derivative of the parabola through three points, limited to the range from zero to 3δ.
  void set_derivatives() {
    std::size_t const n = knots_.size();
    auto const width = [&](std::size_t i) { return knots_[i + 1].x - knots_[i].x; };
    auto const secant = [&](std::size_t i) { return (knots_[i + 1].y - knots_[i].y) / width(i); };
    if (n == 2) {
      knots_[0].slope = knots_[1].slope = secant(0);
      return;
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      double const h0 = width(i - 1), h1 = width(i), d0 = secant(i - 1), d1 = secant(i);
      double const w0 = h0 + 2.0 * h1, w1 = 2.0 * h0 + h1;
      knots_[i].slope = d0 * d1 > 0.0 ? (w0 + w1) / (w0 / d0 + w1 / d1) : 0.0;
    }
    auto const end = [](double h0, double h1, double d0, double d1) {
      double const parabola = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
      return d0 > 0.0 ? std::clamp(parabola, 0.0, 3.0 * d0) : std::clamp(parabola, 3.0 * d0, 0.0);
    };
    knots_[0].slope = end(width(0), width(1), secant(0), secant(1));
    knots_[n - 1].slope = end(width(n - 2), width(n - 3), secant(n - 2), secant(n - 3));
  }

  /// Checks that no value, derivative or area exceeds `largest_number`. Derivatives are large if neighbouring abscissae
  /// differ only in the last digit of a double. In a piece of length h, |y| + h (|m| + h (|a| + h |b|)) bounds the
  /// values. The symbols are those of `Cubic`.
  void check_pieces(std::string const& what) const {
    for (std::size_t i = 1; i < knots_.size(); ++i) {
      Knot const &k = knots_[i - 1], &next = knots_[i];
      Cubic const c = cubic(i);
      double const h = next.x - k.x, slope = std::max(std::abs(k.slope), std::abs(next.slope));
      double const y = std::abs(k.y) + h * (slope + h * (std::abs(c.a) + h * std::abs(c.b)));
      for (double const x : {slope, c.a, c.b, y, h * y, next.area, 1.0 / (h * h)})
        if (!(std::abs(x) <= largest_number))
          throw InvalidInput(
              "table.magnitude",
              {ErrorObject{what}, ": a value, slope or area of the table between its points ", i, " and ", i + 1,
               " is beyond ", largest_number, ". Give smaller numbers, or abscissae that are farther apart."});
    }
  }

  /// Index of the first knot beyond x. x must lie between the first and the last knot.
  std::size_t after(double x) const {
    auto const before = [](double v, Knot const& k) { return v < k.x; };
    return std::size_t(std::upper_bound(knots_.begin(), knots_.end(), x, before) - knots_.begin());
  }
  /// Cubic y + m u + a u² + b u³ between knots i − 1 and i, u = x − x_{i−1}, with the slopes m, m₁ at the knots, the
  /// secant slope δ and the distance h: a = (3δ − 2m − m₁)/h, b = (m + m₁ − 2δ)/h².
  struct Cubic {
    double a, b;  ///< [y/x²] and [y/x³]
  };
  Cubic cubic(std::size_t i) const {
    Knot const &k = knots_[i - 1], &next = knots_[i];
    double const h = next.x - k.x, d = (next.y - k.y) / h;
    return {(3.0 * d - 2.0 * k.slope - next.slope) / h, (k.slope + next.slope - 2.0 * d) / (h * h)};
  }
  Local local(double x) const {
    auto const line = [x](Knot const& k) { return Local{k.y + k.slope * (x - k.x), k.slope}; };
    if (!(x > knots_.front().x)) return line(knots_.front());
    if (x >= knots_.back().x) return line(knots_.back());
    std::size_t const i = after(x);
    Knot const& k = knots_[i - 1];
    Cubic const c = cubic(i);
    double const u = x - k.x;
    return {k.y + u * (k.slope + u * (c.a + u * c.b)), k.slope + u * (2.0 * c.a + 3.0 * u * c.b)};
  }
  double area(Knot const& k, double u, std::size_t i) const {
    Cubic const c = cubic(i);
    return k.area + u * (k.y + u * (k.slope / 2.0 + u * (c.a / 3.0 + u * c.b / 4.0)));
  }
  static double line_area(Knot const& k, double x) {
    double const u = x - k.x;
    return k.area + u * (k.y + 0.5 * k.slope * u);
  }

  std::vector<Knot> knots_;
};

}  // namespace polybody
