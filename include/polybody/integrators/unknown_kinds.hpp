#pragma once
/// \file
/// Kinds of unknowns of a time step, and the assemblies of bodies that joints and forces connect.

#include <string_view>

#include <polybody/system/system.hpp>

namespace polybody::detail {

/// Kinds of unknowns with comparable errors, of coordinates and of their rates.
enum class UnknownKind : unsigned char {
  length,    ///< component of a position in the world
  rotation,  ///< an angle, or an entry of a unit quaternion
  other      ///< any other: gradients, deformations, sliders, coordinates of unknown unit
};

/// Description of an unknown: its body, its kind, and the world axis of a position component; −1 for other kinds.
struct UnknownPlace {
  Index body = 0;
  UnknownKind kind = UnknownKind::other;
  signed char axis = -1;
};

/// Descriptions of the coordinates and velocities of bodies, without first-order states.
struct UnknownPlaces {
  Sequence<UnknownPlace> of_q, of_v;
};

/// Classifies the unknowns of a body by their units. Four coordinates without a unit are a quaternion if three
/// velocities in rad/s belong to them. Consecutive lengths, one for each world axis, are a position if they are the
/// first coordinates or if other coordinates follow. Lengths at the end of a body, after other coordinates, are
/// positions of sliders.
template <class = void>
[[gnu::cold]] void classify(BodyLayout const& body, Index velocities, UnknownPlace* of_q, UnknownPlace* of_v) {
  if (!body.units.of_coordinate) return;
  auto const unit = [&](Index i) { return std::string_view(body.units.of_coordinate(body.body, i)); };
  auto const turns = [&](Index j) {
    return body.units.of_velocity && std::string_view(body.units.of_velocity(body.body, j)) == "rad/s";
  };
  Index const axes = body.planar ? 2 : 3;
  for (Index i = 0, j = 0; i < body.coordinates && j < velocities;) {
    if (unit(i) == "m") {
      Index n = 1;
      while (n < axes && i + n < body.coordinates && unit(i + n) == "m") ++n;
      bool const position = n == axes && (i == 0 || i + n < body.coordinates);
      for (Index k = 0; k < n; ++k, ++i, ++j)
        if (position) of_q[i].kind = of_v[j].kind = UnknownKind::length, of_q[i].axis = of_v[j].axis = char(k);
    } else if (unit(i) == "1" && turns(j)) {
      for (Index k = 0; k < 4; ++k) of_q[i++].kind = UnknownKind::rotation;
      for (Index k = 0; k < 3; ++k) of_v[j++].kind = UnknownKind::rotation;
    } else {
      if (unit(i) == "rad") of_q[i].kind = of_v[j].kind = UnknownKind::rotation;
      ++i, ++j;
    }
  }
}

/// Descriptions of the unknowns of the full model.
template <class = void>
[[gnu::cold]] UnknownPlaces full_places(ModelLayout const& layout) {
  UnknownPlaces out{Sequence<UnknownPlace>(std::size_t(layout.coordinates)),
                    Sequence<UnknownPlace>(std::size_t(layout.body_velocities()))};
  for (std::size_t k = 0; k < layout.bodies.size(); ++k) {
    BodyLayout const& b = layout.bodies[k];
    Index const velocities = std::min(b.velocities, layout.body_velocities() - b.v0);  // first-order states follow
    for (Index i = 0; i < b.coordinates; ++i) out.of_q[std::size_t(b.q0 + i)].body = Index(k);
    for (Index i = 0; i < velocities; ++i) out.of_v[std::size_t(b.v0 + i)].body = Index(k);
    classify(b, velocities, out.of_q.data() + b.q0, out.of_v.data() + b.v0);
  }
  return out;
}

/// Descriptions of the unknowns of a time step, from those of the full model.
template <class = void>
[[gnu::cold]] UnknownPlaces stepped_places(System const& system, UnknownPlaces const& full) {
  ReducedLayout const& n = *system.step_coordinates().reduced;
  UnknownPlaces out{Sequence<UnknownPlace>(std::size_t(n.coordinates)),
                    Sequence<UnknownPlace>(std::size_t(n.velocities - system.layout().states))};
  auto& [of_q, of_v] = out;
  for (std::size_t k = 0; k < n.places.size(); ++k) {
    ReducedPosition const& at = n.places[k];
    BodyLayout const& body = system.layout().bodies[k];
    for (Index i = 0; i < at.velocities; ++i) {
      UnknownPlace& kind = of_v[std::size_t(at.v + i)];
      if (at.kind != ReducedPosition::Kind::carried)
        kind = full.of_v[std::size_t(n.full_velocity[std::size_t(at.v + i)])];
      kind.body = Index(k);
    }
    for (Index i = 0; i < at.coordinates; ++i) {
      UnknownPlace& kind = of_q[std::size_t(at.q + i)];
      if (at.kind == ReducedPosition::Kind::as_it_is) kind = full.of_q[std::size_t(body.q0 + i)];
      if (at.kind == ReducedPosition::Kind::reduced) kind = of_v[std::size_t(at.v + i)];  // additive
      kind.body = Index(k);
    }
  }
  for (ReducedLayout::Turn const& turn : n.turns) {
    for (Index i = 0; i < turn.coordinates; ++i) of_q[std::size_t(turn.q + i)].kind = UnknownKind::rotation;
    for (Index i = 0; i < turn.velocities; ++i) of_v[std::size_t(turn.v + i)].kind = UnknownKind::rotation;
  }
  return out;
}

/// Index of the assembly of each body. Joints and forces connect the bodies of an assembly.
template <class = void>
[[gnu::cold]] Sequence<Index> assemblies_of(ModelLayout const& layout) {
  Sequence<Index> root(layout.bodies.size());
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = Index(i);
  auto const find = [&](Index i) {
    while (root[std::size_t(i)] != i) i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
    return i;
  };
  auto const owner = [&](Index marker) { return marker < 0 ? Index(-1) : layout.owners[std::size_t(marker)]; };
  auto const join = [&](Index a, Index b) {
    if (a >= 0 && b >= 0) root[std::size_t(find(a))] = find(b);
  };
  for (JointLayout const& j : layout.joints) join(owner(j.a), owner(j.b));
  for (ForceLayout const& f : layout.forces) {
    Index last = -1;
    for (Index const marker : f.markers) {
      join(owner(marker), last);
      if (owner(marker) >= 0) last = owner(marker);
    }
  }
  Sequence<Index> number(root.size(), -1), of(root.size());
  Index count = 0;
  for (std::size_t i = 0; i < root.size(); ++i) {
    Index& n = number[std::size_t(find(Index(i)))];
    if (n < 0) n = count++;
    of[i] = n;
  }
  return of;
}

}  // namespace polybody::detail
