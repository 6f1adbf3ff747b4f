#pragma once
/// \file
/// Contact friction with a bristle at each contact point, which sticks without creep.
/// Theory: Eq. 9.47.

#include <polybody/forces/bristle.hpp>
#include <polybody/forces/contact.hpp>

namespace polybody {

/// Friction of a contact with an elastic bristle at each contact point. The tangential displacement is the sum of the
/// deflection z of the bristle and of a slip, as in elasto-plastic friction [Dupont, Hayward, Armstrong & Altpeter
/// 2002]. The friction force on body a is −R with
///   R = σ₀ z + σ₁ v if |σ₀ z + σ₁ v| ≤ μ N, otherwise the vector of this direction with the length μ N;
///   ż = (R − σ₀ z)/σ₁.
/// The tangential velocity is v, and the normal force is N. In sticking, ż = v: no slip occurs below the limit, also
/// under an oscillating load. In sliding, R is Coulomb's friction. A bristle without contact relaxes with the time
/// constant σ₁/σ₀. Steps of an explicit integrator must be shorter than about 2 σ₁/σ₀.
struct BristleFriction {
  Required<double> coefficient;  ///< coefficient of friction μ [1]
  Required<double> stiffness;    ///< σ₀ [N/m], stiffness of the bristle of one contact point
  Required<double> damping;      ///< σ₁ [N s/m], damping of the bristle

  void check(std::string const& name) const {
    require_not_negative(coefficient, name, ": the coefficient of friction");
    require_positive(stiffness, name, ": the bristle stiffness of the friction", "N/m");
    require_positive(damping, name, ": the bristle damping of the friction", "N s/m");
  }
};

/// Contact force between two markers with a bristle at each contact point: N n − R on a, and the opposite force on b.
/// The states are the deflections z of the bristles in the axes of marker b [m], three for each slot of the geometry.
template <ContactGeometry G, NormalForce N>
struct Contact<G, N, BristleFriction> {
  using Geometry = G;                                               ///< type of the geometry
  static constexpr int markers = 2, states = 3 * most_points<G>();  ///< two markers; three states a slot
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = G::needs;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  using Deflections = std::array<double, std::size_t(states)>;  ///< states z of all slots [m]

  G geometry;                ///< contact geometry
  N normal;                  ///< normal force law
  BristleFriction friction;  ///< friction law

  void check(std::string const& name) const {
    geometry.check(name);
    normal.check(name);
    friction.check(name);
  }
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const { return geometry.may_touch(a, b); }
  /// True if the shapes do not overlap at the frames `from` and `to` of a and b, but pass through each other on the
  /// straight path between these frames.
  bool passes(Frame<double> const (&from)[2], Frame<double> const (&to)[2]) const
    requires requires(G const& shape) { shape.passes(from, to); }
  {
    return geometry.passes(from, to);
  }

  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, std::array<T, states> const& z, double) const {
    std::array<Wrench<T>, 2> w;
    for_each_touching<T>(f, z, [&](ContactPoint<T> const& p, Vec<T, 3> const& force, T const& n) {
      if (value_of(n) > 0.0) detail::act<T>(force, p.place, f, w);
      detail::act_at_handover<T>(normal, p, f, w);
    });
    return w;
  }
  /// Calls visit(point, F, N) for every contact point, with the force F (3) on a and the normal force N [N] at the
  /// deflections z.
  template <StateScalar T, class Visit>
  void for_each_touching(std::array<Frame<T>, 2> const& f, std::array<T, states> const& z, Visit&& visit) const {
    for_each_bristle<T>(f, z, [&](ContactPoint<T> const& p, Bristle<T> const& bristle, T const& n) {
      visit(p, detail::shifted<T>(-bristle.resistance(friction), p.normal, n), n);
    });
  }
  template <StateScalar T>
  std::array<T, states> rates(std::array<Frame<T>, 2> const& f, std::array<T, states> const& z, double) const {
    std::array<T, states> rates;
    double const relaxation = friction.stiffness / friction.damping;
    for (std::size_t i = 0; i < z.size(); ++i) rates[i] = -z[i] * relaxation;
    for_each_bristle<T>(f, z, [&](ContactPoint<T> const& p, Bristle<T> const& bristle, T const& n) {
      if (!(value_of(n) > 0.0)) return;
      Vec<T, 3> rate;  // s v + (s z_t − z) σ₀/σ₁
      for (int i = 0; i < 3; ++i)
        rate[i] = bristle.slip[i] * bristle.share + (bristle.along[i] * bristle.share - bristle.whole[i]) * relaxation;
      for (int i = 0; i < 3; ++i)
        rates[std::size_t(3 * p.slot + i)] = f[1].A(0, i) * rate[0] + f[1].A(1, i) * rate[1] + f[1].A(2, i) * rate[2];
    });
    return rates;
  }

  /// Energy of the normal forces and of the bristles, ½ σ₀ z² [J].
  double potential(std::array<Frame<double>, 2> const& f, Deflections const& z, double) const {
    double sum = 0.0;
    for (double const x : z) sum += x * x;
    return detail::potential_of_points(geometry, normal, f) + 0.5 * friction.stiffness * sum;
  }
  /// Power R₀·v − σ₀ z·ż that slip dissipates, with R₀ = R at the velocity zero [W].
  double dissipation(std::array<Frame<double>, 2> const& f, Deflections const& z, double t) const {
    Deflections const rate = rates<double>(f, z, t);
    double sum = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) sum -= friction.stiffness * z[i] * rate[i];
    auto at_rest = f;
    for (Frame<double>& x : at_rest) x.v = x.w = Vec3::Zero();
    auto const velocity = [&](Vec3 const& place) -> Vec3 {
      return f[0].v + f[0].w.cross(place - f[0].r) - f[1].v - f[1].w.cross(place - f[1].r);
    };
    for_each_bristle<double>(at_rest, z, [&](ContactPoint<double> const& p, Bristle<double> const& held, double n) {
      if (n > 0.0) sum += held.resistance(friction).dot(velocity(p.place));
    });
    return sum;
  }

 private:
  /// Bristle of a contact point, in world axes.
  template <StateScalar T>
  struct Bristle {
    Vec<T, 3> whole, along, slip;  ///< z, its tangential part z_t [m], and the tangential velocity v [m/s]
    T share;                       ///< s with R = s (σ₀ z_t + σ₁ v)
    /// Vector R (3) [N].
    Vec<T, 3> resistance(BristleFriction const& law) const {
      Vec<T, 3> r;
      for (int i = 0; i < 3; ++i) r[i] = (along[i] * law.stiffness.value + slip[i] * law.damping.value) * share;
      return r;
    }
  };
  /// Calls visit(point, bristle, N) for every contact point.
  template <StateScalar T, class Visit>
  void for_each_bristle(std::array<Frame<T>, 2> const& f, std::array<T, states> const& z, Visit&& visit) const {
    detail::for_each_pressed_point<T>(
        geometry, normal, f, [&](ContactPoint<T> const& p, Vec<T, 3> const& v, T const& n) {
          Bristle<T> bristle;
          for (int i = 0; i < 3; ++i) {
            bristle.whole[i] = T(0.0);
            for (int k = 0; k < 3; ++k) bristle.whole[i] += f[1].A(i, k) * z[std::size_t(3 * p.slot + k)];
          }
          bristle.along = detail::shifted<T>(bristle.whole, p.normal, -bristle.whole.dot(p.normal));
          bristle.slip = detail::shifted<T>(v, p.normal, -v.dot(p.normal));
          bristle.share = T(1.0);
          Vec<T, 3> const trial = bristle.resistance(friction);
          bristle.share = detail::held_share<T>(trial.dot(trial), T(n * friction.coefficient.value));
          visit(p, bristle, n);
        });
  }
};

}  // namespace polybody
