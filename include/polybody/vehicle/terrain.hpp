#pragma once
/// \file
/// Terrains under vehicles: heights z = h(x, y) in the axes of the ground, with z up, and their slopes.

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <polybody/math/dual.hpp>
#include <polybody/math/element_functions.hpp>
#include <polybody/math/monotone_table.hpp>

namespace polybody {

/// Height and slopes at a point; (−∂h/∂x, −∂h/∂y, 1) is normal to the ground.
template <StateScalar T>
struct Height {
  T z;        ///< h [m]
  T slope_x;  ///< ∂h/∂x
  T slope_y;  ///< ∂h/∂y
};

/// Concept of a terrain: a height with continuous slopes, and an upper bound of the height. The bound is infinite if no
/// upper bound is known. A point above the bound has no contact. For dual numbers the slopes also contain their
/// derivatives.
template <class G>
concept Terrain = requires(G const terrain, double x, Dual<2> d, std::string const name) {
  { terrain.template height<double>(x, x) } -> std::same_as<Height<double>>;
  { terrain.template height<Dual<2>>(d, d) } -> std::same_as<Height<Dual<2>>>;
  { terrain.highest() } -> std::convertible_to<double>;
  terrain.check(name);
};

namespace detail {
/// Height at one point and its first and second derivatives.
struct Relief {
  double z = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
};
/// Height and slopes at dual coordinates by the chain rule, dh = ∂h/∂x dx + ∂h/∂y dy. The result is NaN if x or y is
/// NaN.
template <StateScalar T>
Height<T> follow(Relief const& h, T const& x, T const& y) {
  T const dx = x - value_of(x), dy = y - value_of(y);
  return {dx * h.x + dy * h.y + h.z, dx * h.xx + dy * h.xy + h.x, dx * h.xy + dy * h.yy + h.y};
}
}  // namespace detail

/// Horizontal plane at the height z.
struct FlatGround {
  double z = 0.0;  ///< height of the plane [m]

  void check(std::string const& name) const { require_finite(z, name, ": the height of the ground"); }
  double highest() const { return z; }  ///< height of the plane [m]
  /// Height h = z with zero slopes.
  template <StateScalar T>
  Height<T> height(T const&, T const&) const {
    return {T(z), T(0.0), T(0.0)};
  }
};

/// Endless waves h = a sin(2πx/l), the same for every y.
struct Washboard {
  Required<double> amplitude;   ///< a, half the height from trough to crest [m]
  Required<double> wavelength;  ///< l, wavelength [m]

  void check(std::string const& name) const {
    require_not_negative(amplitude, name, ": the amplitude");
    require_positive(wavelength, name, ": the wavelength");
  }
  double highest() const { return amplitude; }  ///< amplitude of the waves [m]
  /// Height h = a sin(2πx/l) and its slope along x.
  template <StateScalar T>
  Height<T> height(T const& x, T const&) const {
    using std::cos, std::sin;
    double const k = 2.0 * std::numbers::pi / wavelength;
    T const phase = x * k;
    return {sin(phase) * amplitude.value, cos(phase) * (amplitude * k), T(0.0)};
  }
};

/// Bump H c((x − x₀)/L) c((y − y₀)/W) with c(s) = ½ (1 + cos 2πs) for |s| < ½, else zero. It is a hole if H is
/// negative.
struct Bump {
  Required<double> x;                                      ///< x₀, position of the middle along x [m]
  Required<double> length;                                 ///< L, length along x from foot to foot [m]
  Required<double> height;                                 ///< H, height of the middle [m]
  double y = 0.0;                                          ///< y₀, position of the middle along y [m]
  double width = std::numeric_limits<double>::infinity();  ///< W, width along y from foot to foot [m]; infinite: c = 1
};

/// Bumps on the plane z = 0. The heights of overlapping bumps are added.
class BumpCourse {
 public:
  /// \throws InvalidInput naming `what` and the bump, counted from 1, if a length or a width is not positive, or if
  /// another number is not finite.
  explicit BumpCourse(std::vector<Bump> bumps, std::string const& what = "BumpCourse") : bumps_(std::move(bumps)) {
    for (std::size_t i = 0; i < bumps_.size(); ++i) {
      Bump const& b = bumps_[i];
      std::string const bump = what + ": bump " + std::to_string(i + 1);
      require_finite(Vec3(b.x, b.y, b.height), bump, ": its middle and height");
      require_positive(b.length, bump, ": the length");
      if (!(b.width > 0.0))
        throw InvalidInput("terrain.bump",
                           {ErrorObject{bump}, ": the width must be positive, but is ", ErrorValue{b.width},
                            " m. Omit the width for a bump across the whole ground."});
      double together = 0.0;  // every bump that covers a point of this bump overlaps it
      for (Bump const& other : bumps_)
        if (std::abs(other.x - b.x) < 0.5 * (other.length + b.length) &&
            std::abs(other.y - b.y) < 0.5 * (other.width + b.width))
          together += std::max(0.0, other.height.value);
      highest_ = std::max(highest_, together);
    }
  }

  void check(std::string const&) const {}      ///< does nothing: the constructor checks the data
  double highest() const { return highest_; }  ///< upper bound of the height [m]
  /// Sum of all bumps at the point (x, y) [m], and its slopes.
  template <StateScalar T>
  Height<T> height(T const& x, T const& y) const {
    detail::Relief h;
    for (Bump const& b : bumps_) {
      double const u = value_of(x) - b.x, v = value_of(y) - b.y;
      if (!(std::abs(u) < 0.5 * b.length && std::abs(v) < 0.5 * b.width)) continue;
      std::array<double, 3> const f = hump(u, b.length), g = hump(v, b.width);
      h.z += b.height * f[0] * g[0];
      h.x += b.height * f[1] * g[0];
      h.y += b.height * f[0] * g[1];
      h.xx += b.height * f[2] * g[0];
      h.xy += b.height * f[1] * g[1];
      h.yy += b.height * f[0] * g[2];
    }
    return detail::follow(h, x, y);
  }

 private:
  /// Function c(u/L) and its first and second derivatives with respect to u; L is `length`.
  static std::array<double, 3> hump(double u, double length) {
    double const k = 2.0 * std::numbers::pi / length, cosine = std::cos(k * u);
    return {0.5 * (1.0 + cosine), -0.5 * k * std::sin(k * u), -0.5 * k * k * cosine};
  }

  std::vector<Bump> bumps_;
  double highest_ = 0.0;
};

/// Road through points (x, z), the same for every y. Between two points the height is monotone, so the road has no
/// extrema except at the points [Fritsch & Carlson 1980; slopes of MonotoneTable]. Both ends are level, and the height
/// is constant beyond them. Copies share the points.
class RoadProfile {
 public:
  /// Point of the profile.
  struct Point {
    double x, z;  ///< coordinates [m]
  };

  /// \throws InvalidInput naming `what` if there are fewer than two points, if a number is not finite, or if x does not
  /// increase strictly.
  explicit RoadProfile(std::vector<Point> const& points, std::string const& what = "RoadProfile") {
    std::vector<MonotoneTable::Point> entries;
    for (Point const& p : points) entries.push_back({p.x, p.z});
    MonotoneTable const table(entries, what);
    std::vector<Knot> knots;
    for (Point const& p : points) knots.push_back({p.x, p.z, table.slope(p.x)});
    knots.front().slope = knots.back().slope = 0.0;
    for (Knot const& k : knots) highest_ = std::max(highest_, k.z);
    knots_ = std::make_shared<std::vector<Knot> const>(std::move(knots));
  }

  void check(std::string const&) const {}      ///< does nothing: the constructor checks the data
  double highest() const { return highest_; }  ///< upper bound of the height [m]
  /// Height at (x, y) [m] and its slope along x: a cubic between two points of the profile, constant beyond both ends.
  template <StateScalar T>
  Height<T> height(T const& x, T const& y) const {
    double const at = value_of(x);
    auto const after =
        std::upper_bound(knots_->begin(), knots_->end(), at, [](double v, Knot const& k) { return v < k.x; });
    if (after == knots_->begin() || after == knots_->end())
      return detail::follow({.z = after == knots_->begin() ? knots_->front().z : knots_->back().z}, x, y);
    Knot const &a = *(after - 1), &b = *after;
    ShapeValues<4> const h = hermite_shape((at - a.x) / (b.x - a.x), b.x - a.x);
    auto const of = [&](std::array<double, 4> const& s) {
      return s[0] * a.z + s[1] * a.slope + s[2] * b.z + s[3] * b.slope;
    };
    double const z = std::clamp(of(h.s), std::min(a.z, b.z), std::max(a.z, b.z));  // round-off may exceed these bounds
    return detail::follow({.z = z, .x = of(h.ds), .xx = of(h.dds)}, x, y);
  }

 private:
  struct Knot {
    double x, z, slope;  ///< coordinates [m] and slope of a point
  };
  std::shared_ptr<std::vector<Knot> const> knots_;
  double highest_ = -std::numeric_limits<double>::infinity();
};

static_assert(Terrain<FlatGround> && Terrain<Washboard> && Terrain<BumpCourse> && Terrain<RoadProfile>);

}  // namespace polybody
