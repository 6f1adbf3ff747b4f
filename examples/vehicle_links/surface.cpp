#include "surface.hpp"

#include <polybody/bodies/ffr/matrix_structure.hpp>
#include <polybody/stress/decoupled_stress.hpp>
#include <polybody/stress/nodal_stress.hpp>

#include "m113/modal_links.hpp"

namespace chapter3 {

namespace {

struct Surface {
  std::shared_ptr<m113::FiniteElementLink const> link;
  NodalStress stress;
  MatX by_modes;  // (6k×n) stress at the k named nodes for unit coordinates of the n shapes of `link` [Pa]
  VecX strain;    // (n) axial strain of the middle two thirds: relative change of the distance of two planes of nodes
  VecX bending;   // (n) strain by bending in the middle, in the fibre towards the wheels
};

Surface const& surface(LinkSettings const& o) {
  static std::map<std::pair<std::string, Index>, Surface> read;
  std::pair const key(o.files, o.modes.value_or(3));
  if (auto const found = read.find(key); found != read.end()) return found->second;
  auto const file = [&](char const* name) { return (fs::path(o.files) / name).string(); };
  auto const link = m113::finite_element_link(
      read_structure(file("link.mass.mtx"), file("link.stiffness.mtx"), file("link.nodes.txt")), key.second);
  NodalStress const stress =
      NodalStress::read(file("link.stress.mtx"), file("link.stress_nodes.txt"), link->structure.size());
  auto const along = [&](char const* name) -> VecX {
    VecX out(link->shapes.cols());
    for (Index k = 0; k < out.size(); ++k) out[k] = stress.of(name, link->shapes.col(k))[0][0];
    return out;
  };
  VecX const bending = (along("middle, wheel side") - along("middle, ground side")) / (2.0 * m113::youngs_modulus);
  double const third = m113::pitch / 3.0;
  auto const moved = [&](double x) -> VecX {
    return link->section(x).motion(x * Vec3::UnitX(), link->shapes).displacement.row(0);
  };
  VecX const strain = (moved(third) - moved(-third)) / (2.0 * third);
  return read.emplace(key, Surface{link, stress, stress.matrix() * link->shapes, strain, bending}).first->second;
}

}  // namespace

std::shared_ptr<m113::FiniteElementLink const> finite_element_link(LinkSettings const& o) { return surface(o).link; }

void add_surface(LinkHistory& h, LinkSettings const& o, BodyRecord const& record) {
  Surface const& s = surface(o);
  DecoupledStress const stress =
      DecoupledStress::quasi_static(s.link->structure, record, {.patches = s.link->patches()});
  for (NodalStress::Spot const& spot : s.stress.spots())
    h.surface[spot.name] = s.stress.von_mises(spot.name, stress.displacements());
}

void add_surface(LinkHistory& h, LinkSettings const& o, Eigen::Ref<VecX const> const& q) {
  Surface const& s = surface(o);
  VecX const stress = s.by_modes * q;
  Index row = 0;
  for (NodalStress::Spot const& spot : s.stress.spots()) {
    h.surface[spot.name].push_back(von_mises(stress.segment<6>(row)));
    row += 6;
  }
  h.strain.push_back(s.strain.dot(q));
  h.bending.push_back(s.bending.dot(q));
}

}  // namespace chapter3
