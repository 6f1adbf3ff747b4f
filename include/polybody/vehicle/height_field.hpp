#pragma once
/// \file
/// Ground given by heights on a grid, for example from a survey or a generated road.

#include <polybody/math/element_functions.hpp>
#include <polybody/vehicle/terrain.hpp>

namespace polybody {

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
    require_finite(Vec2(grid.x0, grid.y0), what, ": the position x0, y0 of the first point");
    require_positive(grid.dx, what, ": the spacing dx");
    require_positive(grid.dy, what, ": the spacing dy");
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
