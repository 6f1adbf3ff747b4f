#pragma once
/// \file
/// Floating frame of reference in space [Shabana 2013, ch. 5–6; thesis §4.3]. Theory: Eqs. 2.73 to 2.88, 3.5, 3.14.

#include <memory>

#include <polybody/bodies/ffr/ffr_balance.hpp>
#include <polybody/bodies/ffr/ffr_basis.hpp>
#include <polybody/bodies/ffr/ffr_integrals.hpp>
#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/ffr/ffr_points.hpp>
#include <polybody/bodies/ffr/ffr_tangent.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

/// Floating frame of reference in space [Shabana 2013, ch. 5–6; thesis §4.3 and App. A]: small deformation of a
/// structure with a basis, in a frame with arbitrary motion. With c, J, H of ffr_integrals.hpp and C = c_q, all in the
/// axes of the frame, Lagrange's equations of T(ṙ, Ω, q̇) give
///   m r̈ + A (Ω̇ × c + C q̈)                      = −A (Ω × (Ω × c) + 2 Ω × ċ + Ċ q̇),
///   c × Aᵀr̈ + J Ω̇ + H q̈                        = −(J˙ Ω + Ω × (J Ω + H q̇) + H˙ q̇),
///   Cᵀ Aᵀr̈ + Hᵀ Ω̇ + M q̈ + D q̇ + K q            = ½ (Ωᵀ J Ω)_q − Σ Ω_i W_i q̇,   W_i = ∂H_iᵀ/∂q − ∂H_i/∂q.
/// In the thesis H and C are called m_rf, Σ Ω_i W_i is 2 S̃₁, and the part of ½ (ΩᵀJΩ)_q that is linear in q is −S̃₂ q.
///
/// The coordinates are r (3) of the origin of the frame in world axes, its unit quaternion (4), and q (n). The
/// generalised velocities are ṙ (3), Ω (3) in the axes of the frame, and q̇ (n). The coordinates q are multiples of
/// shapes, whose entries are displacements [m] and rotations [rad]. A marker rotates by exp(θ̃), with the small
/// rotation θ = R q of its section or node.
class Ffr {
 public:
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = false;
  static constexpr RigidLayout frame_layout = RigidLayout::quaternion;  ///< order of the frame's coordinates
  static constexpr int element_columns = Eigen::Dynamic;                ///< one element: the whole body
  static constexpr int point_columns = Eigen::Dynamic;
  static constexpr Index default_elements = 8;  ///< number of elements of `from(bar)`

  using Point = FfrPoint;      ///< material point in the axes of the frame
  using Options = FfrOptions;  ///< placement, terms of the inertia, stiffening and damping

  /// Body of the bar in n elements, by default in mean axes and with geometric stiffening. The 6 n coordinates q are
  /// the displacements and rotations of the nodes relative to the first end. The option `modes` reduces the number of
  /// coordinates. The coordinates are suitable for all joints, because the frame needs no condition at a joint. The
  /// placement is that of the bar; `options.placement` has no effect.
  /// \throws InvalidInput for n outside [1, 10⁷], and for a bar with invalid data or without torsional stiffness GJ.
  template <class = void>  // compiled only if used
  static Ffr from(Bar const& bar, Index n, Options options = {}) {
    options.complete_for(bar.placement);
    Structure const s = structure_of(bar, n);
    return Ffr(s, bar_shapes(s, n, options, false), options);
  }
  /// Body of the bar with the number of elements of `mesh`, by default in mean axes and with geometric stiffening.
  template <class = void>  // compiled only if used
  static Ffr from(Bar const& bar, BarMesh const& mesh = {}, Options options = {}) {
    return from(bar, mesh.elements.value_or(default_elements), options);
  }
  /// Body of a structure with the basis `shapes` (N×n, ffr_basis.hpp), in the frame `options.frame` if it is set.
  /// \throws InvalidInput for a basis that does not fit or is linearly dependent, and if `options.modes` is set.
  template <class = void>
  Ffr(Structure structure, MatX shapes, Options const& options = {})
      : Ffr(integrals_of(structure, shapes = in_frame(structure, std::move(shapes), options),
                         options.stiffening.value_or(false)),
            options) {
    points_ = std::make_shared<FfrPoints const>(std::move(structure), std::move(shapes), stiffens());
  }
  /// Body from integrals that the user computes. The options `frame`, `stiffening` and `modes` have no effect.
  /// \throws InvalidInput for integrals that `FfrIntegrals::check` refuses, and for an invalid placement.
  template <class = void>
  Ffr(FfrIntegrals integrals, Options const& options) : placement_(options.placement), terms_(options.terms) {
    integrals.check("Ffr");
    placement_.check("Ffr");
    require_not_negative(options.stiffness_damping, "Ffr: the damping time");
    integrals.damping += options.stiffness_damping * integrals.stiffness;
    FfrStack stack = FfrStack::of(integrals);
    made_of_ = std::make_shared<Constants const>(std::move(integrals), std::move(stack));
  }
  /// Copy of the body at another placement. Both bodies share their constants.
  /// \throws InvalidInput for an invalid placement (`Placement::check`).
  Ffr placed(Placement const& placement) const {
    placement.check("Ffr");
    Ffr other = *this;
    other.placement_ = placement;
    return other;
  }

  FfrIntegrals const& integrals() const { return made_of_->integrals; }  ///< inertia and stiffness as functions of q
  bool stiffens() const { return integrals().stiffens(); }               ///< true with geometric stiffening
  Index deformations() const { return integrals().size(); }              ///< number n of coordinates of the deformation
  /// Length of the first bar [m].
  /// \throws InvalidInput for a body that is not made of bars.
  double length() const { return made().length(); }
  /// Warning of section matrices of the bar that are probably not in SI units; empty if there is none.
  std::string_view unit_warning() const { return points_ ? points_->structure().unit_warning : std::string_view(); }

  /// Point at the distance s along bar number `bar` (counted from 0) from its first end, at (y, z) from the axis of the
  /// bar [m].
  /// \throws InvalidInput for s outside the bar, a bar that does not exist, and a body that is not made of bars.
  template <class = void>
  Point at(double s, double y = 0.0, double z = 0.0, Index bar = 0) const {
    return made().at(s, y, z, bar);
  }
  /// Node i of the structure.
  /// \throws InvalidInput for a node that does not exist.
  template <class = void>
  Point node(Index i) const {
    return made().node(i);
  }
  /// Point `at` of the undeformed body [m] that follows the mean motion of a patch of nodes of the structure.
  /// \throws InvalidInput with geometric stiffening, and for a body made of the user's own integrals.
  template <class = void>
  Point patch(NodePatch const& nodes, Vec3 const& at) const {
    return made().patch(nodes, at);
  }
  /// Structure from which the body is made.
  /// \throws InvalidInput for a body made of the user's own integrals.
  Structure const& structure() const { return made().structure(); }
  /// Point with matrices S and R that the user computes.
  /// \throws InvalidInput for matrices that are not 3×n.
  Point at(Point const& p) const {
    if (p.S.cols() != deformations() || p.R.cols() != deformations())
      throw InvalidInput("ffr.point_size", {ErrorObject{"Ffr"}, ": S and R of a point must be 3×", deformations(),
                                            ", but are 3×", p.S.cols(), " and 3×", p.R.cols(),
                                            ". Each needs one column for each deformation coordinate."});
    return p;
  }

  Index coordinates() const { return 7 + deformations(); }
  Index velocities() const { return 6 + deformations(); }
  char const* coordinate_unit(Index i) const { return i < 3 ? "m" : "1"; }
  char const* velocity_unit(Index i) const { return i < 3 ? "m/s" : i < 6 ? "rad/s" : "1/s"; }
  Index elements() const { return 1; }
  Index first_column(Index) const { return 0; }
  Index first_column(Point const&) const { return 0; }

  template <class = void>
  void reference(std::span<double> q) const {
    std::fill(q.begin(), q.end(), 0.0);
    part<3>(q, 0) = placement_.origin;
    part<4>(q, 3) = quaternion_of(placement_.axes);
  }
  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    part<3>(out, 0) = part<3>(q, 0) + part<3>(delta, 0);
    part<4>(out, 3) = quaternion_plus<T>(part<4>(q, 3), part<3>(delta, 3));
    for (std::size_t i = 6; i < delta.size(); ++i) out[i + 1] = q[i + 1] + delta[i];
  }
  template <StateScalar T>
  void local_rate(std::span<T const> delta, std::span<T const> v, std::span<T> out) const {
    std::copy(v.begin(), v.end(), out.begin());
    part<3>(out, 3) = right_jacobian_inverse<T>(part<3>(delta, 3)) * part<3>(v, 3);
  }
  template <class = void>
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    std::fill(v.begin(), v.end(), 0.0);
    part<3>(v, 0) = v0 + omega.cross(part<3>(q, 0).eval());
    part<3>(v, 3) = rotation_matrix<double>(part<4>(q, 3)).transpose() * omega;
  }

  template <class = void>
  void mass(Index, std::span<double const> q, MatX& m) const {
    Index const n = deformations();
    Mat3 const a = rotation_matrix<double>(part<4>(q, 3));
    Moments<double> x;
    moments<double>(q.data() + 7, x);
    m.setZero(6 + n, 6 + n);
    m.topLeftCorner<3, 3>().diagonal().setConstant(integrals().mass);
    m.block<3, 3>(0, 3) = -a * skew<double>(x.c);
    m.block<3, 3>(3, 0) = m.block<3, 3>(0, 3).transpose();
    m.block<3, 3>(3, 3) = x.J;
    m.bottomRightCorner(n, n) = integrals().mass_matrix;
    if (!terms_.coupling) return;
    for (Index k = 0; k < n; ++k) {
      Vec3 h, c;
      integrals().columns<double>(q.data() + 7, k, c, h);
      m.block<1, 3>(6 + k, 0) = (a * c).transpose();
      m.block<1, 3>(6 + k, 3) = h.transpose();
      if (!terms_.onto_frame) continue;
      m.block<3, 1>(0, 6 + k) = a * c;
      m.block<3, 1>(3, 6 + k) = h;
    }
  }
  template <StateScalar T>
  void inertia(Index, std::span<T const> q, std::span<T const> a, VecXOf<T>& out) const {
    FfrProducts<T> products = own_products<T>();
    products.at(q.data() + 7);
    products.at_rates(a.data() + 6);
    FfrBalance<T>(integrals(), terms_, products, q).inertia(a, out);
  }
  template <StateScalar T>
  void force(Index, std::span<T const> q, std::span<T const> v, VecXOf<T>& out) const {
    FfrProducts<T> products = own_products<T>();
    products.at(q.data() + 7);
    products.at_velocities(v.data() + 6);
    FfrBalance<T>(integrals(), terms_, products, q).force(v, out);
  }
  /// Number of workspace entries for `residual`.
  Index workspace_size() const { return FfrProducts<double>::workspace_size(deformations()); }
  /// Residual M a − force. Both terms share J, H and their derivatives. `workspace` has `workspace_size()` entries, and
  /// `forces` has as many entries as there are generalised velocities.
  template <StateScalar T>
  void residual(BodyMotion<T> const& x, VecXOf<T>& workspace, VecXOf<T>& forces, VecXOf<T>& out) const {
    FfrProducts<T> products(made_of_->integrals, made_of_->stack, workspace.data());
    products.at(x.q.data() + 7);
    products.at_velocities(x.v.data() + 6);
    products.at_rates(x.a.data() + 6);
    FfrBalance<T> const balance(integrals(), terms_, products, x.q);
    balance.inertia(x.a, out);
    balance.force(x.v, forces);
    for (Index k = 0; k < out.size(); ++k) out[k] -= forces[k];
  }

  template <class = void>
  void tangent(Index, std::span<double const> q, std::span<double const> v, double ck, double cd, MatX& k) const {
    FfrTangent(integrals(), terms_, q, v).write(ck, cd, k);
  }

  template <StateScalar T>
  void gravity(Index, std::span<T const> q, Vec3 const& g, VecXOf<T>& out) const {
    Mat<T, 3, 3> const A = rotation_matrix<T>(part<4>(q, 3));
    Vec<T, 3> const pull = A.transpose() * g.template cast<T>();
    T const* const x = q.data() + 7;
    out.template head<3>() = (g * integrals().mass).template cast<T>();
    out.template segment<3>(3) = first_moment<T>(x).cross(pull);
    for (Index k = 0; k < deformations(); ++k) out[6 + k] = integrals().template first_slope<T>(x, k).dot(pull);
  }

  template <class = void>
  double kinetic_energy(Index, std::span<double const> q, std::span<double const> v) const {
    static thread_local VecX mv;  // no allocation: energies are also evaluated within steps
    mv.resize(velocities());
    inertia<double>(0, q, v, mv);
    return 0.5 * mv.dot(Eigen::Map<VecX const>(v.data(), velocities()));
  }
  template <class = void>
  double strain_energy(Index, std::span<double const> q) const {
    double const* const x = q.data() + 7;
    return 0.5 * detail::quadratic<double>(integrals().stiffness, x, x) +
           integrals().initial_force.dot(Eigen::Map<VecX const>(x, deformations()));
  }
  template <class = void>
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    return -g.dot(integrals().mass * part<3>(q, 0) +
                  rotation_matrix<double>(part<4>(q, 3)) * integrals().first_moment<double>(q.data() + 7));
  }

  /// Marker kinematics: r = r₀ + A u;  ω = A (Ω + Jl(θ) θ˙);  bias = A [Ω × (Ω × u) + 2 Ω × u˙ + u¨; Ω × Jl θ˙ + Jl˙
  /// θ˙] with u¨ for q¨ = 0, where Jl is the left Jacobian of exp(θ̃).
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    Mat<T, 3, 3> const A = rotation_matrix<T>(part<4>(q, 3));
    Vec<T, 3> const omega = part<3>(v, 3);
    T const *const x = q.data() + 7, *const xd = v.data() + 6;
    Index const n = deformations();
    T moved[3] = {T(p.u[0]), T(p.u[1]), T(p.u[2])}, rate[3] = {}, turned[3] = {}, turning[3] = {};
    for (Index k = 0; k < n; ++k) {
      T s[3];  // S − qᵀ drawn; u = u₀ + ½ (S + s) q
      p.slopes(x, k, s);
      T const half = 0.5 * x[k];
      for (int i = 0; i < 3; ++i) {
        moved[i] += (s[i] + p.S(i, k)) * half;
        rate[i] += s[i] * xd[k];
        turned[i] += x[k] * p.R(i, k);
        turning[i] += xd[k] * p.R(i, k);
      }
    }
    auto const vector = [](T const* a) { return Vec<T, 3>(a[0], a[1], a[2]); };
    Vec<T, 3> const u = vector(moved), ud = vector(rate), theta = vector(turned), thetad = vector(turning);
    Vec<T, 3> udd = Vec<T, 3>::Zero();
    for (std::size_t i = 0; i < 3 && p.drawn[0].size() > 0; ++i)
      udd[Index(i)] = -detail::quadratic<T>(p.drawn[i], xd, xd);
    Mat<T, 3, 3> const turn = exp_so3<T>(theta), jl = left_jacobian<T>(theta);
    Vec<T, 3> const spin = jl * thetad;
    out.frame.r = part<3>(q, 0) + A * u;
    out.frame.A = A * turn * axes.template cast<T>();
    out.frame.v = part<3>(v, 0) + A * (omega.cross(u) + ud);
    out.frame.w = A * (omega + spin);
    out.bias.template head<3>() = A * (omega.cross(omega.cross(u)) + omega.cross(ud) * T(2.0) + udd);
    out.bias.template tail<3>() =
        A * (omega.cross(spin) - right_jacobian_derivative<T>(Vec<T, 3>(-theta), thetad) * thetad);
    Mat<T, 3, 3> const ajl = A * jl;
    T* column = out.jacobian;
    auto const put = [&](Vec<T, 3> const& above, Vec<T, 3> const& below) {
      for (int i = 0; i < 3; ++i) {
        column[i] = above[i];
        column[3 + i] = below[i];
      }
      column += 6;
    };
    for (int i = 0; i < 3; ++i) put(Vec<T, 3>::Unit(i), Vec<T, 3>::Zero());
    for (int i = 0; i < 3; ++i) {  // −A ũ
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      put(A.col(k) * u[j] - A.col(j) * u[k], A.col(i));
    }
    for (Index k = 0; k < n; ++k) {
      T s[3];
      p.slopes(x, k, s);
      double const* const r = &p.R(0, k);
      for (int i = 0; i < 3; ++i) {
        column[i] = A(i, 0) * s[0] + A(i, 1) * s[1] + A(i, 2) * s[2];
        column[3 + i] = ajl(i, 0) * r[0] + ajl(i, 1) * r[1] + ajl(i, 2) * r[2];
      }
      column += 6;
    }
    out.shape = JacobianShape::dense;
    out.columns = 6 + n;
  }

  /// Load stiffness: the derivative of Jᵀw = [f; u × F + N; Sᵀ F + Rᵀ Jr(θ) N] with respect to δ of q ⊞ δ, with S =
  /// ∂u/∂q, F = Aᵀf, N = Aᵀm and the right Jacobian Jr of exp(θ̃).
  template <class = void>
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, MatX& k) const {
    Index const n = deformations();
    Mat3 const A = rotation_matrix<double>(part<4>(q, 3));
    double const* const x = q.data() + 7;
    Vec3 const f = A.transpose() * w.f, m = A.transpose() * w.m;
    Vec3 u = p.u, theta = Vec3::Zero();
    for (Index c = 0; c < n; ++c) theta += p.R.col(c) * x[c];
    Mat3 const turn = right_jacobian<double>(theta).transpose(), bend = right_jacobian_derivative<double>(theta, m);
    k.setZero(6 + n, 6 + n);
    for (Index c = 0; c < n; ++c) {
      Vec3 const s(p.slope(x, 0, c), p.slope(x, 1, c), p.slope(x, 2, c)), r = p.R.col(c), bent = bend * r;
      u += (0.5 * x[c]) * (s + p.S.col(c));
      k.block<3, 1>(3, 6 + c) = s.cross(f);
      k.block<1, 3>(6 + c, 3) = (s.cross(f) + (turn * r).cross(m)).transpose();
      for (Index d = 0; d < n; ++d) k(6 + d, 6 + c) = p.R.col(d).dot(bent);
    }
    k.block<3, 3>(3, 3) = skew<double>(u) * skew<double>(f) + skew<double>(m);
    for (std::size_t i = 0; i < 3 && p.drawn[0].size() > 0; ++i) k.bottomRightCorner(n, n) -= f[Index(i)] * p.drawn[i];
  }

  /// Ratio of the axial forces to the buckling forces of the beams (ffr_points.hpp). The axial forces are due to
  /// `loads` (world axes), gravity and the motion of the frame. The ratio is zero for a body with geometric stiffening
  /// or without beams.
  /// \param a v̇ of the body
  template <class = void>
  double axial_share(std::span<double const> q, std::span<double const> v, std::span<double const> a,
                     Vec3 const& gravity, std::span<PlacedWrench const> loads) const {
    if (!points_) return 0.0;
    Frame<double> frame;
    frame.r = part<3>(q, 0);
    frame.A = rotation_matrix<double>(part<4>(q, 3));
    frame.w = frame.A * part<3>(v, 3);
    return points_->axial_share(StructureAction::in_frame(frame, part<3>(a, 0) - gravity, part<3>(a, 3), loads));
  }

  /// Axial strain, torsion and curvatures of the beam at point p, as a vector of six (`HasSections`). The shear strains
  /// are zero. q are all coordinates of the body.
  /// \throws InvalidInput for a point that is not on a beam.
  template <class = void>
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    return p.section_strains(q.data() + 7);
  }
  template <class = void>
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return p.section_forces(q.data() + 7);
  }

 private:
  template <class T>
  using Moments = FfrIntegrals::Moments<T>;

  /// First moment c, of the deformed or the undeformed body as `terms_` selects.
  template <class T>
  Vec<T, 3> first_moment(T const* x) const {
    return terms_.first_moment<T>(integrals(), x);
  }
  template <class T>
  void moments(T const* x, Moments<T>& out) const {
    if (terms_.deformed_inertia) return integrals().template moments<T>(x, out);
    out.c = integrals().first.template cast<T>();
    out.J = integrals().inertia.template cast<T>();
  }

  /// Products in a workspace of the calling thread.
  template <class T>
  FfrProducts<T> own_products() const {
    static thread_local VecXOf<T> numbers;
    if (numbers.size() < workspace_size()) numbers.resize(workspace_size());
    return {made_of_->integrals, made_of_->stack, numbers.data()};
  }
  FfrPoints const& made() const { return require_points(points_.get(), "Ffr"); }

  struct Constants {
    FfrIntegrals integrals;
    FfrStack stack;
  };

  std::shared_ptr<Constants const> made_of_;
  Placement placement_;
  FfrTerms terms_;
  std::shared_ptr<FfrPoints const> points_;
};

}  // namespace polybody
