#pragma once
/// \file
/// Rigid body with Euler parameters [thesis §3.4, Table 3.4; Shabana 2020, §2.4 and §3.3].
/// Theory: Eqs. 1.22 to 1.24, 2.7 to 2.9.

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/shared/node_chain.hpp>

namespace polybody {

/// Rotation of `Rigid` as four Euler parameters, with their rates as generalised velocities.
struct EulerParameters {};

/// Rigid body with Euler parameters [thesis §3.4, Table 3.4; Shabana 2020, §2.4 and §3.3]. The seven coordinates are
/// (r, θ), with the centre of mass r in world axes [m] and θ = (θ₀, θ₁, θ₂, θ₃). The seven generalised velocities are
/// the rates of the coordinates. The body has the constraint equation ½ (θᵀθ − 1) = 0. With
///   Ḡ = (2/|θ|²) [−θ₁ θ₀ θ₃ −θ₂; −θ₂ −θ₃ θ₀ θ₁; −θ₃ θ₂ −θ₁ θ₀]   (3×4),   Ω = Ḡ θ̇,   G_w = A Ḡ, ω = G_w θ̇,
/// the moment m_c (body axes) and the generalised moment are related by m_θ = Ḡᵀ m_c. Velocities that satisfy the
/// constraint equation have θ·θ̇ = 0. Then Ω̇ = Ḡ θ̈, and hence
///   M = diag(m 1, Ḡᵀ J Ḡ),   f_θ = −Ḡᵀ (Ω × J Ω).
/// M is singular along θ, and the constraint equation removes this singularity. Due to the division by |θ|², A is a
/// rotation matrix and Ḡ θ̇ its angular velocity even if the constraint equation is not exactly satisfied.
template <>
class Rigid<EulerParameters> : public RigidShape, public AddingCoordinates {
 public:
  static constexpr bool constant_mass = false;
  static constexpr int element_columns = 7;
  static constexpr int point_columns = 7;
  static constexpr int own_equations = 1;  ///< number of constraint equations of the body: |θ| = 1

  using RigidShape::inertia, RigidShape::mass, RigidShape::RigidShape;

  /// Rigid body made from `bar`. The axes of the body are those of the bar, and its origin is the middle of the bar.
  /// The mesh has no effect.
  /// \throws InvalidInput for a mesh of less than one element.
  template <class = void>  // compiled only if used
  static Rigid from(Bar const& bar, BarMesh const& mesh = {}) {
    require_elements(mesh.elements.value_or(1), "Rigid");
    return Rigid(bar);
  }

  Point const& local(Point const& p) const { return p; }  ///< returns p; every point depends on all columns
  Index coordinates() const { return 7; }
  Index velocities() const { return 7; }
  char const* coordinate_unit(Index i) const { return i < 3 ? "m" : "1"; }

  template <class = void>  // compiled only if used
  void reference(std::span<double> q) const {
    part<3>(q, 0) = placement_.origin;
    part<4>(q, 3) = quaternion_of(placement_.axes);
  }
  /// Generalised velocities of a rigid motion with ω = `omega` in world axes: ṙ = v0 + ω × r, θ̇ = ¼ |θ|² Ḡᵀ Aᵀ ω.
  template <class T = double>  // compiled only if used
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    Vec<T, 3> const r = part<3>(q, 0);
    Vec<T, 4> const theta = part<4>(q, 3);
    part<3>(v, 0) = v0 + omega.cross(r);
    part<4>(v, 3) = (0.25 * theta.squaredNorm()) * map<T>(q).transpose() * (axes<T>(q).transpose() * omega);
  }

  /// Matrix Ḡ (3×4) at q: Ω = Ḡ θ̇, and m_θ = Ḡᵀ m for a moment m in body axes.
  template <StateScalar T>
  static Mat<T, 3, 4> map(std::span<T const> q) {
    T const a = q[3], b = q[4], c = q[5], d = q[6], scale = T(2.0) / (a * a + b * b + c * c + d * d);
    Mat<T, 3, 4> g;
    g << -b, a, d, -c, -c, -d, a, b, -d, c, -b, a;
    return g * scale;
  }
  /// Rotation matrix A (3×3) at q, computed from θ/|θ|.
  template <StateScalar T>
  static Mat<T, 3, 3> axes(std::span<T const> q) {
    Mat<T, 3, 3> a;
    set_rotation<T>(part<4>(q, 3), a);
    return a / (q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6]);
  }

  template <class T>  // compiled only if used
  void mass(Index, std::span<double const> q, Mat<T, 7, 7>& m) const {
    Mat<T, 3, 4> const g = map<T>(q);
    m.setZero();
    for (int i = 0; i < 3; ++i) m(i, i) = mass_;
    m.template bottomRightCorner<4, 4>() = g.transpose() * inertia_ * g;
  }
  template <StateScalar T>
  void inertia(Index, std::span<T const> q, std::span<T const> a, Vec<T, 7>& out) const {
    Mat<T, 3, 4> const g = map<T>(q);
    out.template head<3>() = part<3>(a, 0) * T(mass_);
    out.template tail<4>() = g.transpose() * inertia_times<T>(g * part<4>(a, 3));
  }
  /// Gyroscopic force −Ḡᵀ(Ω × J Ω).
  template <StateScalar T>
  void force(Index, std::span<T const> q, std::span<T const> v, Vec<T, 7>& out) const {
    Mat<T, 3, 4> const g = map<T>(q);
    Vec<T, 3> const omega = g * part<4>(v, 3), spin = inertia_times<T>(omega);
    Vec<T, 3> moment;
    set_cross(spin, omega, moment, 0);
    out.template head<3>().setZero();
    out.template tail<4>() = g.transpose() * moment;
  }
  /// Tangent ck (−∂f/∂θ) + cd (−∂f/∂θ̇) by dual numbers.
  template <class T, StateScalar D = Dual<4>>  // compiled only if used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 7, 7>& k) const {
    std::array<D, 7> moved, moving;
    Vec<D, 7> f;
    auto const pass = [&](bool by_position, double scale) {
      for (int i = 0; i < 7; ++i) {
        moved[std::size_t(i)] = D(q[std::size_t(i)]);
        moving[std::size_t(i)] = D(v[std::size_t(i)]);
        if (i >= 3) (by_position ? moved : moving)[std::size_t(i)].d[i - 3] = scale;
      }
      force<D>(e, std::span<D const>(moved), std::span<D const>(moving), f);
      for (int i = 3; i < 7; ++i)
        for (int j = 0; j < 4; ++j) k(i, 3 + j) -= f[i].d[j];
    };
    k.setZero();
    if (ck != 0.0) pass(true, ck);
    if (cd != 0.0) pass(false, cd);
  }

  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Vec<T, 7>& out) const {
    for (int i = 0; i < 7; ++i) out[i] = T(i < 3 ? g[i] * mass_ : 0.0);
  }
  template <class T = double>  // compiled only if used
  double kinetic_energy(Index, std::span<double const> q, std::span<double const> v) const {
    Vec<T, 3> const speed = part<3>(v, 0), omega = map<T>(q) * part<4>(v, 3);
    return 0.5 * mass_ * speed.squaredNorm() + 0.5 * omega.dot(inertia_ * omega);
  }
  double strain_energy(Index, std::span<double const>) const { return 0.0; }
  template <class T = double>  // compiled only if used
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    Vec<T, 3> const r = part<3>(q, 0);
    return -mass_ * g.dot(r);
  }

  /// Constraint function Φ = ½ (θᵀθ − 1), with G = [0, θᵀ] and γ = θ̇ᵀθ̇. The block of θ in ∂(Gᵀλ)/∂q is λ 1.
  template <StateScalar T>
  void own_constraint(std::span<T const> q, Vec<T, 1>& phi) const {
    phi[0] = (q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6]) * 0.5 - 0.5;
  }
  /// Constraint Jacobian G (1×7), written to g.
  template <StateScalar T>
  void own_jacobian(std::span<T const> q, Mat<T, 1, 7>& g) const {
    for (int i = 0; i < 7; ++i) g(0, i) = i < 3 ? T(0.0) : q[i];
  }
  /// Acceleration bias γ of Φ̈ = G v̇ + γ.
  template <StateScalar T>
  void own_gamma(std::span<T const>, std::span<T const> v, Vec<T, 1>& gamma) const {
    gamma[0] = v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6];
  }
  /// Stiffness ∂(Gᵀλ)/∂q (7×7) of the constraint equation.
  template <class T>  // compiled only if used
  void own_stiffness(std::span<double const>, Vec<T, 1> const& lambda, Mat<T, 7, 7>& k) const {
    k.setZero();
    for (int i = 3; i < 7; ++i) k(i, i) = lambda[0];
  }

  /// Marker kinematics as in `Rigid<>`. `marker` are the axes of the marker in body axes. Since Ω = Ḡ θ̇,
  ///   Ω̇ = Ḡ θ̈ + Ḡ˙ θ̇,  Ḡ˙ θ̇ = −2 (θ·θ̇)/|θ|² Ω.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& marker, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    Mat<T, 3, 3> const a = axes<T>(q);
    Mat<T, 3, 4> const g = a * map<T>(q);
    Vec<T, 3> const arm = a * p.u.template cast<T>(), w = g * part<4>(v, 3);
    T const norm2 = q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6];
    Vec<T, 3> const fade = w * ((q[3] * v[3] + q[4] * v[4] + q[5] * v[5] + q[6] * v[6]) * (-2.0) / norm2);
    out.frame.r = part<3>(q, 0) + arm;
    out.frame.A = a * marker.template cast<T>();
    out.frame.v = part<3>(v, 0) + w.cross(arm);
    out.frame.w = w;
    out.bias << w.cross(w.cross(arm)) + fade.cross(arm), fade;
    Eigen::Map<Mat<T, 6, 7>> j(out.jacobian);
    j.setZero();
    j.template topLeftCorner<3, 3>().setIdentity();
    j.template topRightCorner<3, 4>() = -skew<T>(arm) * g;
    j.template bottomRightCorner<3, 4>() = g;
    out.shape = JacobianShape::dense;
    out.columns = 7;
  }
  template <class T>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, Mat<T, 7, 7>& k) const {
    load_stiffness_by_dual_numbers(*this, p, q, w, k);
  }

 private:
  template <class = void>  // compiled only if used
  explicit Rigid(Bar const& bar) : RigidShape(bar) {}
};

}  // namespace polybody
