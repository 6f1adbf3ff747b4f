// Law tests of all bodies and of flexible bodies for Se3Beam, straight and curved.

#include <polybody/bodies/se3/se3_beam.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace se3_beam_laws_test {

struct Case {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Se3Beam body(Bar const& bar) { return Se3Beam::from(bar, 3); }
};
struct Elastic : Case {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
/// Helix of curvature 1.5/m and torsion 0.8/m as reference, with a pretension.
struct CurvedCase {
  static Bar bar() {
    Bar bar = spatial_lrvf_bar();
    bar.pretension = 20.0;
    return bar;
  }
  static Se3Beam body(Bar const& bar) {
    return Se3Beam::from(bar, 3, [](double s) {
      Vec3 const k = s * Vec3(0.8, 0, 1.5);
      return Placement{s * left_jacobian<double>(k).col(0), exp_so3<double>(k)};
    });
  }
};
/// Functions of the law tests for a body other than their straight bar.
struct CurvedSe3Beam : testing::Test, BodyLaws<CurvedCase> {};

TEST_F(CurvedSe3Beam, ForceIsTheGradientOfTheEnergyAndTheTangentThatOfTheForce) {
  elastic_force_is_the_gradient_of_the_strain_energy();
  tangent_is_the_derivative_of_the_force_by_position();
  tangent_is_the_derivative_of_the_force_by_speed();
  weight_is_the_gradient_of_its_energy();
  undamped_force_gives_back_the_strain_energy();
}
TEST_F(CurvedSe3Beam, MarkersMoveWithTheSections) {
  local_rate_moves_the_body_with_its_velocities();
  rigid_velocity_is_the_field_of_a_rigid_motion();
  twist_is_jacobian_times_velocities();
  jacobian_is_the_derivative_of_the_frame();
  bias_is_the_acceleration_at_constant_velocities();
  load_stiffness_is_the_derivative_of_the_pulled_wrench();
}
TEST_F(CurvedSe3Beam, ReferenceIsTheHelixWithoutStrain) {
  VecX const q = reference(), rest = VecX::Zero(nv);
  Placement const place = CurvedCase::bar().placement;
  for (int i = 0; i <= 12; ++i) {
    double const s = i * 1.3 / 12.0;
    Vec3 const k = s * Vec3(0.8, 0, 1.5);
    auto const f = see<double>(body.at(s), Mat3::Identity(), q, rest).marker.frame;
    EXPECT_LT((f.A - place.axes * exp_so3<double>(k)).norm(), 1e-14) << s;
    EXPECT_LT((f.r - place.origin - place.axes * s * left_jacobian<double>(k).col(0)).norm(), 1e-14) << s;
    EXPECT_EQ(body.section_strains(body.at(s), view(q)).norm(), 0.0);
  }
}

bool const beam = obeys<Case, BodyLaws>("Se3Beam");
bool const elastic = obeys<Elastic, FlexibleBodyLaws>("Se3Beam");

}  // namespace se3_beam_laws_test
}  // namespace polybody
