#pragma once
/// \file
/// The links of a track as floating frames with modes: of beam elements, or of a finite element model.
///
/// Not in polybody.hpp: of use to vehicles only, and it comes with Eigen's sparse module.

#include <map>

#include <polybody/bodies/ffr/attachment_modes.hpp>
#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/stress/structure_loads.hpp>
#include <polybody/vehicle/track_links.hpp>

namespace polybody::m113 {

/// A finite element model of a link about its centre, with the size of `link_bar`, and the basis in which it deforms.
struct FiniteElementLink {
  Structure structure;  ///< nodes and elements, in axes of the link from its centre
  MatX shapes;          ///< (N×n)

  /// The end face at the front pin (sign 1) or the rear pin (−1).
  template <class = void>  // compiled where it is used
  NodePatch pin(double sign) const {
    return patch([&](Vec3 const& r) { return sign * r.x() > 0.5 * pitch - same_place; });
  }
  /// The part of a side that is not farther than a sixth of the pitch ahead of x or behind.
  template <class = void>
  NodePatch part(double x, Face face) const {
    double const side = face == Face::wheels ? 1.0 : -1.0;
    return patch([&](Vec3 const& r) {
      return side * r.z() > 0.5 * cable_height - same_place && std::abs(r.x() - x) < pitch / 6.0 + same_place;
    });
  }
  /// The nodes at x.
  template <class = void>
  NodePatch section(double x) const {
    return patch([&](Vec3 const& r) { return std::abs(r.x() - x) < same_place; });
  }
  /// The nodes that bear what acts on a rigid link in its place, as they do on this one
  /// (`ContactsAct::at_their_places`).
  template <class = void>
  std::vector<LoadPatch> patches() const {
    std::vector<LoadPatch> found;
    for (double const sign : {-1.0, 1.0}) found.push_back({0.5 * sign * pitch * Vec3::UnitX(), pin(sign)});
    for (double const x : {-pitch / 3.0, 0.0, pitch / 3.0}) found.push_back({x * Vec3::UnitX(), part(x, Face::wheels)});
    for (double const x : {-pad[0].x, pad[0].x}) found.push_back({x * Vec3::UnitX(), part(x, Face::ground)});
    return found;
  }

 private:
  static constexpr double same_place = 1e-6;  ///< [m]

  /// Nodes that share a load as a line load along the pins does: those at one y have the length of that line which is
  /// nearest to it.
  template <class Chosen>
  NodePatch patch(Chosen const& chosen) const {
    std::vector<Index> nodes;
    std::map<long, double> counts;  // of nodes by y in millionths of a metre
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

/// With the static shapes of what pins, wheels and ground do to a link, and its three lowest free modes: forces and
/// moments but that about y at either pin, forces along z on each third of the inner face and at both ends of the pad.
/// \throws InvalidInput for nodes that leave a face without a patch, and as `attachment_modes`.
template <class = void>
std::shared_ptr<FiniteElementLink const> finite_element_link(Structure structure) {
  FiniteElementLink link{std::move(structure), {}};
  std::vector<LoadPatch> const patches = link.patches();
  Index const size = link.structure.size();
  MatX loads(size, 15);
  Index used = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    MatX const wrench = patches[k].nodes.loads(patches[k].at, size);
    for (int const c : k < 2 ? std::vector{0, 1, 2, 3, 5} : std::vector{2}) loads.col(used++) = wrench.col(c);
  }
  link.shapes = attachment_modes(link.structure, loads, 3);
  return std::make_shared<FiniteElementLink const>(std::move(link));
}

/// Without a finite element model two beam elements, unless more are asked for, with a boundary frame at each pin, the
/// floating frame tied to the rear one [Craig & Bampton 1968]: the six static shapes of the front pin's motion and the
/// three lowest modes between the pins: torsion, bending up and down, stretch. With one its pins move with its end
/// faces, and what touches it acts on parts of its inner and outer face.
template <>
struct LinkOf<Ffr> {
  static constexpr Index modes_between = 3;  ///< how many modes between fixed pins, those of the lowest frequencies

  std::shared_ptr<FiniteElementLink const> model = {};  ///< null: the link is made of beam elements
  FfrTerms terms = {};                                  ///< which terms of the floating frame's equations are kept
  double height = cable_height;                         ///< of the section of beam elements; a model has its own [m]

  /// A link with its centre at `at`: of the model, or of two beam `elements` or more. The `Solid` has no effect.
  template <class = void>
  Ffr make(Solid const&, Placement const& at, int elements) const;
  /// The front pin.
  template <class = void>
  Marker<Ffr> front(BodyHandle<Ffr> const& link) const {
    return pin(link, 1.0);
  }
  /// The rear pin.
  template <class = void>
  Marker<Ffr> rear(BodyHandle<Ffr> const& link) const {
    return pin(link, -1.0);
  }
  /// The middle of the inner face, of a link of beam elements the middle of its line.
  template <class = void>
  Marker<Ffr> middle(BodyHandle<Ffr> const& link) const {
    return under(link, 0.0, Face::wheels);
  }
  /// Where what touches `face` acts, `x` [m] ahead of the link's centre.
  template <class = void>
  Marker<Ffr> under(BodyHandle<Ffr> const& link, double x, Face face) const;
  /// At the front (sign 1) or the rear (−1).
  template <class = void>
  Marker<Ffr> pin(BodyHandle<Ffr> const& link, double sign) const;

  /// The link that was made last. Others like it share its constants, as their shapes cost an eigenproblem.
  struct Made {
    std::shared_ptr<FiniteElementLink const> model;  ///< its finite element model, or null
    FfrTerms terms;                                  ///< which terms of the equations it keeps
    double height;                                   ///< height of its section [m]
    int elements;                                    ///< how many elements were asked for
    Ffr link;                                        ///< the link, wherever it was placed
  };
  mutable std::shared_ptr<Made const> made = {};  ///< null as long as no link was made
};

template <class>
Ffr LinkOf<Ffr>::make(Solid const&, Placement const& at, int elements) const {
  bool const alike =
      made && made->model == model && made->terms == terms && made->height == height && made->elements == elements;
  if (!alike) {
    auto const first = [&] {
      if (model) return Ffr(model->structure, model->shapes, {.terms = terms});
      int const n = std::max(elements, 2);
      Structure structure = structure_of(link_bar({}, height), n);
      MatX shapes = craig_bampton(structure, {0, n}, modes_between);
      return Ffr(std::move(structure), std::move(shapes), {.terms = terms});
    };
    made = std::make_shared<Made const>(Made{model, terms, height, elements, first()});
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
