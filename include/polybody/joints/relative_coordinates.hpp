#pragma once
/// \file
/// Six coordinates of one frame against another, good for any slide and turn: what a bushing measures.

#include <polybody/joints/rows.hpp>

namespace polybody {

/// Place and turn of b against a in the joint's axes, which are fixed in a; 6 rows
///   x = [d; s₁; s₂; ψ],  d = Aaᵀ(r_b − r_a) [m],  AaᵀAb = exp(s̃) exp(ψ ẽ₃),  s = (s₁, s₂, 0) [rad]:
/// b turns by ψ in (−π, π] about the joint's axis and then swings by |s| < π about a line across it. One turn about any
/// of the three axes is the angle itself. With w = Aaᵀ(ω_b − ω_a), n = AaᵀAb e₃ and y = (e₃ + n)/(1 + n₃),
///   w = Jl(s) ṡ + ψ̇ n,  y·n = 1,  y·Jl(s) ṡ = 0,  hence  ψ̇ = y·w,  ṡ = Jl⁻¹(w − ψ̇ n)   [Jl: math/so3.hpp].
/// As a geometry of its own it stops everything: a weld with axes. \throws InvalidInput unless the axis is a unit
/// vector.
struct RelativeCoordinates {
  static constexpr char const* name = "RelativeCoordinates";
  static constexpr int rows = 6;
  static constexpr Observes needs = Observes::frame;
  static constexpr World world = World::both;
  static constexpr Freedoms free = {};

  Vec3 axis = Vec3::UnitZ();  ///< (3) unit vector of the third axis, world axes at the reference configuration

  Mat3 triad() const { return polybody::rows::triad_about(axis, "RelativeCoordinates: the axis"); }

  template <StateScalar T>
  Gap<6, T> gap(Frame<T> const& a, Frame<T> const& b, double) const {
    Gap<6, T> gap;
    slide(a, b, gap);
    turn(a, b, gap);
    return gap;
  }

  /// Writes the first three rows.
  template <StateScalar T>
  static void slide(Frame<T> const& a, Frame<T> const& b, Gap<6, T>& gap) {
    for (int i = 0; i < 3; ++i) polybody::rows::no_slide<6, T>(a.A.col(i), a, b, gap, i);
  }
  /// Writes the last three.
  template <StateScalar T>
  static void turn(Frame<T> const& a, Frame<T> const& b, Gap<6, T>& gap) {
    Turn<T> const x(a, b);
    Mat<T, 3, 3> const map = x.map * a.A.transpose();
    gap.g.template tail<3>() << x.s[0], x.s[1], x.psi;
    gap.Ga.template bottomRightCorner<3, 3>() = -map;
    gap.Gb.template bottomRightCorner<3, 3>() = map;
  }

  /// Of the turn: ẇ = −ω_a × w while the frames keep their ω, and the rate of w = Jl ṡ + ψ̇ n leaves
  ///   [s̈; ψ̈] = B (ẇ − J̇l ṡ − ψ̇ ṅ),  ṅ = w × n.
  template <StateScalar T>
  Vec<T, 6> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Turn<T> const x(a, b);
    Vec<T, 3> const wa = a.A.transpose() * a.w, w = a.A.transpose() * b.w - wa, rate = x.map * w;
    Vec<T, 3> const swing(rate[0], rate[1], T(0.0)), minus_s = -x.s;
    Vec<T, 3> const left = right_jacobian_derivative<T>(minus_s, swing) * swing - wa.cross(w) - w.cross(x.n) * rate[2];
    Vec<T, 6> gamma;
    for (int i = 0; i < 3; ++i) gamma[i] = polybody::rows::no_slide_gamma<T>(a.A.col(i), a, b);
    gamma.template tail<3>() = x.map * left;
    return gamma;
  }

  /// The moment of the turn on b is Aa μ, μ = Bᵀλ = κ + y (λ₃ − n·κ) with Jr(s) κ = λ; for δθ of b against a in a's
  /// axes
  ///   δn = δθ × n,  δκ = −Jr⁻¹ ∂(Jr κ)/∂s δs,  δy = (δn − y δn₃)/(1 + n₃).
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b, Vec6 const& lambda) const {
    Mat<double, 12, 12> k = Mat<double, 12, 12>::Zero();
    polybody::rows::no_slide_gradient(a.A * lambda.head<3>(), a, b, 1.0, k);
    Turn<double> const x(a, b);
    Mat3 const inverse = right_jacobian_inverse<double>(x.s);
    Vec3 const l = lambda.tail<3>(), kappa = inverse * l;
    Mat3 swing = x.map, n_slope = -skew<double>(x.n);
    swing.row(2).setZero();
    Mat3 const kappa_slope = -inverse * right_jacobian_derivative<double>(x.s, kappa) * swing;
    double const along = l[2] - x.n.dot(kappa);
    Mat3 const y_slope = (n_slope - x.y * n_slope.row(2)) / (1.0 + x.n[2]);
    Mat3 const slope =
        kappa_slope + y_slope * along - x.y * (kappa.transpose() * n_slope + x.n.transpose() * kappa_slope);
    Mat3 const of_b = a.A * slope * a.A.transpose(), of_a = -of_b - skew<double>(a.A * (kappa + x.y * along));
    k.block<3, 3>(9, 9) += of_b;
    k.block<3, 3>(9, 3) += of_a;
    k.block<3, 3>(3, 9) -= of_b;
    k.block<3, 3>(3, 3) -= of_a;
    return k;
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
      Mat<T, 3, 3> const R = a.A.transpose() * b.A;
      n = R.col(2);
      T const c = 1.0 + n[2];
      y = n / c;
      y[2] = T(1.0);
      s = Vec<T, 3>(-y[1], y[0], T(0.0));
      s = s * (2.0 * ArctanSeries<T>(s.squaredNorm()).a);
      psi = atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
      map = right_jacobian_inverse<T>(s);
      Vec<T, 3> const rest = -map.col(2);
      map.transposeInPlace();  // Jl = Jrᵀ
      map += rest * y.transpose();
      map.row(2) = y.transpose();
    }
  };
};

static_assert(JointGeometry<RelativeCoordinates>);

/// These coordinates of a joint with geometry G, without those that G leaves free: their rows are zero, so no force
/// finds a way to them, however far they go.
template <JointGeometry G>
struct HeldCoordinates {
  static_assert(
      NamesFreedoms<G>,
      "A bushing stands in for a joint of bodies that says which of the six relative coordinates it leaves free "
      "(`free`). This geometry does not; use Constraint or Penalty.");
  static constexpr int rows = 6;
  static constexpr Observes needs = Observes::frame;
  static constexpr Observes needs_of_second = polybody::needs_of_second<G>();
  static constexpr bool may_turn = G::free[3] && G::free[4] && G::free[5];

  template <StateScalar T>
  Gap<6, T> gap(Frame<T> const& a, Frame<T> const& b, double) const {
    Gap<6, T> gap;
    RelativeCoordinates::slide(a, b, gap);
    if constexpr (!may_turn) RelativeCoordinates::turn(a, b, gap);
    for (int i = 0; i < 6; ++i)
      if (G::free[std::size_t(i)]) {
        gap.g[i] = T(0.0);
        gap.Ga.row(i).setZero();
        gap.Gb.row(i).setZero();
      }
    return gap;
  }
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b, Vec6 lambda) const {
    for (int i = 0; i < 6; ++i)
      if (G::free[std::size_t(i)]) lambda[i] = 0.0;
    if constexpr (!may_turn) return RelativeCoordinates{}.wrench_gradient(a, b, lambda);
    Mat<double, 12, 12> k = Mat<double, 12, 12>::Zero();
    polybody::rows::no_slide_gradient(a.A * lambda.head<3>(), a, b, 1.0, k);
    return k;
  }
};

}  // namespace polybody
