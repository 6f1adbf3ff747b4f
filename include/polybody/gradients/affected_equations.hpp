#pragma once
/// \file
/// Equations of a time step that depend on a parameter, found from the names of objects in `Parameter::affects`.

#include <algorithm>
#include <string>
#include <vector>

#include <polybody/gradients/parameter.hpp>
#include <polybody/system/system.hpp>

namespace polybody::detail {

/// Flags of the equations of the full model: nonzero if an equation depends on the parameter. Equations of motion, in
/// the order of the velocities, precede constraint equations. \throws InvalidInput if a name in
/// `affects` belongs to no object of the model.
template <class = void>
std::vector<char> affected_in_full(ModelLayout const& layout, Parameter const& p) {
  std::vector<char> affected(std::size_t(layout.velocities + layout.rows), p.affects.empty());
  auto const mark = [&](Index first, Index count) {
    for (Index i = first; i < first + count; ++i) affected[std::size_t(i)] = 1;
  };
  auto const mark_owner = [&](Index marker) {
    if (Index const body = marker < 0 ? -1 : layout.owners[std::size_t(marker)]; body >= 0)
      mark(layout.bodies[std::size_t(body)].v0, layout.bodies[std::size_t(body)].velocities);
  };
  for (std::string const& name : p.affects) {
    bool found = false;
    for (BodyLayout const& b : layout.bodies)
      if (b.name == name) {
        mark(b.v0, b.velocities);
        if (b.rows > 0) mark(layout.velocities + b.row, b.rows);
        found = true;
      }
    for (JointLayout const& j : layout.joints)
      if (j.name == name) {
        if (j.rows > 0) mark(layout.velocities + j.row, j.rows);
        mark_owner(j.a);
        mark_owner(j.b);
        found = true;
      }
    for (ForceLayout const& f : layout.forces)
      if (f.name == name) {
        if (f.states > 0) mark(f.v0, f.states);
        for (Index const marker : f.markers) mark_owner(marker);
        found = true;
      }
    if (!found)
      throw InvalidInput("parameter.affects", {"Parameter \"", ErrorObject{p.name}, "\" affects \"", name,
                                               "\", but the model has no body, joint or force of that name."});
  }
  return affected;
}
/// Flags of the equations of a time step, from the flags `full` of the full model. Forces on eliminated coordinates act
/// on the independent coordinates. If an eliminated joint depends on the parameter, all equations are flagged, because
/// the elimination may change. With joint coordinates all equations are flagged, because the assignment of full to
/// reduced equations depends on the configuration.
template <class = void>
std::vector<char> affected_in_step(System const& system, std::vector<char> const& full) {
  Coordinates const& c = system.step_coordinates();
  if (!c) return full;
  if (!c.reduced->keeps_mass_constant) return std::vector<char>(std::size_t(system.size()), 1);
  Index const velocities = system.layout().velocities;
  std::vector<char> affected(std::size_t(system.size()), 0), stays(full.size(), 0);
  for (std::size_t i = 0; i < c.reduced->remaining_equations.size(); ++i) {
    std::size_t const row = std::size_t(velocities + c.reduced->remaining_equations[i]);
    stays[row] = 1;
    affected[std::size_t(system.velocities()) + i] = full[row];
  }
  VecX force(velocities), reduced(system.velocities());
  for (Index i = 0; i < Index(full.size()); ++i) {
    if (!full[std::size_t(i)]) continue;
    if (i >= velocities && !stays[std::size_t(i)]) return std::vector<char>(affected.size(), 1);
    if (i >= velocities) continue;
    force.setZero();
    force[i] = 1.0;
    c->reduce(force, reduced);
    for (Index k = 0; k < reduced.size(); ++k)
      if (reduced[k] != 0.0) affected[std::size_t(k)] = 1;
  }
  return affected;
}
/// Indices of the equations of a step that depend on a parameter, ascending. Equations of motion, in the order of the
/// velocities, precede constraint equations. \throws InvalidInput if a name in `affects` belongs to no object of the
/// model.
template <class = void>
std::vector<Index> affected_equations(System const& system, Parameter const& p) {
  std::vector<char> const affected = affected_in_step(system, affected_in_full(system.layout(), p));
  std::vector<Index> equations;
  for (std::size_t i = 0; i < affected.size(); ++i)
    if (affected[i]) equations.push_back(Index(i));
  return equations;
}

/// List for a message: at most five objects that act on equation i of a step and that `affects` does not contain, for
/// example `body "rod", force "spring"`.
template <class = void>
[[gnu::cold]] std::string unnamed_at(System const& system, Parameter const& p, Index i) {
  std::string list;
  std::size_t count = 0;
  auto const look = [&](char const* kind, std::string const& name) {
    if (std::find(p.affects.begin(), p.affects.end(), name) != p.affects.end()) return;
    std::vector<Index> const of = affected_equations(system, {.name = p.name, .affects = {name}});
    if (!std::binary_search(of.begin(), of.end(), i) || ++count > 5) return;
    list += sentence_of({list.empty() ? "" : ", ", kind, " \"", name, "\""});
  };
  for (BodyLayout const& b : system.layout().bodies) look("body", b.name);
  for (JointLayout const& j : system.layout().joints) look("joint", j.name);
  for (ForceLayout const& f : system.layout().forces) look("force", f.name);
  return count > 5 ? sentence_of({list, " and ", count - 5, " more"}) : list;
}

/// \throws InvalidInput always: parameter p changes equation i at time t [s], but its `affects` contains no object that
/// acts on this equation.
template <class = void>
[[noreturn, gnu::cold]] void refuse_unnamed(System const& system, Parameter const& p, Index i, double t) {
  throw InvalidInput(
      "parameter.affects",
      {"Parameter \"", ErrorObject{p.name}, "\" changes the equations of ", system.name_of(i), " at t = ", ErrorTime{t},
       " s, but its `affects` contains no object that acts there. Add the object that depends on the parameter (",
       unnamed_at(system, p, i), "), or leave `affects` empty."});
}

}  // namespace polybody::detail
