#pragma once
// User-defined body: the requirements of the concept `polybody::Body`, and nothing else.
#include <polybody/polybody.hpp>

namespace own {

using namespace polybody;

/// Two point masses at the ends of a massless elastic rod in space: a diatomic molecule, a tether.
///   q = [r₁; r₂],  M = diag(m₁, m₁, m₁, m₂, m₂, m₂),  N = k (l − l₀) + c l˙,  f₁ = N e = −f₂,  e = (r₂ − r₁)/l.
class Dumbbell : public AddingCoordinates {  // q ⊞ δ = q + δ: `plus` and `local_rate`
 public:
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::point;  ///< its markers have no axes
  static constexpr bool constant_mass = true;
  static constexpr int element_columns = 6;  ///< one element of six velocities
  static constexpr int point_columns = 3;    ///< a marker moves with three of them

  /// A marker is at one of the ends.
  struct Point {
    int end = 0;
  };
  struct Parameters {
    Required<double> mass_1, mass_2;  ///< [kg]
    Required<double> stiffness;       ///< k [N/m]
    double damping = 0.0;             ///< c [N s/m]
    Required<Vec3> r_1, r_2;          ///< (3) positions of the ends in the unstressed state, world axes [m]
  };

  explicit Dumbbell(Parameters const& p)
      : mass_{p.mass_1, p.mass_2}, stiffness_(p.stiffness), damping_(p.damping), reference_{p.r_1.value, p.r_2.value} {
    for (double const m : mass_) require_positive(m, "Dumbbell: the mass");
    require_positive(stiffness_, "Dumbbell: the stiffness");
    require_not_negative(damping_, "Dumbbell: the damping");
    length_ = (reference_[1] - reference_[0]).norm();
    require_positive(length_, "Dumbbell: the length");
  }

  /// Point at the first or the second end: handle.at(1), handle.at(2).
  Point at(int end) const {
    if (end != 1 && end != 2) throw InvalidInput("Dumbbell: an end is 1 or 2, but is " + std::to_string(end) + ".");
    return {end - 1};
  }

  Index coordinates() const { return 6; }
  Index velocities() const { return 6; }
  Index elements() const { return 1; }
  Index first_column(Index) const { return 0; }
  Index first_column(Point const& p) const { return 3 * p.end; }

  void reference(std::span<double> q) const {
    for (int end = 0; end < 2; ++end) part<3>(q, 3 * end) = reference_[end];
  }
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    for (int end = 0; end < 2; ++end) part<3>(v, 3 * end) = v0 + omega.cross(Vec3(part<3>(q, 3 * end)));
  }

  void mass(Index, std::span<double const>, Mat<double, 6, 6>& m) const {
    m.setZero();
    for (int i = 0; i < 6; ++i) m(i, i) = mass_[i / 3];
  }
  template <StateScalar T>
  void inertia(Index, std::span<T const>, std::span<T const> a, Vec<T, 6>& out) const {
    for (int i = 0; i < 6; ++i) out[i] = a[i] * mass_[i / 3];
  }
  template <StateScalar T>
  void force(Index, std::span<T const> q, std::span<T const> v, Vec<T, 6>& out) const {
    using std::sqrt;
    Vec<T, 3> const d = part<3>(q, 3) - part<3>(q, 0), rate = part<3>(v, 3) - part<3>(v, 0);
    T const l = sqrt(d.dot(d));
    T const tension = (l - length_) * stiffness_ + d.dot(rate) / l * damping_;
    for (int i = 0; i < 3; ++i) {
      out[i] = d[i] * tension / l;
      out[3 + i] = -out[i];
    }
  }
  /// K = [B, −B; −B, B], B = e (k e + c (1 − e eᵀ) ḋ/l)ᵀ + N/l (1 − e eᵀ); D has the same form with c e eᵀ.
  void tangent(Index, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<double, 6, 6>& k) const {
    Vec3 const d = part<3>(q, 3) - part<3>(q, 0), rate = part<3>(v, 3) - part<3>(v, 0);
    double const l = d.norm();
    Vec3 const e = d / l;
    Mat3 const across = Mat3::Identity() - e * e.transpose();
    double const tension = stiffness_ * (l - length_) + damping_ * e.dot(rate);
    Mat3 const b = ck * (e * (stiffness_ * e + damping_ / l * (across * rate)).transpose() + tension / l * across) +
                   cd * damping_ * e * e.transpose();
    k << b, -b, -b, b;
  }
  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Vec<T, 6>& out) const {
    for (int i = 0; i < 6; ++i) out[i] = T(mass_[i / 3] * g[i % 3]);
  }

  double kinetic_energy(Index, std::span<double const>, std::span<double const> v) const {
    return 0.5 * (mass_[0] * part<3>(v, 0).squaredNorm() + mass_[1] * part<3>(v, 3).squaredNorm());
  }
  double strain_energy(Index, std::span<double const> q) const {
    double const x = (part<3>(q, 3) - part<3>(q, 0)).norm() - length_;
    return 0.5 * stiffness_ * x * x;
  }
  double gravity_energy(Index, std::span<double const> q, Vec3 const& g) const {
    return -mass_[0] * g.dot(part<3>(q, 0)) - mass_[1] * g.dot(part<3>(q, 3));
  }

  /// Position and velocity of the end. J = [1; 0] (6×3) is written to the memory that `out` points to.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    out.frame.r = part<3>(q, 3 * p.end);
    out.frame.v = part<3>(v, 3 * p.end);
    out.frame.A = axes.template cast<T>();
    out.frame.w.setZero();
    out.bias.setZero();
    Eigen::Map<Mat<T, 6, 3>> j(out.jacobian);
    j.setZero();
    for (int i = 0; i < 3; ++i) j(i, i) = T(1.0);
    out.shape = JacobianShape::dense;
    out.columns = 3;
  }
  /// J is constant, so ∂(Jᵀw)/∂q = 0.
  void load_stiffness(Point const&, std::span<double const>, Wrench<double> const&, Mat3& k) const { k.setZero(); }

 private:
  double mass_[2];
  double stiffness_, damping_;
  Vec3 reference_[2];
  double length_ = 0.0;
};

static_assert(Body<Dumbbell>);

}  // namespace own
