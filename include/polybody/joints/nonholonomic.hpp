#pragma once
/// \file
/// Geometries with nonholonomic constraint equations: a blade, a rolling disc.
/// Theory: Eqs. 4.29 to 4.34.

#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Blade or skate on b that glides on a without motion across the blade, in the plane and in space. 1 nonholonomic
/// equation
///   ġ = b₃·u,  u = ṙ_b − ṙ_a − ω_a × d,  d = r_b − r_a      [Neimark & Fufaev 1972, ch. I].
/// u is the velocity of the point of b relative to a. The blade can reach every position and direction, so that no
/// equation between coordinates exists.
struct KnifeEdge {
  static constexpr char const* name = "KnifeEdge";
  static constexpr int rows = 1;
  static constexpr int nonholonomic_equations = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;

  JointAxis across = {};  ///< (3) unit vector across the blade, world axes at the reference configuration; moves with b

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(across, "KnifeEdge: the direction across");
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<1, T> terms;
    Vec<T, 3> const n = axis_of(b, 2), d = b.r - a.r, c = n.cross(d);
    for (int i = 0; i < 3; ++i) {
      terms.Ga(0, i) = -n[i];
      terms.Ga(0, 3 + i) = c[i];
      terms.Gb(0, i) = n[i];
    }
    return terms;
  }
  /// γ = (ω_b × b₃)·u − b₃·(ω_a × (ṙ_b − ṙ_a)).
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 3> const n = axis_of(b, 2), d = b.r - a.r, rate = b.v - a.v, wd = a.w.cross(d), u = rate - wd;
    return Vec<T, 1>(b.w.cross(n).dot(u) - n.dot(a.w.cross(rate)));
  }
};

/// Thin disc b that rolls without slip on a plane of a. 3 constraint equations; the last two constrain velocities
///   g₁ = n·d − R √(1 − (n·b₃)²),  ġ = [n, t₁, t₂]ᵀ u,  u = ṙ_b + ω_b × ρ − ṙ_a − ω_a × p  [Neimark & Fufaev 1972].
/// d = r_b − r_a; n is the plane's normal, t₁ and t₂ are two directions in the plane, all fixed in a; b₃ is the disc's
/// axis. The contact point is the point of the rim nearest to the plane. The vector from the disc's centre to the
/// contact point is ρ = −R e, e = m/|m| with m = n − (n·b₃) b₃. The vector from the point of a to the contact point is
/// p = d + ρ. u is the velocity of the disc's material point at the contact point, relative to a. The contact point
/// minimises n·ρ over the rim, so that n·u equals ġ₁. λ are the forces along n, t₁, t₂; the first is negative if the
/// plane pushes. A disc that lies flat has no contact point, and steps near this configuration fail with values that
/// are not finite. Lift-off and slip are not modelled: the joint also pulls, and transmits any tangential force.
struct RollingDisc {
  static constexpr char const* name = "RollingDisc";
  static constexpr int rows = 3;
  static constexpr int nonholonomic_equations = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::space;

  Required<double> radius;  ///< radius R [m]
  JointAxis axis = {};      ///< (3) unit vector of the disc's axis, world axes at the reference configuration
  JointAxis normal = {};    ///< (3) unit vector from the plane towards the disc; the point of a is in the plane

  /// Triad with the first axis n × axis and the third axis `axis`, so that n = a₂ |n × axis| + a₃ n·axis. \throws
  /// InvalidInput unless `axis` and `normal` are unit vectors and not parallel.
  template <class = void>  // compiled only if used
  Mat3 triad() const {
    Vec3 const &own = axis.required("RollingDisc: the axis"), &up = normal.required("RollingDisc: the normal");
    require_unit(own, "RollingDisc: the axis");
    require_unit(up, "RollingDisc: the normal");
    Vec3 const first = up.cross(own);
    if (first.norm() < 1e-6)
      throw InvalidInput("rolling_disc.flat",
                         {ErrorObject{"RollingDisc"},
                          ": the disc must not lie flat on the plane at the reference configuration, but "
                          "the sine of the angle between its axis and the normal is ",
                          ErrorValue{first.norm()}, ". It must be at least 1e-06."});
    return polybody::constraint_functions::triad_of(first.normalized(), own, "RollingDisc");
  }
  void check(std::string const& what) const { require_positive(radius, what, ": the radius"); }

  template <StateScalar T>
  ConstraintTerms<3, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    Contact<T> const c(*this, a, b);
    ConstraintTerms<3, T> terms;
    terms.g[0] = c.n.dot(c.p);
    for (int i = 0; i < 3; ++i) {
      Vec<T, 3> const direction = c.direction(i);
      Vec<T, 3> const about_a = direction.cross(c.p), about_b = c.rho.cross(direction);
      for (int j = 0; j < 3; ++j) {
        terms.Ga(i, j) = -direction[j];
        terms.Ga(i, 3 + j) = about_a[j];
        terms.Gb(i, j) = direction[j];
        terms.Gb(i, 3 + j) = about_b[j];
      }
    }
    return terms;
  }
  /// For a direction s fixed in a: γ = (ω_a × s)·u + s·(ω_b × ρ̇ − ω_a × ṗ), ρ̇ = −R (ṁ − e (e·ṁ))/|m|, ṗ = ḋ + ρ̇.
  template <StateScalar T>
  Vec<T, 3> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Contact<T> const c(*this, a, b);
    Vec<T, 3> const axis_b = axis_of(b, 2), n_rate = a.w.cross(c.n), axis_rate = b.w.cross(axis_b);
    T const tilt = c.n.dot(axis_b), tilt_rate = n_rate.dot(axis_b) + c.n.dot(axis_rate);
    Vec<T, 3> m_rate, rho_rate, p_rate, u, turning, gamma;
    for (int i = 0; i < 3; ++i) m_rate[i] = n_rate[i] - axis_b[i] * tilt_rate - axis_rate[i] * tilt;
    T const along = c.e.dot(m_rate), scale = -radius / c.steep;
    for (int i = 0; i < 3; ++i) {
      rho_rate[i] = (m_rate[i] - c.e[i] * along) * scale;
      p_rate[i] = b.v[i] - a.v[i] + rho_rate[i];
    }
    Vec<T, 3> const by_b = b.w.cross(c.rho), by_a = a.w.cross(c.p);
    Vec<T, 3> const turn_b = b.w.cross(rho_rate), turn_a = a.w.cross(p_rate);
    for (int i = 0; i < 3; ++i) {
      u[i] = b.v[i] - a.v[i] + by_b[i] - by_a[i];
      turning[i] = turn_b[i] - turn_a[i];
    }
    for (int i = 0; i < 3; ++i) gamma[i] = a.w.cross(c.direction(i)).dot(u) + c.direction(i).dot(turning);
    return gamma;
  }

 private:
  template <StateScalar T>
  struct Contact {
    Vec<T, 3> n, t1, t2;  ///< normal and two directions in the plane
    Vec<T, 3> e, rho, p;  ///< direction e; vectors to the contact point from the disc's centre and from the point of a
    T steep;              ///< |m|, the sine of the angle between the disc's axis and the normal
    Contact(RollingDisc const& disc, Frame<T> const& a, Frame<T> const& b) {
      using std::sqrt;
      Vec3 const &own = disc.axis, &up = disc.normal;
      double const along = up.dot(own), across = up.cross(own).norm();
      for (int i = 0; i < 3; ++i) n[i] = a.A(i, 1) * across + a.A(i, 2) * along;
      t1 = axis_of(a, 0);
      t2 = n.cross(t1);
      Vec<T, 3> const axis_b = axis_of(b, 2);
      T const tilt = n.dot(axis_b);
      for (int i = 0; i < 3; ++i) e[i] = n[i] - axis_b[i] * tilt;
      steep = sqrt(e.dot(e));
      for (int i = 0; i < 3; ++i) {
        e[i] = e[i] / steep;
        rho[i] = e[i] * -disc.radius;
        p[i] = b.r[i] - a.r[i] + rho[i];
      }
    }
    Vec<T, 3> const& direction(int i) const { return i == 0 ? n : i == 1 ? t1 : t2; }
  };
};

}  // namespace polybody
