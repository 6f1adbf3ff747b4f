#pragma once
/// \file
/// Structures made of bars: space beam element [thesis App. A; Przemieniecki 1968, §5.6, §11.4]. The code corrects
/// errata of thesis Eq. A.1: the correct entries of its rows 11 and 12 are −2ξ + 3ξ² and 2ξ − 3ξ². The intermediate
/// element frames of thesis Eqs. A.2–A.3 permit any direction of an element.
/// Theory: Eqs. 2.96, 2.97, 2.99, 3.14.

#include <Eigen/Eigenvalues>

#include <polybody/bodies/ffr/beam_shapes.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody {

/// Adds the matrix `m` of one beam to the entries of the matrix of the structure.
template <class = void>
void add_entries(Structure::Beam const& beam, BeamMatrix const& m, std::vector<Eigen::Triplet<double>>& entries) {
  auto const dof = [&](int i) { return int(6 * (i < 6 ? beam.a : beam.b) + i % 6); };
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      if (m(i, j) != 0.0) entries.emplace_back(dof(i), dof(j), m(i, j));
}
/// Adds the nodal values x of one beam to those of the structure, `sum` (N).
template <class = void>
void add_entries(Structure::Beam const& beam, Vec<double, 12> const& x, VecX& sum) {
  for (int i = 0; i < 12; ++i) sum[6 * (i < 6 ? beam.a : beam.b) + i % 6] += x[i];
}

/// Section of a beam with rigid section kinematics, in the axes of the body: a point mass at the centre of mass, and
/// the moments Σ w d dᵀ of the mass about the centre with orthogonal directions d.
struct MassPoint {
  /// Moment of mass along one direction.
  struct Spread {
    double w = 0.0;              ///< contribution to ∫ρ (d·r)² [kg m²]
    Vec3 direction;              ///< d, unit vector
    Mat<double, 3, 12> turning;  ///< (3×12) displacement θ × d
  };
  Vec3 at;                       ///< centre of mass, from the origin of the body [m]
  Mat<double, 3, 12> axis;       ///< (3×12) displacement of the centre of mass
  double m = 0.0;                ///< mass [kg]
  std::array<Spread, 3> spread;  ///< moments of the mass
};
/// Section at ξ of a beam, for the length `dx` of the beam [m]. For a mass matrix with the inertia J about the centre
/// of mass, the moments are those of ½ tr(J) 1 − J.
template <class = void>
MassPoint mass_point(Structure const& s, Structure::Beam const& beam, double xi, double dx) {
  BeamShapes const shapes(xi, beam);
  BarConstants const& c = beam.constants;
  MassPoint p;
  Vec3 centre = Vec3::Zero(), moments(0.0, c.rotary_inertia, c.rotary_inertia_y.value_or(c.rotary_inertia));
  Mat3 directions = Mat3::Identity();
  if (beam.section) {
    centre = beam.section->centre;
    Mat3 const& j = beam.section->inertia;
    Eigen::SelfAdjointEigenSolver<Mat3> const principal(0.5 * j.trace() * Mat3::Identity() - j);
    moments = principal.eigenvalues();
    directions = principal.eigenvectors();
  }
  p.m = dx * c.mass_per_length;
  p.at = s.nodes[std::size_t(beam.a)] + beam.axes * Vec3(xi * beam.length, centre[1], centre[2]);
  p.axis = in_body_axes(shapes.axis + centre[1] * shapes.by_y + centre[2] * shapes.by_z, beam.axes);
  for (int i = 0; i < 3; ++i)
    p.spread[std::size_t(i)] = {
        dx * moments[i], beam.axes * directions.col(i),
        in_body_axes(directions(0, i) * shapes.by_x + directions(1, i) * shapes.by_y + directions(2, i) * shapes.by_z,
                     beam.axes)};
  return p;
}
/// Four Gauss points of a beam, exact for products of cubics.
template <class = void>
std::array<MassPoint, 4> mass_points(Structure const& s, Structure::Beam const& beam) {
  std::array<MassPoint, 4> points;
  for (std::size_t i = 0; i < 4; ++i) points[i] = mass_point(s, beam, gauss<4>[i].xi, gauss<4>[i].weight * beam.length);
  return points;
}

namespace detail {
/// Adds sum += w aᵀ b for row `row_a` of a and row `row_b` of b.
template <class A, class B>
void add_product(double w, A const& a, int row_a, B const& b, int row_b, BeamMatrix& sum) {
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) sum(i, j) += w * a(row_a, i) * b(row_b, j);
}
}  // namespace detail

/// Stiffness ∫ Bᵀ C B of a beam with the section stiffness `c` (6×6) of (ε, γ_y, γ_z, κ_x, κ_y, κ_z). Two Gauss points
/// are exact: the closed form for constants [thesis Eq. A.5; Przemieniecki 1968, Eq. 5.116 without shear], and the
/// inverse of the flexibility for matrices.
template <class = void>
BeamMatrix beam_stiffness(Structure::Beam const& beam, Mat<double, 6, 6> const& c) {
  BeamMatrix k = BeamMatrix::Zero();
  for (auto const& g : gauss<2>) {
    Mat<double, 6, 12> const b = by_body_axes<6>(BeamShapes(g.xi, beam).strain, beam.axes);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        if (c(i, j) != 0.0) detail::add_product(g.weight * beam.length * c(i, j), b, i, b, j, k);
  }
  return k;
}
/// Stiffness (6×6) of the section of a beam: diag(EA, 0, 0, GJ, EI_y, EI) for constants.
template <class = void>
Mat<double, 6, 6> section_stiffness(Structure::Beam const& beam) {
  if (beam.section) return detail::about_axis(beam.section->stiffness, *beam.section);
  BarConstants const& c = beam.constants;
  Vec6 diagonal;
  diagonal << c.EA, 0.0, 0.0, c.GJ, c.EI_y.value_or(c.EI), c.EI;
  return diagonal.asDiagonal();
}
/// Damping (6×6) of the section of a beam of a bar with the damping `d`.
template <class = void>
Mat<double, 6, 6> section_damping(Structure::Beam const& beam, Damping const& d) {
  if (beam.section) return detail::about_axis(beam.section->damping, *beam.section);
  return section_stiffness(beam) * detail::damping_times(d).asDiagonal();
}

/// Geometric stiffness ∫ N (v′ᵀv′ + w′ᵀw′) dx of a beam with the axial force N(ξ) = n₀ + n₁ ξ + n₂ ξ² [N].
template <class = void>
BeamMatrix axial_force_stiffness(Structure::Beam const& beam, double n0, double n1 = 0.0, double n2 = 0.0) {
  BeamMatrix k = BeamMatrix::Zero();
  for (auto const& g : gauss<4>) {
    Mat<double, 3, 12> const slopes = by_body_axes<3>(BeamShapes(g.xi, beam).slopes(), beam.axes);
    double const n = n0 + g.xi * (n1 + g.xi * n2);
    for (int i = 1; i < 3; ++i) detail::add_product(g.weight * beam.length * n, slopes, i, slopes, i, k);
  }
  return k;
}

/// Axes of the intermediate element frame of a beam along `direction`, by thesis Eq. A.2. The z axis of the frame is
/// normal to the y axis of the body. If the beam is parallel to the y axis of the body, thesis Eq. A.3 applies.
/// \throws InvalidInput for a zero direction.
template <class = void>  // compiled only if used
Mat3 intermediate_axes(Vec3 const& direction) {
  double const length = direction.norm();
  if (!(length > 0.0))
    throw InvalidInput("structure.beam",
                       {ErrorObject{"Structure"}, ": a beam needs two different nodes, but its length is ",
                        ErrorValue{length}, " m."});
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
      for (auto const& d : p.spread)
        if (k >= 0) sum[j] += d.w * d.direction[k] * d.turning(l, j);
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
      for (int l = 0; l < 3; ++l) {
        s.second(k, l) += g.m * g.at[k] * g.at[l];
        for (auto const& d : g.spread) s.second(k, l) += d.w * d.direction[k] * d.direction[l];
      }
    }
    for (std::size_t p = 0; p < 6; ++p) {
      int const k = symmetric_row[p], l = symmetric_column[p];
      add_product(g.m, g.axis, k, g.axis, l, inertia[p]);
      for (auto const& d : g.spread)
        if (d.w != 0.0) add_product(d.w, d.turning, k, d.turning, l, inertia[p]);
    }
  }
  for (std::size_t p = 0; p < 6; ++p) add_entries(beam, inertia[p], entries[p]);
  for (int l = 0; l < 3; ++l) {
    add_entries(beam, spread_moment(s, beam, -1, l), s.translation[std::size_t(l)]);
    for (int k = 0; k < 3; ++k)
      add_entries(beam, spread_moment(s, beam, k, l), s.moment[std::size_t(k)][std::size_t(l)]);
  }
}

/// Section of a beam of a structure: constants, and matrices if the bar has them.
struct BeamSection {
  BarConstants constants;                         ///< without couplings for matrices
  std::shared_ptr<CentredSection const> section;  ///< empty for constants
};
/// Sections of the n beams of a bar, or one for all.
/// \throws InvalidInput as `constants` and `section_at`, and for constants without torsional stiffness GJ.
template <class = void>
std::vector<BeamSection> beam_sections(Bar const& bar, Index n) {
  std::vector<BeamSection> out;
  if (!std::holds_alternative<SectionAlong>(bar.section)) {
    out.push_back({polybody::constants(bar), {}});
    require_polar_inertia_of_points(out[0].constants, "Structure");
    require_positive(out[0].constants.GJ, "Structure: GJ of a bar (a floating frame in space resists torsion)");
  } else {
    for (Index e = 0; e < (section_varies(bar) ? n : 1); ++e) {
      auto const section = std::make_shared<CentredSection const>(
          section_at(bar, (double(e) + 0.5) * bar.length / double(n), "Structure"));
      out.push_back({constants_without_couplings(*section), section});
    }
  }
  return out;
}

}  // namespace detail

/// Two ends of bars share a node if their distance is smaller than this fraction of the length of the longest bar.
inline constexpr double same_node = 1e-9;

/// Structure of `bars`, each divided into the number of elements given by `elements`, welded at common ends. The
/// placements are in the axes of the body. The damping of the bars is Kelvin–Voigt damping. A pretension contributes
/// its first-order force and its stiffness. A bar with matrices (`Section6`) has elements with shear and all couplings,
/// exact in statics for a constant section; a section that varies is that of the middle of each element.
/// \throws InvalidInput for no bar, `elements` of another size than `bars`, fewer than one element, and a bar with
/// invalid data, or with constants or a shape without torsional stiffness GJ.
template <class = void>
Structure structure_of(std::vector<Bar> const& bars, std::vector<Index> const& elements) {
  if (bars.empty() || bars.size() != elements.size())
    throw InvalidInput(
        "structure.beam",
        {ErrorObject{"Structure"}, ": at least one bar and one number of elements per bar are needed, but there are ",
         bars.size(), " bars and ", elements.size(), " numbers of elements."});
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
    require_elements(elements[i], "Structure: bar " + std::to_string(i + 1));
    double const l = bar.length / double(elements[i]);
    std::vector<detail::BeamSection> const sections = detail::beam_sections(bar, elements[i]);
    for (Index e = 0; e < elements[i]; ++e) {
      auto const end = [&](Index k) {
        return Vec3(bar.placement.origin + bar.placement.axes.col(0) * (l * double(k)));
      };
      Index const a = node_at(end(e)), b = node_at(end(e + 1));
      auto const& [c, section] = sections[sections.size() == 1 ? 0 : std::size_t(e)];
      s.beams.push_back({a, b, bar.placement.axes, l, c, Index(i), l * double(e), section});
      dampings.push_back(bar.damping);
      forces.push_back(bar.pretension);
    }
    s.bar_lengths.push_back(bar.length);
    if (s.unit_warning.empty()) s.unit_warning = detail::unit_warning(bar);
  }
  s.clear();
  std::vector<Eigen::Triplet<double>> stiffness, damping;
  std::array<std::vector<Eigen::Triplet<double>>, 6> inertia;
  for (std::size_t i = 0; i < s.beams.size(); ++i) {
    Structure::Beam const& beam = s.beams[i];
    add_entries(beam, beam_stiffness(beam, section_stiffness(beam)), stiffness);
    add_entries(beam, beam_stiffness(beam, section_damping(beam, dampings[i])), damping);
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
/// omitted. Use this placement for the body.
template <class = void>
Structure structure_of(Bar bar, Index n) {
  bar.placement = {};
  return structure_of(std::vector{bar}, {n});
}

/// Geometric stiffness K_G = ∫ N (v′ᵀv′ + w′ᵀw′) dx over all beams. The axial forces N are due to a load on the
/// structure, which is held at one node [Wallrapp & Schwertassek 1991]. The work of the load on the displacements by
/// axial foreshortening is −½ eᵀ K_G e.
class AxialForceStiffness {
 public:
  /// Holds all six coordinates of `node`.
  /// \throws InvalidInput for a structure that is not made of beams or not connected, and for a node that does not
  /// exist.
  template <class = void>
  explicit AxialForceStiffness(Structure const& s, Index node = 0) : structure_(&s) {
    if (s.beams.empty())
      throw InvalidInput(
          "structure.no_beams",
          {ErrorObject{"Structure"},
           ": geometric stiffening needs beams, because the axial forces of a structure from matrices are unknown. "
           "Make the structure from bars, or switch geometric stiffening off."});
    s.require_node(node, "Structure: the held node");
    Structure::Sparse k = s.stiffness;
    Index const first = 6 * node;
    k.prune([&](Index i, Index j, double) { return i / 6 != node && j / 6 != node; });
    for (Index i = 0; i < 6; ++i) k.coeffRef(fixed_[i] = first + i, first + i) = 1.0;
    solver_.compute(k);
    if (solver_.info() != Eigen::Success || solver_.vectorD().minCoeff() <= 0.0)
      throw InvalidInput("structure.not_joined",
                         {ErrorObject{"Structure"}, ": the stiffness is not positive definite although node ", node,
                          " is held. Connect all bars at common ends, and give each bar positive stiffnesses."});
  }

  /// Geometric stiffness due to one load. \param load (N) all nodal forces [N], [N m], including those of `spread`
  /// \param spread spread(beam) returns the nodal forces (12, body axes) that are equivalent to the load between the
  /// nodes of the beam
  template <class Spread>
  Structure::Sparse operator()(VecX const& load, Spread&& spread) const {
    Structure const& s = *structure_;
    VecX x = load;
    for (Index const i : fixed_) x[i] = 0.0;
    x = solver_.solve(x).eval();
    std::vector<Eigen::Triplet<double>> entries;
    for (Structure::Beam const& beam : s.beams) {
      BeamMatrix const stiff = beam_stiffness(beam, section_stiffness(beam));
      Vec<double, 12> const load_within = spread(beam);
      double n0 = 0.0, at_a = 0.0, at_b = 0.0;  // n0: −(K e − f) along the beam at a; at_a, at_b: f at a and b
      for (int i = 0; i < 3; ++i) {
        double end = -load_within[i];
        for (int j = 0; j < 12; ++j) end += stiff(i, j) * x[6 * (j < 6 ? beam.a : beam.b) + j % 6];
        n0 -= beam.axes(i, 0) * end;
        at_a += beam.axes(i, 0) * load_within[i];
        at_b += beam.axes(i, 0) * load_within[6 + i];
      }
      // A load that is linear along the beam, p₀ + p₁ ξ, has f = l (p₀/2 + p₁/6) at a and l (p₀/2 + p₁/3) at b. p0 and
      // p1 are l p₀ and l p₁.
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
