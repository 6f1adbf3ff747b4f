// Default meshes of `B::from(bar)`: frequencies of a pinned bar against the Euler-Bernoulli beam, tan(b) = tanh(b),
// omega = b^2 sqrt(EI/(m L^4)) [Blevins 1979, Table 8-1].
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/vibration/modes.hpp>

#include "support/refusal.hpp"

namespace polybody::default_mesh_test {

// Slender, so that shear and rotary inertia lower the second frequency by less than 0.01 %.
Bar const bar{.length = 1.0, .section = Circle{.radius = 0.002}, .material = Material{.density = 7800, .young = 2e11}};

/// Relative errors of the two lowest bending frequencies of the pinned bar.
template <class B, class G>
Vec2 errors(B const& body, G const& pin) {
  auto joint = Joint{pin};
  Model<Bodies<B>, Joints<decltype(joint)>> model;
  auto const rod = model.add(body, "rod");
  model.connect(joint, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  VecX const omega = modes(model, model.reference_state(), 10).frequency;
  BarConstants const c = constants(bar);
  Vec2 worst;
  for (int i = 0; i < 2; ++i) {
    double const b = i == 0 ? 3.92660231204792 : 7.06858274562873;
    double const exact = b * b * std::sqrt(c.EI / c.mass_per_length);
    worst[i] = (omega.array() / exact - 1.0).abs().minCoeff();
  }
  return worst;
}

template <class B>
void expect_accurate() {
  Vec2 const by_default = [] {
    if constexpr (B::world == World::plane)
      return errors(B::from(bar), planar::Revolute{});
    else if constexpr (B::observes == MarkerKind::frame)
      return errors(B::from(bar), Revolute{.axis = {0, 1, 0}});
    else
      return errors(B::from(bar), Spherical{});
  }();
  EXPECT_LT(by_default[0], 2e-3);
  EXPECT_LT(by_default[1], 7e-3);
  EXPECT_EQ(B::from(bar).elements(), B::from(bar, B::default_elements).elements());
}

TEST(DefaultMesh, BendingFrequenciesOfAnAncfCable) { expect_accurate<AncfCable<>>(); }
TEST(DefaultMesh, BendingFrequenciesOfAPlanarAncfCable) { expect_accurate<planar::AncfCable<>>(); }
TEST(DefaultMesh, BendingFrequenciesOfAnElasticLine) { expect_accurate<AncfBeam<ElasticLine>>(); }
TEST(DefaultMesh, BendingFrequenciesOfAContinuum) { expect_accurate<AncfBeam<Continuum<>>>(); }
TEST(DefaultMesh, BendingFrequenciesOfALargeRotationVector) { expect_accurate<Lrvf<>>(); }
TEST(DefaultMesh, BendingFrequenciesOfAPlanarLargeRotationVector) { expect_accurate<planar::Lrvf>(); }
TEST(DefaultMesh, BendingFrequenciesOfAFloatingFrame) { expect_accurate<Ffr>(); }
TEST(DefaultMesh, BendingFrequenciesOfAPlanarFloatingFrame) { expect_accurate<planar::Ffr>(); }

TEST(DefaultMesh, EachBodyAcceptsANumberOfElements) {
  auto const accepts = []<class B>(std::type_identity<B>) {
    EXPECT_NO_THROW(B::from(bar, {.elements = 3}));
    EXPECT_TRUE(has(refusal([] { (void)B::from(bar, {.elements = 0}); }), "at least one element"));
  };
  auto const all = [&]<class... Bs>(TypeList<Bs...>) { (accepts(std::type_identity<Bs>{}), ...); };
  all(TypeList<Rigid<>, Rigid<EulerParameters>, planar::Rigid, AncfCable<>, AncfCable<EngineeringStrain>,
               AncfBeam<ElasticLine>, AncfBeam<Continuum<>>, Lrvf<>, Lrvf<Direct>, planar::AncfCable<>,
               planar::AncfCable<planar::EngineeringStrain>, planar::Lrvf, Ffr, planar::Ffr>{});
  EXPECT_EQ(AncfCable<>::from(bar, {.elements = 3}).elements(), 3);
  EXPECT_EQ(planar::Lrvf::from(bar, {.elements = 3}).elements(), 3);
  EXPECT_EQ(Ffr::from(bar, {.elements = 3}).deformations(), 18);
}

}  // namespace polybody::default_mesh_test
