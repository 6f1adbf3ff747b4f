#pragma once
/// \file
/// Bodies in Cholesky coordinates, for which the mass matrix is the identity [Yakoub & Shabana 1999; thesis §4.4].
/// Theory: Eq. 2.47.

#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/node_chain.hpp>

namespace polybody {

/// Body B in Cholesky coordinates p = Lᵀ e, where M = L Lᵀ is the constant mass matrix for the coordinates e [Yakoub &
/// Shabana 1999; thesis §4.4]. The mass matrix becomes the identity, T = ½ ṗᵀ ṗ, and the forces are Q_p = L⁻¹ Q_e. The
/// motion does not change. B can be any body with a constant mass matrix, coordinates that add, and elements of a fixed
/// size.
///
/// Points that are linear in e are linear in p, so that `AncfLinear` can join such bodies. With its elimination matrix
/// T, the mass matrix of the mechanism becomes TᵀT, which couples the bodies. Explicit steps factorise TᵀT once
/// (solvers/constant_block_cache.hpp).
///
/// L is banded like M, so that a force costs a few additional operations per coordinate. L⁻¹ is full; therefore the
/// tangent and the marker Jacobians are full. The class is meant for explicit integrators without constraints, and for
/// comparisons with the coordinates e.
///
/// A program that calls `CholeskyCoordinates<AncfCable<>>::from(bar, n)` instead of `AncfCable<>::from(bar, n)` needs
/// no other change.
template <Body B>
  requires(B::constant_mass && B::element_columns > 0)
class CholeskyCoordinates : public AddingCoordinates {
 public:
  static constexpr World world = B::world;
  static constexpr MarkerKind observes = B::observes;
  static constexpr bool constant_mass = true;
  static constexpr int element_columns = Eigen::Dynamic;
  static constexpr int point_columns = Eigen::Dynamic;
  using Point = typename B::Point;  ///< point type of the body B
  /// Number of position gradients that are linear in the coordinates.
  static constexpr int gradients = [] {
    if constexpr (HasLinearPoints<B>)
      return B::gradients;
    else
      return 0;
  }();

  /// Creates the body from the arguments `args` of `B::from`.
  /// \throws InvalidInput for a body with quaternions, or with a mass matrix that is not positive definite.
  template <class... Args>
  static CholeskyCoordinates from(Args const&... args) {
    return CholeskyCoordinates(B::from(args...));
  }
  /// Creates the body from a bar with the number of elements of `mesh`.
  /// \throws InvalidInput for a body with quaternions, or with a mass matrix that is not positive definite.
  static CholeskyCoordinates from(Bar const& bar, BarMesh const& mesh) {
    return CholeskyCoordinates(B::from(bar, mesh));
  }
  /// Wraps `body`.
  /// \throws InvalidInput for a body whose coordinates do not add, or whose mass matrix is not positive definite.
  explicit CholeskyCoordinates(B body) : body_(std::move(body)), n_(body_.velocities()) {
    if (body_.coordinates() != n_)
      throw InvalidInput("cholesky.quaternions", {ErrorObject{"CholeskyCoordinates"}, ": the body has ",
                                                  ErrorValue{body_.coordinates()}, " coordinates, but ", n_,
                                                  " velocities, so it has rotation coordinates. Use a body whose "
                                                  "coordinates are nodal positions, such as AncfCable."});
    factor();
  }

  B const& base() const { return body_; }  ///< the body in its own coordinates e
  double length() const { return body_.length(); }
  template <class... Args>
    requires requires(B const b, Args... args) { b.at(args...); }
  Point at(Args const&... args) const {
    return body_.at(args...);
  }
  /// Coordinates e of the underlying body from p, for its own functions (strains, centre line).
  VecX base_coordinates(std::span<double const> p) const {
    VecX e = Eigen::Map<VecX const>(p.data(), n_);
    back<double>(e);
    return e;
  }

  /// Matrix S L⁻ᵀ of r = S e at the point `p`, over all columns of the body.
  MatX position_map(Point const& p) const
    requires HasLinearPoints<B>
  {
    return by_own(body_.position_map(p), p);
  }
  /// Matrix of the position gradient ∂r/∂x, ∂r/∂y or ∂r/∂z (`alpha` = 0, 1, 2) at the point `p`, over all columns of
  /// the body. The underlying body must have this gradient.
  MatX gradient_map(Point const& p, int alpha) const
    requires HasLinearPoints<B>
  {
    return by_own(body_.gradient_map(p, alpha), p);
  }

  /// Section strains of the underlying body, as a vector of six (`HasSections`).
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    return body_.section_strains(p, span(base_coordinates(q)));
  }
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return body_.section_forces(p, span(base_coordinates(q)));
  }

  Index coordinates() const { return n_; }
  Index velocities() const { return n_; }
  Index elements() const { return 1; }
  Index first_column(Index) const { return 0; }
  Index first_column(Point const&) const { return 0; }

  void reference(std::span<double> q) const {
    body_.reference(q);
    multiply(q);
  }
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    body_.rigid_velocity(span(base_of<double>(q, 0)), v0, omega, v);
    multiply(v);
  }

  void mass(Index, std::span<double const>, MatX& m) const { m.setIdentity(n_, n_); }
  template <StateScalar T>
  void inertia(Index, std::span<T const>, std::span<T const> a, VecXOf<T>& out) const {
    std::copy(a.begin(), a.end(), out.data());
  }
  template <StateScalar T>
  void force(Index, std::span<T const> q, std::span<T const> v, VecXOf<T>& out) const {
    VecXOf<T> const &e = base_of<T>(q, 0), &rate = base_of<T>(v, 1);
    assemble<T>(out, [&](Index i, auto& f) { body_.template force<T>(i, span(e), span(rate), f); });
  }
  void tangent(Index, std::span<double const> q, std::span<double const> v, double ck, double cd, MatX& k) const {
    VecX const &e = base_of<double>(q, 0), &rate = base_of<double>(v, 1);
    Mat<double, B::element_columns, B::element_columns> element;
    k.setZero(n_, n_);
    for (Index i = 0; i < body_.elements(); ++i) {
      body_.tangent(i, span(e), span(rate), ck, cd, element);
      k.block(body_.first_column(i), body_.first_column(i), element.rows(), element.cols()) += element;
    }
    both_sides(k);
  }
  template <StateScalar T>
  void gravity(Index, std::span<T const> q, Vec3 const& g, VecXOf<T>& out) const {
    VecXOf<T> const& e = base_of<T>(q, 0);
    assemble<T>(out, [&](Index i, auto& f) { body_.template gravity<T>(i, span(e), g, f); });
  }
  double kinetic_energy(Index, std::span<double const>, std::span<double const> v) const {
    return 0.5 * Eigen::Map<VecX const>(v.data(), n_).squaredNorm();
  }
  double strain_energy(Index, std::span<double const> q) const {
    VecX const& e = base_of<double>(q, 0);
    return over_elements([&](Index i) { return body_.strain_energy(i, span(e)); });
  }
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    VecX const& e = base_of<double>(q, 0);
    return over_elements([&](Index i) { return body_.gravity_energy(i, span(e), g); });
  }

  /// Marker kinematics with the Jacobian J_p = J_e L⁻ᵀ.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    constexpr int width = B::point_columns;
    MarkerKinematics<T> own;
    std::array<T, 6 * width> jacobian;
    own.jacobian = jacobian.data();
    body_.template evaluate_marker<T>(p, axes, span(base_of<T>(q, 0)), span(base_of<T>(v, 1)), own);
    Eigen::Map<Mat<T, 6, Eigen::Dynamic>> j(out.jacobian, 6, n_);
    j.setZero();
    Index const first = body_.first_column(p);
    j.middleCols(first, width) = own.full();
    for (Index i = first; i < n_; ++i)  // L y = Jᵀ, by rows of y
      for (int r = 0; r < 6; ++r) {
        T sum = j(r, i);
        for (Index k = std::max(first, i - band_); k < i; ++k) sum -= j(r, k) * l(i, k);
        j(r, i) = sum * (1.0 / l(i, i));
      }
    out.frame = own.frame;
    out.bias = own.bias;
    out.shape = JacobianShape::dense;
    out.columns = n_;
  }
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, MatX& k) const {
    Mat<double, B::point_columns, B::point_columns> own;
    body_.load_stiffness(p, span(base_of<double>(q, 0)), w, own);
    k.setZero(n_, n_);
    k.block(body_.first_column(p), body_.first_column(p), own.rows(), own.cols()) = own;
    both_sides(k);
  }

 private:
  template <class V>
  static auto span(V const& x) {
    return std::span<typename V::Scalar const>(x.data(), std::size_t(x.size()));
  }
  template <class F>
  double over_elements(F&& energy) const {
    double sum = 0.0;
    for (Index i = 0; i < body_.elements(); ++i) sum += energy(i);
    return sum;
  }
  double l(Index i, Index j) const { return factor_[place(i, j)]; }
  std::size_t place(Index i, Index j) const { return std::size_t(i * (band_ + 1) + j - i + band_); }

  /// Cholesky factorisation M = L Lᵀ within the band.
  void factor() {
    constexpr int width = B::element_columns;
    band_ = std::min<Index>(width - 1, n_ - 1);
    factor_.assign(std::size_t(n_ * (band_ + 1)), 0.0);
    auto const at = [&](Index i, Index j) -> double& { return factor_[place(i, j)]; };
    VecX reference(n_);
    body_.reference({reference.data(), std::size_t(n_)});
    Mat<double, width, width> m;
    for (Index e = 0; e < body_.elements(); ++e) {
      body_.mass(e, span(reference), m);
      Index const first = body_.first_column(e);
      for (int i = 0; i < width; ++i)
        for (int j = 0; j <= i; ++j) at(first + i, first + j) += m(i, j);
    }
    for (Index i = 0; i < n_; ++i)
      for (Index j = std::max<Index>(0, i - band_); j <= i; ++j) {
        double sum = at(i, j);
        for (Index k = std::max<Index>(0, i - band_); k < j; ++k) sum -= at(i, k) * at(j, k);
        if (j == i && !(sum > 0.0))
          throw InvalidInput("body.mass_matrix", {ErrorObject{"CholeskyCoordinates"},
                                                  ": the body's mass matrix is not positive definite at coordinate ", j,
                                                  ", counted from 0: the pivot is ", ErrorValue{sum}, "."});
        at(i, j) = j < i ? sum / at(j, j) : std::sqrt(sum);
      }
  }
  /// Replaces x by Lᵀ x.
  void multiply(std::span<double> x) const {
    for (Index j = 0; j < n_; ++j) {
      double sum = 0.0;
      for (Index i = j; i < std::min(n_, j + band_ + 1); ++i) sum += l(i, j) * x[std::size_t(i)];
      x[std::size_t(j)] = sum;
    }
  }
  /// Replaces x by L⁻¹ x (`forth`) or by L⁻ᵀ x (`back`).
  template <class T, class V>
  void forth(V&& x) const {
    for (Index i = 0; i < n_; ++i) {
      T sum = x[i];
      for (Index k = std::max<Index>(0, i - band_); k < i; ++k) sum -= x[k] * l(i, k);
      x[i] = sum * (1.0 / l(i, i));
    }
  }
  template <class T, class V>
  void back(V&& x) const {
    for (Index j = n_ - 1; j >= 0; --j) {
      T sum = x[j];
      for (Index i = j + 1; i < std::min(n_, j + band_ + 1); ++i) sum -= x[i] * l(i, j);
      x[j] = sum * (1.0 / l(j, j));
    }
  }
  /// Product m L⁻ᵀ of a matrix m whose columns are those of the point `p`.
  MatX by_own(auto const& m, Point const& p) const {
    MatX out = MatX::Zero(m.rows(), n_);
    out.middleCols(body_.first_column(p), m.cols()) = m;
    for (Index i = 0; i < out.rows(); ++i) forth<double>(out.row(i));
    return out;
  }
  /// Product L⁻¹ k L⁻ᵀ.
  void both_sides(MatX& k) const {
    for (Index j = 0; j < n_; ++j) forth<double>(k.col(j));
    for (Index i = 0; i < n_; ++i) forth<double>(k.row(i));
  }
  /// Coordinates or generalised velocities of the underlying body. Each thread has two buffers for them, so that no
  /// step allocates memory.
  template <class T>
  VecXOf<T> const& base_of(std::span<T const> p, int place) const {
    static thread_local VecXOf<T> kept[2];
    VecXOf<T>& e = kept[place];
    e.resize(n_);
    std::copy(p.begin(), p.end(), e.data());
    back<T>(e);
    return e;
  }
  template <class T, class F>
  void assemble(VecXOf<T>& out, F&& element) const {
    constexpr int width = B::element_columns;
    Vec<T, width> f;
    for (Index i = 0; i < n_; ++i) out[i] = T(0.0);
    for (Index e = 0; e < body_.elements(); ++e) {
      element(e, f);
      T* const to = out.data() + body_.first_column(e);
      for (int k = 0; k < width; ++k) to[k] += f[k];
    }
    forth<T>(out);
  }

  B body_;
  Index n_, band_ = 0;
  std::vector<double> factor_;  ///< L by rows: `band_` entries, then the diagonal entry
};

}  // namespace polybody
