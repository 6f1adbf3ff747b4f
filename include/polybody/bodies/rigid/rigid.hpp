#pragma once
/// \file
/// Rigid body in space with a unit quaternion [Shabana 2020, §3.5; Brüls, Cardona & Arnold 2012].
/// Theory: Eqs. 1.4, 1.20, 1.21, 1.27, 1.31, 2.1 to 2.6.

#include <concepts>

#include <polybody/bodies/rigid/inertia_tensor.hpp>
#include <polybody/bodies/rigid/rigid_marker.hpp>
#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/frame_secants.hpp>

namespace polybody {

/// Mass properties, placement and points of a rigid body, independent of its rotation coordinates.
class RigidShape {
 public:
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::frame;

  /// Material point, in body axes from the centre of mass [m].
  struct Point {
    Vec3 u = Vec3::Zero();  ///< (3) position from the centre of mass, body axes [m]
  };

  /// Mass properties and placement of a rigid body.
  struct Parameters {
    Required<double> mass;        ///< [kg]
    Mat3 inertia = Mat3::Zero();  ///< (3×3) about the centre of mass, body axes [kg m²]
    Placement placement = {};     ///< placement of the centre of mass and of the axes of the body
  };

  /// Body with the mass properties and the placement `p`. Moments of inertia may be zero.
  /// \throws InvalidInput for mass ≤ 0, an inertia tensor that no distribution of mass has, or an invalid placement.
  template <class = void>  // compiled only if used
  RigidShape(Parameters const& p) : mass_(p.mass), inertia_(p.inertia), placement_(p.placement) {  // NOLINT
    require_positive(mass_, "Rigid: the mass");
    require_inertia(inertia_, "Rigid");
    placement_.check("Rigid");
  }
  /// Body with `mass` [kg] and `inertia` about the centre of mass, in body axes [kg m²].
  /// \throws InvalidInput for mass ≤ 0, an inertia tensor that no distribution of mass has, or an invalid placement.
  template <class = void>  // compiled only if used
  RigidShape(double mass, Mat3 const& inertia, Placement const& placement = {})
      : RigidShape(Parameters{.mass = mass, .inertia = inertia, .placement = placement}) {}

  double mass() const { return mass_; }             ///< [kg]
  Mat3 const& inertia() const { return inertia_; }  ///< J (3×3) about the centre of mass, body axes [kg m²]

  /// Point at the distance s along the bar from its first end, and (y, z) from the axis of the bar [m].
  /// \throws InvalidInput for s outside the bar, and for a body that is not made from a bar.
  template <class = void>  // compiled only if used
  Point at(double s, double y = 0.0, double z = 0.0) const {
    if (length_ == 0.0)
      throw InvalidInput(
          "rigid.no_bar",
          {ErrorObject{"Rigid"},
           ": at(s) needs a body made from a Bar. Use at(u) with the vector u from the centre of mass."});
    return at(Vec3(require_inside(s, length_, "Rigid") - 0.5 * length_, y, z));
  }
  /// Point u in body axes from the centre of mass [m].
  template <class = void>  // compiled only if used
  Point at(Vec3 const& u) const {
    require_finite(u, "Rigid: the point");
    return {u};
  }
  /// Centre of mass.
  Point centre() const { return {}; }

  Index elements() const { return 1; }
  Index first_column(Index) const { return 0; }
  Index first_column(Point const&) const { return 0; }

 protected:
  /// Rigid body made from `bar`. The axes of the body are those of the bar, and its origin is the middle of the bar.
  template <class = void>  // compiled only if used
  explicit RigidShape(Bar const& bar) : RigidShape(parameters(bar)) {
    length_ = bar.length;
  }
  /// Mass properties of the bar.
  template <class T = double>  // compiled only if used
  static Parameters parameters(Bar const& bar) {
    BarConstants const c = constants(bar);
    double const l = bar.length, m = c.mass_per_length * l;
    double const z = c.rotary_inertia * l, y = c.rotary_inertia_y.value_or(c.rotary_inertia) * l;
    Placement place = bar.placement;
    for (int i = 0; i < 3; ++i) place.origin[i] += place.axes(i, 0) * (0.5 * l);
    auto inertia = detail::zeros<Mat<T, 3, 3>>();
    inertia(0, 0) = c.polar_inertia ? *c.polar_inertia * l : y + z;
    inertia(1, 1) = m * l * l / 12.0 + y;
    inertia(2, 2) = m * l * l / 12.0 + z;
    return {.mass = m, .inertia = inertia, .placement = place};
  }

  /// Product J x in body axes.
  template <StateScalar T>
  Vec<T, 3> inertia_times(Vec<T, 3> const& x) const {
    Vec<T, 3> y;
    for (int i = 0; i < 3; ++i) y[i] = x[0] * inertia_(i, 0) + x[1] * inertia_(i, 1) + x[2] * inertia_(i, 2);
    return y;
  }
  /// Column j of the inertia tensor J.
  template <class T>
  Vec<T, 3> axis_of_inertia(int j) const {
    return {inertia_(0, j), inertia_(1, j), inertia_(2, j)};
  }
  /// Writes a × b to three entries of `out`, beginning at `first`. Eigen's cross product is slower, because it stores
  /// its result in memory and waits for this store.
  template <class A, class B, class Out>
  static void set_cross(A const& a, B const& b, Out& out, int first) {
    out[first] = a[1] * b[2] - a[2] * b[1];
    out[first + 1] = a[2] * b[0] - a[0] * b[2];
    out[first + 2] = a[0] * b[1] - a[1] * b[0];
  }

  double mass_;          ///< [kg]
  Mat3 inertia_;         ///< J about the centre of mass, body axes [kg m²]
  Placement placement_;  ///< placement of the centre of mass
  double length_ = 0.0;  ///< length of the bar; 0 without a bar [m]
};

/// Rotation of `Rigid` as a unit quaternion, with the angular velocity in body axes as generalised velocities.
struct UnitQuaternion {};

/// Rigid body: `Rigid<>` with a unit quaternion, or `Rigid<EulerParameters>` (bodies/rigid/rigid_euler_parameters.hpp).
template <class Rotation = UnitQuaternion>
class Rigid;

/// Rigid body with a unit quaternion: six generalised velocities and no constraint equation of its own [Shabana 2020,
/// §3.5; Brüls, Cardona & Arnold 2012]. The coordinates are (r, q), with the centre of mass r in world axes [m] and the
/// unit quaternion q. The generalised velocities are (ṙ, Ω), with the angular velocity Ω in body axes [rad/s].
/// The equations of Newton and Euler, with the force f and the moment m_c about the centre of mass in world axes, are
///   m r̈ = f,  J Ω˙ + Ω × J Ω = Aᵀ m_c.
template <>
class Rigid<UnitQuaternion> : public RigidShape {
 public:
  static constexpr bool constant_mass = true;
  static constexpr int element_columns = 6;
  static constexpr int point_columns = 6;
  static constexpr RigidLayout layout =
      RigidLayout::quaternion;  ///< (r, quaternion); suitable for joints with `JointCoordinates`

  using RigidShape::inertia, RigidShape::mass, RigidShape::RigidShape;

  /// Rigid body made from `bar`. The axes of the body are those of the bar, and its origin is the middle of the bar.
  /// The mesh has no effect.
  /// \throws InvalidInput for a mesh of less than one element.
  template <class = void>  // compiled only if used
  static Rigid from(Bar const& bar, BarMesh const& mesh = {}) {
    require_elements(mesh.elements.value_or(1), "Rigid");
    return Rigid(bar);
  }

  Index coordinates() const { return 7; }
  Index velocities() const { return 6; }
  char const* coordinate_unit(Index i) const { return i < 3 ? "m" : "1"; }
  char const* velocity_unit(Index i) const { return i < 3 ? "m/s" : "rad/s"; }

  template <class = void>  // compiled only if used
  void reference(std::span<double> q) const {
    Quaternion<double> const turn = quaternion_of(placement_.axes);
    for (std::size_t i = 0; i < 3; ++i) q[i] = placement_.origin[Index(i)];
    for (std::size_t i = 0; i < 4; ++i) q[3 + i] = turn[Index(i)];
  }

  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    for (std::size_t i = 0; i < 3; ++i) out[i] = q[i] + delta[i];
    set_quaternion_plus<T>(q.data() + 3, delta.data() + 3, out.data() + 3);
  }

  /// Rate δ˙ for which q ⊞ δ(t) moves with the generalised velocities v. For the rotation, Ω = Jr(δ) δ˙.
  template <StateScalar T>
  void local_rate(std::span<T const> delta, std::span<T const> v, std::span<T> out) const {
    Mat<T, 3, 3> const jacobian = right_jacobian_inverse<T>({delta[3], delta[4], delta[5]});
    for (std::size_t i = 0; i < 3; ++i) out[i] = v[i];
    for (int i = 0; i < 3; ++i)
      out[std::size_t(3 + i)] = jacobian(i, 0) * v[3] + jacobian(i, 1) * v[4] + jacobian(i, 2) * v[5];
  }

  /// Generalised velocities of a rigid motion: velocity `v0` of the body-fixed point at the origin of the world [m/s]
  /// and angular velocity `omega` [rad/s] (world axes).
  template <class T = double>  // compiled only if used
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    Vec<T, 3> const r = part<3>(q, 0);
    part<3>(v, 0) = v0 + omega.cross(r);
    part<3>(v, 3) = rotation_matrix<T>(part<4>(q, 3)).transpose() * omega;
  }

  template <class T>  // compiled only if used
  void mass(Index, std::span<double const>, Mat<T, 6, 6>& m) const {
    m = detail::zeros<Mat<T, 6, 6>>();
    for (int i = 0; i < 3; ++i) {
      m(i, i) = mass_;
      for (int j = 0; j < 3; ++j) m(3 + i, 3 + j) = inertia_(i, j);
    }
  }

  template <StateScalar T>
  void inertia(Index, std::span<T const>, std::span<T const> a, Vec<T, 6>& out) const {
    Vec<T, 3> const spin = inertia_times<T>({a[3], a[4], a[5]});
    for (int i = 0; i < 3; ++i) {
      out[i] = a[std::size_t(i)] * T(mass_);
      out[3 + i] = spin[i];
    }
  }

  /// Gyroscopic force −Ω × J Ω.
  template <StateScalar T>
  void force(Index, std::span<T const>, std::span<T const> v, Vec<T, 6>& out) const {
    Vec<T, 3> const omega(v[3], v[4], v[5]), spin = inertia_times<T>(omega);
    for (int i = 0; i < 3; ++i) out[i] = T(0.0);
    set_cross(spin, omega, out, 3);
  }

  /// Adds the residual, `rows` (6) += [m (v̇ − g); J Ω˙ + Ω × J Ω].
  template <StateScalar T>
  void add_residual(BodyMotion<T> const& x, Vec3 const& g, T* rows) const {
    Vec<T, 3> const omega(x.v[3], x.v[4], x.v[5]), spin = inertia_times<T>(omega),
                                                   moment = inertia_times<T>({x.a[3], x.a[4], x.a[5]});
    T turning[3];
    set_cross(omega, spin, turning, 0);
    for (int i = 0; i < 3; ++i) {
      rows[i] += (x.a[std::size_t(i)] - g[i]) * mass_;
      rows[3 + i] += moment[i] + turning[i];
    }
  }

  /// Mean force over an energy-conserving step, −u × J Ω̄.
  template <class T>  // compiled only if used
  void discrete_force(Index, FrameStep const& step, Vec<T, 6>& out) const {
    Vec<T, 3> const moment = mean_gyroscopic_moment<T>(step, 0, inertia_);
    for (int i = 0; i < 3; ++i) {
      out[i] = 0.0;
      out[3 + i] = moment[i];
    }
  }
  /// Tangent s K̄ of `discrete_force`.
  template <class T>  // compiled only if used
  void discrete_tangent(Index, FrameStep const& step, std::span<double const>, std::span<double const>, double,
                        Mat<T, 6, 6>& k) const {
    Mat<T, 3, 3> const block = mean_gyroscopic_tangent<T>(step, 0, inertia_);
    k = detail::zeros<Mat<T, 6, 6>>();
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) k(3 + i, 3 + j) = block(i, j);
  }
  /// Frame of a marker over an energy-conserving step.
  template <class S>
  FrameSecant<S> discrete_marker(Point const& p, Mat3 const& axes, FrameStep const& step) const {
    return marker_of_frame<S>(p.u, axes, frame_secant<S>(step, 0, 0));
  }

  /// Tangent cd (−∂f/∂Ω) with −∂f/∂Ω = Ω̃ J − (J Ω)~, where x~ is the skew-symmetric matrix of x.
  template <class T>  // compiled only if used
  void tangent(Index, std::span<double const>, std::span<double const> v, double, double cd, Mat<T, 6, 6>& k) const {
    Vec<T, 3> const omega(v[3], v[4], v[5]);
    Mat<T, 3, 3> const of_spin = skew<T>(inertia_times<T>(omega));
    k = detail::zeros<Mat<T, 6, 6>>();
    for (int j = 0; j < 3; ++j) {
      Vec<T, 3> across;  // Ω × column j of J
      set_cross(omega, axis_of_inertia<T>(j), across, 0);
      for (int i = 0; i < 3; ++i) k(3 + i, 3 + j) = cd * (across[i] - of_spin(i, j));
    }
  }

  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Vec<T, 6>& out) const {
    for (int i = 0; i < 3; ++i) {
      out[i] = T(g[i] * mass_);
      out[3 + i] = T(0.0);
    }
  }

  template <class T = double>  // compiled only if used
  double kinetic_energy(Index, std::span<double const>, std::span<double const> v) const {
    Vec<T, 3> const omega(v[3], v[4], v[5]), spin = inertia_times<T>(omega);
    return 0.5 * mass_ * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) +
           0.5 * (omega[0] * spin[0] + omega[1] * spin[1] + omega[2] * spin[2]);
  }
  double strain_energy(Index, std::span<double const>) const { return 0.0; }
  template <class T = double>  // compiled only if used
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    return -mass_ * (g[0] * q[0] + g[1] * q[1] + g[2] * q[2]);
  }

  /// Kinematics that all points of the body share.
  template <StateScalar T>
  struct Pose {
    Vec<T, 3> r, v, w;  ///< centre of mass: position [m], velocity [m/s]; angular velocity [rad/s]; world axes
    Mat<T, 3, 3> A;     ///< rotation matrix from body to world axes
  };

  template <StateScalar T>
  void pose(std::span<T const> q, std::span<T const> v, Pose<T>& out) const {
    set_rotation<T>({q[3], q[4], q[5], q[6]}, out.A);
    for (int i = 0; i < 3; ++i) {
      out.r[i] = q[std::size_t(i)];
      out.v[i] = v[std::size_t(i)];
      out.w[i] = out.A(i, 0) * v[3] + out.A(i, 1) * v[4] + out.A(i, 2) * v[5];
    }
  }

  /// Marker kinematics of a body with the pose `at`: r = r_c + A u;  ṙ = ṙ_c + ω × A u;  bias = [ω × (ω × A u); 0].
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, Pose<T> const& at, MarkerKinematics<T>& out) const {
    out.shape = JacobianShape::rigid;
    out.columns = 6;
    if constexpr (std::same_as<T, double>) return detail::write_rigid_marker(p.u, axes, at, out);
    T arm[3], rate[3];
    for (int i = 0; i < 3; ++i) {
      T const x = at.A(i, 0), y = at.A(i, 1), z = at.A(i, 2);
      arm[i] = x * T(p.u[0]) + y * T(p.u[1]) + z * T(p.u[2]);
      for (int j = 0; j < 3; ++j) out.frame.A(i, j) = x * T(axes(0, j)) + y * T(axes(1, j)) + z * T(axes(2, j));
    }
    set_cross(at.w, arm, rate, 0);
    set_cross(at.w, rate, out.bias, 0);
    for (int i = 0; i < 3; ++i) {
      out.frame.r[i] = at.r[i] + arm[i];
      out.frame.v[i] = at.v[i] + rate[i];
      out.bias[3 + i] = T(0.0);
      out.arm[i] = arm[i];  // entry by entry: a vector load would wait for these writes
    }
    out.frame.w = at.w;
    out.body_axes = at.A;
  }
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    Pose<T> at;
    pose<T>(q, v, at);
    evaluate_marker(p, axes, at, out);
  }

  /// Load stiffness, the derivative of Jᵀw = [f; Aᵀm + u × Aᵀf]. A rotation A ⊞ δ changes Aᵀm by (Aᵀm)~ δ, with the
  /// skew-symmetric matrix x~ of x. The block of the rotation is therefore (Aᵀm)~ + ũ (Aᵀf)~.
  template <class T>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, Mat<T, 6, 6>& k) const {
    Mat<T, 3, 3> const a = rotation_matrix<T>({q[3], q[4], q[5], q[6]});
    Vec<T, 3> f, m;
    for (int i = 0; i < 3; ++i) {
      f[i] = a(0, i) * w.f[0] + a(1, i) * w.f[1] + a(2, i) * w.f[2];
      m[i] = a(0, i) * w.m[0] + a(1, i) * w.m[1] + a(2, i) * w.m[2];
    }
    T const along = p.u[0] * f[0] + p.u[1] * f[1] + p.u[2] * f[2];  // ũ f̃ = f uᵀ − (u·f) 1
    Mat<T, 3, 3> const of_moment = skew<T>(m);
    k = detail::zeros<Mat<T, 6, 6>>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) k(3 + i, 3 + j) = of_moment(i, j) + (f[i] * p.u[j] - (i == j ? along : T(0.0)));
  }

 private:
  template <class = void>  // compiled only if used
  explicit Rigid(Bar const& bar) : RigidShape(bar) {}
};

/// True: the body moves by the equations of Newton and Euler about its centre of mass.
template <>
inline constexpr bool moves_by_newton_euler<Rigid<UnitQuaternion>> = true;

}  // namespace polybody
