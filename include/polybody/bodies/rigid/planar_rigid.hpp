#pragma once
/// \file
/// Rigid body in the plane, with the coordinates (x, y, θ) of the centre of mass and their rates as generalised
/// velocities.
/// Theory: Eq. 2.10.

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/node_chain.hpp>

namespace polybody::planar {

/// Rigid body in the plane. The coordinates are x, y of the centre of mass [m] and the angle θ [rad]; the generalised
/// velocities are their rates.
class Rigid : public AddingCoordinates {
 public:
  static constexpr World world = World::plane;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = true;
  static constexpr int element_columns = 3;
  static constexpr int point_columns = 3;
  static constexpr RigidLayout layout = RigidLayout::plane;  ///< (x, y, θ); suitable for joints with `JointCoordinates`

  /// Material point, in body axes from the centre of mass [m].
  struct Point {
    Vec2 u = Vec2::Zero();  ///< (2) position from the centre of mass, body axes [m]
  };

  /// Mass, inertia and placement.
  struct Parameters {
    Required<double> mass;     ///< [kg]
    Required<double> inertia;  ///< about the axis z through the centre of mass [kg m²]; zero for a point mass
    Placement placement = {};  ///< placement of the centre of mass
  };

  /// Body with the mass, the inertia and the placement `p`.
  /// \throws InvalidInput for mass ≤ 0, inertia < 0 or a placement that leaves the plane.
  template <class = void>     // compiled only if used
  Rigid(Parameters const& p)  // NOLINT(google-explicit-constructor)
      : mass_(p.mass),
        inertia_(p.inertia),
        origin_(p.placement.origin[0], p.placement.origin[1]),
        angle_(p.placement.planar_angle("planar::Rigid")) {
    require_positive(mass_, "planar::Rigid: the mass");
    require_not_negative(inertia_, "planar::Rigid: the inertia");
  }
  /// Body with `mass` [kg] and `inertia` about the centre of mass [kg m²].
  /// \throws InvalidInput for mass ≤ 0, inertia < 0 or a placement that leaves the plane.
  template <class = void>  // compiled only if used
  Rigid(double mass, double inertia, Placement const& placement = {})
      : Rigid(Parameters{.mass = mass, .inertia = inertia, .placement = placement}) {}

  /// Rigid body made from `bar`. The origin of the body is the middle of the bar. The mesh has no effect.
  /// \throws InvalidInput for a mesh of less than one element, or a placement that leaves the plane.
  template <class = void>  // compiled only if used
  static Rigid from(Bar const& bar, BarMesh const& mesh = {}) {
    require_elements(mesh.elements.value_or(1), "planar::Rigid");
    BarConstants const c = constants(bar);
    double const l = bar.length, m = c.mass_per_length * l;
    Placement place = bar.placement;
    for (int i = 0; i < 3; ++i) place.origin[i] += place.axes(i, 0) * (0.5 * l);
    Rigid body(m, m * l * l / 12.0 + c.rotary_inertia * l, place);
    body.length_ = l;
    return body;
  }

  /// Point at the distance s along the bar from its first end, and y from the axis of the bar [m].
  /// \throws InvalidInput for s outside the bar, and for a body that is not made from a bar.
  template <class = void>  // compiled only if used
  Point at(double s, double y = 0.0) const {
    if (length_ == 0.0)
      throw InvalidInput(
          "rigid.no_bar",
          {ErrorObject{"planar::Rigid"},
           ": at(s) needs a body made from a Bar. Use at(u) with the vector u from the centre of mass."});
    return at(Vec2(require_inside(s, length_, "planar::Rigid") - 0.5 * length_, y));
  }
  /// Point u in body axes from the centre of mass [m].
  template <class = void>  // compiled only if used
  Point at(Vec2 const& u) const {
    require_finite(u, "planar::Rigid: the point");
    return {u};
  }
  /// Centre of mass.
  Point centre() const { return {}; }

  Index coordinates() const { return 3; }
  Index velocities() const { return 3; }
  char const* coordinate_unit(Index i) const { return i < 2 ? "m" : "rad"; }
  Index elements() const { return 1; }
  Index first_column(Index) const { return 0; }
  Index first_column(Point const&) const { return 0; }

  void reference(std::span<double> q) const {
    q[0] = origin_[0];
    q[1] = origin_[1];
    q[2] = angle_;
  }

  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    v[0] = v0[0] - omega[2] * q[1];
    v[1] = v0[1] + omega[2] * q[0];
    v[2] = omega[2];
  }

  template <class = void>  // compiled only if used
  void mass(Index, std::span<double const>, Mat3& m) const {
    m.setZero();
    m(0, 0) = m(1, 1) = mass_;
    m(2, 2) = inertia_;
  }
  template <StateScalar T>
  void inertia(Index, std::span<T const>, std::span<T const> a, Vec<T, 3>& out) const {
    out = {a[0] * mass_, a[1] * mass_, a[2] * inertia_};
  }
  template <StateScalar T>
  void force(Index, std::span<T const>, std::span<T const>, Vec<T, 3>& out) const {
    out.setZero();
  }
  template <class = void>  // compiled only if used
  void tangent(Index, std::span<double const>, std::span<double const>, double, double, Mat3& k) const {
    k.setZero();
  }
  template <class = void>  // compiled only if used
  void discrete_force(Index, std::span<double const>, std::span<double const>, DiscreteDerivative const&,
                      Vec3& out) const {
    out.setZero();
  }
  template <class = void>  // compiled only if used
  void discrete_tangent(Index, std::span<double const>, std::span<double const>, DiscreteDerivative const&, double,
                        Mat3& k) const {
    k.setZero();
  }
  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Vec<T, 3>& out) const {
    out = {T(g[0] * mass_), T(g[1] * mass_), T(0.0)};
  }

  double kinetic_energy(Index, std::span<double const>, std::span<double const> v) const {
    return 0.5 * mass_ * (v[0] * v[0] + v[1] * v[1]) + 0.5 * inertia_ * v[2] * v[2];
  }
  double strain_energy(Index, std::span<double const>) const { return 0.0; }
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    return -mass_ * (g[0] * q[0] + g[1] * q[1]);
  }

  /// Marker kinematics: r = r_c + ρ, ρ = A u;  ṙ = ṙ_c + θ̇ e_z × ρ;  bias = −θ̇² ρ.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    using std::cos, std::sin;
    T const c = cos(q[2]), s = sin(q[2]);
    T const x = c * p.u[0] - s * p.u[1], y = s * p.u[0] + c * p.u[1];
    Mat<T, 3, 3> a;
    a << c, -s, T(0), s, c, T(0), T(0), T(0), T(1);
    out.frame.r << q[0] + x, q[1] + y, T(0);
    out.frame.A = a * axes.template cast<T>();
    out.frame.v << v[0] - v[2] * y, v[1] + v[2] * x, T(0);
    out.frame.w << T(0), T(0), v[2];
    out.bias.setZero();
    out.bias[0] = -v[2] * v[2] * x;
    out.bias[1] = -v[2] * v[2] * y;
    Eigen::Map<Mat<T, 6, 3>> j(out.jacobian);
    j.setZero();
    j(0, 0) = T(1);
    j(1, 1) = T(1);
    j(0, 2) = -y;
    j(1, 2) = x;
    j(5, 2) = T(1);
    out.shape = JacobianShape::dense;
    out.columns = 3;
  }

  /// Load stiffness ∂(Jᵀw)/∂q. Only the third row of Jᵀw depends on q: ∂(ρ × f)/∂θ = −ρ · f.
  template <class = void>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, Mat3& k) const {
    double const c = std::cos(q[2]), s = std::sin(q[2]);
    k.setZero();
    k(2, 2) = -(c * p.u[0] - s * p.u[1]) * w.f[0] - (s * p.u[0] + c * p.u[1]) * w.f[1];
  }

 private:
  double mass_;
  double inertia_;
  Vec2 origin_;
  double angle_;
  double length_ = 0.0;
};

}  // namespace polybody::planar

template <>
inline constexpr bool polybody::moves_by_newton_euler<polybody::planar::Rigid> = true;
