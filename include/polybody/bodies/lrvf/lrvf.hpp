#pragma once
/// \file
/// Large rotation vector formulation in space, the geometrically exact beam [Reissner 1981; Simo & Vu-Quoc 1986; thesis
/// §2.3–2.5]: a chain of equal two-node elements. Positions are interpolated linearly, rotations by a policy
/// (rotation_interpolation.hpp); strains are taken in the middle of the element (one-point quadrature: no shear
/// locking):
///   Γ = R_mᵀ r′ − Γ₀,  K = axial(R_mᵀ R_m′) − K₀,  N = diag(EA, GA, GA_z) Γ,  M = diag(GJ, EI_y, EI) K,
/// in the axes of the section, x along the beam; Γ₀, K₀ are those of the reference configuration.

#include <algorithm>
#include <vector>

#include <polybody/bodies/lrvf/lrvf_section.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

/// Coordinates of a node: position r (3) in world axes and a unit quaternion (4) of the section; speeds: ṙ (3) and Ω
/// (3), the angular velocity in the section's axes. q ⊞ δ acts on each node as in `Rigid`: no angle is singular.
///
/// Mass: translation consistent with the linear shapes, Aρ l/6 [2 1; 1 2]; rotary inertia lumped at the nodes,
/// J = ½ l diag(Iρ_y + Iρ_z, Iρ_y, Iρ_z), so that M is constant. Without any rotary inertia M is singular: the
/// rotations then follow the positions without delay; implicit methods and statics take that, explicit ones do not.
///
/// A curved reference is cut into n pieces of arc length l whose nodes lie on the curve. With the chord c₀ of an
/// element in the reference, r′ = (r₂ − r₁)/c₀ and K = (R_mᵀ R_m′) over l: a uniform stretch and a uniform bend of a
/// circular arc are then measured exactly; integrals run over l.
template <RotationInterpolation Interpolation = Objective>
class Lrvf {
 public:
  static constexpr World world = World::space;
  static constexpr Observes observes = Observes::frame;
  static constexpr bool constant_mass = true;
  static constexpr bool objective = Interpolation::objective;
  static constexpr int element_columns = 12;
  static constexpr int point_columns = 12;
  static constexpr int element_stride = 6;
  static constexpr bool packs_pay = false;
  template <class T>
  using Element = Vec<T, 12>;
  using ElementMatrix = Mat<double, 12, 12>;

  /// A material point: element, place ξ ∈ [0, 1] on it, and (y, z) off the axis [m].
  struct Point {
    Index element = 0;
    double xi = 0.0;
    double y = 0.0, z = 0.0;
  };

  /// The straight bar in n equal elements. \throws InvalidInput for n < 1 or a stiffness that is missing (GA, GJ, ...).
  static Lrvf from(Bar const& bar, Index n) {
    return from(bar, n, [](double s) { return Placement{.origin = Vec3(s, 0, 0)}; });
  }
  /// The bar bent and twisted without stress to `curve`, whose parameter is its arc length. \throws InvalidInput as
  /// above, and for a curve on which nodes coincide or lie farther apart than the arc between them.
  static Lrvf from(Bar const& bar, Index n, ReferenceCurve const& curve) {
    require_elements(n, "Lrvf");
    if (!curve) throw InvalidInput("Lrvf: the reference curve is empty.");
    return Lrvf(bar, polybody::constants(bar), n, curve);
  }

  double length() const { return length_; }
  double element_length() const { return l_; }
  BarConstants const& constants() const { return constants_; }

  /// The section at arc length s of the reference, (y, z) off its axis. \throws InvalidInput outside the bar.
  Point at(double s, double y = 0.0, double z = 0.0) const {
    double const x = require_inside(s, length_, "Lrvf") / l_;
    if (!std::isfinite(y) || !std::isfinite(z)) throw InvalidInput("Lrvf: y and z of a point must be finite.");
    Index const e = std::min(Index(x + 1e-12), elements() - 1);
    double const xi = x - double(e);
    return {e, xi < 1e-12 ? 0.0 : xi > 1.0 - 1e-12 ? 1.0 : xi, y, z};  // a node is met exactly
  }

  Index coordinates() const { return Index(reference_.size()); }
  Index speeds() const { return 6 * (elements() + 1); }
  Index elements() const { return Index(free_.size()); }
  Index first_column(Index e) const { return 6 * e; }
  Index first_column(Point const& p) const { return first_column(p.element); }

  void reference(std::span<double> q) const { std::copy(reference_.begin(), reference_.end(), q.begin()); }

  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    for (Index i = 0; i <= elements(); ++i) {
      part<3>(out, 7 * i) = part<3>(q, 7 * i) + part<3>(delta, 6 * i);
      part<4>(out, 7 * i + 3) = quaternion_plus<T>(part<4>(q, 7 * i + 3), part<3>(delta, 6 * i + 3));
    }
  }
  /// δ˙ with q ⊞ δ(t) moving with v: Ω = Jr(δ) δ˙ at each node.
  template <StateScalar T>
  void local_rate(std::span<T const> delta, std::span<T const> v, std::span<T> out) const {
    for (Index i = 0; i < speeds(); i += 6) {
      part<3>(out, i) = part<3>(v, i);
      part<3>(out, i + 3) = right_jacobian_inverse<T>(part<3>(delta, i + 3)) * part<3>(v, i + 3);
    }
  }
  template <class T = double>  // compiled where it is used
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    for (Index i = 0; i <= elements(); ++i) {
      Vec<T, 3> const r = part<3>(q, 7 * i);
      part<3>(v, 6 * i) = v0 + omega.cross(r);
      part<3>(v, 6 * i + 3) = rotation_matrix<T>(part<4>(q, 7 * i + 3)).transpose() * omega;
    }
  }

  void mass(Index, std::span<double const>, ElementMatrix& m) const {
    m.setZero();
    for (int i = 0; i < 3; ++i) {
      m(i, i) = m(6 + i, 6 + i) = 2.0 * sixth_;
      m(i, 6 + i) = m(6 + i, i) = sixth_;
      m(3 + i, 3 + i) = m(9 + i, 9 + i) = rotary_[i];
    }
  }
  template <StateScalar T>
  void inertia(Index e, std::span<T const>, std::span<T const> a, Element<T>& out) const {
    T const* const x = a.data() + 6 * e;
    for (int i = 0; i < 3; ++i) {
      out[i] = (2.0 * x[i] + x[6 + i]) * sixth_;
      out[6 + i] = (x[i] + 2.0 * x[6 + i]) * sixth_;
      out[3 + i] = x[3 + i] * rotary_[i];
      out[9 + i] = x[9 + i] * rotary_[i];
    }
  }

  /// From l (N·δΓ + M·δK), δΓ = R_mᵀ (δr₂ − δr₁)/c₀ + Γ × δθ, δθ = P δθ₁₂, δK = Q δθ₁₂/l  (Γ with Γ₀):
  /// f_r = ± l/c₀ R_m N,  f_θ = −(Pᵀ t + Qᵀ M) with t = l N × Γ; and −Ω × J Ω at the nodes.
  template <StateScalar T>
  void force(Index e, std::span<T const> q, std::span<T const> v, Element<T>& out) const {
    StrainedSection<T> s;
    strain<T>(e, q, v, s);
    Vec<T, 3> const pull = s.at.R * s.n * (l_ / s.chord), t = s.n.cross(s.gamma) * l_;
    Vec<T, 6> const torque = s.at.spin.transpose() * t + s.at.bend.transpose() * s.m;
    for (int i = 0; i < 2; ++i) {
      Vec<T, 3> const omega = part<3>(v, 6 * (e + i) + 3);
      Vec<T, 3> momentum;
      for (int k = 0; k < 3; ++k) momentum[k] = omega[k] * rotary_[k];
      if (i == 0)
        out.template segment<3>(0) = pull;
      else
        out.template segment<3>(6) = -pull;
      out.template segment<3>(6 * i + 3) = momentum.cross(omega) - torque.template segment<3>(3 * i);
    }
  }

  /// ck (−∂f/∂δ) + cd (−∂f/∂v), δ of q ⊞ δ: not symmetric in general, as δθ does not commute.
  template <class T>  // compiled where it is used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    using V3 = Vec<T, 3>;
    StrainedSection<T> s;
    strain<T>(e, q, v, s);
    MiddleGradient by;
    V3 const t = l_ * s.n.cross(s.gamma);
    interpolation_.gradient(turned<T>(q, e), turned<T>(q, e + 1), t, s.m, s.turning, by);
    section_.tangent(s, by, ck, cd, k);
    for (int i = 0; i < 2; ++i) {
      V3 const omega = part<3>(v, 6 * (e + i) + 3);
      k.template block<3, 3>(6 * i + 3, 6 * i + 3) +=
          cd * (skew<T>(omega) * rotary_.asDiagonal() - skew<T>(omega.cwiseProduct(rotary_)));
    }
  }

  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Element<T>& out) const {
    out.setZero();
    for (int i = 0; i < 3; ++i) out[i] = out[6 + i] = T(3.0 * sixth_ * g[i]);
  }

  template <class T = double>  // compiled where it is used
  double kinetic_energy(Index e, std::span<double const>, std::span<double const> v) const {
    Vec<T, 3> const v1 = part<3>(v, 6 * e), w1 = part<3>(v, 6 * e + 3), v2 = part<3>(v, 6 * e + 6),
                    w2 = part<3>(v, 6 * e + 9);
    return sixth_ * (v1.squaredNorm() + v1.dot(v2) + v2.squaredNorm()) +
           0.5 * rotary_.dot(w1.cwiseProduct(w1) + w2.cwiseProduct(w2));
  }
  double strain_energy(Index e, std::span<double const> q) const {
    return l_ * section_.energy(section_strains({e, 0.5}, q));
  }
  template <class T = double>  // compiled where it is used
  double gravity_energy(Index e, std::span<double const> q, Vec3 const& g) const {
    Vec<T, 3> const r1 = part<3>(q, 7 * e), r2 = part<3>(q, 7 * e + 7);
    return -3.0 * sixth_ * g.dot(r1 + r2);
  }

  /// (Γ, K) of the element of `p` in the axes of its section [1], [1/m]: see sections.hpp.
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    MiddleSection<double> at;
    Vec3 gamma;
    place<double>(p.element, q, at, gamma);
    Free const& free = free_[std::size_t(p.element)];
    Vec6 x;
    for (int i = 0; i < 3; ++i) x[i] = gamma[i] - free.gamma[i];
    for (int i = 0; i < 3; ++i) x[3 + i] = (at.turn[i] - free.turn[i]) / l_;
    return x;
  }
  /// (N, M) of the element of `p`, without damping [N], [N m].
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return section_.forces(section_strains(p, q));
  }
  /// The rotation field at `p`, with its curvature (reference included).
  SectionTurn rotation_field(Point const& p, std::span<double const> q) const {
    return interpolation_.turn(p.xi, l_, turned<double>(q, p.element), turned<double>(q, p.element + 1));
  }

  /// r = (1 − ξ) r₁ + ξ r₂ + ρ, ρ = R(ξ) (0, y, z);  ω = R Ω;  bias: ω˙ᵇ = R Ω˙ᵇ,  ω˙ᵇ × ρ + ω × (ω × ρ).
  template <StateScalar T>
  void publish(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v, Published<T>& out) const {
    Index const e = p.element;
    Vec<T, 6> turning;
    turning << part<3>(v, 6 * e + 3), part<3>(v, 6 * e + 9);
    SectionMotion<T> s;
    section<T>(p, turned<T>(q, e), turned<T>(q, e + 1), turning, s);
    Mat<T, 3, 6> const spin = s.R * s.spin;
    Vec<T, 3> const arm = s.R.col(1) * T(p.y) + s.R.col(2) * T(p.z), w = spin * turning, bias = s.R * s.bias;
    Vec<T, 3> const rate = w.cross(arm);
    out.frame.r = part<3>(q, 7 * e) * T(1.0 - p.xi) + part<3>(q, 7 * e + 7) * T(p.xi) + arm;
    out.frame.A = s.R * axes.template cast<T>();
    out.frame.v = part<3>(v, 6 * e) * T(1.0 - p.xi) + part<3>(v, 6 * e + 6) * T(p.xi) + rate;
    out.frame.w = w;
    out.bias.template head<3>() = bias.cross(arm) + w.cross(rate);
    out.bias.template tail<3>() = bias;
    Eigen::Map<Mat<T, 6, 12>> j(out.jacobian);
    j.setZero();
    for (int i = 0; i < 3; ++i) {
      j(i, i) = T(1.0 - p.xi);
      j(i, 6 + i) = T(p.xi);
    }
    for (int k = 0; k < 6; ++k) {
      Vec<T, 3> const column = spin.col(k);
      int const c = k < 3 ? 3 + k : 6 + k;
      j.template block<3, 1>(0, c) = column.cross(arm);
      j.template block<3, 1>(3, c) = column;
    }
    out.shape = JacobianShape::dense;
    out.columns = 12;
  }

  /// Jᵀw = [(1 − ξ) f; P₁ᵀ c; ξ f; P₂ᵀ c], c = ρ × Rᵀf + Rᵀm: by dual numbers in the nodes' rotations alone.
  template <StateScalar D = Dual<6>>  // compiled where it is used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, ElementMatrix& k) const {
    Index const e = p.element;
    SectionMotion<D> s;
    section<D>(p, detail::turning_quaternion<6>(turned<double>(q, e), 0),
               detail::turning_quaternion<6>(turned<double>(q, e + 1), 3), Vec<D, 6>::Zero(), s);
    Vec<D, 3> const f = s.R.transpose() * w.f.template cast<D>(), m = s.R.transpose() * w.m.template cast<D>();
    Vec<D, 3> const off(0.0, p.y, p.z), c = off.cross(f) + m;
    Vec<D, 6> const torque = s.spin.transpose() * c;
    k.setZero();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) k(i < 3 ? 3 + i : 6 + i, j < 3 ? 3 + j : 6 + j) = torque[i].d[j];
  }

 private:
  /// An element in the reference configuration.
  struct Free {
    double chord = 1.0;  ///< c₀ [m]
    Vec3 gamma, turn;    ///< Γ₀, l K₀
  };

  Lrvf(Bar const& bar, BarConstants const& c, Index n, ReferenceCurve const& curve);

  template <StateScalar T>
  static Quaternion<T> turned(std::span<T const> q, Index node) {
    return part<4>(q, 7 * node + 3);
  }
  template <StateScalar T>
  void place(Index e, std::span<T const> q, MiddleSection<T>& at, Vec<T, 3>& gamma) const {
    interpolation_.template middle<T>(turned<T>(q, e), turned<T>(q, e + 1), at);
    Vec<T, 3> const slope = (part<3>(q, 7 * e + 7) - part<3>(q, 7 * e)) * T(1.0 / free_[std::size_t(e)].chord);
    gamma = at.R.transpose() * slope;
  }
  /// Strains and section forces of an element.
  template <StateScalar T>
  void strain(Index e, std::span<T const> q, std::span<T const> v, StrainedSection<T>& s) const {
    Free const& free = free_[std::size_t(e)];
    s.chord = free.chord;
    place<T>(e, q, s.at, s.gamma);
    s.n = s.gamma - free.gamma.template cast<T>();
    s.m = s.at.turn - free.turn.template cast<T>();
    s.turning << part<3>(v, 6 * e + 3), part<3>(v, 6 * e + 9);
    if (section_.damped())
      s.rate = s.at.R.transpose() * (part<3>(v, 6 * e + 6) - part<3>(v, 6 * e)) * T(1.0 / free.chord);
    section_.stress(s);
  }
  /// At a node the node's own section, exactly; else the policy's.
  template <StateScalar T>
  void section(Point const& p, Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 6> const& w,
               SectionMotion<T>& out) const {
    if (p.xi != 0.0 && p.xi != 1.0) return interpolation_.template section<T>(p.xi, a, b, w, out);
    out.R = rotation_matrix<T>(p.xi == 0.0 ? a : b);
    out.spin.setZero();
    for (int i = 0; i < 3; ++i) out.spin(i, p.xi == 0.0 ? i : 3 + i) = T(1.0);
    out.bias.setZero();
  }

  BarConstants constants_;
  double length_, l_;
  Interpolation interpolation_;
  LrvfSection section_;
  double sixth_ = 0.0;  ///< Aρ l/6 [kg]
  Vec3 rotary_;         ///< J of a node's half element [kg m²]
  std::vector<Free> free_;
  std::vector<double> reference_;
};

template <RotationInterpolation Interpolation>
Lrvf<Interpolation>::Lrvf(Bar const& bar, BarConstants const& c, Index n, ReferenceCurve const& curve)
    : constants_(c),
      length_(bar.length),
      l_(bar.length / double(n)),
      interpolation_(bar.placement),
      section_(bar, c, l_),
      free_(std::size_t(n)),
      reference_(std::size_t(7 * (n + 1))) {
  sixth_ = c.mass_per_length * l_ / 6.0;
  Vec3 const inertias = rotary_inertias(c);
  for (int i = 0; i < 3; ++i) rotary_[i] = 0.5 * l_ * inertias[i];
  std::span<double> const q(reference_);
  Mat<double, 3, 3> const axes = bar.placement.axes;
  for (Index i = 0; i <= n; ++i) {
    Placement const section = curve(double(i) * l_);
    section.check("Lrvf: the reference curve");
    part<3>(q, 7 * i) = bar.placement.origin + axes * section.origin;
    part<4>(q, 7 * i + 3) = quaternion_of(axes * section.axes);
  }
  for (Index e = 0; e < n; ++e) {
    Free& free = free_[std::size_t(e)];
    Vec<double, 3> const from = part<3>(q, 7 * e), to = part<3>(q, 7 * e + 7);
    free.chord = (to - from).norm();
    if (!(free.chord > 1e-6 * l_ && free.chord < (1.0 + 1e-6) * l_))
      throw InvalidInput{"Lrvf: element ",
                         double(e),
                         " of arc length ",
                         l_,
                         " has a chord of ",
                         free.chord,
                         ". The reference curve's parameter must be its arc length; use more elements "
                         "on a closed curve."};
    MiddleSection<double> at;
    place<double>(e, std::span<double const>(q), at, free.gamma);
    free.turn = at.turn;
  }
}

}  // namespace polybody
