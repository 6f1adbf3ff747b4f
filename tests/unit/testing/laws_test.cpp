// The law suites detect errors: a type with one mistake breaks the law that describes it. A law without meaning for a
// case has no test.
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/body_laws.hpp>
#include <polybody/testing/force_laws.hpp>
#include <polybody/testing/integrator_laws.hpp>
#include <polybody/testing/joint_laws.hpp>
#include <polybody/testing/policy_laws.hpp>
#include <polybody/testing/user_system_laws.hpp>

#include "support/broken_laws.hpp"
#include "support/integrator_cases.hpp"

namespace polybody {
using namespace laws;
namespace laws_test {

// --- bodies -----------------------------------------------------------------------------------------------------

struct Block {
  static planar::Rigid body() { return {2.0, 0.3, Placement::planar(0.4, -0.3, 0.7)}; }
  static std::vector<planar::Rigid::Point> points() { return {body().at(Vec2(0, 0)), body().at(Vec2(0.3, -0.1))}; }
  static double mass() { return 2.0; }
  static Vec3 centre() { return {0.4, -0.3, 0.0}; }
};
bool const block_obeys = obeys<Block, BodyLaws>("BlockWithoutABar");

struct LightBlock : Block {
  static double mass() { return 1.9; }
};
struct WithoutBias : planar::Rigid {
  using planar::Rigid::Rigid;
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    planar::Rigid::evaluate_marker<T>(p, axes, q, v, out);
    out.bias.setZero();
  }
};
struct BlockWithoutBias : Block {
  static WithoutBias body() { return {2.0, 0.3, Placement::planar(0.4, -0.3, 0.7)}; }
};

TEST(BodyLaws, TellWhatIsWrong) {
  EXPECT_EQ(broken<BodyLaws<Block>>(), Names{});
  EXPECT_EQ(broken<BodyLaws<LightBlock>>(), (Names{"TotalMassIsAsGiven", "WeightActsAtTheCentreOfMass"}));
  EXPECT_EQ(broken<BodyLaws<BlockWithoutBias>>(), Names{"BiasIsTheAccelerationAtConstantSpeeds"});
}

// --- joints -----------------------------------------------------------------------------------------------------

struct Bead {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static PointOnLine geometry() { return {.axis = Vec3::UnitZ()}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.d = Vec3(0, 0, number()), .R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 4)};
    mate.free_directions(2, 0) = 1.0;
    mate.free_directions.bottomRightCorner<3, 3>().setIdentity();
    return mate;
  }
};
struct LineWithoutGamma : PointOnLine {
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const&, Frame<T> const&, double) const {
    return Vec<T, 2>::Zero();
  }
};
struct BeadWithoutGamma : Bead {
  static LineWithoutGamma geometry() { return {}; }
};
struct BeadThatSticks : Bead {
  static Mate mate(Numbers& number, double t) {
    Mate mate = Bead::mate(number, t);
    mate.free_directions = mate.free_directions.rightCols<3>().eval();
    return mate;
  }
};

TEST(JointLaws, TellWhatIsWrong) {
  EXPECT_EQ(broken<JointLaws<Bead>>(), Names{});
  EXPECT_EQ(broken<JointLaws<BeadWithoutGamma>>(), Names{"GammaIsTheSecondDerivativeWithoutAccelerations"});
  EXPECT_EQ(broken<JointLaws<BeadThatSticks>>(), Names{"EquationsAndFreeDirectionsSpanAllMotions"});
}

// --- policies and forces ------------------------------------------------------------------------------------------

struct Stiff {
  static constexpr int rows = 2;
  static Penalty policy() { return {.stiffness = 30.0, .damping = 2.0}; }
};
struct HalfEnergy : Penalty {
  template <int m>
  double potential(Vec<double, m> const& g) const {
    return 0.5 * Penalty::potential<m>(g);
  }
};
struct StiffOfHalfEnergy : Stiff {
  static HalfEnergy policy() { return {Stiff::policy()}; }
};

TEST(PolicyLaws, TellWhatIsWrong) {
  EXPECT_EQ(broken<PolicyLaws<Stiff>>(), Names{});
  EXPECT_EQ(broken<PolicyLaws<StiffOfHalfEnergy>>(), Names{"ElasticMultiplierIsTheSlopeOfThePotential"});
}

struct Spring {
  static SpringDamper force() { return {.stiffness = 80.0, .damping = 3.0, .free_length = 0.7}; }
};
struct OneSidedSpring : SpringDamper {
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double t) const {
    auto w = SpringDamper::wrenches<T>(f, t);
    w[1] = {};
    return w;
  }
};
struct OneSided {
  static OneSidedSpring force() { return {Spring::force()}; }
};
struct Gusher : SpringDamper {
  static Gusher with_energy() {
    Gusher g{Spring::force()};
    g.damping = -1.0;
    return g;
  }
};
struct Gushing {
  static Gusher force() { return Gusher::with_energy(); }
};

struct HalfLost : MaxwellElement {
  double dissipation(std::array<Frame<double>, 2> const& f, std::array<double, 1> const& z, double t) const {
    return 0.5 * MaxwellElement::dissipation(f, z, t);
  }
};
struct Losing {
  static HalfLost force() { return {{.stiffness = 80.0, .damping = 3.0, .free_length = 0.7}}; }
};

TEST(ForceLaws, TellWhatIsWrong) {
  EXPECT_EQ(broken<ForceLaws<Spring>>(), Names{});
  EXPECT_EQ(broken<ForceLaws<Gushing>>(), Names{"GivesBackNoMoreThanItsPotential"});
  EXPECT_EQ(broken<ForceLaws<Losing>>(), Names{"DissipationIsTheLostPower"});
  Names const one_sided = broken<ForceLaws<OneSided>>();
  ASSERT_FALSE(one_sided.empty());
  EXPECT_EQ(one_sided.front(), "ActionIsReaction");
}

// --- integrators and equations --------------------------------------------------------------------------------------

struct Bragging : SymplecticEuler {
  static constexpr int order = 2;
};
struct BraggingOnFreeBody {
  using Model = SprungBody;
  static auto integrators() { return std::vector<Bragging>(1); }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 64;
};

TEST(IntegratorLaws, TellWhatIsWrong) {
  EXPECT_EQ(broken<IntegratorLaws<BraggingOnFreeBody>>(),
            (Names{"StateConvergesAtTheDeclaredOrder", "EnergyErrorFallsAtTheDeclaredOrder"}));
}

/// A point of mass 3 on a circle with growing radius, Φ = ½ (x² + y² − (1 + t)²), on a spring.
struct Circle {
  Index velocities() const { return 2; }
  Index rows() const { return 1; }
  void mass(VecX const&, MatX& m) const { m = 3.0 * MatX::Identity(2, 2); }
  void force(VecX const& q, VecX const& v, double, VecX& f) const { f = -5.0 * q - 0.2 * v; }
  void tangent(VecX const&, VecX const&, double, double ck, double cd, MatX& k) const {
    k = (5.0 * ck + 0.2 * cd) * MatX::Identity(2, 2);
  }
  void violation(VecX const& q, double t, VecX& phi) const { phi[0] = 0.5 * (q.squaredNorm() - (1 + t) * (1 + t)); }
  void jacobian(VecX const& q, double, MatX& g) const { g = q.transpose(); }
  void rate(VecX const&, double t, VecX& phi_t) const { phi_t[0] = -(1 + t); }
  void gamma(VecX const&, VecX const& v, double, VecX& gamma) const { gamma[0] = v.squaredNorm() - 1.0; }
};
struct OnTheCircle {
  static Circle equations() { return {}; }
};
bool const circle_obeys = obeys<OnTheCircle, UserSystemLaws>("PointOnACircle");

struct AddingCircle : Circle {  // adds to M instead of overwriting it
  void mass(VecX const&, MatX& m) const { m += MatX::Identity(2, 2); }
  void gamma(VecX const&, VecX const& v, double, VecX& gamma) const { gamma[0] = v.squaredNorm(); }
};
struct OnTheAddingCircle {
  static AddingCircle equations() { return {}; }
};

TEST(UserSystemLaws, TellWhatIsWrong) {
  EXPECT_EQ(broken<UserSystemLaws<OnTheCircle>>(), Names{});
  EXPECT_EQ(broken<UserSystemLaws<OnTheAddingCircle>>(),
            (Names{"MassIsSymmetricAndPositive", "GammaIsTheSecondDerivativeWithoutAccelerations"}));
}

// --- laws that do not apply -----------------------------------------------------------------------------------------

/// A constant force on one marker: it has no reaction and no potential.
struct Push {
  static PointForce<> force() { return {.force = {Vec3(3.0, -1.0, 2.0)}}; }
};
bool const push_obeys = obeys<Push, ForceLaws>("Push");
struct Maxwell {
  static MaxwellElement force() { return {.stiffness = 80.0, .damping = 3.0, .free_length = 0.7}; }
};
bool const spring_obeys = obeys<Spring, ForceLaws>("Spring");
bool const maxwell_obeys = obeys<Maxwell, ForceLaws>("Maxwell");

/// A free mass without tangent and constraint equations.
struct FreeMass {
  Index velocities() const { return 1; }
  void mass(VecX const&, MatX& m) const { m = MatX::Identity(1, 1); }
  void force(VecX const& q, VecX const&, double, VecX& f) const { f = -5.0 * q; }
};
struct FreeMassCase {
  static FreeMass equations() { return {}; }
};
bool const free_mass_obeys = obeys<FreeMassCase, UserSystemLaws>("FreeMass");

/// Names of the tests of a suite in this program.
Names tests_of(std::string const& suite) {
  testing::UnitTest const& all = *testing::UnitTest::GetInstance();
  Names names;
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    testing::TestSuite const& one = *all.GetTestSuite(i);
    for (int j = 0; one.name() == suite && j < one.total_test_count(); ++j) names.push_back(one.GetTestInfo(j)->name());
  }
  return names;
}
/// Names of the laws of a suite, except those in `without`.
template <class Laws>
Names laws_of(Names const& without = {}) {
  Names names;
  for (Law<Laws> const& law : Laws::laws)
    if (std::ranges::find(without, std::string(law.name)) == without.end()) names.push_back(law.name);
  return names;
}

TEST(Laws, ThatDoNotApplyHaveNoTest) {
  EXPECT_EQ(tests_of("BlockWithoutABar/BodyLaws"),
            laws_of<BodyLaws<Block>>({"OwnRowsHoldAtTheReferenceAndTheirMapsAreDerivatives",
                                      "ReferenceStandsWhereTheBarIsPlaced", "PointsOutsideTheBarAreRefused"}));
  EXPECT_EQ(tests_of("Push/ForceLaws"), (Names{"GradientIsTheDerivativeOfTheWrenches", "AsksNoMoreThanItSays"}));
  EXPECT_EQ(tests_of("Spring/ForceLaws"), laws_of<ForceLaws<Spring>>({"DissipationIsTheLostPower"}));
  EXPECT_EQ(tests_of("Maxwell/ForceLaws"), laws_of<ForceLaws<Maxwell>>());
  EXPECT_EQ(tests_of("FreeMass/UserSystemLaws"), Names{"MassIsSymmetricAndPositive"});
  EXPECT_EQ(tests_of("PointOnACircle/UserSystemLaws"), laws_of<UserSystemLaws<OnTheCircle>>());
}

}  // namespace laws_test
}  // namespace polybody
