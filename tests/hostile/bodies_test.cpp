// Bars and bodies with invalid or extreme parameters.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "runs.hpp"
#include "support/measured_sections.hpp"

namespace polybody::hostile_bodies_test {
namespace {

using Ball = Joint<Spherical, Constraint>;
using Hinge = Joint<planar::Revolute, Constraint>;

Bar const by_constants{.length = 1.0,
                       .constants = BarConstants{.EA = 1e5,
                                                 .EI = 10.0,
                                                 .mass_per_length = 1.0,
                                                 .GA = 1e5,
                                                 .GJ = 10.0,
                                                 .rotary_inertia = 1e-3,
                                                 .EI_y = 10.0,
                                                 .GA_z = 1e5,
                                                 .rotary_inertia_y = 1e-3},
                       .damping = {.axial = 1e-3, .shear = 1e-3, .bending = 1e-3},
                       .pretension = 1.0};
Bar const round{.length = 1.0,
                .section = Circle{.radius = 0.02},
                .material = Material{.density = 1000, .young = 1e8, .poisson = 0.3}};
Bar const square{.length = 1.0,
                 .section = Rectangle{.height = 0.02, .width = 0.04},
                 .material = Material{.density = 1000, .young = 1e8, .poisson = 0.3},
                 .shear_factor = 0.9};

/// A stride that does not divide the number of hostile values, so that all values are tested.
Share const some{.every = 40};

/// A pendulum with the body that `made()` makes.
template <class B, class Made>
void swing(Made const& made) {
  constexpr bool planar = B::world == World::plane;
  using J = std::conditional_t<planar, Hinge, Ball>;
  Model<Bodies<B>, Joints<J>> model{planar ? Gravity{0, -9.81, 0} : Gravity{0, 0, -9.81}};
  auto const body = model.add(made(), "body");
  auto const marker = body.at(0.0);
  model.connect(J{}, model.ground().at({0, 0, 0}), marker, "pin");
  run_ten_steps(model, GeneralisedAlpha{});
}
template <class B, class Made>
int try_bars(std::string const& type, Made const& made) {
  auto const run = [&](Bar const& bar) { swing<B>([&] { return made(bar); }); };
  int tried =
      try_hostile(round, type + " of a circle", run, some) + try_hostile(square, type + " of a rectangle", run, some);
  if constexpr (!std::is_same_v<B, AncfBeam<Continuum<>>>)
    tried += try_hostile(by_constants, type + " by constants", run, some);
  return tried;
}

TEST(HostileParameters, OfBars) {
  int tried = 0;
  tried += try_bars<Rigid<>>("Rigid", [](Bar const& b) { return Rigid<>::from(b); });
  tried += try_bars<planar::Rigid>("planar::Rigid", [](Bar const& b) { return planar::Rigid::from(b); });
  tried += try_bars<AncfCable<>>("AncfCable", [](Bar const& b) { return AncfCable<>::from(b, 2); });
  tried += try_bars<AncfBeam<>>("AncfBeam", [](Bar const& b) { return AncfBeam<>::from(b, 2); });
  tried += try_bars<AncfBeam<Continuum<>>>("AncfBeam<Continuum>",
                                           [](Bar const& b) { return AncfBeam<Continuum<>>::from(b, 1); });
  tried += try_bars<Se3Beam>("Se3Beam", [](Bar const& b) { return Se3Beam::from(b, 2); });
  tried += try_bars<Lrvf<>>("Lrvf", [](Bar const& b) { return Lrvf<>::from(b, 2); });
  tried +=
      try_bars<planar::AncfCable<>>("planar::AncfCable", [](Bar const& b) { return planar::AncfCable<>::from(b, 2); });
  tried += try_bars<planar::Lrvf>("planar::Lrvf", [](Bar const& b) { return planar::Lrvf::from(b, 2); });
  tried += try_bars<planar::Se3Beam>("planar::Se3Beam", [](Bar const& b) { return planar::Se3Beam::from(b, 2); });
  tried += try_bars<Ffr>("Ffr", [](Bar const& b) { return Ffr::from(b, 2); });
  tried += try_bars<planar::Ffr>("planar::Ffr", [](Bar const& b) { return planar::Ffr::from(b, 2); });
  std::cout << tried << " numbers of bars\n";
}

/// Entries of the matrices and damping times of a section with couplings, an offset and damping.
template <class B, class Made>
int try_sections(std::string const& type, Made const& made) {
  Section6 section = composite().placed(0.02, -0.03);
  section.damping_times.setConstant(1e-3);
  return try_hostile(
      section, type + " of a Section6",
      [&](Section6 const& s) { swing<B>([&] { return made(Bar{.length = 10.0, .section = s}); }); }, some);
}

TEST(HostileParameters, OfSections) {
  int tried = 0;
  tried += try_sections<Se3Beam>("Se3Beam", [](Bar const& b) { return Se3Beam::from(b, 2); });
  tried += try_sections<Lrvf<>>("Lrvf", [](Bar const& b) { return Lrvf<>::from(b, 2); });
  tried += try_sections<AncfBeam<CoupledLine>>("AncfBeam<CoupledLine>",
                                               [](Bar const& b) { return AncfBeam<CoupledLine>::from(b, 2); });
  tried += try_sections<Ffr>("Ffr", [](Bar const& b) { return Ffr::from(b, 2); });
  std::cout << tried << " numbers of sections\n";
}

TEST(HostileParameters, OfBodies) {
  int tried = 0;
  RigidShape::Parameters const solid{.mass = 1.0, .inertia = Mat3(Vec3(1.0, 2.0, 2.5).asDiagonal())};
  tried += try_hostile(solid, "Rigid", [](RigidShape::Parameters const& p) {
    Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
    auto const body = model.add(Rigid<>(p), "body");
    model.connect(Ball{}, model.ground().at({0, 0, 0}), body.at({0, 0, 0}), "pin");
    run_ten_steps(model, GeneralisedAlpha{});
  });
  tried += try_hostile(Inertia{.mass = 1.0, .centre = {0.1, 0.2, -0.3}, .tensor = solid.inertia}, "Inertia",
                       [](Inertia const& inertia) {
                         Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
                         auto const body = model.add(Rigid<>(inertia.body()), "body");
                         model.connect(Ball{}, model.ground().at(inertia.centre), body.centre(), "pin");
                         run_ten_steps(model, GeneralisedAlpha{});
                       });
  tried += try_hostile(planar::Rigid::Parameters{.mass = 1.0, .inertia = 1.0}, "planar::Rigid",
                       [](planar::Rigid::Parameters const& p) {
                         Model<Bodies<planar::Rigid>, Joints<Hinge>> model{Gravity{0, -9.81, 0}};
                         auto const body = model.add(planar::Rigid(p), "body");
                         model.connect(Hinge{}, model.ground().at({0, 0, 0}), body.at(Vec2(0, 0)), "pin");
                         run_ten_steps(model, GeneralisedAlpha{});
                       });
  tried += try_hostile(
      FfrOptions{}, "FfrOptions",
      [](FfrOptions const& o) {
        Structure const s = structure_of(round, 2);
        swing<Ffr>([&] { return Ffr(s, nodal_coordinates(s), o); });
      },
      some);
  Structure const s = structure_of(round, 1);
  tried += try_hostile(
      integrals_of(s, nodal_coordinates(s), true), "FfrIntegrals",
      [](FfrIntegrals const& integrals) {
        Model<Bodies<Ffr>, Joints<>> model{Gravity{0, 0, -9.81}};
        model.add(Ffr(integrals, FfrOptions{}), "body");
        run_ten_steps(model, GeneralisedAlpha{});
      },
      some);
  std::cout << tried << " parameters of bodies\n";
}

}  // namespace
}  // namespace polybody::hostile_bodies_test
