#pragma once
/// \file
/// `System`, the interface between models and algorithms: the class (`basic_system.hpp`), its member functions
/// (`system_operations.hpp`) and related free functions.

#include <polybody/math/sequence.hpp>
#include <polybody/system/system_operations.hpp>

namespace polybody {

/// Equations of a model or of a user for integrators, solvers and analyses: `BasicSystem` with scalar double.
using System = BasicSystem<double>;

/// Computes the reduced state of a time step from the full state x. The result is exact if x satisfies the constraint
/// equations of the eliminated joints. If policies eliminate unknowns, the result has no integrator history.
template <class = void>
State reduce(System const& s, State const& x) {
  State out = x;
  if (Coordinates const& c = s.step_coordinates()) c.entries->reduced(c.self.get(), x, out);
  return out;
}
/// Number of multipliers that a step can store: those of its constraint equations, and estimates for eliminated joints
/// (`ReducedLayout::eliminated_equations`).
inline Index multipliers_of(System const& s) {
  return s.rows() + (s.step_coordinates() ? Index(s.step_coordinates().reduced->eliminated_equations.size()) : 0);
}
/// Converts the reduced state `stepped` to the full state x. Multipliers of eliminated joints are copied if `stepped`
/// contains them, and otherwise computed. `r` is workspace.
template <StateScalar T>
void expand(BasicSystem<T>& s, StateOf<T> const& stepped, StateOf<T>& x, VecXOf<T>& r) {
  CoordinatesOf<T> const& c = s.step_coordinates();
  if (!c) {
    x = stepped;
    return;
  }
  bool const keeps = stepped.lambda.size() == s.layout().rows;
  x.q.resize(s.layout().coordinates);
  x.v.resize(s.layout().velocities);
  x.a.resize(x.v.size());
  x.lambda.resize(s.layout().rows);
  if (keeps) {
    c.entries->expand(c.self.get(), stepped.q, stepped.v, x.q, x.v);
  } else {
    s.evaluate(stepped.q, stepped.v, stepped.t);
    x.q = s.at().q;
    x.v = s.at().v;
    r.resize(s.velocities());
    s.residual(stepped.a, stepped.lambda, r);
  }
  c.entries->expand_rates(c.self.get(), stepped.a, true, x.a);
  c.reduced->expand_rows(stepped.lambda, x.lambda);
  if (!keeps) c.entries->recover_multipliers(c.self.get(), s.data(), x.lambda);
  x.t = stepped.t;
  x.history = stepped.history;
}

/// Appends estimates of the multipliers of eliminated joints to the multipliers of a reduced state. Its accelerations
/// must be known.
template <class = void>
[[gnu::cold]] void append_multipliers(System& s, State& stepped) {
  if (multipliers_of(s) == s.rows()) return;
  Coordinates const& c = s.step_coordinates();
  VecX full = VecX::Zero(s.layout().rows), r(s.velocities());
  s.evaluate(stepped.q, stepped.v, stepped.t);
  s.residual(stepped.a, stepped.lambda, r);
  c.entries->recover_multipliers(c.self.get(), s.data(), full);
  VecX all(multipliers_of(s));
  std::copy_n(stepped.lambda.data(), s.rows(), all.data());
  Index at = s.rows();
  for (Index const row : c.reduced->eliminated_equations) all[at++] = full[row];
  stepped.lambda.swap(all);
}

/// Writes q̇ for the generalised velocities v to `rate`. `workspace` has 2 nq + nv entries, with nq and nv of the full
/// model.
template <class = void>
void coordinate_rates(System const& s, VecX const& q, VecX const& v, VecXOf<Dual<1>>& workspace, VecX& rate) {
  Coordinates const& c = s.step_coordinates();
  if (c) c.entries->coordinate_rates(c.self.get(), q, v, rate);
  auto const& [entries, model] = s.entries();
  require_entry(entries.coordinate_rates, "rates of coordinates")(model, c ? c.reduced->places.data() : nullptr, q, v,
                                                                  workspace, rate);
}

/// Name of the body to which coordinate i of a time step belongs.
template <class = void>
std::string name_of_coordinate(System const& s, Index i) {
  Coordinates const& c = s.step_coordinates();
  Sequence<BodyLayout> const& bodies = s.layout().bodies;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    Index const first = c ? c.reduced->places[k].q : bodies[k].q0;
    Index const count = c ? c.reduced->places[k].coordinates : bodies[k].coordinates;
    if (i >= first && i < first + count) return sentence_of({"body \"", bodies[k].name, "\""});
  }
  return "unknown";
}

/// True if M does not depend on q.
inline bool has_constant_mass(System const& s) {
  return s.layout().constant_mass && (!s.step_coordinates() || s.step_coordinates().reduced->keeps_mass_constant);
}

}  // namespace polybody
