#pragma once
/// \file
/// Structures made of bars: space beam element [thesis App. A; Przemieniecki 1968, §5.6, §11.4]. The code corrects
/// errata of thesis Eq. A.1: the correct entries of its rows 11 and 12 are −2ξ + 3ξ² and 2ξ − 3ξ². The intermediate
/// element frames of thesis Eqs. A.2–A.3 permit any direction of an element.
/// Theory: Eqs. 2.96, 2.97, 2.99, 3.14.

#include <polybody/bodies/ffr/structure.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody {

// Space beam element [thesis App. A; Przemieniecki 1968, §5.6, §11.4]: shape functions, stiffness and mass points, in
// the axes of the body.

/// Shape functions of thesis Eq. A.1 in the axes of the element, with nodal coordinates (u, v, w, θx, θy, θz) at both
/// ends. The displacement at (ξ l, y, z) is (axis + y · by_y + z · by_z) e, and the rotation of the section is
/// `rotation` e.
struct BeamShapes {
  Mat<double, 3, 12> axis = Mat<double, 3, 12>::Zero();  ///< displacement of the axis
  Mat<double, 3, 12> by_y = Mat<double, 3, 12>::Zero(), by_z = Mat<double, 3, 12>::Zero();  ///< ∂/∂y, ∂/∂z of (u, v, w)
  Mat<double, 3, 12> rotation = Mat<double, 3, 12>::Zero();                                 ///< (θx, −w′, v′)
  Mat<double, 4, 12> strain =
      Mat<double, 4, 12>::Zero();  ///< rows: axial strain [1], torsion, curvatures about y and z [1/m]

  /// Shape functions at ξ of an element of length l [m].
  template <class = void>  // compiled only if used
  BeamShapes(double xi, double l) {
    double const x = xi, h[4] = {1 - 3 * x * x + 2 * x * x * x, (x - 2 * x * x + x * x * x) * l,
                                 3 * x * x - 2 * x * x * x, (x * x * x - x * x) * l};
    double const d[4] = {6 * (x * x - x) / l, 1 - 4 * x + 3 * x * x, 6 * (x - x * x) / l, 3 * x * x - 2 * x};
    double const c[4] = {(12 * x - 6) / (l * l), (6 * x - 4) / l, (6 - 12 * x) / (l * l), (6 * x - 2) / l};
    for (int end = 0; end < 2; ++end) {
      int const u = 6 * end, v = u + 1, w = u + 2, tx = u + 3, ty = u + 4, tz = u + 5, i = 2 * end;
      double const linear = end == 0 ? 1 - x : x, slope = end == 0 ? -1 / l : 1 / l;
      axis(0, u) = linear;
      axis(1, v) = axis(2, w) = h[i];
      axis(1, tz) = h[i + 1];
      axis(2, ty) = -h[i + 1];
      rotation(0, tx) = linear;  // (θx, −w′, v′)
      rotation(1, w) = -d[i];
      rotation(1, ty) = d[i + 1];
      rotation(2, v) = d[i];
      rotation(2, tz) = d[i + 1];
      strain(0, u) = strain(1, tx) = slope;  // (u′, θx′, −w″, v″)
      strain(2, w) = -c[i];
      strain(2, ty) = c[i + 1];
      strain(3, v) = c[i];
      strain(3, tz) = c[i + 1];
    }
    by_y.row(0) = -rotation.row(2);  // θ × (0, y, z)
    by_y.row(2) = rotation.row(0);
    by_z.row(0) = rotation.row(1);
    by_z.row(1) = -rotation.row(0);
  }
};

// The following functions run once, when a body is made. They use plain loops, which compile fast.

/// Matrix with respect to the nodal coordinates of both ends of a beam, in the axes of the body.
using BeamMatrix = Mat<double, 12, 12>;

/// Transforms the columns of m from the axes of the element to those of the body: m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ), C = `axes`.
template <int rows>
Mat<double, rows, 12> by_body_axes(Mat<double, rows, 12> const& m, Mat3 const& axes) {
  Mat<double, rows, 12> out;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 12; ++j) {
      int const block = 3 * (j / 3);
      out(i, j) = m(i, block) * axes(j % 3, 0) + m(i, block + 1) * axes(j % 3, 1) + m(i, block + 2) * axes(j % 3, 2);
    }
  return out;
}
/// Transforms the rows and columns of m from the axes of the element to those of the body: C m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ),
/// C = `axes`.
template <class = void>
Mat<double, 3, 12> in_body_axes(Mat<double, 3, 12> const& m, Mat3 const& axes) {
  Mat<double, 3, 12> const t = by_body_axes<3>(m, axes);
  Mat<double, 3, 12> out;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 3; ++i) out(i, j) = axes(i, 0) * t(0, j) + axes(i, 1) * t(1, j) + axes(i, 2) * t(2, j);
  return out;
}
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

/// Gauss point of a beam in the axes of the body, with its contributions to ∫ρ, ∫ρy², ∫ρz².
struct MassPoint {
  Vec3 at;                        ///< position on the axis of the beam, from the origin of the body [m]
  Mat<double, 3, 12> axis, y, z;  ///< (3×12) displacement of the axis and its derivatives with respect to y and z
  double m, my, mz;               ///< contributions to ∫ρ [kg], ∫ρy² and ∫ρz² [kg m²]
};
/// Four Gauss points of a beam, exact for products of cubics.
template <class = void>
std::array<MassPoint, 4> mass_points(Structure const& s, Structure::Beam const& beam) {
  std::array<MassPoint, 4> points;
  double const about_z = beam.constants.rotary_inertia, about_y = beam.constants.rotary_inertia_y.value_or(about_z);
  for (std::size_t i = 0; i < 4; ++i) {
    auto const& g = gauss<4>[i];
    BeamShapes const shapes(g.xi, beam.length);
    double const w = g.weight * beam.length;
    points[i] = {s.nodes[std::size_t(beam.a)] + beam.axes.col(0) * (g.xi * beam.length),
                 in_body_axes(shapes.axis, beam.axes),
                 in_body_axes(shapes.by_y, beam.axes),
                 in_body_axes(shapes.by_z, beam.axes),
                 w * beam.constants.mass_per_length,
                 w * about_z,
                 w * about_y};
  }
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

/// Stiffness ∫ Bᵀ diag(c) B of a beam with the section stiffness c. Two Gauss points give the closed form [thesis Eq.
/// A.5; Przemieniecki 1968, Eq. 5.116 without shear].
template <class = void>
BeamMatrix beam_stiffness(Structure::Beam const& beam, Vec4 const& c) {
  BeamMatrix k = BeamMatrix::Zero();
  for (auto const& g : gauss<2>) {
    Mat<double, 4, 12> const b = by_body_axes<4>(BeamShapes(g.xi, beam.length).strain, beam.axes);
    for (int i = 0; i < 4; ++i) detail::add_product(g.weight * beam.length * c[i], b, i, b, i, k);
  }
  return k;
}
/// Stiffness (EA, GJ, EI_y, EI_z) of a section: axial strain, torsion, and bending about y and z.
template <class = void>
Vec4 section_stiffness(BarConstants const& c) {
  return {c.EA, c.GJ, c.EI_y.value_or(c.EI), c.EI};
}

/// Geometric stiffness ∫ N (v′ᵀv′ + w′ᵀw′) dx of a beam with the axial force N(ξ) = n₀ + n₁ ξ + n₂ ξ² [N].
template <class = void>
BeamMatrix axial_force_stiffness(Structure::Beam const& beam, double n0, double n1 = 0.0, double n2 = 0.0) {
  BeamMatrix k = BeamMatrix::Zero();
  for (auto const& g : gauss<4>) {
    Mat<double, 3, 12> const slopes = by_body_axes<3>(BeamShapes(g.xi, beam.length).rotation, beam.axes);
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

/// Two ends of bars share a node if their distance is smaller than this fraction of the length of the longest bar.
inline constexpr double same_node = 1e-9;

/// Structure of `bars`, each divided into the number of elements given by `elements`, welded at common ends. The
/// placements are in the axes of the body. The damping of the bars is Kelvin–Voigt damping. A pretension contributes
/// its first-order force and its stiffness.
/// \throws InvalidInput for no bar, `elements` of another size than `bars`, fewer than one element, and a bar with
/// invalid data or without torsional stiffness GJ.
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
