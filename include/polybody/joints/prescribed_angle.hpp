#pragma once
/// \file
/// A relative angle prescribed as a function of time, in the plane and in space.

#include <polybody/joints/rows.hpp>
#include <polybody/math/time_laws.hpp>

namespace polybody {

/// One row: b has turned against a by ψ(t) about the common third axis. Use it beside a Revolute.
///   g = atan2(b₁·n, b₁·t),  t = a₁ cos ψ + a₂ sin ψ,  n = a₂ cos ψ − a₁ sin ψ,
/// so g = θ − ψ wrapped to (−π, π]; angles beyond a full turn need no counting. With b₁ in the plane of
/// a₁, a₂ (as the Revolute keeps it) ġ = a₃·(ω_b − ω_a) − ψ̇ exactly.
template <TimeLaw Law>
struct PrescribedAngle {
  static constexpr char const* name = "PrescribedAngle";
  static constexpr int rows = 1;
  static constexpr Observes needs = Observes::frame;
  static constexpr World world = World::both;

  Law law;                    ///< angle [rad], rate and acceleration as functions of time [s]
  Vec3 axis = Vec3::UnitZ();  ///< (3) unit vector, world axes at the reference configuration

  Mat3 triad() const { return polybody::rows::triad_about(axis, "PrescribedAngle: the axis"); }
  void check(std::string const& what) const { check_law(law, what + ": the law of time"); }
  std::vector<double> corners() const {
    if constexpr (HasCorners<Law>)
      return law.corners();
    else
      return {};
  }

  template <StateScalar T>
  Gap<1, T> gap(Frame<T> const& a, Frame<T> const& b, double t) const {
    using std::atan2;
    Motion const psi = law(t);
    Part<T> const p(a, b, psi.value);
    Gap<1, T> gap;
    gap.g[0] = atan2(p.y, p.x);
    gap.Ga.template tail<3>() = p.ga.transpose() / p.n2;
    gap.Gb.template tail<3>() = p.gb.transpose() / p.n2;
    gap.rate[0] = T(-psi.rate);
    return gap;
  }

  /// d/dt of ga·ω_a/n² + gb·ω_b/n² − ψ̇ at constant ω.
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double t) const {
    Motion const psi = law(t);
    Part<T> const p(a, b, psi.value);
    Vec<T, 3> const t_rate = a.w.cross(p.t) + p.n * T(psi.rate), e_rate = b.w.cross(p.e);
    Vec<T, 3> const n_rate = a.w.cross(p.n) - p.t * T(psi.rate);
    T const x_rate = t_rate.dot(p.e) + p.t.dot(e_rate), y_rate = n_rate.dot(p.e) + p.n.dot(e_rate);
    Vec<T, 3> const ga_rate = p.n.cross(p.e) * x_rate + (n_rate.cross(p.e) + p.n.cross(e_rate)) * p.x -
                              p.t.cross(p.e) * y_rate - (t_rate.cross(p.e) + p.t.cross(e_rate)) * p.y;
    T const n2_rate = 2.0 * (p.x * x_rate + p.y * y_rate);
    T const w = p.ga.dot(a.w) + p.gb.dot(b.w);
    // gb = −ga, so both halves share one derivative
    return Vec<T, 1>((ga_rate.dot(a.w - b.w)) / p.n2 - w * n2_rate / (p.n2 * p.n2) -
                     T(psi.acceleration));
  }

 private:
  /// x = b₁·t, y = b₁·n; ẋ, ẏ by ω: (u × e)·(ω_a − ω_b) for u = t, n; ġ = (x ẏ − y ẋ)/n².
  template <StateScalar T>
  struct Part {
    Vec<T, 3> t, n, e, ga, gb;
    T x, y, n2;
    Part(Frame<T> const& a, Frame<T> const& b, double psi) {
      double const c = std::cos(psi), s = std::sin(psi);
      t = a.A.col(0) * c + a.A.col(1) * s;
      n = a.A.col(1) * c - a.A.col(0) * s;
      e = b.A.col(0);
      x = t.dot(e);
      y = n.dot(e);
      n2 = x * x + y * y;
      ga = n.cross(e) * x - t.cross(e) * y;
      gb = -ga;
    }
  };
};

static_assert(JointGeometry<PrescribedAngle<Ramp>>);

}  // namespace polybody
