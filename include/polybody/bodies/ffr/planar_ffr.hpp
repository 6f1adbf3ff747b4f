#pragma once
/// \file
/// Floating frame of reference in the plane [Shabana 2013, ch. 5]. Theory: Eq. 2.90.

#include <memory>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr_integrals.hpp>
#include <polybody/bodies/shared/node_chain.hpp>

namespace polybody::planar {

/// Floating frame of reference in the plane [Shabana 2013, ch. 5]: small deformation in a frame that rotates by any
/// angle θ. With c, J, H of planar_ffr_integrals.hpp, C = c_q, and e× a rotation by a right angle, all in the axes of
/// the frame,
///   m r̈ + A (θ̈ e × c + C q̈)          = −A (−θ̇² c + 2 θ̇ e × ċ + Ċ q̇),
///   (e × c) · Aᵀr̈ + J θ̈ + H q̈        = −J˙ θ̇ − H˙ q̇,   H˙ q̇ = q̇ᵀ coupling_by q̇ (0 without stiffening),
///   Cᵀ Aᵀr̈ + Hᵀ θ̈ + M q̈ + D q̇ + K q = ½ θ̇² J_q − θ̇ W q̇,   W = ∂Hᵀ/∂q − ∂H/∂q.
/// The coordinates are x, y of the origin of the frame, its angle θ, and q (n). The generalised velocities are their
/// rates. A marker rotates with its section.
class Ffr : public AddingCoordinates {
 public:
  static constexpr World world = World::plane;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = false;
  static constexpr RigidLayout frame_layout = RigidLayout::plane;  ///< order of the frame's coordinates
  static constexpr int element_columns = Eigen::Dynamic;
  static constexpr int point_columns = Eigen::Dynamic;
  static constexpr Index default_elements = 8;  ///< number of elements of `from(bar)`

  using Point = FfrPoint;      ///< material point in the axes of the frame
  using Options = FfrOptions;  ///< placement, terms of the inertia, stiffening and damping

  /// Body of the bar in n elements, at the placement of the bar. By default it has mean axes and geometric stiffening.
  /// The 3 n coordinates q are displacements and rotations of the nodes in the plane. The bar needs no GJ.
  /// \throws InvalidInput for n outside [1, 10⁷], invalid data of the bar, and a placement that leaves the plane.
  template <class = void>  // compiled only if used
  static Ffr from(Bar const& bar, Index n, Options options = {}) {
    options.complete_for(bar.placement);
    Structure const s = structure_in_plane(bar, n);
    return Ffr(s, bar_shapes(s, n, options, true), options);
  }
  /// Body of the bar with the number of elements of `mesh`, by default in mean axes and with geometric stiffening.
  template <class = void>  // compiled only if used
  static Ffr from(Bar const& bar, BarMesh const& mesh = {}, Options options = {}) {
    return from(bar, mesh.elements.value_or(default_elements), options);
  }
  /// Structure of a bar in n elements, for the plane. \throws InvalidInput for n outside [1, 10⁷] or invalid data.
  template <class = void>
  static Structure structure_in_plane(Bar bar, Index n) {
    BarConstants c = constants(bar);
    std::string unit_warning = polybody::detail::unit_warning(bar);
    if (c.GJ == 0.0) c.GJ = c.EI;  // any torsional stiffness, because the plane excludes torsion
    bar.section = std::monostate{};
    bar.material.reset();
    bar.shear_factor.reset();
    bar.constants = c;
    Structure s = structure_of(bar, n);
    s.unit_warning = std::move(unit_warning);
    return s;
  }
  /// Body of a structure in the plane of x and y. Build the basis `shapes` with `restrict_to_plane` or `in_plane`.
  /// \throws InvalidInput for a basis that leaves the plane.
  template <class = void>
  Ffr(Structure structure, MatX shapes, Options const& options = {})
      : Ffr(FfrIntegrals::of(integrals_of(structure, shapes = in_frame(structure, std::move(shapes), options),
                                          options.stiffening.value_or(false))),
            options) {
    for (Index i = 0; i < shapes.rows(); ++i)
      if (int const c = int(i) % structure.per_node; c >= 2 && c < 5 && !shapes.row(i).isZero(0.0))
        throw InvalidInput("ffr.out_of_plane", {ErrorObject{"planar::Ffr"},
                                                ": the shapes of the basis move nodes out of the plane. Make the basis "
                                                "with in_plane = true or restrict_to_plane()."});
    points_ = std::make_shared<FfrPoints const>(std::move(structure), std::move(shapes), i_.stiffens());
  }
  /// Body from integrals that the user computes. The options `frame`, `stiffening` and `modes` have no effect.
  /// \throws InvalidInput for integrals that `FfrIntegrals::check` refuses, and for a placement that leaves the plane.
  template <class = void>
  Ffr(FfrIntegrals integrals, Options const& options) : i_(std::move(integrals)), terms_(options.terms) {
    i_.check("planar::Ffr");
    require_not_negative(options.stiffness_damping, "planar::Ffr: the damping time");
    i_.damping += options.stiffness_damping * i_.stiffness;
    origin_ = options.placement.origin.head<2>();
    angle_ = options.placement.planar_angle("planar::Ffr");
  }

  FfrIntegrals const& integrals() const { return i_; }  ///< inertia and stiffness as functions of the deformation
  Index deformations() const { return i_.size(); }      ///< number n of coordinates of the deformation
  /// Length of the first bar [m].
  /// \throws InvalidInput for a body that is not made of bars.
  double length() const { return made().length(); }
  /// Warning of section matrices of the bar that are probably not in SI units; empty if there is none.
  std::string_view unit_warning() const { return points_ ? points_->structure().unit_warning : std::string_view(); }

  /// Point at the distance s along bar number `bar` (counted from 0) from its first end, and y from the axis [m].
  /// \throws InvalidInput for s outside the bar, a bar that does not exist, and a body that is not made of bars.
  template <class = void>
  Point at(double s, double y = 0.0, Index bar = 0) const {
    return made().at(s, y, 0.0, bar);
  }
  /// Point at node i.
  /// \throws InvalidInput for a node that does not exist.
  template <class = void>
  Point node(Index i) const {
    return made().node(i);
  }
  /// Point with matrices S and R that the user computes.
  /// \throws InvalidInput for matrices that are not 3×n.
  Point at(Point const& p) const {
    if (p.S.cols() != deformations() || p.R.cols() != deformations())
      throw InvalidInput("ffr.point_size", {ErrorObject{"planar::Ffr"}, ": S and R of a point must be 3×",
                                            deformations(), ", but are 3×", p.S.cols(), " and 3×", p.R.cols(),
                                            ". Each needs one column for each deformation coordinate."});
    return p;
  }

  Index coordinates() const { return 3 + deformations(); }
  Index velocities() const { return 3 + deformations(); }
  char const* coordinate_unit(Index i) const { return i < 2 ? "m" : i == 2 ? "rad" : "1"; }
  Index elements() const { return 1; }
  Index first_column(Index) const { return 0; }
  Index first_column(Point const&) const { return 0; }

  template <class = void>
  void reference(std::span<double> q) const {
    std::fill(q.begin(), q.end(), 0.0);
    part<3>(q, 0) << origin_, angle_;
  }
  template <class = void>
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    std::fill(v.begin(), v.end(), 0.0);
    part<3>(v, 0) << v0[0] - omega[2] * q[1], v0[1] + omega[2] * q[0], omega[2];
  }

  template <class = void>
  void mass(Index, std::span<double const> q, MatX& m) const {
    Index const n = deformations();
    double const c = std::cos(q[2]), s = std::sin(q[2]);
    FfrIntegrals::Moments<double> at;
    moments<double>(q.data() + 3, at);
    m.setZero(3 + n, 3 + n);
    m(0, 0) = m(1, 1) = i_.mass;
    m(2, 2) = at.J;
    m(0, 2) = m(2, 0) = -(s * at.c[0] + c * at.c[1]);
    m(1, 2) = m(2, 1) = c * at.c[0] - s * at.c[1];
    m.bottomRightCorner(n, n) = i_.mass_matrix;
    for (Index k = 0; k < n && terms_.coupling; ++k) {
      double const x = i_.first_slope<double>(q.data() + 3, 0, k), y = i_.first_slope<double>(q.data() + 3, 1, k);
      m(3 + k, 0) = c * x - s * y;
      m(3 + k, 1) = s * x + c * y;
      m(3 + k, 2) = i_.coupling_at<double>(q.data() + 3, k);
      for (Index i = 0; i < 3 && terms_.onto_frame; ++i) m(i, 3 + k) = m(3 + k, i);
    }
  }
  template <StateScalar T>
  void inertia(Index, std::span<T const> q, std::span<T const> a, VecXOf<T>& out) const {
    using std::cos, std::sin;
    T const c = cos(q[2]), s = sin(q[2]);
    T const along[2] = {c * a[0] + s * a[1], c * a[1] - s * a[0]};
    T const *const x = q.data() + 3, *const xdd = a.data() + 3;
    FfrIntegrals::Moments<T> at;
    moments<T>(x, at);
    T push[2] = {-(a[2] * at.c[1]), a[2] * at.c[0]};
    T turn = at.c[0] * along[1] - at.c[1] * along[0] + at.J * a[2];
    for (Index k = 0; k < deformations(); ++k) {
      T sum(0.0);
      for (Index j = 0; j < deformations(); ++j) sum += xdd[j] * i_.mass_matrix(j, k);
      if (terms_.coupling) {
        for (int i = 0; i < 2; ++i) {
          T const ck = i_.template first_slope<T>(x, i, k);
          sum += along[i] * ck;
          if (terms_.onto_frame) push[i] += ck * xdd[k];
        }
        T const h = i_.template coupling_at<T>(x, k);
        sum += a[2] * h;
        if (terms_.onto_frame) turn += h * xdd[k];
      }
      out[3 + k] = sum;
    }
    out[0] = a[0] * i_.mass + c * push[0] - s * push[1];
    out[1] = a[1] * i_.mass + s * push[0] + c * push[1];
    out[2] = turn;
  }

  template <StateScalar T>
  void force(Index, std::span<T const> q, std::span<T const> v, VecXOf<T>& out) const {
    using std::cos, std::sin;
    T const c = cos(q[2]), s = sin(q[2]), omega = v[2];
    T const *const x = q.data() + 3, *const xd = v.data() + 3;
    FfrIntegrals::Moments<T> at;
    moments<T>(x, at);
    bool const pushes = terms_.couples_frame_velocity();
    T rate[2] = {T(0.0), T(0.0)}, j_rate(0.0);
    for (Index k = 0; k < deformations(); ++k) {
      T const slope = i_.template inertia_slope<T>(x, k);
      if (terms_.changes_inertia()) j_rate += slope * xd[k];
      T f = omega * omega * 0.5 * terms_.centrifugal_slope(slope, i_.inertia_by[k]) - i_.initial_force[k];
      T w(0.0);
      for (Index j = 0; j < deformations(); ++j) {
        f -= x[j] * i_.stiffness(j, k) + xd[j] * i_.damping(j, k);
        w += xd[j] * (i_.coupling_by(j, k) - i_.coupling_by(k, j));
      }
      if (terms_.coriolis) f -= omega * w;
      out[3 + k] = f;
      for (int i = 0; i < 2 && pushes; ++i) rate[i] += i_.template first_slope<T>(x, i, k) * xd[k];
    }
    T w[2] = {-(omega * omega * at.c[0]) - omega * rate[1] * 2.0, -(omega * omega * at.c[1]) + omega * rate[0] * 2.0};
    for (std::size_t i = 0; i < 2 && i_.stiffens() && pushes; ++i)
      w[i] -= detail::quadratic<T>(i_.first_second[i], xd, xd);
    out[0] = -(c * w[0] - s * w[1]);
    out[1] = -(s * w[0] + c * w[1]);
    out[2] = -(j_rate * omega) - (i_.stiffens() && pushes ? detail::quadratic<T>(i_.coupling_by, xd, xd) : T(0.0));
  }

  template <class = void>
  void tangent(Index, std::span<double const> q, std::span<double const> v, double ck, double cd, MatX& k) const {
    Index const n = deformations();
    double const c = std::cos(q[2]), s = std::sin(q[2]), omega = v[2];
    Eigen::Map<VecX const> const x(q.data() + 3, n), xd(v.data() + 3, n);
    FfrIntegrals::Moments<double> at;
    moments<double>(x.data(), at);
    double const pushes = terms_.couples_frame_velocity() ? 1.0 : 0.0, deformed = terms_.deformed_inertia ? 1.0 : 0.0,
                 moving = terms_.changes_inertia() ? 1.0 : 0.0;
    k.setZero(3 + n, 3 + n);
    auto const turned = [&](Index column, double wx, double wy) {  // A w into the rows of r
      k(0, column) += c * wx - s * wy;
      k(1, column) += s * wx + c * wy;
    };
    double rate[2] = {0.0, 0.0}, j_rate = 0.0, drawn_rate[2] = {0.0, 0.0};
    for (Index i = 0; i < n; ++i) {
      double const cx = i_.first_slope<double>(x.data(), 0, i), cy = i_.first_slope<double>(x.data(), 1, i);
      double const slope = i_.inertia_slope<double>(x.data(), i), bent = 2.0 * i_.inertia_second.col(i).dot(xd);
      double const left = i_.coupling_by.row(i).dot(xd), right = i_.coupling_by.col(i).dot(xd);
      rate[0] += pushes * cx * xd[i];
      rate[1] += pushes * cy * xd[i];
      j_rate += moving * slope * xd[i];
      double const two = pushes * 2.0 * cd * omega, square = deformed * ck * omega * omega;
      turned(3 + i, -square * cx - two * cy, -square * cy + two * cx);
      for (std::size_t j = 0; j < 2 && i_.stiffens() && terms_.couples_frame_velocity(); ++j) {
        double const drawn = i_.first_second[j].col(i).dot(xd);
        drawn_rate[j] += drawn * xd[i];
        double const by_rate = -2.0 * cd * drawn, by_place = -2.0 * ck * omega * drawn;
        turned(3 + i, j == 0 ? by_rate : -by_place, j == 0 ? by_place : by_rate);
      }
      k(2, 3 + i) += moving * omega * (ck * bent + cd * slope) + (i_.stiffens() ? pushes * cd * (left + right) : 0.0);
      k(3 + i, 2) -= cd * omega * terms_.centrifugal_slope(slope, i_.inertia_by[i]);
      if (terms_.coriolis) k(3 + i, 2) += cd * (right - left);
    }
    auto kq = k.bottomRightCorner(n, n);
    kq += ck * i_.stiffness + cd * i_.damping;
    if (terms_.centrifugal) kq -= (ck * omega * omega) * i_.inertia_second;
    if (terms_.coriolis) kq += (cd * omega) * (i_.coupling_by.transpose() - i_.coupling_by);
    double const wx = -omega * omega * at.c[0] - 2.0 * omega * rate[1] - drawn_rate[0],
                 wy = -omega * omega * at.c[1] + 2.0 * omega * rate[0] - drawn_rate[1];
    turned(2, -ck * wy - 2.0 * cd * (omega * at.c[0] + rate[1]), ck * wx + 2.0 * cd * (rate[0] - omega * at.c[1]));
    k(2, 2) += cd * j_rate;
  }

  template <StateScalar T>
  void gravity(Index, std::span<T const> q, Vec3 const& g, VecXOf<T>& out) const {
    using std::cos, std::sin;
    T const c = cos(q[2]), s = sin(q[2]);
    T const pull[2] = {c * g[0] + s * g[1], c * g[1] - s * g[0]};
    FfrIntegrals::Moments<T> at;
    moments<T>(q.data() + 3, at);
    out[0] = T(g[0] * i_.mass);
    out[1] = T(g[1] * i_.mass);
    out[2] = at.c[0] * pull[1] - at.c[1] * pull[0];
    for (Index k = 0; k < deformations(); ++k)
      out[3 + k] = i_.template first_slope<T>(q.data() + 3, 0, k) * pull[0] +
                   i_.template first_slope<T>(q.data() + 3, 1, k) * pull[1];
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
    double const* const x = q.data() + 3;
    return 0.5 * detail::quadratic<double>(i_.stiffness, x, x) +
           i_.initial_force.dot(Eigen::Map<VecX const>(x, deformations()));
  }
  template <class = void>
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    FfrIntegrals::Moments<double> at;
    i_.moments<double>(q.data() + 3, at);
    double const c = std::cos(q[2]), s = std::sin(q[2]);
    return -g[0] * (i_.mass * q[0] + c * at.c[0] - s * at.c[1]) - g[1] * (i_.mass * q[1] + s * at.c[0] + c * at.c[1]);
  }

  /// Marker kinematics: r = r₀ + A u, the angle θ + R_z q;  at q¨ = 0 bias = A [−θ̇² u + 2 θ̇ e × u˙ + u¨; 0].
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    using std::cos, std::sin;
    T const c = cos(q[2]), s = sin(q[2]), omega = v[2];
    T const *const x = q.data() + 3, *const xd = v.data() + 3;
    Index const n = deformations();
    T u[2] = {T(p.u[0]), T(p.u[1])}, ud[2] = {T(0.0), T(0.0)}, udd[2] = {T(0.0), T(0.0)};
    T angle = q[2], turning = omega;
    Eigen::Map<Mat<T, 6, Eigen::Dynamic>> j(out.jacobian, 6, 3 + n);
    j.setZero();
    for (Index k = 0; k < n; ++k) {
      T const slope[2] = {p.slope(x, 0, k), p.slope(x, 1, k)};
      for (int i = 0; i < 2; ++i) {
        u[i] += (slope[i] + p.S(i, k)) * 0.5 * x[k];
        ud[i] += slope[i] * xd[k];
      }
      angle += x[k] * p.R(2, k);
      turning += xd[k] * p.R(2, k);
      j(0, 3 + k) = c * slope[0] - s * slope[1];
      j(1, 3 + k) = s * slope[0] + c * slope[1];
      j(5, 3 + k) = T(p.R(2, k));
    }
    for (std::size_t i = 0; i < 2 && p.drawn[0].size() > 0; ++i) udd[i] = -detail::quadratic<T>(p.drawn[i], xd, xd);
    T const rx = c * u[0] - s * u[1], ry = s * u[0] + c * u[1], vx = c * ud[0] - s * ud[1], vy = s * ud[0] + c * ud[1];
    T const ca = cos(angle), sa = sin(angle);
    Mat<T, 3, 3> turned;
    turned << ca, -sa, T(0.0), sa, ca, T(0.0), T(0.0), T(0.0), T(1.0);
    out.frame.r << q[0] + rx, q[1] + ry, T(0.0);
    out.frame.A = turned * axes.template cast<T>();
    out.frame.v << v[0] - omega * ry + vx, v[1] + omega * rx + vy, T(0.0);
    out.frame.w << T(0.0), T(0.0), turning;
    out.bias.setZero();
    out.bias[0] = -(omega * omega * rx) - omega * vy * 2.0 + c * udd[0] - s * udd[1];
    out.bias[1] = -(omega * omega * ry) + omega * vx * 2.0 + s * udd[0] + c * udd[1];
    j(0, 0) = j(1, 1) = j(5, 2) = T(1.0);
    j(0, 2) = -ry;
    j(1, 2) = rx;
    out.shape = JacobianShape::dense;
    out.columns = 3 + n;
  }

  /// Load stiffness of Jᵀw = [f; u × F + m; Sᵀ F + R_zᵀ m] with F = Aᵀf.
  template <class = void>
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, MatX& k) const {
    Index const n = deformations();
    double const c = std::cos(q[2]), s = std::sin(q[2]), fx = c * w.f[0] + s * w.f[1], fy = c * w.f[1] - s * w.f[0];
    double const* const x = q.data() + 3;
    double ux = p.u[0], uy = p.u[1];
    k.setZero(3 + n, 3 + n);
    for (Index i = 0; i < n; ++i) {
      double const sx = p.slope(x, 0, i), sy = p.slope(x, 1, i);
      ux += 0.5 * (sx + p.S(0, i)) * x[i];
      uy += 0.5 * (sy + p.S(1, i)) * x[i];
      k(2, 3 + i) = k(3 + i, 2) = sx * fy - sy * fx;
    }
    k(2, 2) = -(ux * fx + uy * fy);
    for (std::size_t i = 0; i < 2 && p.drawn[0].size() > 0; ++i)
      k.bottomRightCorner(n, n) -= (i == 0 ? fx : fy) * p.drawn[i];
  }

  /// Ratio of the axial forces to the buckling forces of the beams (ffr_points.hpp).
  /// \param gravity (3), whose z component is ignored
  template <class = void>
  double axial_share(std::span<double const> q, std::span<double const> v, std::span<double const> a,
                     Vec3 const& gravity, std::span<PlacedWrench const> loads) const {
    if (!points_) return 0.0;
    Frame<double> frame;
    frame.r << q[0], q[1], 0.0;
    frame.A << std::cos(q[2]), -std::sin(q[2]), 0.0, std::sin(q[2]), std::cos(q[2]), 0.0, 0.0, 0.0, 1.0;
    frame.w << 0.0, 0.0, v[2];
    Vec3 const acceleration(a[0] - gravity[0], a[1] - gravity[1], 0.0);
    return points_->axial_share(StructureAction::in_frame(frame, acceleration, Vec3(0.0, 0.0, a[2]), loads));
  }

  /// Axial strain and curvature of the beam at point p, as a vector of six (`HasSections`).
  template <class = void>
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    return p.section_strains(q.data() + 3);
  }
  template <class = void>
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return p.section_forces(q.data() + 3);
  }

 private:
  /// Moments c and J, of the deformed or the undeformed body as `terms_` selects.
  template <class T>
  void moments(T const* x, FfrIntegrals::Moments<T>& out) const {
    if (terms_.deformed_inertia) return i_.template moments<T>(x, out);
    for (int i = 0; i < 2; ++i) out.c[i] = T(i_.first[i]);
    out.J = T(i_.inertia);
  }

  FfrPoints const& made() const { return require_points(points_.get(), "planar::Ffr"); }

  FfrIntegrals i_;
  FfrTerms terms_;
  Vec2 origin_ = Vec2::Zero();
  double angle_ = 0.0;
  std::shared_ptr<FfrPoints const> points_;
};

}  // namespace polybody::planar
