#pragma once
/// \file
/// Model with an erased C++ type.

#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {

/// List of integrator types for the constructor of `AnyModel`: `AnyModel(model, stepped_by<GeneralisedAlpha>)`.
template <class... Is>
struct SteppedBy {};
/// Constructor argument of `AnyModel` that lists the integrators Is.
template <class... Is>
inline constexpr SteppedBy<Is...> stepped_by{};

namespace detail {
template <class I>
inline constexpr char integrator_tag = 0;

/// Capabilities for runs by each of the integrators Is, and for evaluations of states. All systems of an `AnyModel`
/// have the same set, because each further set of a model takes time to compile.
template <class... Is>
inline constexpr Capabilities capabilities_for =
    ((Capabilities::energy | Capabilities::rigid_velocities) | ... | (entries_of<Is>() | warned<Is>));
}  // namespace detail

/// Type-erased model for runs, comparisons and records. Functions that take an `AnyModel` are compiled once for all
/// formulations:
///   AnyModel const model(std::make_shared<MyModel const>(my_model), stepped_by<GeneralisedAlpha, Radau>);
///   State x = model.reference_state();
///   simulate(model, x, Radau{}, {.end_time = 1.0, .step = 1e-3}).run();
/// `AnyModel` shares ownership of the model. `observation_system(model).layout()` gives the indices of the model's
/// bodies and joints for their handles.
class AnyModel {
 public:
  /// Stores the model, and functions that evaluate the model and step it with each of the integrators Is.
  template <class M, class... Is>
  AnyModel(std::shared_ptr<M const> model, SteppedBy<Is...>)
      : reference_(model->reference_state()),
        system_(&full_system<M, detail::capabilities_for<Is...>>),
        problem_size_(polybody::problem_size(*model)) {
    (runs_.push_back({&detail::integrator_tag<Is>, &systems<Is, M, detail::capabilities_for<Is...>>}), ...);
    model_ = std::move(model);
  }

  State const& reference_state() const { return reference_; }  ///< state with the bodies as built, at rest
  ProblemSize const& counts() const { return problem_size_; }  ///< problem size at construction
  /// System of the full model, for energies, powers and momenta of its states.
  System system() const { return system_(model_.get()); }
  SystemSource source() const { return {system_, model_.get()}; }  ///< source of systems of the full model

  /// Systems of a run by integrator I. \throws InvalidInput if the constructor was called without integrator I.
  template <class I>
  [[gnu::cold]] RunSystems systems_of() const {
    for (Run const& run : runs_)
      if (run.integrator == &detail::integrator_tag<I>) return run.make(model_.get());
    throw InvalidInput("system.missing_capability",
                       {"AnyModel was made without the integrator ", ErrorObject{I::name},
                        ". Add this integrator to the list in AnyModel(model, stepped_by<...>)."});
  }

 private:
  struct Run {
    void const* integrator;
    RunSystems (*make)(void const*);
  };
  template <class M, Capabilities all>
  [[gnu::cold]] static System full_system(void const* model) {
    return System(*static_cast<M const*>(model), with<all>);
  }
  template <class I, class M, Capabilities all>
  [[gnu::cold]] static RunSystems systems(void const* model) {
    return run_systems<I, all>(*static_cast<M const*>(model), {&full_system<M, all>, model});
  }

  std::shared_ptr<void const> model_;
  State reference_;
  System (*system_)(void const*);
  ProblemSize problem_size_;
  Sequence<Run> runs_ = {};
};

/// Systems of a run of the model by integrator I. \throws InvalidInput if the constructor was called without this
/// integrator.
template <class I>
RunSystems run_systems(AnyModel const& model) {
  return model.systems_of<I>();
}
/// System of the full model, for evaluations of its states.
inline System observation_system(AnyModel const& model) { return model.system(); }
/// Source of systems of the model that `model` contains.
inline SystemSource system_source(AnyModel const& model) { return model.source(); }
/// Coordinates, constraint equations and degrees of freedom of the model when the `AnyModel` was constructed.
inline ProblemSize problem_size(AnyModel const& model) { return model.counts(); }

}  // namespace polybody
