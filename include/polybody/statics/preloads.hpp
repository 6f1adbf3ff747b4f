#pragma once
/// \file
/// Wrenches of compliant joints in one state, such as the initial state.
/// Theory: Eqs. 4.5, 5.3.

#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Wrench in a compliant joint in one state.
struct Preload {
  std::string joint;      ///< name of the joint in the model
  Wrench<double> wrench;  ///< on the second body about its joint point, world axes [N], [N m]
};

/// Wrenches of all compliant joints (penalties, bushings) in the state last evaluated by `system`, in the order of
/// the model's joint types.
template <class = void>
std::vector<Preload> preloads(System const& system) {
  std::vector<Preload> out;
  for (ConstraintBlock<double> const& block : system.data().rows) {
    if (block.source != ConstraintSource::compliant) continue;
    double w[6];
    wrench_at(block, block.b, block.answer, w);
    out.push_back(
        {system.layout().joints[std::size_t(block.owner)].name, {-Vec3(w[0], w[1], w[2]), -Vec3(w[3], w[4], w[5])}});
  }
  return out;
}
/// Wrenches of all compliant joints in the reference state. They are zero if the markers coincide and the functions
/// of time start at zero. A run from the reference state releases the stored energy.
template <class M>
std::vector<Preload> preloads(M const& model) {
  State const x = model.reference_state();
  System system(model, with<Capabilities::motion>);
  system.evaluate(x.q, x.v, x.t);
  return preloads<>(system);
}

}  // namespace polybody
