#pragma once
/// \file
/// Six coordinates of one frame relative to another, for any translation and rotation. A bushing acts on these
/// coordinates.
/// Theory: Eqs. 4.23 to 4.25.

#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Translation and rotation of b relative to a in the joint's axes, which are fixed in a; 6 coordinates
///   x = [d; s₁; s₂; ψ],  d = Aaᵀ(r_b − r_a) [m],  AaᵀAb = exp(s̃) exp(ψ ẽ₃),  s = (s₁, s₂, 0) [rad]:
/// b rotates by ψ in (−π, π] about the joint's axis and then swings by |s| < π about a line perpendicular to it. For a
/// rotation about one of the three axes, the coordinate is the angle itself. With w = Aaᵀ(ω_b − ω_a), n = AaᵀAb e₃ and
/// y = (e₃ + n)/(1 + n₃),
///   w = Jl(s) ṡ + ψ̇ n,  y·n = 1,  y·Jl(s) ṡ = 0,  hence  ψ̇ = y·w,  ṡ = Jl⁻¹(w − ψ̇ n)   [Jl: math/so3.hpp].
/// As a joint geometry, `RelativeCoordinates` leaves no motion free: a weld with axes. \throws InvalidInput unless the
/// axis is a unit vector.
struct RelativeCoordinates {
  static constexpr char const* name = "RelativeCoordinates";
  static constexpr int rows = 6;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::both;
  static constexpr FreeDirections free = {};

  TurnAxis axis = {};  ///< (3) unit vector of the third axis, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "RelativeCoordinates: the axis");
  }

  template <StateScalar T>
  ConstraintTerms<6, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<6, T> terms;
    slide(a, b, terms);
    turn(a, b, terms);
    return terms;
  }

  /// Writes the three translations.
  template <StateScalar T>
  static void slide(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<6, T>& terms) {
    for (int i = 0; i < 3; ++i) polybody::constraint_functions::no_slide(axis_of(a, i), a, b, terms, i);
  }
  /// Writes the three rotations.
  template <StateScalar T>
  static void turn(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<6, T>& terms) {
    Turn<T> const x(a, b);
    Mat<T, 3, 3> const map = product<T>(x.map, transposed<T>(a.A));
    terms.g[3] = x.s[0];
    terms.g[4] = x.s[1];
    terms.g[5] = x.psi;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        terms.Ga(3 + i, 3 + j) = -map(i, j);
        terms.Gb(3 + i, 3 + j) = map(i, j);
      }
  }

  /// γ of the rotations: w = Jl ṡ + ψ̇ n, and ẇ = −ω_a × w for constant ω_a and ω_b, so that
  ///   [s̈; ψ̈] = B (ẇ − J̇l ṡ − ψ̇ ṅ),  ṅ = w × n,  with B of `Turn`.
  template <StateScalar T>
  Vec<T, 6> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Turn<T> const x(a, b);
    Mat<T, 3, 3> const back = transposed<T>(a.A);
    Vec<T, 3> const wa = times<T>(back, a.w), wb = times<T>(back, b.w), w = wb - wa, rate = times<T>(x.map, w);
    Vec<T, 3> const swing(rate[0], rate[1], T(0.0)), minus_s(-x.s[0], -x.s[1], T(0.0));
    Vec<T, 3> const turning = wa.cross(w), n_rate = w.cross(x.n);
    Vec<T, 3> left = times<T>(right_jacobian_derivative<T>(minus_s, swing), swing);
    for (int i = 0; i < 3; ++i) left[i] = left[i] - turning[i] - n_rate[i] * rate[2];
    left = times<T>(x.map, left);
    Vec<T, 6> gamma;
    for (int i = 0; i < 3; ++i) {
      gamma[i] = polybody::constraint_functions::no_slide_gamma(axis_of(a, i), a, b);
      gamma[3 + i] = left[i];
    }
    return gamma;
  }

  /// The multipliers λ (3) of the rotations cause the moment Aa μ on b, μ = Bᵀλ = κ + y (λ₃ − n·κ) with Jr(s) κ = λ and
  /// B of `Turn`. For a rotation δθ of b relative to a in a's axes,
  ///   δn = δθ × n,  δκ = −Jr⁻¹ ∂(Jr κ)/∂s δs,  δy = (δn − y δn₃)/(1 + n₃).
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b, Vec6 const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::no_slide_gradient(times<double>(a.A, {lambda[0], lambda[1], lambda[2]}), a, b, 1.0,
                                                      k);
    Turn<double> const x(a, b);
    Mat3 const inverse = right_jacobian_inverse<double>(x.s), n_fall = skew<double>(x.n);  // δn = −n_fall δθ
    Vec3 const l(lambda[3], lambda[4], lambda[5]), kappa = times<double>(inverse, l);
    Mat3 swing = x.map;
    for (int j = 0; j < 3; ++j) swing(2, j) = 0.0;
    Mat3 const kappa_fall =
        product<double>(product<double>(inverse, right_jacobian_derivative<double>(x.s, kappa)), swing);
    double const along = l[2] - x.n.dot(kappa);
    Mat3 slope;
    Vec3 moment;
    for (int j = 0; j < 3; ++j) {
      double fall = 0.0;
      for (int i = 0; i < 3; ++i) fall += kappa[i] * n_fall(i, j) + x.n[i] * kappa_fall(i, j);
      for (int i = 0; i < 3; ++i) {
        double const y_fall = (n_fall(i, j) - x.y[i] * n_fall(2, j)) / (1.0 + x.n[2]);
        slope(i, j) = x.y[i] * fall - kappa_fall(i, j) - y_fall * along;
      }
      moment[j] = kappa[j] + x.y[j] * along;
    }
    Mat3 const of_b = product<double>(product<double>(a.A, slope), transposed<double>(a.A));
    Mat3 const turn = skew<double>(times<double>(a.A, moment));
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        double const of_a = of_b(i, j) + turn(i, j);
        k(9 + i, 9 + j) += of_b(i, j);
        k(9 + i, 3 + j) -= of_a;
        k(3 + i, 9 + j) -= of_b(i, j);
        k(3 + i, 3 + j) += of_a;
      }
    return k;
  }

  /// Product m x.
  template <StateScalar T>
  static Vec<T, 3> times(Mat<T, 3, 3> const& m, Vec<T, 3> const& x) {
    return {m(0, 0) * x[0] + m(0, 1) * x[1] + m(0, 2) * x[2], m(1, 0) * x[0] + m(1, 1) * x[1] + m(1, 2) * x[2],
            m(2, 0) * x[0] + m(2, 1) * x[1] + m(2, 2) * x[2]};
  }

 private:
  /// Swing and twist of R = AaᵀAb, and B with [ṡ; ψ̇] = B w:
  ///   tan(|s|/2) = |(n₁, n₂)|/(1 + n₃),  ψ = atan2(R₂₁ − R₁₂, R₁₁ + R₂₂),  B = Jl⁻¹ + (e₃ − Jl⁻¹n) yᵀ,  Jl⁻¹n =
  ///   Jr⁻¹e₃.
  template <StateScalar T>
  struct Turn {
    Vec<T, 3> s, n, y;
    T psi;
    Mat<T, 3, 3> map;
    Turn(Frame<T> const& a, Frame<T> const& b) {
      using std::atan2;
      Mat<T, 3, 3> const R = transposed_product<T>(a.A, b.A);
      n = Vec<T, 3>(R(0, 2), R(1, 2), R(2, 2));
      T const c = 1.0 + n[2];
      y = Vec<T, 3>(n[0] / c, n[1] / c, T(1.0));
      T const stretch = 2.0 * ArctanSeries<T>(T(y[0] * y[0] + y[1] * y[1])).a;
      s = Vec<T, 3>(-y[1] * stretch, y[0] * stretch, T(0.0));
      psi = atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
      Mat<T, 3, 3> const inverse = right_jacobian_inverse<T>(s);  // Jl = Jrᵀ
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 2; ++i) map(i, j) = inverse(j, i) - inverse(i, 2) * y[j];
        map(2, j) = y[j];
      }
    }
  };
};

/// Relative coordinates of a joint with geometry G. The rows of its free directions are zero, so that no force acts on
/// these directions at any displacement.
template <JointGeometry G>
struct ConstrainedCoordinates {
  static_assert(HasFreeDirections<G>,
                "Bushing does not support this geometry, because the geometry does not declare its free directions "
                "(static member `free`). Use Constraint or Penalty.");
  static constexpr int rows = 6;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = polybody::needs_of_second<G>();
  static constexpr FreeDirections free = free_directions<G>();
  /// True if G leaves all three rotations free: then no rotation is evaluated.
  static constexpr bool may_turn = free_turns(free) == 3;

  template <StateScalar T>
  ConstraintTerms<6, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<6, T> terms;
    RelativeCoordinates::slide(a, b, terms);
    if constexpr (!may_turn) RelativeCoordinates::turn(a, b, terms);
    for (int i = 0; i < 6; ++i)
      if (free[std::size_t(i)]) {
        terms.g[i] = T(0.0);
        for (int j = 0; j < 6; ++j) terms.Ga(i, j) = terms.Gb(i, j) = T(0.0);
      }
    return terms;
  }
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b, Vec6 lambda) const {
    for (int i = 0; i < 6; ++i)
      if (free[std::size_t(i)]) lambda[i] = 0.0;
    if constexpr (!may_turn) return RelativeCoordinates{}.wrench_gradient(a, b, lambda);
    auto k = detail::zeros<Mat<double, 12, 12>>();
    Vec3 const force = RelativeCoordinates::times<double>(a.A, {lambda[0], lambda[1], lambda[2]});
    polybody::constraint_functions::no_slide_gradient(force, a, b, 1.0, k);
    return k;
  }
};

}  // namespace polybody
