#pragma once
// Slider-crank with a flexible coupler that is pinned at both ends (case D8). The crank reaches 150 rad/s within 0.1 s.
#include <polybody/polybody.hpp>

namespace polybody::slider_crank {

inline constexpr double crank_length = 0.1, rod_length = 0.4;
inline Bar const crank_bar{.length = crank_length,
                           .section = Circle{.radius = 0.01},
                           .material = Material{.density = 7800, .young = 2e11, .poisson = 0.3}};
inline Bar const rod_bar{.length = rod_length,
                         .section = Rectangle{.height = 0.006, .width = 0.02},
                         .material = Material{.density = 7800, .young = 2e11, .poisson = 0.3},
                         .placement = Placement::at({crank_length, 0, 0})};
inline SpinUp const law{.speed = 150.0, .duration = 0.1};

/// Deflection of the middle of the rod from its chord [mm], upwards.
template <class M, class B>
double bend(M const& model, State const& x, BodyHandle<B> const& rod) {
  Vec3 const a = position(model, x, rod.at(0.0)), b = position(model, x, rod.at(rod_length)),
             c = position(model, x, rod.at(0.5 * rod_length)), along = (b - a).normalized();
  return 1e3 * along.cross(c - a)[2];
}

/// Scenario from a model, its rod and a marker on its slider.
template <class M, class B, class Marked>
Scenario<M> scenario(M model, BodyHandle<B> const& rod, Marked const& slider) {
  State const start = model.reference_state();
  return {std::move(model),
          start,
          {.end_time = 0.2, .step = 1e-4},
          {{"slider [m]", [slider](M const& m, State const& x) { return position(m, x, slider)[0]; }},
           {"bend [mm]", [rod](M const& m, State const& x) { return bend(m, x, rod); }}},
          {},
          5e-4};
}

inline auto const in_the_plane = [](auto const& choice) {
  using F = std::remove_cvref_t<decltype(choice)>;
  using B = typename F::BodyType;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Slide = Joint<planar::Prismatic, Constraint>;
  using Drive = Joint<PrescribedAngle<SpinUp>, Constraint>;
  using Listed = std::conditional_t<std::same_as<B, planar::Rigid>, Bodies<planar::Rigid>, Bodies<planar::Rigid, B>>;
  Model<Listed, Joints<Pin, Slide, Drive>> model{Gravity{0, -9.81, 0}};
  auto const crank = model.add(planar::Rigid::from(crank_bar), "crank");
  auto const rod = model.add(choice.body(rod_bar), "rod");
  auto const piston = model.add(planar::Rigid(0.5, 1e-4, Placement::planar(crank_length + rod_length, 0, 0)), "piston");
  auto const ground = model.ground().at({0, 0, 0});
  auto const at_piston = piston.at(Vec2(0, 0));
  model.connect(Pin{}, ground, crank.at(0.0), "main pin");
  model.connect(Pin{}, crank.at(crank_length), rod.at(0.0), "crank pin");
  model.connect(Pin{}, rod.at(rod_length), at_piston, "piston pin");
  model.connect(Slide{{.axis = Vec3(1, 0, 0)}, {}}, ground, at_piston, "cylinder");
  model.connect(Drive{{.law = law}, {}}, ground, crank.at(0.0), "motor");
  return scenario(std::move(model), rod, at_piston);
};

inline auto const in_space = [](auto const& choice) {
  using B = typename std::remove_cvref_t<decltype(choice)>::BodyType;
  using Pin = Joint<Revolute, Constraint>;
  using Ball = Joint<Spherical, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Drive = Joint<PrescribedAngle<SpinUp>, Constraint>;
  Model<Bodies<Rigid<>, B>, Joints<Pin, Ball, Slide, Drive>> model{Gravity{0, -9.81, 0}};
  auto const crank = model.add(Rigid<>::from(crank_bar), "crank");
  auto const rod = model.add(choice.body(rod_bar), "rod");
  auto const piston =
      model.add(Rigid<>(0.5, 1e-4 * Mat3::Identity(), Placement::at({crank_length + rod_length, 0, 0})), "piston");
  auto const ground = model.ground().at({0, 0, 0});
  auto const at_piston = piston.at({0, 0, 0});
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, ground, crank.at(0.0), "main pin");
  if constexpr (B::observes == MarkerKind::frame)
    model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, crank.at(crank_length), rod.at(0.0), "crank pin");
  else  // the markers of a cable have no axis across it
    model.connect(Ball{}, crank.at(crank_length), rod.at(0.0), "crank pin");
  model.connect(Ball{}, rod.at(rod_length), at_piston, "piston pin");
  model.connect(Slide{{.axis = Vec3::UnitX()}, {}}, ground, at_piston, "cylinder");
  model.connect(Drive{{.law = law, .axis = Vec3::UnitZ()}, {}}, ground, crank.at(0.0), "motor");
  return scenario(std::move(model), rod, at_piston);
};

}  // namespace polybody::slider_crank
