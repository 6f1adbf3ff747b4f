#pragma once
/// \file
/// Track links in a floating frame with modes, from beam elements or from a finite element model. Requires Eigen's
/// sparse module.

#include <map>
#include <optional>

#include <polybody/bodies/ffr/attachment_modes.hpp>
#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/stress/structure_loads.hpp>

#include "links.hpp"

namespace polybody::m113 {

/// Finite element model of a link about its centre, with the dimensions of `link_bar`, and the shapes of its
/// deformation.
struct FiniteElementLink {
  Structure structure;  ///< nodes and elements, in axes of the link from its centre
  MatX shapes;          ///< (N×n) shapes of the deformation

  /// Nodes of the end face at the front pin (sign 1) or at the rear pin (−1).
  template <class = void>  // compiled only if it is used
  NodePatch pin(double sign) const {
    return patch([&](Vec3 const& r) { return sign * r.x() > 0.5 * pitch - same_place; });
  }
  /// Nodes of a face within a sixth of the pitch from x.
  template <class = void>
  NodePatch part(double x, Face face) const {
    double const side = face == Face::wheels ? 1.0 : -1.0;
    return patch([&](Vec3 const& r) {
      return side * r.z() > 0.5 * cable_height - same_place && std::abs(r.x() - x) < pitch / 6.0 + same_place;
    });
  }
  /// Nodes of the cross section at x.
  template <class = void>
  NodePatch section(double x) const {
    return patch([&](Vec3 const& r) { return std::abs(r.x() - x) < same_place; });
  }
  /// Nodes that carry the loads that act on a rigid link at the same points (`ContactsAct::at_their_places`).
  template <class = void>
  std::vector<LoadPatch> patches() const {
    std::vector<LoadPatch> found;
    for (double const sign : {-1.0, 1.0}) found.push_back({0.5 * sign * pitch * Vec3::UnitX(), pin(sign)});
    for (double const x : {-pitch / 3.0, 0.0, pitch / 3.0}) found.push_back({x * Vec3::UnitX(), part(x, Face::wheels)});
    for (double const x : {-pad[0].x, pad[0].x}) found.push_back({x * Vec3::UnitX(), part(x, Face::ground)});
    return found;
  }

 private:
  static constexpr double same_place = 1e-6;  ///< tolerance of positions [m]

  /// Nodes with weights that distribute a load as a line load along the pins. Nodes at the same y carry the part of the
  /// line that is nearest to this y.
  template <class Chosen>
  NodePatch patch(Chosen const& chosen) const {
    std::vector<Index> nodes;
    std::map<long, double> counts;  // number of nodes for each y in millionths of a metre
    auto const line = [&](Index i) { return std::lround(structure.nodes[std::size_t(i)].y() / same_place); };
    for (std::size_t i = 0; i < structure.nodes.size(); ++i)
      if (chosen(structure.nodes[i])) {
        nodes.push_back(Index(i));
        ++counts[line(Index(i))];
      }
    std::vector<double> weights;
    for (Index const i : nodes) {
      auto const at = counts.find(line(i));
      double const before = at == counts.begin() ? double(at->first) : double(std::prev(at)->first);
      double const after = std::next(at) == counts.end() ? double(at->first) : double(std::next(at)->first);
      weights.push_back(std::max(0.5 * (after - before), 1.0) / at->second);
    }
    return NodePatch(structure, std::move(nodes), "M113: a finite element link", std::move(weights));
  }
};

/// Finite element link with static shapes under the loads of pins, wheels and ground, and with the lowest free
/// `modes`. The loads at either pin are all forces, and the moments about x and z. The other loads are forces along z
/// on each third of the inner face and at both ends of the pad. \throws InvalidInput if a face has no nodes for its
/// patch, and as `attachment_modes`.
template <class = void>
std::shared_ptr<FiniteElementLink const> finite_element_link(Structure structure, Index modes = 3) {
  FiniteElementLink link{std::move(structure), {}};
  std::vector<LoadPatch> const patches = link.patches();
  Index const size = link.structure.size();
  MatX loads(size, 15);
  Index used = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    MatX const wrench = patches[k].nodes.loads(patches[k].at, size);
    for (int const c : k < 2 ? std::vector{0, 1, 2, 3, 5} : std::vector{2}) loads.col(used++) = wrench.col(c);
  }
  link.shapes = attachment_modes(link.structure, loads, modes);
  return std::make_shared<FiniteElementLink const>(std::move(link));
}

/// Links in a floating frame with modes. Without a finite element model, a link has at least two beam elements and a
/// boundary frame at each pin. The floating frame is attached to the rear boundary frame [Craig & Bampton 1968]. The
/// shapes are the six static shapes of the front pin's motion, and the lowest modes with fixed pins. The three lowest
/// modes are torsion, vertical bending and axial stretch. With a finite element model, the pins move with the end
/// faces, and contact forces act on parts of the inner and outer faces.
template <>
struct LinkOf<Ffr> {
  std::shared_ptr<FiniteElementLink const> model = {};  ///< null: the link consists of beam elements
  FfrTerms terms = {};                                  ///< terms of the floating frame's equations that are included
  double height = cable_height;  ///< height of the section of beam elements; not used with a finite element model [m]
  /// Number of fixed-interface modes of beam elements, those of the lowest frequencies. If empty, the coordinates of
  /// the nodes replace the shapes. Not used with a finite element model.
  std::optional<Index> modes = 3;

  /// Link with its centre at `at`, from the finite element model or from at least two beam `elements`. The `Solid` has
  /// no effect.
  template <class = void>
  Ffr make(Solid const&, Placement const& at, int elements) const;
  /// Front pin.
  template <class = void>
  Marker<Ffr> front(BodyHandle<Ffr> const& link) const {
    return pin(link, 1.0);
  }
  /// Rear pin.
  template <class = void>
  Marker<Ffr> rear(BodyHandle<Ffr> const& link) const {
    return pin(link, -1.0);
  }
  /// Middle of the inner face; for a link of beam elements, midpoint of the beam axis.
  template <class = void>
  Marker<Ffr> middle(BodyHandle<Ffr> const& link) const {
    return under(link, 0.0, Face::wheels);
  }
  /// Point of action of contact forces on `face`, at the distance `x` [m] in front of the link's centre.
  template <class = void>
  Marker<Ffr> under(BodyHandle<Ffr> const& link, double x, Face face) const;
  /// Pin at the front (sign 1) or at the rear (−1).
  template <class = void>
  Marker<Ffr> pin(BodyHandle<Ffr> const& link, double sign) const;

  /// Constants of the link that was made last. Links with the same data share these constants, because the shapes
  /// require the solution of an eigenvalue problem.
  struct Made {
    std::shared_ptr<FiniteElementLink const> model;  ///< finite element model of the link, or null
    FfrTerms terms;                                  ///< terms of the equations that are included
    double height;                                   ///< height of the section [m]
    std::optional<Index> modes;                      ///< number of fixed-interface modes, or empty
    int elements;                                    ///< number of elements passed to `make`
    Ffr link;                                        ///< the link, at any placement
  };
  mutable std::shared_ptr<Made const> made = {};  ///< null until a link is made
};

template <class>
Ffr LinkOf<Ffr>::make(Solid const&, Placement const& at, int elements) const {
  bool const alike = made && made->model == model && made->terms == terms && made->height == height &&
                     made->modes == modes && made->elements == elements;
  if (!alike) {
    auto const first = [&] {
      if (model) return Ffr(model->structure, model->shapes, {.terms = terms});
      int const n = std::max(elements, 2);
      Structure structure = structure_of(link_bar({}, height), n);
      MatX shapes = modes ? craig_bampton(structure, {0, n}, *modes)
                          : nodal_coordinates(structure, ReferenceConditions::clamped());
      return Ffr(std::move(structure), std::move(shapes), {.terms = terms});
    };
    made = std::make_shared<Made const>(Made{model, terms, height, modes, elements, first()});
  }
  return made->link.placed(model ? at : link_bar(at, height).placement);
}
template <class>
Marker<Ffr> LinkOf<Ffr>::under(BodyHandle<Ffr> const& link, double x, Face face) const {
  if (!model) return link.at(0.5 * pitch + x);
  return link.at(link.body().patch(model->part(x, face), Vec3(x, 0, 0)));
}
template <class>
Marker<Ffr> LinkOf<Ffr>::pin(BodyHandle<Ffr> const& link, double sign) const {
  if (!model) return link.at(sign > 0.0 ? link.body().length() : 0.0);
  return link.at(link.body().patch(model->pin(sign), Vec3(0.5 * sign * pitch, 0, 0)));
}

}  // namespace polybody::m113
