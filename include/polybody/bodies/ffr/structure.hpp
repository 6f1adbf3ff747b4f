#pragma once
/// \file
/// Linear finite element model of one body in its own axes, for a floating frame of reference (ffr.hpp).
/// Theory: Eq. 2.81.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Sparse>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Row indices (0, 1, 2 for x, y, z) of the six different entries of a symmetric 3×3 matrix, in the order in which this
/// library stores them.
inline constexpr int symmetric_row[6] = {0, 1, 2, 0, 0, 1};
inline constexpr int symmetric_column[6] = {0, 1, 2, 1, 2, 2};  ///< column index of each entry
/// Position of entry (k, l) in the order of `symmetric_row` and `symmetric_column`.
inline constexpr int symmetric_place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/// Linear finite element model of one body in its own axes. Each node has displacements (3), or displacements and small
/// rotations (6), in the axes of the body. With the position u(x) = u₀(x) + S(x) e of the material point x and the
/// nodal coordinates e, the structure stores the stiffness and the inertia shape integrals [Shabana 2013, ch. 5–6;
/// thesis App. A]
///   ∫ρ, ∫ρ u₀, ∫ρ u₀u₀ᵀ, ∫ρ S_k, ∫ρ u₀ₖ S_l, ∫ρ S_kᵀ S_l,   k, l = x, y, z.
/// The integrals are exact, so that the inertia of a rigid body follows from them for every mesh.
struct Structure {
  using Sparse = Eigen::SparseMatrix<double>;  ///< matrix of nodal coordinates

  /// Straight beam between two nodes: Euler–Bernoulli beam for constants, and beam with shear for matrices of the
  /// section. Beams are stored for strains and stresses, for material points
  /// between nodes, and for the geometric stiffness of an axial force.
  struct Beam {
    Index a = 0, b = 0;      ///< indices of the nodes at the ends
    Mat3 axes;               ///< (3×3) columns: unit vectors along the beam, and along y, z of the section
    double length = 0.0;     ///< length of the beam [m]
    BarConstants constants;  ///< constants of the section
    Index bar = 0;           ///< index of the bar that contains the beam
    double start = 0.0;      ///< distance of node a from the first end of that bar [m]
    std::shared_ptr<detail::CentredSection const> section = {};  ///< section by matrices; empty for constants
  };

  int per_node = 6;                           ///< coordinates of a node: 3 or 6
  std::vector<Vec3> nodes;                    ///< positions of the nodes [m]
  Sparse stiffness;                           ///< K (N×N)
  Sparse damping;                             ///< D (N×N)
  VecX initial_force;                         ///< (N) ∂U/∂e in the undeformed body, due to a pretension
  std::array<Sparse, 6> inertia;              ///< ∫ρ S_kᵀ S_l (N×N) for (k, l) in the order of `symmetric_row`
  double mass = 0.0;                          ///< ∫ρ [kg]
  Vec3 first = Vec3::Zero();                  ///< ∫ρ u₀ [kg m]
  Mat3 second = Mat3::Zero();                 ///< ∫ρ u₀ u₀ᵀ [kg m²]
  std::array<VecX, 3> translation;            ///< ∫ρ S_k (N)
  std::array<std::array<VecX, 3>, 3> moment;  ///< ∫ρ u₀ₖ S_l (N)
  std::vector<Beam> beams;                    ///< empty for a structure from matrices
  std::vector<double> bar_lengths;            ///< length of each bar [m]
  std::string unit_warning = {};              ///< warning of section matrices that are probably not in SI units

  Index size() const { return per_node * Index(nodes.size()); }  ///< number N of nodal coordinates
  /// Mass matrix M = Σ ∫ρ S_kᵀ S_k.
  template <class = void>  // compiled only if used
  Sparse mass_matrix() const {
    return inertia[0] + inertia[1] + inertia[2];
  }

  /// Allocates all matrices and sets them to zero. Requires `nodes` and `per_node`.
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
  /// Checks the index of a node.
  /// \throws InvalidInput naming `what` unless the node exists.
  template <class = void>
  void require_node(Index node, std::string const& what) const {
    if (node < 0 || node >= Index(nodes.size()))
      throw InvalidInput("structure.node",
                         {ErrorObject{what}, ": node ", ErrorValue{node},
                          " does not exist; the structure has nodes 0 to ", Index(nodes.size()) - 1, "."});
  }
};

}  // namespace polybody
