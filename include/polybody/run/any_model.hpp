#pragma once
/// \file
/// A model whose type is forgotten.

#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {

/// Names integrators in a constructor: `AnyModel(model, stepped_by<GeneralisedAlpha>)`.
template <class... Is>
struct SteppedBy {};
/// The integrators Is, as an argument.
template <class... Is>
inline constexpr SteppedBy<Is...> stepped_by{};

namespace detail {
template <class I>
inline constexpr char integrator_tag = 0;
}  // namespace detail

/// What runs, comparisons and records ask of a model, whatever its type. Programs that drive many formulations compile
/// what they do with them once:
///   AnyModel const model(std::make_shared<MyModel const>(my_model), stepped_by<GeneralisedAlpha, Radau>);
///   State x = model.reference_state();
///   simulate(model, x, Radau{}, {.until = 1.0, .step = 1e-3}).run();
/// It keeps the model. Handles of the model's bodies and joints find their places in
/// `observation_system(model).layout()`.
class AnyModel {
 public:
  /// Compiles what is asked of M, and its steps by each of the integrators Is; keeps the model.
  template <class M, class... Is>
  AnyModel(std::shared_ptr<M const> model, SteppedBy<Is...>)
      : reference_(model->reference_state()), system_(&questions<M>), census_(polybody::problem_size(*model)) {
    (runs_.push_back({&detail::integrator_tag<Is>, &systems<Is, M>}), ...);
    model_ = std::move(model);
  }

  State const& reference_state() const { return reference_; }  ///< the bodies as placed, at rest
  ProblemSize const& counts() const { return census_; }        ///< as counted when it was made
  /// The whole mechanism, with what is asked of its motion and its energies.
  System system() const { return system_(model_.get()); }

  /// \throws InvalidInput where the model was made without integrator I.
  template <class I>
  [[gnu::cold]] RunSystems systems_of() const {
    for (Run const& run : runs_)
      if (run.integrator == &detail::integrator_tag<I>) return run.make(model_.get());
    throw InvalidInput("system.missing_capability",
                       {"AnyModel was made without ", ErrorObject{I::name},
                        ". Give it to the constructor: AnyModel(model, stepped_by<...>)."});
  }

 private:
  struct Run {
    void const* integrator;
    RunSystems (*make)(void const*);
  };
  template <class M>
  [[gnu::cold]] static System questions(void const* model) {
    return System(*static_cast<M const*>(model), with<Capabilities::energy>);
  }
  template <class I, class M>
  [[gnu::cold]] static RunSystems systems(void const* model) {
    return run_systems<I>(*static_cast<M const*>(model));
  }

  std::shared_ptr<void const> model_;
  State reference_;
  System (*system_)(void const*);
  ProblemSize census_;
  Sequence<Run> runs_ = {};
};

/// The systems in which integrator I steps the model. \throws InvalidInput for an integrator that it was not made with.
template <class I>
RunSystems run_systems(AnyModel const& model) {
  return model.systems_of<I>();
}
/// A system that answers questions about a state.
inline System observation_system(AnyModel const& model) { return model.system(); }
/// Coordinates, rows and degrees of freedom as counted when the model was made.
inline ProblemSize problem_size(AnyModel const& model) { return model.counts(); }

}  // namespace polybody
