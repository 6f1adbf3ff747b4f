// Cholesky coordinates: identity mass matrix, law tests of bodies, and the same motion.
#include <polybody/bodies/ancf/cholesky_coordinates.hpp>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/flexible_body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace cholesky_coordinates_test {

using Cable = CholeskyCoordinates<AncfCable<>>;
using PlanarCable = CholeskyCoordinates<planar::AncfCable<>>;
static_assert(Body<Cable> && Body<PlanarCable>);

struct CholeskyCase {
  static constexpr double rounding = 100.0;  // e = L⁻ᵀ (Lᵀ e): condition number of L
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 40.0, .EI = 3.0, .mass_per_length = 0.7},
            .placement = Placement::at({0.4, -0.3, 0.2}, {0.3, -0.5, 0.9}),
            .damping = {.axial = 0.02, .bending = 0.01}};
  }
  static Cable body(Bar const& bar) { return Cable::from(bar, Index(3)); }
};
bool const cholesky_coordinates_obeys = obeys<CholeskyCase, BodyLaws, FlexibleBodyLaws>("CholeskyCable");

Bar rod() { return {.length = 1.0, .constants = BarConstants{.EA = 1e3, .EI = 1.0, .mass_per_length = 1.0}}; }

template <class B>
Vec3 swung() {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<B>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const bar = model.add(B::from(rod(), Index(4)), "rod");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), bar.at(0.0), "pin");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8, .tolerance = 1e-11}, {.end_time = 0.5, .step = 2e-3}).run();
  return position(model, x, bar.at(1.0));
}
TEST(CholeskyCoordinates, SwingLikeTheCableItself) {
  Vec3 const own = swung<planar::AncfCable<>>(), cholesky = swung<PlanarCable>();
  EXPECT_LT(own[1], -0.5);
  EXPECT_LT((own - cholesky).norm(), 1e-8);
}

template <class B>
Vec3 thrown() {
  Model<Bodies<B>, Joints<>> model{Gravity{0, -9.81, 0}};
  auto const bar = model.add(B::from(rod(), Index(4)), "rod");
  State x = model.reference_state();
  model.set_velocity(x, bar, {0, 3, 0}, {0, 0, 5});
  simulate(model, x, RungeKutta4<>{}, {.end_time = 0.2, .step = 1e-4}).run();
  return position(model, x, bar.at(0.3));
}
TEST(CholeskyCoordinates, FlyLikeTheCableItself) {
  EXPECT_LT((thrown<planar::AncfCable<>>() - thrown<PlanarCable>()).norm(), 1e-10);
}

TEST(CholeskyCoordinates, KnowTheBodysOwnCoordinates) {
  Cable const c = CholeskyCase::body(CholeskyCase::bar());
  VecX p(c.coordinates()), e(c.coordinates());
  c.reference({p.data(), std::size_t(p.size())});
  c.base().reference({e.data(), std::size_t(e.size())});
  EXPECT_LT((c.base_coordinates({p.data(), std::size_t(p.size())}) - e).norm(), 1e-13 * e.norm());
  EXPECT_GT((p - e).norm(), 0.1);
}

}  // namespace cholesky_coordinates_test
}  // namespace polybody
