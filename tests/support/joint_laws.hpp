#pragma once
/// \file
/// The laws that every joint geometry obeys. A case says how its frames fit together:
///
///     struct RevoluteCase {
///       static constexpr bool planar = false;      // its frames stay in the plane z = 0
///       static constexpr int world_rows = 3;       // leading rows given in world axes
///       static Revolute geometry();
///       static Mate mate(Numbers&, double t);      // how b may stand against a at time t
///     };
///     bool const obeyed = obeys<RevoluteCase, JointLaws>("Revolute");
///
/// Derivatives are taken with dual numbers along motions of the frames, [δr; φ] in world axes. The geometry is
/// asked through a few functions, so that the laws are compiled once (joint_laws_test.cpp) for all geometries.

#include <gtest/gtest.h>

#include <functional>
#include <polybody/joints/gap.hpp>
#include <vector>

#include "support/frames.hpp"
#include "support/laws.hpp"

namespace polybody {

/// A place of b against a where the joint is closed, and the motions of b against a that keep it closed.
struct Mate {
  Vec3 d = Vec3::Zero();      ///< (3) r_b − r_a in a's axes
  Mat3 R = Mat3::Identity();  ///< (3×3) AaᵀAb
  MatX freedoms;              ///< (6×dof) [velocity; angular velocity] of b in a's axes
};

/// Two frames, their twists with them.
struct FramePair {
  Frame<double> a, b;
  MatX freedoms = MatX::Zero(6, 0);  ///< (6×dof) of b, world axes

  VecX twists() const;
  FramePair moved_by(VecX const& motion) const;
};

/// A gap with G = [Ga Gb] and its derivatives.
struct SeenGap {
  VecX g, rate;  ///< (m)
  MatX G;        ///< (m×12)
  MatX slope;    ///< (m×12) ∂g/∂(motions), dual numbers
  MatX G_rate;   ///< (m×12) Ġ while the frames keep their twists and time stands still, dual numbers
};

/// A geometry of any type.
struct AnyGeometry {
  Index rows = 0, world_rows = 0, velocity_rows = 0;
  bool planar = false;
  std::function<SeenGap(FramePair const&, double)> gap, gap_with_slopes;
  std::function<VecX(FramePair const&, double)> gamma;
  std::function<MatX(FramePair const&, double, VecX const&)> gradient;
  std::function<Mate(Numbers&, double)> mate;
};

template <class Case>
AnyGeometry any_geometry() {
  using G = decltype(Case::geometry());
  using D = Dual<12>;
  static constexpr int m = G::rows;
  static auto const geometry = Case::geometry();
  auto const gap = [](FramePair const& p, double t) {
    Gap<m> const x = geometry.template gap<double>(p.a, p.b, t);
    SeenGap seen{x.g, x.rate, MatX(m, 12), {}, {}};
    seen.G << x.Ga, x.Gb;
    return seen;
  };
  auto const by_duals = [gap](FramePair const& p, double t) {
    SeenGap seen = gap(p, t);
    seen.slope.resize(m, 12);
    seen.G_rate.resize(m, 12);
    auto const see = [&](Frame<D> const& a, Frame<D> const& b, auto&& keep) {
      Gap<m, D> const x = geometry.template gap<D>(a, b, t);
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
          .velocity_rows = velocity_rows<G>(),
          .planar = Case::planar,
          .gap = gap,
          .gap_with_slopes = by_duals,
          .gamma = [](FramePair const& p, double t) { return VecX(geometry.template gamma<double>(p.a, p.b, t)); },
          .gradient = [](FramePair const& p, double t,
                         VecX const& lambda) { return MatX(wrench_gradient<G>(geometry, p.a, p.b, t, lambda)); },
          .mate = &Case::mate};
}

/// The laws themselves.
struct JointLawsOf {
  static constexpr double tolerance = 1e-12;
  AnyGeometry const geometry;
  bool const planar = geometry.planar;
  Index const m = geometry.rows, held = m - geometry.velocity_rows;  ///< rows, and those of them that hold positions
  double const t = 1.3;
  Numbers number;

  explicit JointLawsOf(AnyGeometry g) : geometry(std::move(g)) {}

  /// Frames that fit, and frames where b was then moved away.
  std::vector<FramePair> closed();
  std::vector<FramePair> open();
  std::vector<FramePair> all();
  /// The motions of two frames that their world knows, as a 0/1 matrix (12×n).
  MatX known() const;
  VecX multipliers();
  VecX wrenches(FramePair const& p, VecX const& lambda) const;

  // the laws: defined in tests/joints/joint_laws_test.cpp
  void closed_frames_have_no_gap();
  void maps_are_the_derivative_of_the_gap();
  void rate_is_the_derivative_of_the_gap_by_time();
  void gamma_is_the_second_derivative_without_accelerations();
  void wrenches_have_the_power_of_the_multipliers();
  void wrenches_are_equal_and_opposite();
  void does_not_see_a_rigid_motion_of_both_frames();
  void wrench_gradient_is_the_derivative_of_the_wrenches();
  void rows_and_freedoms_make_up_all_motions();
};

template <class Case>
struct JointLaws : JointLawsOf {
  JointLaws() : JointLawsOf(any_geometry<Case>()) {}

  static constexpr char const* suite = "JointLaws";
  static constexpr Law<JointLaws> laws[] = {
      {"ClosedFramesHaveNoGap", &JointLaws::closed_frames_have_no_gap},
      {"MapsAreTheDerivativeOfTheGap", &JointLaws::maps_are_the_derivative_of_the_gap},
      {"RateIsTheDerivativeOfTheGapByTime", &JointLaws::rate_is_the_derivative_of_the_gap_by_time},
      {"GammaIsTheSecondDerivativeWithoutAccelerations",
       &JointLaws::gamma_is_the_second_derivative_without_accelerations},
      {"WrenchesHaveThePowerOfTheMultipliers", &JointLaws::wrenches_have_the_power_of_the_multipliers},
      {"WrenchesAreEqualAndOpposite", &JointLaws::wrenches_are_equal_and_opposite},
      {"DoesNotSeeARigidMotionOfBothFrames", &JointLaws::does_not_see_a_rigid_motion_of_both_frames},
      {"WrenchGradientIsTheDerivativeOfTheWrenches", &JointLaws::wrench_gradient_is_the_derivative_of_the_wrenches},
      {"RowsAndFreedomsMakeUpAllMotions", &JointLaws::rows_and_freedoms_make_up_all_motions}};
};

}  // namespace polybody
