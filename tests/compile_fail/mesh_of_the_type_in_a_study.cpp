// refused: Name the body without Meshed or Modal
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/compare/equal_error.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>

using namespace polybody;

auto const pendulum = [](auto const& choice) {
  using M = Model<Bodies<planar::Lrvf>, Joints<Joint<planar::Revolute>>>;
  M model;
  auto const rod = model.add(choice.body(Bar{.length = 1.0}), "rod");
  model.connect(Joint{planar::Revolute{}}, model.ground().at({0, 0, 0}), rod.at(0.0));
  State const start = model.reference_state();
  return Scenario<M>{std::move(model), start, {.end_time = 1.0, .step = 0.1}, {}};
};

void add(EqualErrorStudy& study) {
  study.add(pendulum, Formulation<Meshed<planar::Lrvf, 4>, Constraint, GeneralisedAlpha>{"rod"}, {.model = "beam"});
}
