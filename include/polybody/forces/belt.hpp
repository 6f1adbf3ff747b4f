#pragma once
/// \file
/// Elastic belt over two or more pulleys, with creep.
/// Theory: Eqs. 3.16 to 3.21.

#include <algorithm>
#include <array>
#include <cmath>

#include <polybody/forces/force_element.hpp>

namespace polybody {

/// Span of a belt in one state.
struct BeltSpan {
  double length = 0.0;   ///< distance of its tangent points l [m]
  double strain = 0.0;   ///< relative elongation ε = l/L − 1 with the unstretched length L; negative if slack
  double tension = 0.0;  ///< N ≥ 0 [N]
};

/// Elastic belt over N pulleys on parallel axes. Marker k is the centre of pulley k; the third axis n of marker 0 is
/// the direction of all axes. Span k runs from pulley k to pulley k + 1, the last one from pulley N − 1 to pulley 0.
/// The centres may move.
///
/// Tangent points: with the senses s = ±1 and d = r_{k+1} − r_k, D = s_{k+1} R_{k+1} − s_k R_k, span k has the length
/// l = √(d² − D²) and the direction t of d = l t + D n×t. Its end on pulley j is r_j − s_j R_j n×t. The tension acts on
/// both ends.
///
/// Creep: the belt adheres to a pulley where it arrives, with the strain of the incoming span; it slips on the last
/// part of the arc [Firbank 1970]. Pulley j, which rotates at ω_j, passes the unstretched length s_j R_j ω_j/(1 + ε)
/// per second from one span to the next, with the strain ε of the span that arrives [Bechtel et al. 2000]. State k is
/// the change z_k of the unstretched length of span k. In the steady state of a driver 1 and a driven pulley 2,
///   R₁ω₁/(R₂ω₂) = (1 + ε_tight)/(1 + ε_slack).
/// Changes of the unstretched length on the arcs by their strain are neglected. Friction is assumed
/// sufficient for all loads, so that the belt never slips on the whole arc.
template <int N>
struct BeltAndPulley {
  static_assert(N >= 2, "A belt needs at least two pulleys.");
  static constexpr int markers = N, states = N;  ///< one marker for each pulley, one state for each span
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;
  /// One number for each pulley.
  using Numbers = std::array<double, N>;

  Numbers radii = {};  ///< (N) radii R of the pulleys [m]; each must be given
  std::array<Vec3, N> centres =
      origins();                     ///< (N) centres, the markers, in the reference configuration, world axes [m]
  Required<double> axial_stiffness;  ///< EA [N]: tension per strain
  double damping = 0.0;              ///< c [N s]: tension per strain rate; fades out below the pretension
  Required<double> pretension;       ///< tension of all spans in the reference configuration [N]
  std::array<int, N> senses = all_senses(1);  ///< (N) s: +1 for a pulley that turns about +n while the belt runs from
                                              ///< pulley 0 to pulley 1, otherwise −1; a crossed belt has +1 and −1

  void check(std::string const& name) const {
    require_positive(axial_stiffness, name, ": the axial stiffness EA", "N");
    require_not_negative(damping, name, ": the damping", "N s");
    require_not_negative(pretension, name, ": the pretension", "N");
    for (std::size_t k = 0; k < N; ++k) {
      std::string const pulley = " of pulley " + std::to_string(k);
      require_positive(radii[k], name, ": the radius" + pulley, "m");
      require_finite(centres[k], name, ": the centre" + pulley, "m");
      if (senses[k] != 1 && senses[k] != -1)
        throw InvalidInput("belt.sense", {ErrorObject{name}, ": the sense" + pulley, " must be 1 or -1, but is ",
                                          ErrorValue{senses[k]}, "."});
    }
    for (std::size_t k = 0; k < N; ++k)
      if (!(reference_length(k) > 0.0))
        throw InvalidInput("belt.span", {ErrorObject{name}, ": the centres of pulleys ", k, " and ", next(k), " are ",
                                         ErrorValue{(centres[next(k)] - centres[k]).norm()},
                                         " m apart, but their distance must exceed ", std::abs(step(k)),
                                         " m, the difference of the radii (their sum for opposite senses)."});
  }

  template <StateScalar T>
  std::array<Wrench<T>, N> wrenches(std::array<Frame<T>, N> const& f, std::array<T, N> const& z, double) const {
    std::array<Wrench<T>, N> w;
    std::array<Span<T>, N> const all = spans_at(f, z);
    for (std::size_t k = 0; k < N; ++k) {
      Vec<T, 3> const pull = scaled(all[k].along, all[k].tension);
      pull_at<T>(arm(all[k], k), pull, w[k]);
      pull_at<T>(arm(all[k], next(k)), -pull, w[next(k)]);
    }
    return w;
  }
  /// Rates ż of the unstretched lengths [m/s]: inflow from pulley k less outflow to pulley k + 1. `f` are the frames of
  /// the pulleys, z the states.
  template <StateScalar T>
  std::array<T, N> rates(std::array<Frame<T>, N> const& f, std::array<T, N> const& z, double) const {
    return inflow(f, geometry_at(f, z));
  }
  /// Spans in a state: `f` are the frames of the pulleys, `z` the states.
  std::array<BeltSpan, N> spans(std::array<Frame<double>, N> const& f, std::array<double, N> const& z) const {
    std::array<BeltSpan, N> out;
    std::array<Span<double>, N> const all = spans_at(f, z);
    for (std::size_t k = 0; k < N; ++k) out[k] = {all[k].length, all[k].strain, all[k].tension};
    return out;
  }

 private:
  template <StateScalar T>
  struct Span {
    Vec<T, 3> along, side;    // unit vector from tangent point to tangent point; n×t
    T length, rate, turning;  // l [m], l˙ [m/s], angular velocity of t about n [rad/s]
    T unstretched, strain, tension;
  };

  static constexpr std::array<int, N> all_senses(int sense) {
    std::array<int, N> all{};
    for (int& s : all) s = sense;
    return all;
  }
  static std::array<Vec3, N> origins() {
    std::array<Vec3, N> all;
    for (Vec3& r : all) r = Vec3::Zero();
    return all;
  }
  static constexpr std::size_t next(std::size_t k) { return (k + 1) % N; }
  static constexpr std::size_t before(std::size_t k) { return (k + N - 1) % N; }
  double signed_radius(std::size_t k) const { return senses[k] * radii[k]; }
  double step(std::size_t k) const { return signed_radius(next(k)) - signed_radius(k); }
  double reference_length(std::size_t k) const {
    Vec3 const d = centres[next(k)] - centres[k];
    return std::sqrt(d.squaredNorm() - step(k) * step(k));
  }

  template <StateScalar T>
  static Vec<T, 3> scaled(Vec<T, 3> const& v, T const& x) {
    return {v[0] * x, v[1] * x, v[2] * x};
  }
  /// Vector from the centre of pulley j to the end of the span on it.
  template <StateScalar T>
  Vec<T, 3> arm(Span<T> const& span, std::size_t j) const {
    return scaled(span.side, T(-signed_radius(j)));
  }
  template <StateScalar T>
  static void pull_at(Vec<T, 3> const& arm, Vec<T, 3> const& pull, Wrench<T>& w) {
    Vec<T, 3> const moment = arm.cross(pull);
    for (int i = 0; i < 3; ++i) {
      w.f[i] += pull[i];
      w.m[i] += moment[i];
    }
  }

  /// Geometry and strain of all spans. A span may also have a component e along n: its direction is then that of
  /// l t + e n, so that both forces act along the line through the tangent points.
  template <StateScalar T>
  std::array<Span<T>, N> geometry_at(std::array<Frame<T>, N> const& f, std::array<T, N> const& z) const {
    using std::sqrt;
    std::array<Span<T>, N> all;
    Vec<T, 3> const n(f[0].A(0, 2), f[0].A(1, 2), f[0].A(2, 2));
    for (std::size_t k = 0; k < N; ++k) {
      Span<T>& s = all[k];
      double const D = step(k);
      Vec<T, 3> const d = f[next(k)].r - f[k].r, v = f[next(k)].v - f[k].v;
      T const e = n.dot(d);
      Vec<T, 3> const flat = d - scaled(n, e), across = n.cross(flat);
      T const squared = flat.dot(flat), l = sqrt(squared - D * D);
      Vec<T, 3> t;
      for (int i = 0; i < 3; ++i) t[i] = (flat[i] * l - across[i] * D) / squared;
      s.side = n.cross(t);
      s.length = sqrt(l * l + e * e);
      for (int i = 0; i < 3; ++i) s.along[i] = (t[i] * l + n[i] * e) / s.length;
      s.turning = s.side.dot(v) / l;
      s.rate = d.dot(v) / s.length;  // l² = d² − D²
      s.unstretched = z[k] + reference_length(k) / (1.0 + pretension / axial_stiffness);
      s.strain = s.length / s.unstretched - 1.0;
    }
    return all;
  }

  /// Stretch 1 + ε of the belt that arrives on a pulley from `span`; 1 if the span is slack.
  template <StateScalar T>
  static T stretch(Span<T> const& span) {
    return value_of(span.strain) > 0.0 ? span.strain + 1.0 : T(1.0);
  }
  /// Unstretched length that pulley j passes on per second, u = s R (ω_j − ψ_j)/(1 + ε), where ψ_j is the mean angular
  /// velocity of the two spans on it. A change of the arc's angle takes belt from a span, or returns belt to it, with
  /// this span's own strain.
  template <StateScalar T>
  std::array<T, N> inflow(std::array<Frame<T>, N> const& f, std::array<Span<T>, N> const& all) const {
    Vec<T, 3> const n(f[0].A(0, 2), f[0].A(1, 2), f[0].A(2, 2));
    std::array<T, N> in;
    for (T& x : in) x = T(0.0);
    for (std::size_t j = 0; j < N; ++j) {
      Span<T> const &arriving = all[before(j)], &leaving = all[j];
      T const surface = (f[j].w.dot(n) - (arriving.turning + leaving.turning) * 0.5) * signed_radius(j);
      T const passed = surface / stretch(value_of(surface) > 0.0 ? arriving : leaving);
      T const opening = (arriving.turning - leaving.turning) * (0.5 * signed_radius(j));
      in[before(j)] += opening / stretch(arriving) - passed;
      in[j] += opening / stretch(leaving) + passed;
    }
    return in;
  }

  /// Spans with tension N = EA ε + c ε˙ for ε > 0, never negative. With the strain ε₀ of the pretension, the factor
  /// min(1, ε/ε₀) of c ε˙ keeps the tension continuous at ε = 0.
  template <StateScalar T>
  std::array<Span<T>, N> spans_at(std::array<Frame<T>, N> const& f, std::array<T, N> const& z) const {
    std::array<Span<T>, N> all = geometry_at(f, z);
    std::array<T, N> const fed = inflow(f, all);
    double const onset = pretension / axial_stiffness;
    for (std::size_t k = 0; k < N; ++k) {
      Span<T>& s = all[k];
      s.tension = T(0.0);
      if (value_of(s.strain) <= 0.0) continue;
      T const strain_rate = (s.rate - (s.strain + 1.0) * fed[k]) / s.unstretched;
      T const share = value_of(s.strain) < onset ? s.strain / onset : T(1.0);
      T const pull = s.strain * axial_stiffness.value + share * strain_rate * damping;
      if (value_of(pull) > 0.0) s.tension = pull;
    }
    return all;
  }
};

}  // namespace polybody
