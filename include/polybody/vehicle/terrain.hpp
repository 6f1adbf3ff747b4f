#pragma once
/// \file
/// Terrains under vehicles: heights z = h(x, y) in the axes of the ground, with z up, and their slopes. `HeightField`
/// is ground given by heights on a grid, for example from a survey or a generated road.
/// Theory: Eqs. 9.63, 9.64.

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

  void check(std::string const& name) const { require_finite(z, name, ": the height of the ground", "m"); }
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
    require_not_negative(amplitude, name, ": the amplitude", "m");
    require_positive(wavelength, name, ": the wavelength", "m");
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
      require_finite(Vec3(b.x, b.y, b.height), bump, ": its middle and height", "m");
      require_positive(b.length, bump, ": the length", "m");
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

/// Ground through heights on a grid: bicubic in each cell, with continuous slopes [Catmull & Rom 1974, along x and
/// along y]. The slope at a grid point equals the slope of the chord between its two neighbours. At a border point the
/// slope equals the slope of the chord to the only neighbour. So heights z = a + bx + cy + dxy are reproduced exactly
/// within the grid, and parabolas in the cells that do not touch the border. Beyond the border, the slope normal to the
/// border decreases to zero linearly over one spacing and is zero farther out. Four numbers are stored for each height;
/// copies share them.
class HeightField {
 public:
  /// Heights at the corners of equal rectangles.
  struct Grid {
    Required<double> x0, y0;  ///< position of heights(0, 0) [m]
    Required<double> dx, dy;  ///< spacings [m]
    MatX heights;             ///< (nx × ny) heights(i, j) at (x0 + i dx, y0 + j dy) [m]
  };

  /// \throws InvalidInput naming `what` if there are fewer than two points along x or y, if a spacing is not positive,
  /// if x0, y0 or a height is not finite, or if a slope or curvature exceeds `largest_number`.
  explicit HeightField(Grid const& grid, std::string const& what = "HeightField") {
    MatX const& z = grid.heights;
    require_finite(Vec2(grid.x0, grid.y0), what, ": the position x0, y0 of the first point", "m");
    require_positive(grid.dx, what, ": the spacing dx", "m");
    require_positive(grid.dy, what, ": the spacing dy", "m");
    if (z.rows() < 2 || z.cols() < 2)
      throw InvalidInput("terrain.grid",
                         {ErrorObject{what}, ": a grid needs at least two points along x and along y, but has ",
                          z.rows(), " by ", z.cols(), ". For a ground that does not change along y use RoadProfile."});
    for (Index j = 0; j < z.cols(); ++j)
      for (Index i = 0; i < z.rows(); ++i)
        if (!std::isfinite(z(i, j)))
          throw InvalidInput("value.not_finite",
                             {ErrorObject{what}, ": heights(", i, ", ", j, ") must be finite, but is ",
                              ErrorValue{z(i, j)}, ". Fill gaps in the data first."});
    x_ = {.start = grid.x0 - grid.dx, .spacing = grid.dx, .cells = z.rows() + 1};
    y_ = {.start = grid.y0 - grid.dy, .spacing = grid.dy, .cells = z.cols() + 1};
    nodes_ = std::make_shared<MatX const>(with_slopes(with_slopes(z, grid.dx).transpose(), grid.dy).transpose());
    double const finest = std::min<double>(grid.dx, grid.dy);
    bool computable = largest_number * finest * finest >= 1.0;
    for (double const x : nodes_->reshaped()) computable = computable && std::abs(x) <= largest_number;
    if (!computable)
      throw InvalidInput("terrain.magnitude", {ErrorObject{what}, ": its slopes or curvatures exceed ", largest_number,
                                               ". Give heights and spacings in metres."});
    highest_ = z.maxCoeff();
    Mat<double, 4, 4> const bx = x_.bezier(), by = y_.bezier();
    for (Index j = 0; j < y_.cells; ++j)
      for (Index i = 0; i < x_.cells; ++i)
        highest_ = std::max(highest_, (bx * nodes_->block<4, 4>(2 * i, 2 * j) * by.transpose()).eval().maxCoeff());
  }

  void check(std::string const&) const {}      ///< does nothing: the constructor checks the data
  double highest() const { return highest_; }  ///< upper bound of the height, inside and outside of the grid [m]
  /// Height h = s(x)ᵀ N s(y) and its derivatives h(k, l) = ∂ᵏ⁺ˡh/∂xᵏ∂yˡ. s are the Hermite polynomials; N contains the
  /// values and slopes at the corners of the cell.
  template <StateScalar T>
  Height<T> height(T const& x, T const& y) const {
    Piece const px = x_.piece(value_of(x)), py = y_.piece(value_of(y));
    Mat3 const h = px.shape.transpose() * nodes_->block<4, 4>(2 * px.cell, 2 * py.cell) * py.shape;
    return detail::follow({.z = h(0, 0), .x = h(1, 0), .y = h(0, 1), .xx = h(2, 0), .xy = h(1, 1), .yy = h(0, 2)}, x,
                          y);
  }

 private:
  struct Piece {
    Index cell;
    Mat<double, 4, 3> shape;  ///< Hermite polynomials, their first and their second derivatives
  };
  /// Cells along x or y; the first and the last cell lie outside of the grid.
  struct Axis {
    double start = 0.0, spacing = 1.0;  ///< start of the first cell and length of a cell [m]
    Index cells = 0;

    Piece piece(double x) const {
      double const s = (x - start) / spacing, end = double(cells);
      bool const inside = s > 0.0 && s < end;
      double const at = inside ? s : s >= end ? end : 0.0;
      Index const cell = std::min(Index(at), cells - 1);
      ShapeValues<4> const h = hermite_shape(at - double(cell), spacing);
      Piece p{cell, Mat<double, 4, 3>::Zero()};
      // Outside of the cells the slope and its derivative are zero.
      for (int i = 0; i < 4; ++i) p.shape.row(i) << h.s[i], h.ds[i], inside ? h.dds[i] : 0.0;
      return p;
    }
    /// Matrix that maps (z₀, z₀′, z₁, z₁′) to the Bézier ordinates (z₀, z₀ + z₀′h/3, z₁ − z₁′h/3, z₁). A cubic does not
    /// exceed its highest ordinate.
    Mat<double, 4, 4> bezier() const {
      double const third = spacing / 3.0;
      return Mat<double, 4, 4>{
          {1.0, 0.0, 0.0, 0.0}, {1.0, third, 0.0, 0.0}, {0.0, 0.0, 1.0, -third}, {0.0, 0.0, 1.0, 0.0}};
    }
  };

  /// Matrix with values and slopes in alternate rows, for the n rows of z with spacing h and one added row on either
  /// side. In the added rows the slope is zero. Their values are z₁ − hz₁′/2 and zₙ + hzₙ′/2, from the first and the
  /// last row of z.
  static MatX with_slopes(MatX const& z, double h) {
    Index const n = z.rows();
    MatX all = MatX::Zero(2 * n + 4, z.cols());
    for (Index i = 0; i < n; ++i) all.row(2 * i + 2) = z.row(i);
    for (Index i = 1; i + 1 < n; ++i) all.row(2 * i + 3) = (z.row(i + 1) - z.row(i - 1)) / (2.0 * h);
    all.row(3) = (z.row(1) - z.row(0)) / h;
    all.row(2 * n + 1) = (z.row(n - 1) - z.row(n - 2)) / h;
    all.row(0) = z.row(0) - 0.5 * h * all.row(3);
    all.row(2 * n + 2) = z.row(n - 1) + 0.5 * h * all.row(2 * n + 1);
    return all;
  }

  Axis x_, y_;
  /// ((2nx + 4) × (2ny + 4)) values and slopes: rows alternate between h and ∂h/∂x, columns between h and ∂h/∂y.
  std::shared_ptr<MatX const> nodes_;
  double highest_ = 0.0;
};

static_assert(Terrain<HeightField>);

}  // namespace polybody
