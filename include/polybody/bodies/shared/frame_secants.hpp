#pragma once
/// \file
/// Energy-conserving steps of bodies whose coordinates are frames, each with a position and a unit quaternion.
/// Theory: Eqs. 6.39 to 6.44.
///
/// The step of a frame from (r₀, R₀) to (r₁, R₁) has the increments Δr = h u_r in world axes, and c = h u in the axes
/// of the frame. c is a Cayley (Rodrigues) vector [Simo & Wong 1991; Romero & Armero 2002]:
///   R₁ = R₀ cay(c),  cay(c) = (1 − ½ c̃)⁻¹ (1 + ½ c̃),  |c| = 2 tan ½θ.
/// With the mean axes R̄ = ½ (R₀ + R₁), the change of every axis is exact: ΔR = (P c)~ R̄, P = R̄⁻ᵀ = R₀ (1 + ½ c̃).
/// Functions of R are computed with secants (math/secant.hpp), whose slopes with respect to c follow from this formula.
/// The equation of motion of a frame is
///   J ΔΩ + h u × J Ω̄ = h f̄_c,  u = Ω̄ + χ ΔΩ,
/// so that c·f̄_c/h = (ΔT + χ ΔΩ·J ΔΩ)/h. In world axes, it is R₁ J Ω₁ − R₀ J Ω₀ = h R̄ f̄_c. Slopes of functions of
/// scalar products of axes and positions exert no net moment P⁻ᵀ f̄_c, and the angular momentum is conserved.

#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/math/quaternion.hpp>
#include <polybody/math/secant.hpp>

namespace polybody {

/// Step of a body whose coordinates are frames (r, unit quaternion), with the generalised velocities (ṙ, Ω).
struct FrameStep {
  std::span<double const> q0, q1;  ///< coordinates of the body at both ends of the step
  std::span<double const> v0, a;   ///< velocities at the start, and mean accelerations
  double h = 0.0;                  ///< length of the step [s]
  double decay = 0.0;              ///< χ [1]

  /// Coefficients of the stress over the step.
  DiscreteDerivative means() const { return {1.0 / h, decay}; }
  /// Angular velocity v₀ + share h a of frame i in its axes [rad/s].
  template <class T = double>  // compiled only if used
  Vec<T, 3> spin(Index i, double share) const {
    Vec<T, 3> w = entries<3>(v0, 6 * i + 3);
    for (int k = 0; k < 3; ++k) w[k] += share * h * a[std::size_t(6 * i + 3 + k)];
    return w;
  }
};

/// Frame at both ends of a step, with slopes.
template <class S>
struct FrameSecant {
  Vec<S, 3> r;     ///< position [m]
  Mat<S, 3, 3> R;  ///< axes
};

/// Rotation of a frame over a step.
struct CayleyTurn {
  Mat3 from, to;  ///< axes R₀ and R₁
  Mat3 map;       ///< P: the vector c in world axes is P c
  Vec3 spatial;   ///< P c [1]
};
/// Rotation of frame i of `step`.
template <class T = double>  // compiled only if used
CayleyTurn cayley_turn(FrameStep const& step, Index i) {
  Quaternion<T> const p = entries<4>(step.q0, 7 * i + 3), q = entries<4>(step.q1, 7 * i + 3);
  Quaternion<T> const turn = quaternion_product<T>(conjugate<T>(p), q);
  Vec<T, 3> const half(turn[1] / turn[0], turn[2] / turn[0], turn[3] / turn[0]);  // ½ c
  CayleyTurn out{rotation_matrix<T>(p), rotation_matrix<T>(q), {}, {}};
  out.map = product<T>(out.from, one_and_skew<T>(half, 1.0, 0.0));
  out.spatial = scaled<T>(product<T>(out.from, half), 2.0);
  return out;
}

/// Frame i of `step`. Its increments (Δr, c) are the variables `first` … `first` + 5 of the `Secant` type S.
template <class S>
FrameSecant<S> frame_secant(FrameStep const& step, Index i, int first) {
  FrameSecant<S> out;
  CayleyTurn const turn = cayley_turn(step, i);
  for (int k = 0; k < 3; ++k) {
    out.r[k] = S::variable(step.q0[std::size_t(7 * i + k)], step.q1[std::size_t(7 * i + k)], first + k);
    Vec3 mean;
    for (int j = 0; j < 3; ++j) {
      out.R(j, k) = S(turn.from(j, k), turn.to(j, k), S::Slope::Zero());
      mean[j] = 0.5 * (turn.from(j, k) + turn.to(j, k));
    }
    for (int j = 0; j < 3; ++j) {
      Vec3 const slope = cross<double>({turn.map(0, j), turn.map(1, j), turn.map(2, j)}, mean);
      for (int row = 0; row < 3; ++row) out.R(row, k).d[first + 3 + j] = slope[row];
    }
  }
  return out;
}

/// Product R w of the axes R of frame i, with the increments 0 … 5, and of vectors w that depend on scalar products of
/// axes and positions only. Its mean over the step rotates with a common rotation of all frames:
///   Δ(R w) = (P c)~ mean(R w) + (R̄ − ¼ (P c)~ ΔR) Δw.
template <class S, int n>
Mat<S, 3, n> carried_secant(FrameStep const& step, Index i, Mat<S, 3, n> const& w) {
  CayleyTurn const turn = cayley_turn(step, i);
  Mat3 change, map;
  for (int k = 0; k < 9; ++k) change.data()[k] = turn.to.data()[k] - turn.from.data()[k];
  map = skew_product<double>(turn.spatial, change);
  for (int k = 0; k < 9; ++k) map.data()[k] = 0.5 * (turn.from.data()[k] + turn.to.data()[k]) - 0.25 * map.data()[k];
  Mat<S, 3, n> out;
  for (int k = 0; k < n; ++k) {
    Vec3 mean;
    for (int row = 0; row < 3; ++row) {
      S& x = out(row, k);
      for (int j = 0; j < 3; ++j) {
        x.a += turn.from(row, j) * w(j, k).a;
        x.b += turn.to(row, j) * w(j, k).b;
        x.d += map(row, j) * w(j, k).d;
      }
      mean[row] = x.mean();
    }
    for (int j = 0; j < 3; ++j) {
      Vec3 const slope = cross<double>({turn.map(0, j), turn.map(1, j), turn.map(2, j)}, mean);
      for (int row = 0; row < 3; ++row) out(row, k).d[3 + j] += slope[row];
    }
  }
  return out;
}

/// Point `u` of the frame `at`, with `axes` in those of the frame.
template <class S>
FrameSecant<S> marker_of_frame(Vec3 const& u, Mat3 const& axes, FrameSecant<S> const& at) {
  FrameSecant<S> out = at;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      out.r[i] += at.R(i, k) * u[k];
      out.R(i, k) = at.R(i, 0) * axes(0, k) + at.R(i, 1) * axes(1, k) + at.R(i, 2) * axes(2, k);
    }
  return out;
}

/// Motion from frame a to frame b in the axes of a.
template <class S>
struct RelativeSecant {
  Vec<S, 3> chord;  ///< R_aᵀ (r_b − r_a) [m]
  Vec<S, 3> phi;    ///< rotation vector of R_aᵀ R_b [rad]
};

/// Motion between the frames i and i + 1 of `step`, from scalar products of their axes and positions. With the
/// Rodrigues vector g = tan(½θ) n of R_aᵀ R_b,
///   c = g/(1 + √(1 + g·g)) = tan(¼θ) n,  φ = 4 (atan|c|/|c|) c.
template <class S>
RelativeSecant<S> relative_secant(FrameStep const& step, Index i) {
  FrameSecant<S> const a = frame_secant<S>(step, i, 0), b = frame_secant<S>(step, i + 1, 6);
  Mat<S, 3, 3> const e = transposed_product<S>(a.R, b.R);
  S const scale = 1.0 + (e(0, 0) + e(1, 1) + e(2, 2));
  Vec<S, 3> const g((e(2, 1) - e(1, 2)) / scale, (e(0, 2) - e(2, 0)) / scale, (e(1, 0) - e(0, 1)) / scale);
  S const part = 1.0 / (1.0 + sqrt(1.0 + squared_norm(g)));
  Vec<S, 3> const c(g[0] * part, g[1] * part, g[2] * part);
  S const factor = 4.0 * ArctanSeries<S>(squared_norm(c)).a;
  return {transposed_product<S>(a.R, difference<S>(b.r, a.r)), {c[0] * factor, c[1] * factor, c[2] * factor}};
}

/// Writes the frames (r₀ + Δr, q₀ cay(c)) to `q1`, for the increments y = (Δr, c) of each frame.
template <class T = double>  // compiled only if used
void plus_cayley(std::span<T const> q0, std::span<T const> y, std::span<T> q1) {
  for (Index i = 0; 6 * i < Index(y.size()); ++i) {
    for (int k = 0; k < 3; ++k) q1[std::size_t(7 * i + k)] = q0[std::size_t(7 * i + k)] + y[std::size_t(6 * i + k)];
    Quaternion<T> turn(1.0, 0.5 * y[std::size_t(6 * i + 3)], 0.5 * y[std::size_t(6 * i + 4)],
                       0.5 * y[std::size_t(6 * i + 5)]);
    turn = quaternion_product<T>(entries<4>(q0, 7 * i + 3), turn);
    set_entries<4>(q1, 7 * i + 3, unit_quaternion<T>(turn));
  }
}
/// Writes the frames halfway between those of `q0` and `q1` to `middle`.
template <class T = double>  // compiled only if used
void frames_between(std::span<T const> q0, std::span<T const> q1, std::span<T> middle) {
  for (std::size_t i = 0; i < q0.size(); ++i) middle[i] = 0.5 * (q0[i] + q1[i]);
  for (Index i = 3; i < Index(q0.size()); i += 7)
    set_entries<4>(middle, i, unit_quaternion<T>(entries<4, T const>(middle, i)));
}

/// Moment −u × J Ω̄ of the inertia forces on frame i with the inertia J in its axes.
template <class T = double>  // compiled only if used
Vec<T, 3> mean_gyroscopic_moment(FrameStep const& step, Index i, Mat<T, 3, 3> const& inertia) {
  return cross<T>(product(inertia, step.spin<T>(i, 0.5)), step.spin<T>(i, 0.5 + step.decay));
}
/// Derivative ½ h ũ J − (½ + χ) h (J Ω̄)~ of u × J Ω̄ of frame i, whose `inertia` is J, with respect to the mean
/// acceleration.
template <class T = double>  // compiled only if used
Mat<T, 3, 3> mean_gyroscopic_tangent(FrameStep const& step, Index i, Mat<T, 3, 3> const& inertia) {
  Mat<T, 3, 3> k = skew_product<T>(step.spin<T>(i, 0.5 + step.decay), inertia);
  Mat<T, 3, 3> const of_momentum = skew<T>(product(inertia, step.spin<T>(i, 0.5)));
  for (int n = 0; n < 9; ++n) k.data()[n] = step.h * (0.5 * k.data()[n] - (0.5 + step.decay) * of_momentum.data()[n]);
  return k;
}

/// Body of constant mass whose coordinates are frames. It computes a discrete-gradient force f over a step with the
/// increments y of `FrameStep`: f·y is −ΔU minus the dissipated energy.
template <class B>
concept HasFrameSteps =
    B::constant_mass &&
    requires(B const b, Index e, FrameStep const& step, std::span<double const> q, typename B::Point p,
             Vec<double, B::element_columns>& f, Mat<double, B::element_columns, B::element_columns>& k) {
      b.discrete_force(e, step, f);
      b.discrete_tangent(e, step, q, q, 1.0, k);  // at the coordinates q in the middle, with zero velocities
      {
        b.template discrete_marker<Secant<B::point_columns>>(p, identity(), step)
      } -> std::same_as<FrameSecant<Secant<B::point_columns>>>;
    };

/// Writes the coordinates of `body` at the end of a step from `q0` with the increments y to `q1`.
template <class B>
void step_end(B const& body, std::span<double const> q0, std::span<double const> y, std::span<double> q1) {
  if constexpr (HasFrameSteps<B>)
    plus_cayley<double>(q0, y, q1);
  else
    body.template plus<double>(q0, y, q1);
}
/// Writes the coordinates of a body in the middle between `q0` and `q1` to `middle`.
template <class B>
void step_middle(B const&, std::span<double const> q0, std::span<double const> q1, std::span<double> middle) {
  if constexpr (HasFrameSteps<B>)
    frames_between<double>(q0, q1, middle);
  else
    for (std::size_t i = 0; i < q0.size(); ++i) middle[i] = 0.5 * (q0[i] + q1[i]);
}

}  // namespace polybody
