#pragma once
#include <polybody/system/model_entries.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// What a compliant joint bears before anything moves.
struct Preload {
  std::string joint;      ///< its name in the model
  Wrench<double> wrench;  ///< on the second body about the joint point there, world axes
};

/// The wrenches of all compliant joints (penalties, bushings) where `system` has been evaluated last, in the order of
/// the model's joint types.
template <class = void>
std::vector<Preload> preloads(System const& system) {
  std::vector<Preload> out;
  for (RowBlock<double> const& block : system.data().rows) {
    if (block.source != RowSource::compliant) continue;
    double w[6];
    wrench_at(block, block.b, block.answer, w);
    out.push_back(
        {system.layout().joints[std::size_t(block.owner)].name, {-Vec3(w[0], w[1], w[2]), -Vec3(w[3], w[4], w[5])}});
  }
  return out;
}
/// The same at the reference state. They are zero where markers coincide and laws begin at zero; a start from the
/// reference state releases what they store.
template <class M>
std::vector<Preload> preloads(M const& model) {
  State const x = model.reference_state();
  System system(model, with<Entries::motion>);
  system.evaluate(x.q, x.v, x.t);
  return preloads<>(system);
}

}  // namespace polybody
