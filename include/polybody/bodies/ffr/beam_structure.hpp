#pragma once
/// \file
/// Structures made of bars: the space beam element of thesis App. A [Przemieniecki 1968, §5.6, §11.4] with the errata
/// of its Eq. A.1 (−2ξ + 3ξ², 2ξ − 3ξ² in rows 11 and 12), with intermediate element frames A.2–A.3 that let elements
/// point anywhere.
///
/// Not in polybody.hpp: Eigen's sparse module and factorisations would cost every program seconds to compile.

#include <polybody/bodies/ffr/structure.hpp>
#include <polybody/math/quadrature.hpp>

namespace polybody {

/// Shape functions of Eq. A.1, in the element's axes with nodal coordinates (u, v, w, θx, θy, θz) at either end: the
/// displacement at (ξ l, y, z) is (axis + y · by_y + z · by_z) e, the section's rotation `rotation` e.
struct BeamShapes {
  Mat<double, 3, 12> axis = Mat<double, 3, 12>::Zero();
  Mat<double, 3, 12> by_y = Mat<double, 3, 12>::Zero(), by_z = Mat<double, 3, 12>::Zero();
  Mat<double, 3, 12> rotation = Mat<double, 3, 12>::Zero();
  Mat<double, 4, 12> strain =
      Mat<double, 4, 12>::Zero();  ///< rows: axial strain, torsion, curvature about y, about z [1/m]

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

/// Axes of the intermediate element frame of a beam along `direction`: Eq. A.2, which keeps z normal to the body's y
/// axis, and Eq. A.3 where the beam points along it. \throws InvalidInput for a zero direction.
inline Mat3 intermediate_axes(Vec3 const& direction) {
  double const length = direction.norm();
  if (!(length > 0.0)) throw InvalidInput("Structure: a beam needs two different nodes.");
  Vec3 const c = direction / length;
  double const level = std::hypot(c[0], c[2]);
  Mat3 axes;
  if (level > 1e-8)
    axes << c[0], -c[0] * c[1] / level, -c[2] / level, c[1], level, 0.0, c[2], -c[1] * c[2] / level, c[0] / level;
  else
    axes << 0.0, -std::copysign(1.0, c[1]), 0.0, std::copysign(1.0, c[1]), 0.0, 0.0, 0.0, 0.0, 1.0;
  return axes;
}

// What follows runs once, when a body is made: plain loops, for they compile fast.
namespace detail {

using Twelve = Mat<double, 12, 12>;

/// m from the element's axes to the body's in its columns: m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ).
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
/// … and in its rows, too: C m diag(Cᵀ, …).
inline Mat<double, 3, 12> in_body_axes(Mat<double, 3, 12> const& m, Mat3 const& axes) {
  Mat<double, 3, 12> const t = by_body_axes<3>(m, axes);
  Mat<double, 3, 12> out;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 3; ++i) out(i, j) = axes(i, 0) * t(0, j) + axes(i, 1) * t(1, j) + axes(i, 2) * t(2, j);
  return out;
}
/// sum += w aᵀ b for a row a and a row b.
template <class A, class B>
void add_product(double w, A const& a, int row_a, B const& b, int row_b, Twelve& sum) {
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) sum(i, j) += w * a(row_a, i) * b(row_b, j);
}

/// Adds the rows and columns of one beam to a list of entries.
inline void add_entries(Structure::Beam const& beam, Twelve const& m, std::vector<Eigen::Triplet<double>>& entries) {
  auto const dof = [&](int i) { return int(6 * (i < 6 ? beam.a : beam.b) + i % 6); };
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      if (m(i, j) != 0.0) entries.emplace_back(dof(i), dof(j), m(i, j));
}
inline void add_entries(Structure::Beam const& beam, Vec<double, 12> const& x, VecX& sum) {
  for (int i = 0; i < 12; ++i) sum[6 * (i < 6 ? beam.a : beam.b) + i % 6] += x[i];
}

/// A point of a beam at a Gauss point, in the body's axes, with its part of ∫ρ, ∫ρy², ∫ρz².
struct MassPoint {
  Vec3 at;
  Mat<double, 3, 12> axis, y, z;
  double m, my, mz;
};
/// Four of them are exact for products of cubics.
inline std::array<MassPoint, 4> mass_points(Structure const& s, Structure::Beam const& beam) {
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

/// The part of ∫ρ u₀ₖ S_l (k = −1: of ∫ρ S_l) that stems from one beam.
inline Vec<double, 12> spread_moment(Structure const& s, Structure::Beam const& beam, int k, int l) {
  Vec<double, 12> sum = Vec<double, 12>::Zero();
  for (MassPoint const& p : mass_points(s, beam))
    for (int j = 0; j < 12; ++j) {
      sum[j] += p.m * (k < 0 ? 1.0 : p.at[k]) * p.axis(l, j);
      if (k >= 0) sum[j] += p.my * beam.axes(k, 1) * p.y(l, j) + p.mz * beam.axes(k, 2) * p.z(l, j);
    }
  return sum;
}

/// Inertia of a beam: the integrals of structure.hpp.
inline void add_inertia(Structure& s, Structure::Beam const& beam,
                        std::array<std::vector<Eigen::Triplet<double>>, 6>& entries) {
  std::array<Twelve, 6> inertia;
  for (Twelve& m : inertia) m.setZero();
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

/// ∫ Bᵀ diag(c) B: with two Gauss points the closed form of Eq. A.5 [Przemieniecki 1968, Eq. 5.116 without shear].
inline Twelve beam_stiffness(Structure::Beam const& beam, Vec4 const& c) {
  Twelve k = Twelve::Zero();
  for (auto const& g : gauss<2>) {
    Mat<double, 4, 12> const b = by_body_axes<4>(BeamShapes(g.xi, beam.length).strain, beam.axes);
    for (int i = 0; i < 4; ++i) add_product(g.weight * beam.length * c[i], b, i, b, i, k);
  }
  return k;
}
inline Vec4 section_stiffness(BarConstants const& c) { return {c.EA, c.GJ, c.EI_y.value_or(c.EI), c.EI}; }

/// ∫ N (v′ᵀv′ + w′ᵀw′) dx: what an axial force N(ξ) = n₀ + n₁ ξ + n₂ ξ² [N] adds to the stiffness.
inline Twelve axial_force_stiffness(Structure::Beam const& beam, double n0, double n1 = 0.0, double n2 = 0.0) {
  Twelve k = Twelve::Zero();
  for (auto const& g : gauss<4>) {
    Mat<double, 3, 12> const slopes = by_body_axes<3>(BeamShapes(g.xi, beam.length).rotation, beam.axes);
    double const n = n0 + g.xi * (n1 + g.xi * n2);
    for (int i = 1; i < 3; ++i) add_product(g.weight * beam.length * n, slopes, i, slopes, i, k);
  }
  return k;
}

}  // namespace detail

/// Ends of bars that are closer than this part of the longest bar are one node.
inline constexpr double same_node = 1e-9;

/// Bars, each cut into as many elements as `elements` says, welded wherever their ends meet; placements are in the
/// body's axes. Their damping is Kelvin–Voigt's; a pretension keeps its first-order force and its stiffness.
/// \throws InvalidInput for no bar, fewer than one element, or a bar without torsional stiffness GJ.
inline Structure structure_of(std::vector<Bar> const& bars, std::vector<Index> const& elements) {
  if (bars.empty() || bars.size() != elements.size())
    throw InvalidInput("Structure: give at least one bar, and a number of elements for each.");
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
    if (elements[i] < 1) throw InvalidInput("Structure: each bar needs at least one element.");
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
    Vec4 const c = detail::section_stiffness(beam.constants);
    Damping const& d = dampings[i];
    detail::add_entries(beam, detail::beam_stiffness(beam, c), stiffness);
    detail::add_entries(
        beam, detail::beam_stiffness(beam, c.cwiseProduct(Vec4(d.axial, d.shear, d.bending, d.bending))), damping);
    if (forces[i] != 0.0) {
      detail::add_entries(beam, detail::axial_force_stiffness(beam, forces[i]), stiffness);
      Vec<double, 12> pull = Vec<double, 12>::Zero();
      for (int k = 0; k < 3; ++k) pull[6 + k] = -(pull[k] = -forces[i] * beam.axes(k, 0));
      detail::add_entries(beam, pull, s.initial_force);
    }
    detail::add_inertia(s, beam, inertia);
  }
  s.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
  s.damping.setFromTriplets(damping.begin(), damping.end());
  for (std::size_t p = 0; p < 6; ++p) s.inertia[p].setFromTriplets(inertia[p].begin(), inertia[p].end());
  return s;
}

/// One bar in n equal elements, in its own axes: nodes 0 … n, and the body placed where the bar is.
inline Structure structure_of(Bar bar, Index n) {
  bar.placement = {};
  return structure_of(std::vector{bar}, {n});
}

/// ∫ N (v′ᵀv′ + w′ᵀw′) dx over all beams, N the axial forces that a load causes in the structure held at one node:
/// twice the second-order work of the load [Wallrapp & Schwertassek 1991], e · (·) e = 2 Σ load · (what bending draws
/// it along).
class AxialForceStiffness {
 public:
  /// Holds all six coordinates of `node`. \throws InvalidInput for a structure that is not made of beams, or in parts.
  explicit AxialForceStiffness(Structure const& s, Index node = 0) : structure_(&s) {
    if (s.beams.empty())
      throw InvalidInput(
          "Structure: geometric stiffening needs beams; a structure from matrices does not know its axial forces.");
    s.require_node(node, "Structure: the held node");
    Structure::Sparse k = s.stiffness;
    Index const first = 6 * node;
    k.prune([&](Index i, Index j, double) { return i / 6 != node && j / 6 != node; });
    for (Index i = 0; i < 6; ++i) k.coeffRef(held_[i] = first + i, first + i) = 1.0;
    solver_.compute(k);
    if (solver_.info() != Eigen::Success || solver_.vectorD().minCoeff() <= 0.0)
      throw InvalidInput("Structure: its beams are not all joined, or their stiffness is not positive.");
  }

  /// `spread(beam)`: the nodal forces (12, body axes) equivalent to what acts within the beam.
  template <class Spread>
  Structure::Sparse operator()(VecX const& load, Spread&& spread) const {
    Structure const& s = *structure_;
    VecX x = load;
    for (Index const i : held_) x[i] = 0.0;
    x = solver_.solve(x).eval();
    std::vector<Eigen::Triplet<double>> entries;
    for (Structure::Beam const& beam : s.beams) {
      detail::Twelve const stiff = detail::beam_stiffness(beam, detail::section_stiffness(beam.constants));
      Vec<double, 12> const load_within = spread(beam);
      double n0 = 0.0, at_a = 0.0, at_b = 0.0;  // −(K e − f) along the beam at a; f at a and b
      for (int i = 0; i < 3; ++i) {
        double end = -load_within[i];
        for (int j = 0; j < 12; ++j) end += stiff(i, j) * x[6 * (j < 6 ? beam.a : beam.b) + j % 6];
        n0 -= beam.axes(i, 0) * end;
        at_a += beam.axes(i, 0) * load_within[i];
        at_b += beam.axes(i, 0) * load_within[6 + i];
      }
      // A load that runs linearly along the beam, p₀ + p₁ ξ, has f = l (p₀/2 + p₁/6) at a and l (p₀/2 + p₁/3) at b.
      double const p0 = 4.0 * at_a - 2.0 * at_b, p1 = 6.0 * (at_b - at_a);
      detail::add_entries(beam, detail::axial_force_stiffness(beam, n0, -p0, -0.5 * p1), entries);
    }
    Structure::Sparse k(s.size(), s.size());
    k.setFromTriplets(entries.begin(), entries.end());
    return k;
  }

 private:
  Structure const* structure_;
  Index held_[6];
  Eigen::SimplicialLDLT<Structure::Sparse> solver_;
};

}  // namespace polybody
