#pragma once
// Distance between the position mesh and the rotation mesh of geometrically exact beams, and its causes (thesis 2.5.1,
// 2.7). Shared by the examples and their tests.
//
// An element of length l has the chord dr between its nodes. Its strains Gamma = (eps, gamma) are those of dr in
// axes A, for a straight reference:
//   dr = l A (e1 + Gamma).
// Let R be the rotation field of the element and <R> its mean. Along the element, the curve that the rotations imply
// advances by the integral of t1 = R e1, which is l <R> e1. Hence the distance between the two positions of a node is
//   sum l A Gamma  +  sum l (A - <R>) e1  over the elements before the node.
// The first sum is due to the strains. The second sum is due to the interpolation:
//   Lrvf     A is R in the middle of the element. In the plane <R> = s A with s = sin(phi/2)/(phi/2), for the relative
//            rotation phi of the nodes. The second sum is sum l (1 - s) t1, of second order in l.
//   Se3Beam  R and Gamma follow from one interpolation with r' = R (e1 + Gamma) and constant Gamma [Sonneville, Cardona
//            & Brüls 2014, §4]. Hence A = <R>, and the second sum is zero for any mesh.
// If the reference of an Lrvf is curved, the second sum also contains its chords. It is zero in the reference.
#include <polybody/se3_beam.hpp>

#include "chapter2.hpp"

namespace chapter2 {

// Rigid displacement x -> shift + R(turn) x of one set of points with the least mean square distance from another set.
struct RigidFit {
  double turn = 0.0;          // [rad]
  Vec2 shift = Vec2::Zero();  // [m]
  double apart = 0.0;         // rms distance before the displacement [m]
  double left = 0.0;          // rms distance after the displacement [m]
};

// Planar Procrustes problem: with both sets relative to their means, tan(turn) = sum(from x to)/sum(from . to). Throws
// InvalidInput unless both sets have the same number of points, and at least one.
inline RigidFit rigid_fit(std::vector<Vec2> const& from, std::vector<Vec2> const& to) {
  if (from.empty() || from.size() != to.size())
    throw InvalidInput("rigid_fit: both sets need the same number of points, and at least one.");
  double const n = double(from.size());
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += from[i] / n;
    b += to[i] / n;
  }
  double along = 0.0, across = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    Vec2 const p = from[i] - a, q = to[i] - b;
    along += p.dot(q);
    across += p[0] * q[1] - p[1] * q[0];
  }
  RigidFit fit{.turn = std::atan2(across, along)};
  Eigen::Rotation2Dd const turned(fit.turn);
  fit.shift = b - turned * a;
  for (std::size_t i = 0; i < from.size(); ++i) {
    fit.apart += (to[i] - from[i]).squaredNorm() / n;
    fit.left += (to[i] - fit.shift - turned * from[i]).squaredNorm() / n;
  }
  fit.apart = std::sqrt(fit.apart);
  fit.left = std::sqrt(fit.left);
  return fit;
}

template <class B>
inline constexpr int dimension = B::world == World::plane ? 2 : 3;

// Axes A of the strains of element e at the coordinates q.
template <class B>
Mat<double, dimension<B>, dimension<B>> strain_axes(B const& beam, Index e, std::span<double const> q) {
  bool constexpr mean = std::is_same_v<B, planar::Se3Beam> || std::is_same_v<B, Se3Beam>;
  if constexpr (B::world == World::plane) {
    double const first = q[std::size_t(3 * e + 2)], last = q[std::size_t(3 * e + 5)], half = 0.5 * (last - first);
    double const s = !mean ? 1.0 : std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
    return s * Eigen::Rotation2Dd(0.5 * (first + last)).toRotationMatrix();
  } else {
    SectionTurn const at = beam.rotation_field({e, mean ? 0.0 : 0.5, 0.0, 0.0}, q);
    if constexpr (mean) return at.R * left_jacobian<double>(beam.element_length() * at.K);  // mean of R exp(x l K)
    return at.R;
  }
}

// Largest distance of a node between the two meshes, and its two parts. The distance is the position of the node on the
// position mesh minus its position on the rotation mesh.
template <int dim>
struct Gap {
  double gap = 0.0;                                                 // [m]
  Mat<double, dim, 1> strain = Mat<double, dim, 1>::Zero();         // part due to the strains [m]
  Mat<double, dim, 1> interpolation = Mat<double, dim, 1>::Zero();  // part due to the interpolation [m]
  double interpolation_of_all = 0.0;                                // largest of all nodes [m]
};

template <class B>
Gap<dimension<B>> gap_of_meshes(B const& beam, std::span<double const> q) {
  int constexpr dim = dimension<B>;
  TwoMeshes<dim> const d = mesh_diagnostics(beam, q);
  Gap<dim> out;
  Mat<double, dim, 1> strain = Mat<double, dim, 1>::Zero();
  for (Index e = 0; e < beam.elements(); ++e) {
    typename B::Point middle;
    middle.element = e;
    middle.xi = 0.5;
    Mat<double, dim, 1> const strains = Vec6(beam.section_strains(middle, q)).template head<dim>();
    strain += beam.element_length() * (strain_axes(beam, e, q) * strains);
    std::size_t const node = std::size_t(e) + 1;
    Mat<double, dim, 1> const gap = d.position_nodes[node] - d.rotation_nodes[node], interpolation = gap - strain;
    out.interpolation_of_all = std::max(out.interpolation_of_all, interpolation.norm());
    if (gap.norm() <= out.gap) continue;
    out.gap = gap.norm();
    out.strain = strain;
    out.interpolation = interpolation;
  }
  return out;
}

// The two meshes of one state in the plane.
struct Apart : Gap<2> {
  double element = 0.0;  // largest difference between the two chord lengths of an element [m]
  double bow = 0.0;      // largest height of an element's implied arc above its chord [m]
  RigidFit rigid;        // fit of the nodes of the rotation mesh to the nodes of the position mesh
};

template <class B>
Apart meshes_apart(B const& beam, std::span<double const> q) {
  MeshDiagnostics const d = mesh_diagnostics(beam, q);
  Apart out{gap_of_meshes(beam, q), 0.0, 0.0, rigid_fit(d.rotation_nodes, d.position_nodes)};
  for (std::size_t e = 0; e < d.rotation_curvature.size(); ++e) {
    auto const chord = [&](std::vector<Vec2> const& nodes) { return (nodes[e + 1] - nodes[e]).norm(); };
    double const implied = chord(d.rotation_nodes), turn = beam.element_length() * d.rotation_curvature[e];
    out.element = std::max(out.element, std::abs(chord(d.position_nodes) - implied));
    out.bow = std::max(out.bow, 0.5 * std::abs(implied * std::tan(0.25 * turn)));  // l (1 - cos(turn/2))/turn
  }
  return out;
}

// Prints the line "  ROW, COLUMN: VALUE UNIT". tests/long reads such lines as numbers of docs/chapter2.md.
inline void say(std::string const& row, char const* column, double value, char const* unit = "") {
  std::printf("  %s, %s: %.6g%s%s\n", row.c_str(), column, value, *unit ? " " : "", unit);
}

inline void meshes_head() {
  std::printf("  %-18s %6s %9s %9s %9s %9s %9s %9s %9s %10s\n", "meshes [m]", "t [s]", "gap", "strain", "interpol.",
              "rms", "rms left", "element", "bow", "turn [rad]");
}
inline void meshes_row(std::string const& name, double t, Apart const& a) {
  std::printf("  meshes %-11s %6.1f %9.5f %9.5f %9.5f %9.5f %9.5f %9.5f %9.5f %10.6f\n", name.c_str(), t, a.gap,
              a.strain.norm(), a.interpolation.norm(), a.rigid.apart, a.rigid.left, a.element, a.bow, a.rigid.turn);
}

}  // namespace chapter2
