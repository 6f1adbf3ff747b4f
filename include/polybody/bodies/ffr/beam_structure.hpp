#pragma once
/// \file
/// Structures made of bars: space beam element of thesis App. A [Przemieniecki 1968, §5.6, §11.4]. The code corrects
/// errata of Eq. A.1: rows 11 and 12 contain −2ξ + 3ξ² and 2ξ − 3ξ². The intermediate element frames of Eqs. A.2–A.3
/// permit any direction of an element.
///
/// Not in polybody.hpp: Eigen's sparse module and factorisations take seconds to compile.

#include <polybody/bodies/ffr/beam_element.hpp>

namespace polybody {

/// Axes of the intermediate element frame of a beam along `direction`, by Eq. A.2, which keeps z normal to the y axis
/// of the body. If the beam is parallel to the y axis of the body, Eq. A.3 applies.
/// \throws InvalidInput for a zero direction.
template <class = void>  // compiled only if used
Mat3 intermediate_axes(Vec3 const& direction) {
  double const length = direction.norm();
  if (!(length > 0.0))
    throw InvalidInput("structure.beam", {ErrorObject{"Structure"}, ": a beam needs two different nodes."});
  Vec3 const c = direction / length;
  double const level = std::hypot(c[0], c[2]);
  Mat3 axes;
  if (level > 1e-8)
    axes << c[0], -c[0] * c[1] / level, -c[2] / level, c[1], level, 0.0, c[2], -c[1] * c[2] / level, c[0] / level;
  else
    axes << 0.0, -std::copysign(1.0, c[1]), 0.0, std::copysign(1.0, c[1]), 0.0, 0.0, 0.0, 0.0, 1.0;
  return axes;
}

namespace detail {

/// Integral ∫ρ u₀ₖ S_l over one beam (12); ∫ρ S_l for k = −1.
template <class = void>
Vec<double, 12> spread_moment(Structure const& s, Structure::Beam const& beam, int k, int l) {
  Vec<double, 12> sum = Vec<double, 12>::Zero();
  for (MassPoint const& p : mass_points(s, beam))
    for (int j = 0; j < 12; ++j) {
      sum[j] += p.m * (k < 0 ? 1.0 : p.at[k]) * p.axis(l, j);
      if (k >= 0) sum[j] += p.my * beam.axes(k, 1) * p.y(l, j) + p.mz * beam.axes(k, 2) * p.z(l, j);
    }
  return sum;
}

/// Adds the inertia of a beam to the integrals of `Structure`.
template <class = void>
void add_inertia(Structure& s, Structure::Beam const& beam,
                 std::array<std::vector<Eigen::Triplet<double>>, 6>& entries) {
  std::array<BeamMatrix, 6> inertia;
  for (BeamMatrix& m : inertia) m.setZero();
  for (MassPoint const& g : mass_points(s, beam)) {
    s.mass += g.m;
    for (int k = 0; k < 3; ++k) {
      s.first[k] += g.m * g.at[k];
      for (int l = 0; l < 3; ++l)
        s.second(k, l) += g.m * g.at[k] * g.at[l] + g.my * beam.axes(k, 1) * beam.axes(l, 1) +
                          g.mz * beam.axes(k, 2) * beam.axes(l, 2);
    }
    for (std::size_t p = 0; p < 6; ++p) {
      int const k = symmetric_row[p], l = symmetric_column[p];
      add_product(g.m, g.axis, k, g.axis, l, inertia[p]);
      add_product(g.my, g.y, k, g.y, l, inertia[p]);
      add_product(g.mz, g.z, k, g.z, l, inertia[p]);
    }
  }
  for (std::size_t p = 0; p < 6; ++p) add_entries(beam, inertia[p], entries[p]);
  for (int l = 0; l < 3; ++l) {
    add_entries(beam, spread_moment(s, beam, -1, l), s.translation[std::size_t(l)]);
    for (int k = 0; k < 3; ++k)
      add_entries(beam, spread_moment(s, beam, k, l), s.moment[std::size_t(k)][std::size_t(l)]);
  }
}

}  // namespace detail

/// Ends of bars are one node if their distance is smaller than this fraction of the length of the longest bar.
inline constexpr double same_node = 1e-9;

/// Structure of `bars`, each divided into the number of elements given by `elements`, welded at common ends. The
/// placements are in the axes of the body. The damping of the bars is Kelvin–Voigt damping. A pretension contributes
/// its first-order force and its stiffness.
/// \throws InvalidInput for no bar, fewer than one element, or a bar without torsional stiffness GJ.
template <class = void>
Structure structure_of(std::vector<Bar> const& bars, std::vector<Index> const& elements) {
  if (bars.empty() || bars.size() != elements.size())
    throw InvalidInput("structure.beam", {ErrorObject{"Structure"},
                                          ": at least one bar is needed, and a number of elements for each bar."});
  Structure s;
  double longest = 0.0;
  for (Bar const& bar : bars) longest = std::max(longest, double(bar.length));
  auto const node_at = [&](Vec3 const& r) {
    for (std::size_t i = 0; i < s.nodes.size(); ++i)
      if ((s.nodes[i] - r).norm() < same_node * longest) return Index(i);
    s.nodes.push_back(r);
    return Index(s.nodes.size()) - 1;
  };
  std::vector<Damping> dampings;
  std::vector<double> forces;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    Bar const& bar = bars[i];
    BarConstants const c = constants(bar);
    require_polar_inertia_of_points(c, "Structure");
    require_elements(elements[i], "Structure: bar " + std::to_string(i + 1));
    require_positive(c.GJ, "Structure: GJ of a bar (a floating frame in space resists torsion)");
    double const l = bar.length / double(elements[i]);
    for (Index e = 0; e < elements[i]; ++e) {
      auto const end = [&](Index k) {
        return Vec3(bar.placement.origin + bar.placement.axes.col(0) * (l * double(k)));
      };
      Index const a = node_at(end(e)), b = node_at(end(e + 1));
      s.beams.push_back({a, b, bar.placement.axes, l, c, Index(i), l * double(e)});
      dampings.push_back(bar.damping);
      forces.push_back(bar.pretension);
    }
    s.bar_lengths.push_back(bar.length);
  }
  s.clear();
  std::vector<Eigen::Triplet<double>> stiffness, damping;
  std::array<std::vector<Eigen::Triplet<double>>, 6> inertia;
  for (std::size_t i = 0; i < s.beams.size(); ++i) {
    Structure::Beam const& beam = s.beams[i];
    Vec4 const c = section_stiffness(beam.constants);
    Damping const& d = dampings[i];
    add_entries(beam, beam_stiffness(beam, c), stiffness);
    add_entries(beam, beam_stiffness(beam, c.cwiseProduct(Vec4(d.axial, d.shear, d.bending, d.bending))), damping);
    if (forces[i] != 0.0) {
      add_entries(beam, axial_force_stiffness(beam, forces[i]), stiffness);
      Vec<double, 12> pull = Vec<double, 12>::Zero();
      for (int k = 0; k < 3; ++k) pull[6 + k] = -(pull[k] = -forces[i] * beam.axes(k, 0));
      add_entries(beam, pull, s.initial_force);
    }
    detail::add_inertia(s, beam, inertia);
  }
  s.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
  s.damping.setFromTriplets(damping.begin(), damping.end());
  for (std::size_t p = 0; p < 6; ++p) s.inertia[p].setFromTriplets(inertia[p].begin(), inertia[p].end());
  return s;
}

/// Structure of one bar in n equal elements, in the axes of the bar, with nodes 0 … n. The placement of the bar is
/// omitted; use it as the placement of the body.
template <class = void>
Structure structure_of(Bar bar, Index n) {
  bar.placement = {};
  return structure_of(std::vector{bar}, {n});
}

/// Geometric stiffness K_G = ∫ N (v′ᵀv′ + w′ᵀw′) dx over all beams. The axial forces N are due to a load on the
/// structure, held at one node [Wallrapp & Schwertassek 1991]. eᵀ K_G e is twice the second-order work of the load: eᵀ
/// K_G e = 2 Σ load · (displacement by axial foreshortening).
class AxialForceStiffness {
 public:
  /// Holds all six coordinates of `node`.
  /// \throws InvalidInput for a structure that is not made of beams, or not connected.
  template <class = void>
  explicit AxialForceStiffness(Structure const& s, Index node = 0) : structure_(&s) {
    if (s.beams.empty())
      throw InvalidInput(
          "structure.no_beams",
          {ErrorObject{"Structure"},
           ": geometric stiffening needs beams, because the axial forces of a structure from matrices are unknown."});
    s.require_node(node, "Structure: the held node");
    Structure::Sparse k = s.stiffness;
    Index const first = 6 * node;
    k.prune([&](Index i, Index j, double) { return i / 6 != node && j / 6 != node; });
    for (Index i = 0; i < 6; ++i) k.coeffRef(fixed_[i] = first + i, first + i) = 1.0;
    solver_.compute(k);
    if (solver_.info() != Eigen::Success || solver_.vectorD().minCoeff() <= 0.0)
      throw InvalidInput(
          "structure.not_joined",
          {ErrorObject{"Structure"}, ": not all beams are connected, or their stiffness is not positive."});
  }

  /// Geometric stiffness due to one load: `load` (N) at the nodes, and `spread(beam)`, the nodal forces (12, body axes)
  /// equivalent to the load within the beam.
  template <class Spread>
  Structure::Sparse operator()(VecX const& load, Spread&& spread) const {
    Structure const& s = *structure_;
    VecX x = load;
    for (Index const i : fixed_) x[i] = 0.0;
    x = solver_.solve(x).eval();
    std::vector<Eigen::Triplet<double>> entries;
    for (Structure::Beam const& beam : s.beams) {
      BeamMatrix const stiff = beam_stiffness(beam, section_stiffness(beam.constants));
      Vec<double, 12> const load_within = spread(beam);
      double n0 = 0.0, at_a = 0.0, at_b = 0.0;  // n0: −(K e − f) along the beam at a; at_a, at_b: f at a and b
      for (int i = 0; i < 3; ++i) {
        double end = -load_within[i];
        for (int j = 0; j < 12; ++j) end += stiff(i, j) * x[6 * (j < 6 ? beam.a : beam.b) + j % 6];
        n0 -= beam.axes(i, 0) * end;
        at_a += beam.axes(i, 0) * load_within[i];
        at_b += beam.axes(i, 0) * load_within[6 + i];
      }
      // A load that is linear along the beam, p₀ + p₁ ξ, has f = l (p₀/2 + p₁/6) at a and l (p₀/2 + p₁/3) at b.
      double const p0 = 4.0 * at_a - 2.0 * at_b, p1 = 6.0 * (at_b - at_a);
      add_entries(beam, axial_force_stiffness(beam, n0, -p0, -0.5 * p1), entries);
    }
    Structure::Sparse k(s.size(), s.size());
    k.setFromTriplets(entries.begin(), entries.end());
    return k;
  }

 private:
  Structure const* structure_;
  Index fixed_[6];
  Eigen::SimplicialLDLT<Structure::Sparse> solver_;
};

}  // namespace polybody
