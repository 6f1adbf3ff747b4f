#include "../chapter2_formulations.hpp"

namespace chapter2 {

std::vector<BodyOnPolicy> bodies_on_policies(Mechanism mechanism) {
  std::vector<BodyOnPolicy> table;
  for (auto const of_body :
       {rigid_bodies, lrvf_beams, green_cables, engineering_cables, floating_frames, spatial_rigid_bodies,
        elastic_line_beams, continuum_beams, spatial_lrvf_beams, helicoidal_beams, spatial_helicoidal_beams})
    for (BodyOnPolicy& one : of_body(mechanism)) table.push_back(std::move(one));
  return table;
}

Scenario<AnyModel> scenario_of(Problem const& problem, MakeMechanism const& make, FormulationMesh const& mesh) {
  AnyMechanism const made = make(problem.setup, mesh);
  auto const value = [tip = made.tip, of = problem.output_value](AnyModel const&, State const& x) {
    return of(x.t, tip(x));
  };
  return {made.model,
          made.model.reference_state(),
          {.end_time = problem.end_time, .step = problem.end_time / 1000.0, .max_step_halvings = 6},
          {{problem.output, value}}};
}

}  // namespace chapter2
