#pragma once
// Distance between the position mesh and the rotation mesh of the planar Lrvf, and its causes (thesis 2.5.1, 2.7).
// Shared by the examples and their tests.
//
// Consider an element with the relative rotation phi of its ends, the strains (eps, gamma) and the axes t1, t2 of its
// middle. Over the element, the position mesh advances by l ((1 + eps) t1 + gamma t2), and the curve that the rotations
// imply advances by l s t1 with s = sin(phi/2)/(phi/2). Hence the distance between the two positions of a node is
// exactly
//   sum l (eps t1 + gamma t2)  +  sum l (1 - s) t1  over the elements before the node.
// The first sum is due to the strains. The second sum is an interpolation error of second order in l.
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

// The two meshes of one state. A gap is the position of a node on the position mesh minus its position on the
// rotation mesh.
struct Apart {
  double gap = 0.0;                   // largest gap of all nodes [m]
  Vec2 strain = Vec2::Zero();         // part of this gap due to the strains [m]
  Vec2 interpolation = Vec2::Zero();  // part of this gap due to the interpolation [m]
  double element = 0.0;               // largest difference between the two chord lengths of an element [m]
  double bow = 0.0;                   // largest height of an element's implied arc above its chord [m]
  RigidFit rigid;                     // fit of the nodes of the rotation mesh to the nodes of the position mesh
};

template <class B>
Apart meshes_apart(B const& beam, std::span<double const> q) {
  MeshDiagnostics const d = mesh_diagnostics(beam, q);
  Apart out{.rigid = rigid_fit(d.rotation_nodes, d.position_nodes)};
  double const l = beam.element_length();
  Vec2 strain = Vec2::Zero(), interpolation = Vec2::Zero();
  for (Index e = 0; e < beam.elements(); ++e) {
    double const first = q[std::size_t(3 * e + 2)], last = q[std::size_t(3 * e + 5)], half = 0.5 * (last - first);
    double const s = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
    Vec6 const at = beam.section_strains({e, 0.5, 0.0}, q);
    Eigen::Rotation2Dd const axes(0.5 * (first + last));
    strain += l * (axes * Vec2(at[0], at[1]));
    interpolation += l * (axes * Vec2(1.0 - s, 0.0));
    out.element = std::max(out.element, l * std::abs(std::hypot(1.0 + at[0], at[1]) - s));
    out.bow = std::max(out.bow, 0.5 * l * std::abs(s * std::tan(0.5 * half)));  // l (1 - cos(half))/(2 half)
    std::size_t const node = std::size_t(e) + 1;
    double const gap = (d.position_nodes[node] - d.rotation_nodes[node]).norm();
    if (gap <= out.gap) continue;
    out.gap = gap;
    out.strain = strain;
    out.interpolation = interpolation;
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
