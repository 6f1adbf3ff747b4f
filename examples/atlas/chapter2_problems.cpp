// The arm and the cantilever of Chapter 2 of the thesis, by the combinations of the programs robot_arm and cantilever:
// each body with the constraint and the generalised-α method, and one body with each policy and each integrator.
#include "../chapter2_formulations.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

using chapter2::Mechanism;

// A combination by its names in --body, --policy and --integrator.
struct Combination {
  std::string name;  // in the atlas
  Settings settings;
  std::string body, policy = "constraint", integrator = "generalised-alpha";
};

chapter2::BodyOnPolicy const& row_of(std::vector<chapter2::BodyOnPolicy> const& table, Combination const& one) {
  auto const row = std::find_if(table.begin(), table.end(), [&](chapter2::BodyOnPolicy const& of) {
    return of.body.name == one.body && of.policy == one.policy;
  });
  if (row == table.end())
    throw InvalidInput{"the combination of \"", ErrorObject{one.body}, "\" and \"", one.policy,
                       "\" is not in the table."};
  return *row;
}

std::size_t integrator_of(Combination const& one) {
  auto const names = combinations::names_of(chapter2::integrators);
  return std::size_t(std::find(names.begin(), names.end(), one.integrator) - names.begin());
}

void add_combinations(Formulations& to, chapter2::Problem const& problem, std::vector<Combination> const& all) {
  auto const table = chapter2::bodies_on_policies(problem.mechanism);
  for (Combination const& one : all) {
    chapter2::BodyOnPolicy const& row = row_of(table, one);
    to.add(row, one.name, one.settings, [&](EqualErrorStudy& study, StudyEntry const& entry) {
      chapter2::add_to(study, problem, row, integrator_of(one), one.name, entry);
    });
  }
}

// The sudden loads of both problems excite vibrations that only short steps resolve.
std::vector<double> const steps{4e-2, 2e-2, 1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4, 3.125e-4, 1.5625e-4};
std::vector<double> const few(steps.begin(), steps.begin() + 4);  // these deformations are beyond a floating frame
std::vector<Index> const cubic{2, 4, 8, 16, 32, 64};

// Bodies with their meshes. The spatial bodies have coarser meshes.
std::vector<Combination> bodies() {
  return {{"LRVF in the plane", {{5, 10, 20, 40, 80, 160, 320}, steps}, "lrvf"},
          {"SE(3) beam in the plane", {{5, 10, 20, 40, 80, 160, 320}, steps}, "se3"},
          {"ANCF cable, Green strain", {cubic, steps}, "ancf"},
          {"ANCF cable, engineering strain", {cubic, steps}, "ancf-engineering"},
          {"FFR, nodal coordinates", {{2, 4, 8, 16, 32}, few}, "ffr"},
          {"FFR, modal coordinates", {{1, 2, 4, 8}, few}, "ffr-modal"},
          {"LRVF in space", {{5, 10, 20, 40, 80, 160}, steps}, "lrvf-space"},
          {"SE(3) beam in space", {{5, 10, 20, 40, 80, 160}, steps}, "se3-space"},
          {"ANCF beam, elastic line", {{4, 8, 16, 32, 64}, steps}, "ancf-beam"},
          {"ANCF beam, continuum", {{4, 8, 16, 32, 64}, steps}, "ancf-beam-continuum"}};
}

// The cable with the other policies and the other integrators, and a floating frame in joint coordinates. Long steps of
// the Runge–Kutta method are unstable with fine meshes. Radau and energy–momentum need more time per step.
std::vector<Combination> variants() {
  std::string const cable = "ANCF cable, Green strain, ";
  std::vector<Index> const coarse{2, 4, 8, 16}, medium{2, 4, 8, 16, 32};
  std::vector<double> const shorter(steps.begin() + 4, steps.end()), longer(steps.begin(), steps.end() - 2),
      without_last(steps.begin(), steps.end() - 1), tolerances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  return {{cable + "penalty", {cubic, steps}, "ancf", "penalty"},
          {cable + "bushing", {cubic, steps}, "ancf", "bushing"},
          {cable + "ancf-linear", {cubic, steps}, "ancf", "ancf-linear"},
          {cable + "joint-coordinates", {cubic, steps}, "ancf", "joint-coordinates"},
          {"FFR, modal coordinates, joint-coordinates", {{1, 2, 4, 8}, few}, "ffr-modal", "joint-coordinates"},
          {cable + "hht", {cubic, steps}, "ancf", "constraint", "hht"},
          {cable + "newmark", {cubic, steps}, "ancf", "constraint", "newmark"},
          {cable + "radau", {cubic, without_last}, "ancf", "constraint", "radau"},
          {cable + "energy-momentum", {medium, longer}, "ancf", "constraint", "energy-momentum"},
          {cable + "runge-kutta", {coarse, shorter}, "ancf", "constraint", "runge-kutta"},
          {cable + "adams", {coarse, tolerances}, "ancf", "constraint", "adams"}};
}

// Completes a problem with its combinations. The page lists each combination that does not exist, with the reason.
Problem with_combinations(Problem made, chapter2::Problem const& of) {
  made.text += "\nThe ANCF cable with Green strain also runs with each policy of its joint and with each integrator.";
  std::vector<Combination> all = bodies();
  auto const table = chapter2::bodies_on_policies(of.mechanism);
  for (Combination const& one : variants())
    if (std::string const& why = row_of(table, one).refusals[integrator_of(one)]; why.empty())
      all.push_back(one);
    else
      made.excluded.push_back({one.name, why});
  made.add = [of, all](Formulations& to) { add_combinations(to, of, all); };
  return made;
}

}  // namespace

Problem robot_arm() {
  double const ramp = 4.5, end_time = 6.75;
  chapter2::Problem const arm{
      .mechanism = Mechanism::arm,
      .motion = "arm driven by 1.5 rad in 4.5 s",
      .setup = {.stiffness = chapter2::medium, .ramp = ramp},
      .end_time = end_time,
      .output = "lag of the tip [m]",
      .output_value = [=](double t, Vec3 const& tip) { return chapter2::lag_of(t, tip, ramp); }};
  return with_combinations(
      {.name = "robot_arm",
       .title = "Robot arm of the thesis",
       .text = "A flexible arm of 10 m turns on a pin by 1.5 rad within 4.5 s (thesis, Chapter 2, medium stiffness, "
               "density 7850 kg/m³).\nThe output is the distance of the tip behind the rigid arm, from 0 to 6.75 s.",
       .question = {arm.output, end_time},
       .model = "rigid sections",
       .excluded = {{"rigid body", "A rigid arm has no lag. The difference from it is the output."}}},
      arm);
}

Problem cantilever() {
  double const end_time = 4.0;
  chapter2::Problem const beam{.mechanism = Mechanism::cantilever,
                               .motion = "clamped beam, 30 kN m at its tip",
                               .setup = {.stiffness = chapter2::low},
                               .end_time = end_time,
                               .output = "tip x [m]",
                               .output_value = [](double, Vec3 const& tip) { return tip[0]; }};
  return with_combinations(
      {.name = "cantilever",
       .title = "Cantilever with tip moment",
       .text = "A moment of 30 kN m acts suddenly at the tip of a clamped beam of 10 m (thesis, Figure 2.9, low "
               "stiffness, density 7850 kg/m³).\nThe output is the position of the tip along the beam, from 0 to "
               "4 s.",
       .question = {beam.output, end_time},
       .model = "rigid sections",
       .excluded = {{"rigid body",
                     "The tip of a rigid beam stays at 10 m. The difference from it is the deflection."}}},
      beam);
}

}  // namespace atlas
