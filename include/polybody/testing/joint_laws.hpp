#pragma once
/// \file
/// Tests of properties that every joint geometry has: `JointLaws`.
///
/// Requires GoogleTest.

#include <functional>
#include <vector>

#include <polybody/joints/constraint_terms.hpp>
#include <polybody/testing/differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

// Joint geometry with its type erased: constraint function between two frames, and derivatives that the laws compare.

/// Pose of frame b relative to frame a that satisfies the constraint equations, and the free directions of b in this
/// pose.
struct Mate {
  Vec3 d = Vec3::Zero();      ///< (3) r_b − r_a in a's axes [m]
  Mat3 R = Mat3::Identity();  ///< (3×3) AaᵀAb, direction cosines
  MatX free_directions;       ///< (6×dof) columns [velocity; angular velocity] of b relative to a, in a's axes
};

/// Two frames with their twists.
struct FramePair {
  Frame<double> a, b;                       ///< frames of the joint's markers
  MatX free_directions = MatX::Zero(6, 0);  ///< (6×dof) free directions of b, world axes

  VecX twists() const;                           ///< (12) [ṙ; ω] of a, then of b, world axes
  FramePair moved_by(VecX const& motion) const;  ///< frames after a motion (12): [δr; φ] of a, then of b, world axes
};

/// Constraint function g of m equations, its Jacobian G = [Ga Gb] and its derivatives.
struct SeenTerms {
  VecX g, rate;  ///< (m) g and Φ_t = ∂g/∂t
  MatX G;        ///< (m×12) Jacobian G
  MatX slope;    ///< (m×12) ∂g/∂(motions), by dual numbers
  MatX G_rate;   ///< (m×12) Ġ at constant twists and constant time, by dual numbers
};

/// Joint geometry with its type erased.
struct AnyGeometry {
  /// Numbers of constraint equations: all, the leading ones in world axes, and the nonholonomic ones at the end.
  Index rows = 0, world_rows = 0, nonholonomic_equations = 0;
  bool planar = false;         ///< true if the frames stay in the plane z = 0
  bool opposite_ends = false;  ///< true if the geometry declares Gb = −Ga
  ///@{
  /// Constraint function at a time [s]. `terms_by_duals` also computes `slope` and `G_rate`.
  std::function<SeenTerms(FramePair const&, double)> constraint_function, terms_by_duals;
  ///@}
  std::function<VecX(FramePair const&, double)> gamma;                  ///< γ (m) at a time [s]
  std::function<MatX(FramePair const&, double, VecX const&)> gradient;  ///< (12×12) ∂(Gᵀλ)/∂(motions)
  std::function<Mate(Numbers&, double)> mate;                           ///< pose of b relative to a at a time [s]
};

/// Erases the type of a case's joint geometry.
template <class Case>
AnyGeometry any_geometry() {
  using G = decltype(Case::geometry());
  using D = Dual<12>;
  static constexpr int m = constraint_equations<G>();
  static auto const geometry = Case::geometry();
  auto const constraint_function = [](FramePair const& p, double t) {
    ConstraintTerms<m> const x = polybody::constraint_function<double>(geometry, p.a, p.b, t);
    SeenTerms seen{x.g, x.rate, MatX(m, 12), {}, {}};
    seen.G << x.Ga, x.Gb;
    return seen;
  };
  auto const by_duals = [constraint_function](FramePair const& p, double t) {
    SeenTerms seen = constraint_function(p, t);
    seen.slope.resize(m, 12);
    seen.G_rate.resize(m, 12);
    auto const see = [&](Frame<D> const& a, Frame<D> const& b, auto&& keep) {
      ConstraintTerms<m, D> const x = polybody::constraint_function<D>(geometry, a, b, t);
      for (Index i = 0; i < m; ++i) keep(i, x);
    };
    Vec<D, 6> of_a, of_b;
    for (int i = 0; i < 6; ++i) {
      of_a[i] = D::variable(0.0, i);
      of_b[i] = D::variable(0.0, i + 6);
    }
    see(moved<D>(p.a, of_a), moved<D>(p.b, of_b),
        [&](Index i, auto const& x) { seen.slope.row(i) = x.g[i].d.matrix().transpose(); });
    D const time = D::variable(0.0, 0);
    see(later<D>(p.a, time), later<D>(p.b, time), [&](Index i, auto const& x) {
      for (int j = 0; j < 6; ++j) {
        seen.G_rate(i, j) = x.Ga(i, j).d[0];
        seen.G_rate(i, j + 6) = x.Gb(i, j).d[0];
      }
    });
    return seen;
  };
  return {.rows = m,
          .world_rows = Case::world_rows,
          .nonholonomic_equations = nonholonomic_equations<G>(),
          .planar = Case::planar,
          .opposite_ends = has_opposite_ends<G>(),
          .constraint_function = constraint_function,
          .terms_by_duals = by_duals,
          .gamma = [](FramePair const& p, double t) { return VecX(constraint_gamma<double>(geometry, p.a, p.b, t)); },
          .gradient = [](FramePair const& p, double t,
                         VecX const& lambda) { return MatX(wrench_gradient<G>(geometry, p.a, p.b, t, lambda)); },
          .mate = &Case::mate};
}

inline VecX FramePair::twists() const {
  VecX v(12);
  v << twist(a), twist(b);
  return v;
}

inline FramePair FramePair::moved_by(VecX const& motion) const {
  return {moved<double>(a, motion.head<6>()), moved<double>(b, motion.tail<6>())};
}

/// Laws of a joint geometry, whose type is erased, between the frames a and b. Symbols: twists V = [ṙ; ω] of the
/// frames, constraint function g, its Jacobian G = [Ga Gb], and multipliers λ.
struct JointLawsOf {
  static constexpr double tolerance = 1e-12;                    ///< largest relative error of exact derivatives
  AnyGeometry const geometry;                                   ///< geometry under test
  bool const planar = geometry.planar;                          ///< true if all frames stay in the plane z = 0
  Index const m = geometry.rows;                                ///< number of constraint equations
  Index const holonomic = m - geometry.nonholonomic_equations;  ///< number of holonomic constraint equations
  double const t = 1.3;                                         ///< time of the evaluation [s]
  Numbers number;                                               ///< random numbers with a fixed seed

  explicit JointLawsOf(AnyGeometry g) : geometry(std::move(g)) {}  ///< laws of the geometry g

  /// Pairs of frames that satisfy the constraint equations.
  std::vector<FramePair> closed();
  std::vector<FramePair> open();  ///< pairs of `closed()` after a random motion of b
  std::vector<FramePair> all();   ///< pairs of `closed()` and of `open()`
  /// Basis (12×n) of the possible motions of two frames in space or in the plane, with entries 0 and 1.
  MatX known() const;
  VecX multipliers();                                           ///< random λ (m) in [−3, 3]
  VecX wrenches(FramePair const& p, VecX const& lambda) const;  ///< Gᵀλ (12): [f; m] on a, then on b
  MatX jacobian(FramePair const& p) const { return geometry.constraint_function(p, t).G; }  ///< G (m×12) at time t

  /// Allowed error of `quantity(p)`, a quantity of two frames: `relative` (1 + its norm), plus its change due to a
  /// motion of 10⁻¹⁴. Positions r are rounded with the relative error ε, so a function with the gradient G has the
  /// error |G| ε |r|.
  template <class Quantity>
  double allowed(FramePair const& p, Quantity&& quantity, double relative = tolerance) const {
    auto const here = quantity(p), near = quantity(p.moved_by(known() * VecX::LinSpaced(known().cols(), -1e-7, 1e-7)));
    return relative * (1.0 + here.norm()) + 1e-14 * (near - here).norm() / 1e-7;
  }

  /// g = 0 for frames of `closed()`. If there are holonomic constraints, g ≠ 0 after a motion of b.
  void closed_frames_satisfy_the_equations();
  /// G = ∂g/∂(motions of the frames) for holonomic constraints. For nonholonomic constraints, g = 0 everywhere.
  void maps_are_the_derivative_of_the_function();
  /// `rate` = Φ_t = ∂g/∂t.
  void rate_is_the_derivative_of_the_function_by_time();
  /// γ = d/dt (G V + Φ_t) at constant V. The derivative along the motion is computed by dual numbers, the partial
  /// derivative with respect to time by differences.
  void gamma_is_the_second_derivative_without_accelerations();
  /// Gaᵀλ·Va + Gbᵀλ·Vb = λ·(ġ − Φ_t), with ġ along the motion.
  void wrenches_have_the_power_of_the_multipliers();
  /// f_a + f_b = 0 for all frames. If the constraint equations are satisfied, the moments about every point are
  /// balanced. Otherwise the sum of the moments is d × f, with the force f of the constraint equations in world axes
  /// and d = r_b − r_a. This moment is zero for a force along d, such as that of a spring. If a geometry declares
  /// opposite ends, Gb = −Ga is bitwise exact.
  void wrenches_are_equal_and_opposite();
  /// A rotation and displacement of both frames and their twists rotates the constraint equations in world axes and
  /// does not change the other equations.
  void does_not_see_a_rigid_motion_of_both_frames();
  /// `wrench_gradient`, in closed form or by dual numbers, is ∂(Gᵀλ)/∂(motions of the frames). It is compared with
  /// extrapolated differences: the derivative with respect to each motion has an error below 10⁻⁹ (1 + its norm).
  void wrench_gradient_is_the_derivative_of_the_wrenches();
  /// If the constraint equations are satisfied, G has full rank, and Gb T = 0 for the free directions T of the case.
  /// The numbers of constraint equations and of free directions add up to the number of motions of b.
  void equations_and_free_directions_span_all_motions();
};

/// Laws that every joint geometry satisfies. A case gives frames that satisfy the constraint equations:
///
///     struct RevoluteCase {
///       static constexpr bool planar = false;  // true: frames in the plane z = 0
///       static constexpr int world_rows = 3;   // number of leading constraint equations in world axes
///       static Revolute geometry();
///       static Mate mate(Numbers&, double t);  // pose of b relative to a at time t
///     };
///     bool const revolute_obeys = obeys<RevoluteCase, JointLaws>("Revolute");
///
/// Derivatives are computed with dual numbers along motions of the frames, [δr; φ] in world axes. Tolerances are
/// relative and include the round-off of positions, so a geometry may have lengths from 1 mm to 10 m. The laws access
/// the geometry through `AnyGeometry`, so that a source file compiles them once for all of its geometries.
template <class Case>
struct JointLaws : JointLawsOf {
  JointLaws() : JointLawsOf(any_geometry<Case>()) {}

  static constexpr char const* suite = "JointLaws";
  static constexpr Law<JointLaws> laws[] = {
      {"ClosedFramesSatisfyTheEquations", &JointLaws::closed_frames_satisfy_the_equations},
      {"MapsAreTheDerivativeOfTheFunction", &JointLaws::maps_are_the_derivative_of_the_function},
      {"RateIsTheDerivativeOfTheFunctionByTime", &JointLaws::rate_is_the_derivative_of_the_function_by_time},
      {"GammaIsTheSecondDerivativeWithoutAccelerations",
       &JointLaws::gamma_is_the_second_derivative_without_accelerations},
      {"WrenchesHaveThePowerOfTheMultipliers", &JointLaws::wrenches_have_the_power_of_the_multipliers},
      {"WrenchesAreEqualAndOpposite", &JointLaws::wrenches_are_equal_and_opposite},
      {"DoesNotSeeARigidMotionOfBothFrames", &JointLaws::does_not_see_a_rigid_motion_of_both_frames},
      {"WrenchGradientIsTheDerivativeOfTheWrenches", &JointLaws::wrench_gradient_is_the_derivative_of_the_wrenches},
      {"EquationsAndFreeDirectionsSpanAllMotions", &JointLaws::equations_and_free_directions_span_all_motions}};
};

inline std::vector<FramePair> JointLawsOf::closed() {
  std::vector<FramePair> pairs(3);
  for (FramePair& p : pairs) {
    Mate const mate = geometry.mate(number, t);
    p.a = number.frame(planar);
    p.b = number.frame(planar);
    p.b.r = p.a.r + p.a.A * mate.d;
    p.b.A = p.a.A * mate.R;
    p.free_directions.resize(6, mate.free_directions.cols());
    if (mate.free_directions.cols() > 0)  // a weld has no free directions; an empty matrix has no blocks
      p.free_directions << p.a.A * mate.free_directions.topRows<3>(), p.a.A * mate.free_directions.bottomRows<3>();
  }
  return pairs;
}

inline std::vector<FramePair> JointLawsOf::open() {
  std::vector<FramePair> pairs = closed();
  for (FramePair& p : pairs) p.b = moved<double>(p.b, number.motion(planar, 0.4));
  return pairs;
}

inline std::vector<FramePair> JointLawsOf::all() {
  std::vector<FramePair> pairs = closed();
  for (FramePair& p : open()) pairs.push_back(std::move(p));
  return pairs;
}

inline MatX JointLawsOf::known() const {
  std::vector<Index> const columns =
      planar ? std::vector<Index>{0, 1, 5, 6, 7, 11} : std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  MatX k = MatX::Zero(12, Index(columns.size()));
  for (Index j = 0; j < k.cols(); ++j) k(columns[std::size_t(j)], j) = 1.0;
  return k;
}

inline VecX JointLawsOf::multipliers() { return number.vector(m, 3.0); }

inline VecX JointLawsOf::wrenches(FramePair const& p, VecX const& lambda) const {
  return geometry.constraint_function(p, t).G.transpose() * lambda;
}

/// Moment (3) about the point `about` of the wrenches w (12) on both frames.
inline Vec3 moment_about(FramePair const& p, VecX const& w, Vec3 const& about) {
  Vec3 const fa = w.segment<3>(0), fb = w.segment<3>(6);
  return w.segment<3>(3) + (p.a.r - about).cross(fa) + w.segment<3>(9) + (p.b.r - about).cross(fb);
}

inline void JointLawsOf::closed_frames_satisfy_the_equations() {
  auto const g = [&](FramePair const& p) { return geometry.constraint_function(p, t).g; };
  for (FramePair const& p : closed()) EXPECT_LT(g(p).norm(), allowed(p, g, 1e-14));
  if (holonomic == 0) return;
  for (FramePair const& p : open()) EXPECT_GT(g(p).norm(), 1e-3);
}

// The constraint function of nonholonomic constraints is zero, without derivatives.
inline void JointLawsOf::maps_are_the_derivative_of_the_function() {
  for (FramePair const& p : all()) {
    SeenTerms const seen = geometry.terms_by_duals(p, t);
    double const most = allowed(p, [&](FramePair const& at) { return jacobian(at); });
    EXPECT_LT(((seen.G - seen.slope).topRows(holonomic) * known()).norm(), most);
    EXPECT_TRUE(seen.g.tail(m - holonomic).isZero(0.0) && seen.slope.bottomRows(m - holonomic).isZero(0.0));
  }
}

inline void JointLawsOf::rate_is_the_derivative_of_the_function_by_time() {
  for (FramePair const& p : all()) {
    VecX const slope = slope_at_zero([&](double h) { return geometry.constraint_function(p, t + h).g; });
    EXPECT_LT((geometry.constraint_function(p, t).rate - slope).norm(), tolerance * (1.0 + slope.norm()));
  }
}

inline void JointLawsOf::gamma_is_the_second_derivative_without_accelerations() {
  for (FramePair const& p : all()) {
    VecX const v = p.twists();
    VecX const by_time = slope_at_zero(
        [&](double h) {
          SeenTerms const later = geometry.constraint_function(p, t + h);
          return VecX(later.G * v + later.rate);
        },
        1e-2);
    VecX const expected = geometry.terms_by_duals(p, t).G_rate * v + by_time;
    double const most = allowed(p, [&](FramePair const& at) { return geometry.gamma(at, t); });
    EXPECT_LT((geometry.gamma(p, t) - expected).norm(), most);
  }
}

inline void JointLawsOf::wrenches_have_the_power_of_the_multipliers() {
  for (FramePair const& p : all()) {
    VecX const lambda = multipliers(), v = p.twists();
    SeenTerms const seen = geometry.terms_by_duals(p, t);
    VecX rate = seen.slope * v;
    rate.tail(m - holonomic) = seen.G.bottomRows(m - holonomic) * v;
    EXPECT_NEAR(wrenches(p, lambda).dot(v), lambda.dot(rate),
                tolerance * (1.0 + lambda.norm() * seen.G.norm() * v.norm()));
  }
}

inline void JointLawsOf::wrenches_are_equal_and_opposite() {
  for (FramePair const& p : all()) {
    VecX const lambda = multipliers(), w = wrenches(p, lambda);
    Vec3 f = Vec3::Zero(), about = number.vec<3>(5.0);
    if (planar) about[2] = 0.0;
    f.head(geometry.world_rows) = lambda.head(geometry.world_rows);
    double const most = tolerance * (1.0 + w.norm());
    EXPECT_LT((w.segment<3>(0) + w.segment<3>(6)).norm(), most);
    MatX const G = jacobian(p);
    EXPECT_TRUE(!geometry.opposite_ends || G.leftCols(6) == -G.rightCols(6));
    EXPECT_LT((moment_about(p, w, about) - (p.b.r - p.a.r).cross(f)).norm(), 10 * most);
  }
  for (FramePair const& p : closed()) {
    VecX const w = wrenches(p, multipliers());
    EXPECT_LT(moment_about(p, w, Vec3::Zero()).norm(), 10 * tolerance * (1.0 + w.norm()));
  }
}

inline void JointLawsOf::does_not_see_a_rigid_motion_of_both_frames() {
  for (FramePair const& p : all()) {
    Vec6 const motion = number.motion(planar, 2.0);
    Mat3 const turn = exp_so3<double>(motion.tail<3>());
    Vec3 const shift = motion.head<3>();
    FramePair const q{carried(p.a, turn, shift), carried(p.b, turn, shift)};
    Index const n = geometry.world_rows;
    MatX rows = MatX::Identity(m, m), back = MatX::Zero(12, 12);
    rows.topLeftCorner(n, n) = turn.topLeftCorner(n, n);
    for (int i = 0; i < 12; i += 3) back.block<3, 3>(i, i) = turn.transpose();
    SeenTerms const before = geometry.constraint_function(p, t), after = geometry.constraint_function(q, t);
    auto const g = [&](FramePair const& at) { return geometry.constraint_function(at, t).g; };
    auto const rate = [&](FramePair const& at) { return geometry.constraint_function(at, t).rate; };
    auto const G = [&](FramePair const& at) { return jacobian(at); };
    auto const gamma = [&](FramePair const& at) { return geometry.gamma(at, t); };
    EXPECT_LT((after.g - rows * before.g).norm(), allowed(p, g));
    EXPECT_LT((after.rate - rows * before.rate).norm(), allowed(p, rate));
    EXPECT_LT(((after.G - rows * before.G * back) * known()).norm(), allowed(p, G));
    EXPECT_LT((gamma(q) - rows * gamma(p)).norm(), 10 * allowed(p, gamma));
  }
}

inline void JointLawsOf::wrench_gradient_is_the_derivative_of_the_wrenches() {
  MatX const k = known();
  for (FramePair const& p : all()) {
    VecX const lambda = multipliers();
    MatX const gradient = geometry.gradient(p, t, lambda) * k;
    for (Index j = 0; j < k.cols(); ++j) {
      VecX const slope = slope_at_zero([&](double h) { return wrenches(p.moved_by(k.col(j) * h), lambda); });
      EXPECT_LT((k.transpose() * (gradient.col(j) - slope)).norm(), 1e-9 * (1.0 + slope.norm())) << "motion " << j;
    }
  }
}

inline void JointLawsOf::equations_and_free_directions_span_all_motions() {
  MatX const k = known();
  auto const min_load_step = [](MatX a) {  // smallest norm of a row of a after orthogonalisation to the previous rows
    double smallest = a.row(0).norm();
    for (Index i = 1; i < a.rows(); ++i) {
      a.row(i - 1).normalize();
      for (Index j = 0; j < i; ++j) a.row(i) -= a.row(i).dot(a.row(j)) * a.row(j);
      smallest = std::min(smallest, a.row(i).norm());
    }
    return smallest;
  };
  for (FramePair const& p : closed()) {
    EXPECT_EQ(m + p.free_directions.cols(), k.cols() / 2);
    MatX const g = jacobian(p);
    EXPECT_GT(min_load_step(g * k), 0.3);
    EXPECT_GT(min_load_step((g * k).rightCols(k.cols() / 2)), 0.3);
    EXPECT_LT((g.rightCols<6>() * p.free_directions).norm(),
              allowed(p, [&](FramePair const& at) { return jacobian(at); }));
  }
}

}  // namespace polybody::laws
