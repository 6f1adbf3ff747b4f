// Scalar laws with invalid or extreme parameters: an error names the parameter, or ten steps give finite numbers.
#include <gtest/gtest.h>

#include "runs.hpp"
#include "scalar_force_words.hpp"

namespace polybody::hostile_scalar_forces_test {
namespace {

using Pin = Joint<Revolute, Constraint>;
using Slide = Joint<Prismatic, Constraint>;

/// A body on a hinge and a body on a slide below the ground; both move.
template <class F>
struct Stage {
  Model<Bodies<Rigid<>>, Joints<Pin, Slide>, Forces<F>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> arm = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({0.5, 0, 0})), "arm");
  BodyHandle<Rigid<>> block = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({0, 0, -1})), "block");
  ElementHandle<Pin> pin =
      model.connect(Pin{Revolute{.axis = Vec3::UnitY()}}, model.ground().at({0, 0, 0}), arm.at({-0.5, 0, 0}), "pin");
  ElementHandle<Slide> slide = model.connect(Slide{Prismatic{.axis = Vec3::UnitZ()}}, model.ground().at({0, 0, -1}),
                                             block.at({0, 0, 0}), "slide");
};

template <class C, class L>
void act(ScalarForce<C, L> const& force) {
  using F = ScalarForce<C, L>;
  Stage<F> s;
  if constexpr (!JointForce<F>)
    s.model.apply(force, s.model.ground().at({0, 0, 0}), s.block.at({0, 0, 0}), "hostile");
  else if constexpr (F::Coordinate::motion == JointMotion::Kind::turn)
    s.model.apply(force, s.pin, "hostile");
  else
    s.model.apply(force, s.slide, "hostile");
  run_ten_steps(s.model, GeneralisedAlpha{});
}
template <class F>
int try_force(F const& sane, std::string const& type) {
  return try_hostile(sane, type, [](F const& force) { act(force); });
}

TEST(HostileParameters, OfScalarLaws) {
  MonotoneTable const table({{-1.0, -50.0}, {0.0, 0.0}, {1.0, 20.0}});
  int tried = 0;
  tried += try_force(on_turns(LinearSpring{.stiffness = 10.0, .damping = 1.0, .free = 0.2}), "LinearSpring");
  tried += try_force(on_translation(TwoSlopeSpring{.stiffness_above = 9.0, .stiffness_below = 5.0}), "TwoSlopeSpring");
  tried += try_force(on_translation(TableSpring{.table = table, .damping = 1.0}), "TableSpring");
  tried += try_force(on_translation(TableDamper{table}), "TableDamper");
  tried += try_force(on_angle(FunctionSpring{LinearLaw{.stiffness = 1.0, .damping = 1.0}}), "FunctionSpring");
  tried += try_force(on_distance(Rope{.stiffness = 100.0, .damping = 1.0, .length = 0.9}), "Rope");
  tried += try_force(
      on_distance(Winch<Constant>{.axial_stiffness = 100.0, .damping = 1.0, .length = 1.0, .reeled = {.value = 0.1}}),
      "Winch");
  std::cout << tried << " parameters of scalar laws\n";
}

TEST(HostileParameters, OfLimits) {
  int tried = 0;
  tried += try_force(on_angle(Limit{.lower = -0.5, .upper = 0.01, .stiffness = 100.0, .damping = 1.0, .onset = 1e-3}),
                     "JointLimit");
  tried += try_force(TurnsLimit{{.upper = 0.01, .stiffness = 100.0, .damping = 1.0}}, "TurnsLimit");
  tried += try_force(SlideLimit{{.lower = -0.01, .stiffness = 100.0, .damping = 1.0}}, "SlideLimit");
  tried += try_force(EndStop{{.upper = 1.01, .stiffness = 100.0, .damping = 1.0}}, "EndStop");
  tried += try_force(on_angle(Backlash{.play = 0.02, .stiffness = 100.0, .damping = 1.0}), "Backlash");
  tried += try_force(on_translation(BumpStop{.lower = -0.01, .stiffness = 1e4, .damping = 0.1}), "BumpStop");
  tried += try_hostile(LimitImpact{.upper = 0.01, .restitution = 0.5}, "LimitImpact", [](LimitImpact const& limit) {
    Stage<JointLimit> s;
    run_ten_steps(s.model, GeneralisedAlpha{},
                  {.end_time = 0.1, .step = 0.01, .events = {impact_at_limit(s.model, s.pin, limit)}});
  });
  std::cout << tried << " parameters of limits\n";
}

}  // namespace
}  // namespace polybody::hostile_scalar_forces_test
