#pragma once
/// \file
/// A linear finite element model of one body in its own axes: what a floating frame of reference (ffr.hpp) is made of.
/// With the displacement field u(x) = u₀(x) + S(x) e, e the nodal displacements, it holds the stiffness and the inertia
/// shape integrals [Shabana 2013, ch. 5–6; thesis App. A]
///   ∫ρ, ∫ρ u₀, ∫ρ u₀u₀ᵀ, ∫ρ S_k, ∫ρ u₀ₖ S_l, ∫ρ S_kᵀ S_l,   k, l = x, y, z,
/// exactly, so that the inertia of a rigid body is found in it whatever the mesh.
///
/// Not in polybody.hpp: Eigen's sparse module and factorisations would cost every program seconds to compile.

#include <array>
#include <vector>

#include <Eigen/Sparse>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Which of the components x, y, z the six different entries of a symmetric 3×3 belong to, in the order kept everywhere
/// here.
inline constexpr int symmetric_row[6] = {0, 1, 2, 0, 0, 1};
inline constexpr int symmetric_column[6] = {0, 1, 2, 1, 2, 2};  ///< the second component of each entry
/// The place of (k, l) in that order.
inline constexpr int symmetric_place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/// Nodal displacements (3) or displacements and small rotations (6) of every node, in the body's axes.
struct Structure {
  using Sparse = Eigen::SparseMatrix<double>;  ///< by nodal coordinates

  /// A straight Euler–Bernoulli beam between two nodes: kept for strains and stresses, material points between nodes,
  /// and the stiffness that an axial force adds.
  struct Beam {
    Index a = 0, b = 0;      ///< nodes
    Mat3 axes;               ///< (3×3) columns: unit vectors along the beam, and along y, z of the section
    double length = 0.0;     ///< [m]
    BarConstants constants;  ///< of the section
    Index bar = 0;           ///< which bar it belongs to
    double start = 0.0;      ///< distance of node a from that bar's first end [m]
  };

  int per_node = 6;                 ///< coordinates of a node: 3 or 6
  std::vector<Vec3> nodes;          ///< [m]
  Sparse stiffness;                 ///< K (N×N)
  Sparse damping;                   ///< (N×N)
  VecX initial_force;               ///< (N) ∂U/∂e in the undeformed body, of a pretension
  std::array<Sparse, 6> inertia;    ///< ∫ρ S_kᵀ S_l (N×N), in the order of `symmetric_row`; (l, k) is transposed
  double mass = 0.0;                ///< ∫ρ [kg]
  Vec3 first = Vec3::Zero();        ///< ∫ρ u₀ [kg m]
  Mat3 second = Mat3::Zero();       ///< ∫ρ u₀ u₀ᵀ [kg m²]
  std::array<VecX, 3> translation;  ///< ∫ρ S_k (N)
  std::array<std::array<VecX, 3>, 3> moment;  ///< ∫ρ u₀ₖ S_l (N)
  std::vector<Beam> beams;                    ///< empty for a structure from matrices
  std::vector<double> bar_lengths;            ///< of each bar [m]

  Index size() const { return per_node * Index(nodes.size()); }  ///< N, nodal coordinates
  /// M = Σ ∫ρ S_kᵀ S_k.
  template <class = void>  // compiled where it is used
  Sparse mass_matrix() const {
    return inertia[0] + inertia[1] + inertia[2];
  }

  /// Room for everything, all zero. Needs `nodes` and `per_node`.
  template <class = void>
  void clear() {
    Index const n = size();
    stiffness = damping = Sparse(n, n);
    for (Sparse& m : inertia) m = Sparse(n, n);
    initial_force = VecX::Zero(n);
    for (int k = 0; k < 3; ++k) {
      translation[std::size_t(k)] = VecX::Zero(n);
      for (int l = 0; l < 3; ++l) moment[std::size_t(k)][std::size_t(l)] = VecX::Zero(n);
    }
  }
  /// \throws InvalidInput naming `what` unless the node exists.
  template <class = void>
  void require_node(Index node, std::string const& what) const {
    if (node < 0 || node >= Index(nodes.size()))
      throw InvalidInput{
          what, ": node ", node, " does not exist; the structure has nodes 0 to ", Index(nodes.size()) - 1, "."};
  }
};

}  // namespace polybody
