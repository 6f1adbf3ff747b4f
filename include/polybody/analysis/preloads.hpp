#pragma once
#include <polybody/analysis/observe.hpp>

namespace polybody {

/// What a compliant joint bears before anything moves.
struct Preload {
  std::string joint;
  Wrench<double> wrench;  ///< on the second body about the joint point there, world axes
};

/// The wrenches of all compliant joints (penalties, bushings) at the reference state, in the order of the model's joint
/// types. They are zero where markers coincide and laws begin at zero; a start from the reference state lets go what
/// they store.
template <class M>
std::vector<Preload> preloads(M const& model) {
  State const x = model.reference_state();
  System<M> system(model);
  system.evaluate(x.q, x.v, x.t);
  std::vector<Preload> out;
  for_each_gap(model, system.data(), [&](auto const& e, auto const& gap) {
    if constexpr (AddsForce<typename std::decay_t<decltype(e.joint)>::PolicyType>) {
      Vec6 const w = -gap.Gb.transpose() * detail::multiplier(e, gap, system.data(), x.lambda);
      out.push_back({e.name, {w.head<3>(), w.tail<3>()}});
    }
  });
  return out;
}

}  // namespace polybody
