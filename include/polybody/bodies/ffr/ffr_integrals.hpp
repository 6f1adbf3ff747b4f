#pragma once
/// \file
/// Inertia and stiffness of the body of a floating frame as functions of its n deformation coordinates q. The integrals
/// of a structure follow from its inertia shape integrals by projection onto a basis, e = Φ q. A user can also provide
/// the integrals.
/// Theory: Eqs. 2.76 to 2.80, 2.82 to 2.84.

#include <polybody/bodies/ffr/beam_structure.hpp>

namespace polybody {

namespace detail {

/// Product of column k of m and x.
template <class T>
T column_times(MatX const& m, Index k, T const* x) {
  if constexpr (std::is_same_v<T, double>) {
    return m.col(k).dot(Eigen::Map<VecX const>(x, m.rows()));  // Eigen may reorder this sum, the compiler may not
  } else {
    T sum(0.0);
    for (Index j = 0; j < m.rows(); ++j) sum += x[j] * m(j, k);
    return sum;
  }
}

/// Product xᵀ m y.
template <class T>
T quadratic(MatX const& m, T const* x, T const* y) {
  T sum(0.0);
  for (Index k = 0; k < m.cols(); ++k) sum += column_times(m, k, x) * y[k];
  return sum;
}

/// Product out = m x, column by column. The entries are contiguous in memory for every number type.
template <class T>
void times(MatX const& m, T const* x, T* out) {
  Index const rows = m.rows();
  for (Index i = 0; i < rows; ++i) out[i] = T(0.0);
  for (Index k = 0; k < m.cols(); ++k) {
    double const* const column = m.col(k).data();
    for (Index i = 0; i < rows; ++i) out[i] += x[k] * column[i];
  }
}

}  // namespace detail

/// Integrals of the body of a floating frame, in the axes of the frame. The points are u = u₀ + S q. Geometric
/// stiffening adds axial foreshortening, which is quadratic in q, to u. [x_k]_k is the vector or matrix with the
/// entries x_k:
///   c(q) = ∫ρ u = first + first_by q − ½ [qᵀ first_second_k q]_k,
///   J(q) = inertia + [inertia_by_kl · q + qᵀ inertia_second_kl q]_kl, the inertia tensor about the origin,
///   H(q) = ∫ρ ũ ∂u/∂q with the rows H_i = coupling_i + qᵀ coupling_by_i,
///   T = ½ m ṙ² + ṙᵀA (Ω × c + c_q q̇) + ½ Ωᵀ J Ω + Ωᵀ H q̇ + ½ q̇ᵀ mass_matrix q̇,
///   U = ½ qᵀ stiffness q + initial_force · q.
struct FfrIntegrals {
  double mass = 0.0;                        ///< [kg]
  Vec3 first = Vec3::Zero();                ///< ∫ρ u₀ [kg m]
  Mat<double, 3, Eigen::Dynamic> first_by;  ///< (3×n) ∫ρ S
  std::array<MatX, 3> first_second;         ///< (n×n) symmetric; empty without geometric stiffening
  Mat3 inertia = Mat3::Zero();              ///< inertia tensor at q = 0 [kg m²]
  std::array<VecX, 6> inertia_by;           ///< (n) J_kl contains inertia_by_kl · q; kl = xx, yy, zz, xy, xz, yz
  std::array<MatX, 6> inertia_second;       ///< (n×n) symmetric; J_kl contains qᵀ inertia_second_kl q
  Mat<double, 3, Eigen::Dynamic> coupling;  ///< (3×n) H at q = 0
  std::array<MatX, 3> coupling_by;          ///< (n×n) row H_i contains qᵀ coupling_by_i
  MatX mass_matrix, stiffness, damping;     ///< (n×n)
  VecX initial_force;                       ///< (n) ∂U/∂q at q = 0

  Index size() const { return mass_matrix.rows(); }  ///< number n of coordinates of the deformation

  /// Integrals that are all zero, for n deformation coordinates.
  template <class = void>  // compiled only if used
  static FfrIntegrals zero(Index n) {
    FfrIntegrals x;
    x.first_by.setZero(3, n);
    x.coupling.setZero(3, n);
    x.inertia_by.fill(VecX::Zero(n));
    x.inertia_second.fill(MatX::Zero(n, n));
    x.coupling_by.fill(MatX::Zero(n, n));
    x.mass_matrix = x.stiffness = x.damping = MatX::Zero(n, n);
    x.initial_force = VecX::Zero(n);
    return x;
  }

  /// Checks the sizes, the mass and the entries.
  /// \throws InvalidInput naming `what` for sizes that differ, a mass that is not positive, an entry that is not finite
  /// or exceeds `largest_number`, or a mass matrix that is not symmetric and positive definite.
  template <class = void>
  void check(std::string const& what) const {
    require_sizes(what);
    require_positive(mass, what, ": the mass");
    require_finite(mass_matrix, what, ": the mass matrix");
    require_finite(stiffness, what, ": the stiffness matrix");
    require_entries(what);
    MatX l = mass_matrix;  // L D Lᵀ; all entries of D must be positive
    if (double const odd = (l - l.transpose()).norm(); !(odd <= 1e-9 * l.norm()))
      throw InvalidInput("body.mass_matrix",
                         {ErrorObject{what}, ": the mass matrix of the deformation is not symmetric: |M - M'| is ",
                          ErrorValue{odd}, ", and |M| is ", l.norm(), "."});
    for (Index k = 0; k < size(); ++k) {
      if (!(l(k, k) > 1e-13 * mass_matrix(k, k)))
        throw InvalidInput("body.mass_matrix",
                           {ErrorObject{what}, ": the mass matrix of the deformation is not positive definite: pivot ",
                            k, ", counted from 0, is ", ErrorValue{l(k, k)}, "."});
      for (Index j = k + 1; j < size(); ++j)
        for (Index i = k + 1; i < size(); ++i) l(i, j) -= l(i, k) * l(k, j) / l(k, k);
    }
  }
  /// Checks the sizes of all integrals.
  /// \throws InvalidInput naming `what` and the integral whose size does not fit the n rows of the mass matrix.
  template <class = void>
  void require_sizes(std::string const& what) const {
    Index const n = size();
    auto const require = [&](auto const& x, Index rows, Index columns, char const* name) {
      if (x.rows() != rows || x.cols() != columns)
        throw InvalidInput("ffr.integral_size",
                           {ErrorObject{what}, ": the integral \"", name, "\" is ", x.rows(), "×", x.cols(),
                            ", but must be ", rows, "×", columns, ": the mass matrix has ", n, " rows."});
    };
    require(mass_matrix, n, n, "mass_matrix");
    require(stiffness, n, n, "stiffness");
    require(damping, n, n, "damping");
    require(first_by, 3, n, "first_by");
    require(coupling, 3, n, "coupling");
    require(initial_force, n, 1, "initial_force");
    for (VecX const& x : inertia_by) require(x, n, 1, "inertia_by");
    for (MatX const& x : inertia_second) require(x, n, n, "inertia_second");
    for (MatX const& x : coupling_by) require(x, n, n, "coupling_by");
    for (MatX const& x : first_second)
      if (x.size() > 0) require(x, n, n, "first_second");
  }
  /// Checks the entries of all integrals.
  /// \throws InvalidInput naming `what` and the integral with an entry that is NaN or exceeds `largest_number`.
  template <class = void>
  void require_entries(std::string const& what) const {
    auto const require = [&](double const* x, Index count, char const* name) {
      for (Index i = 0; i < count; ++i)
        if (!(std::abs(x[i]) <= largest_number))
          throw InvalidInput("value.magnitude", {ErrorObject{what}, ": the integral \"", name, "\" has an entry of ",
                                                 ErrorValue{x[i]}, ", but the limit is ", largest_number, "."});
    };
    require(first.data(), 3, "first");
    require(first_by.data(), first_by.size(), "first_by");
    for (MatX const& x : first_second) require(x.data(), x.size(), "first_second");
    require(inertia.data(), 9, "inertia");
    for (VecX const& x : inertia_by) require(x.data(), x.size(), "inertia_by");
    for (MatX const& x : inertia_second) require(x.data(), x.size(), "inertia_second");
    require(coupling.data(), coupling.size(), "coupling");
    for (MatX const& x : coupling_by) require(x.data(), x.size(), "coupling_by");
    require(damping.data(), damping.size(), "damping");
    require(initial_force.data(), initial_force.size(), "initial_force");
  }
  /// Returns true if the integrals have the terms of geometric stiffening.
  template <class = void>
  bool stiffens() const {
    return first_second[0].size() > 0;
  }

  /// First and second moment of the deformed body about the origin of its frame [kg m], [kg m²].
  template <class T>
  struct Moments {
    Vec<T, 3> c;     ///< first moment ∫ρ u
    Mat<T, 3, 3> J;  ///< inertia tensor about the origin
  };

  /// Moments c(q) and J(q) at q = x (n).
  template <class T>
  void moments(T const* x, Moments<T>& out) const {
    Vec<T, 6> j;
    for (int p = 0; p < 6; ++p) {
      j[p] = T(inertia(symmetric_row[p], symmetric_column[p]));
      for (Index k = 0; k < size(); ++k)
        j[p] += (inertia_slope<T>(x, std::size_t(p), k) + inertia_by[std::size_t(p)][k]) * 0.5 * x[k];
    }
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) out.J(i, k) = j[symmetric_place[i][k]];
    out.c = first_moment<T>(x);
  }
  /// First moment c(q) at q = x.
  template <class T>
  Vec<T, 3> first_moment(T const* x) const {
    Vec<T, 3> c;
    for (int i = 0; i < 3; ++i) {
      c[i] = T(first[i]);
      for (Index k = 0; k < size(); ++k) c[i] += x[k] * first_by(i, k);
      if (stiffens()) c[i] -= detail::quadratic<T>(first_second[std::size_t(i)], x, x) * 0.5;
    }
    return c;
  }
  /// Column k of C(q) = c_q at q = x.
  template <class T>
  Vec<T, 3> first_slope(T const* x, Index k) const {
    Vec<T, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      c[Index(i)] = T(first_by(Index(i), k));
      if (stiffens()) c[Index(i)] -= detail::column_times(first_second[i], k, x);
    }
    return c;
  }
  /// Columns k of C(q) and of H(q) at q = x, written to c and h.
  template <class T>
  void columns(T const* x, Index k, Vec<T, 3>& c, Vec<T, 3>& h) const {
    c = first_slope(x, k);
    for (std::size_t i = 0; i < 3; ++i)
      h[Index(i)] = detail::column_times(coupling_by[i], k, x) + coupling(Index(i), k);
  }
  /// Derivative ∂J_p/∂q_k at q = x, for entry p in the order of `symmetric_row` and coordinate k.
  template <class T>
  T inertia_slope(T const* x, std::size_t p, Index k) const {
    return detail::column_times(inertia_second[p], k, x) * 2.0 + inertia_by[p][k];
  }
};

/// Integrals of the structure `s` for e = Φ q with Φ = `shapes` (N×n). `stiffening` adds axial foreshortening to second
/// order in q, on which centrifugal and other axial forces do work.
/// \throws InvalidInput for shapes of another size; with stiffening, for a structure without beams.
template <class = void>
FfrIntegrals integrals_of(Structure const& s, MatX const& shapes, bool stiffening = false) {
  if (shapes.rows() != s.size())
    throw InvalidInput("ffr.shape_size", {ErrorObject{"Ffr"}, ": the shapes have ", ErrorValue{shapes.rows()},
                                          " rows, but the structure has ", s.size(), " nodal coordinates."});
  FfrIntegrals x = FfrIntegrals::zero(shapes.cols());
  auto const carried = [&](Structure::Sparse const& m) { return MatX(shapes.transpose() * (m * shapes)); };
  x.mass = s.mass;
  x.first = s.first;
  x.inertia = s.second.trace() * Mat3::Identity() - s.second;
  std::array<MatX, 6> products;  // ∫ρ S_kᵀ S_l
  for (std::size_t p = 0; p < 6; ++p) products[p] = carried(s.inertia[p]);
  x.mass_matrix = products[0] + products[1] + products[2];
  x.mass_matrix = (0.5 * (x.mass_matrix + x.mass_matrix.transpose())).eval();
  x.stiffness = carried(s.stiffness);
  x.stiffness = (0.5 * (x.stiffness + x.stiffness.transpose())).eval();
  x.damping = carried(s.damping);
  x.initial_force = shapes.transpose() * s.initial_force;

  std::array<std::array<VecX, 3>, 3> moment;  // ∫ρ u₀ₖ S_l
  for (std::size_t k = 0; k < 3; ++k) {
    x.first_by.row(Index(k)) = (shapes.transpose() * s.translation[k]).transpose();
    for (std::size_t l = 0; l < 3; ++l) moment[k][l] = shapes.transpose() * s.moment[k][l];
  }
  // Axial foreshortening: −½ qᵀ drawn_kl q = ∫ρ u₀ₖ (second-order displacement along l).
  std::array<std::array<MatX, 3>, 3> drawn;
  if (stiffening) {
    AxialForceStiffness const axial(s);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        drawn[k][l] = carried(axial(
            s.moment[k][l], [&](Structure::Beam const& b) { return detail::spread_moment(s, b, int(k), int(l)); }));
    for (std::size_t l = 0; l < 3; ++l)
      x.first_second[l] = carried(
          axial(s.translation[l], [&](Structure::Beam const& b) { return detail::spread_moment(s, b, -1, int(l)); }));
  }
  std::array<VecX, 6> second_by;  // of ∫ρ u_k u_l
  std::array<MatX, 6> second;
  for (std::size_t p = 0; p < 6; ++p) {
    auto const k = std::size_t(symmetric_row[p]), l = std::size_t(symmetric_column[p]);
    second_by[p] = moment[k][l] + moment[l][k];
    second[p] = 0.5 * (products[p] + products[p].transpose());
    if (stiffening) second[p] -= 0.5 * (drawn[k][l] + drawn[l][k]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t const j = (i + 1) % 3, k = (i + 2) % 3;
    x.inertia_by[i] = second_by[j] + second_by[k];
    x.inertia_second[i] = second[j] + second[k];
    x.inertia_by[i + 3] = -second_by[i + 3];
    x.inertia_second[i + 3] = -second[i + 3];
    // H_i = ∫ρ (u_j S_k − u_k S_j)
    x.coupling.row(Index(i)) = (moment[j][k] - moment[k][j]).transpose();
    auto const p = std::size_t(symmetric_place[j][k]);
    bool const as_kept = symmetric_row[p] == int(j);  // otherwise ∫ρ S_jᵀ S_k is the transpose of the stored product
    MatX const jk = as_kept ? products[p] : MatX(products[p].transpose());
    x.coupling_by[i] = jk - jk.transpose();
    if (stiffening) x.coupling_by[i] -= drawn[j][k] - drawn[k][j];
  }
  return x;
}

}  // namespace polybody
