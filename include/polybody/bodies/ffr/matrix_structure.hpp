#pragma once
/// \file
/// Structure from the matrices of a finite element program: solid elements with three displacements per node.
/// Theory: Eqs. 10.13, 10.15 to 10.17.

#include <limits>

#include <Eigen/SparseCholesky>

#include <polybody/bodies/ffr/matrix_file.hpp>
#include <polybody/bodies/ffr/structure.hpp>

namespace polybody {

namespace detail {

/// Name of row or column i in messages, for a matrix whose rows and columns are x, y, z of every node.
template <class = void>  // compiled only if used
std::string coordinate_name(Index i) {
  return sentence_of({i, " (", "xyz"[i % 3], " of node ", i / 3, ")"});
}
template <class = void>
std::string entry_name(Index i, Index j) {
  return sentence_of({"row ", coordinate_name(i), ", column ", coordinate_name(j)});
}

template <class = void>
double largest_entry(Structure::Sparse const& m) {
  double largest = 0.0;
  for (Index j = 0; j < m.outerSize(); ++j)
    for (Structure::Sparse::InnerIterator it(m, j); it; ++it) largest = std::max(largest, std::abs(it.value()));
  return largest;
}

/// Checks the matrix m; `name` begins the message.
/// \throws InvalidInput unless m is n×n, has entries up to `largest_number`, and is symmetric to 1e-9 of its largest
/// entry.
template <class = void>
void require_symmetric(Structure::Sparse const& m, Index n, std::string const& name) {
  if (m.rows() != n || m.cols() != n)
    throw InvalidInput(
        "structure.matrix_size",
        {ErrorObject{"Structure"}, ": ", name, " is ", ErrorValue{m.rows()}, "×", m.cols(), ", but ", n / 3,
         " nodes with three displacements each need ", n, "×", n,
         ". Give every node of the model, without elements that have rotations, and do not omit fixed displacements."});
  double const least = 1e-9 * largest_entry(m);
  Structure::Sparse const turned = m.transpose();
  for (Index j = 0; j < n; ++j) {
    for (Structure::Sparse::InnerIterator it(m, j); it; ++it) {
      if (!(std::abs(it.value()) <= largest_number))
        throw InvalidInput("value.not_finite", {ErrorObject{"Structure"}, ": ", name, non_finite_suffix(it.value()),
                                                " in ", entry_name(it.row(), j), ". Export the matrices again."});
      double const other = turned.coeff(it.row(), j);
      if (!(std::abs(it.value() - other) <= least))
        throw InvalidInput("structure.not_symmetric",
                           {ErrorObject{"Structure"}, ": ", name, " is not symmetric: ", entry_name(it.row(), j),
                            " is ", ErrorValue{it.value()}, ", but its mirror image is ", other,
                            ". If a matrix is stored as one triangle, give both triangles."});
    }
  }
}

/// Matrix m (n×n) of the mass matrix M = m ⊗ 1₃.
/// \throws InvalidInput if M does not have this form to 1e-9 of its largest entry, or if m is not positive definite.
template <class = void>
Structure::Sparse scalar_mass(Structure::Sparse const& mass) {
  std::string const remedy =
      ". Use solid elements with a consistent mass matrix and three displacements per node, and order "
      "the displacements x, y, z of node 0, x, y, z of node 1, and so on.";
  double const largest = largest_entry(mass), least = 1e-9 * largest;
  Index const n = mass.rows() / 3;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < mass.cols(); ++j)
    for (Structure::Sparse::InnerIterator it(mass, j); it; ++it) {
      Index const i = it.row();
      if (i % 3 != j % 3) {
        if (std::abs(it.value()) > least)
          throw InvalidInput("structure.mass",
                             {ErrorObject{"Structure"}, ": the mass matrix couples different directions in ",
                              entry_name(i, j), remedy});
        continue;
      }
      Index const next = j % 3 == 2 ? -2 : 1;
      double const other = mass.coeff(i + next, j + next);
      if (std::abs(it.value() - other) > least)
        throw InvalidInput("structure.mass",
                           {ErrorObject{"Structure"}, ": the mass matrix has ", ErrorValue{it.value()}, " in ",
                            entry_name(i, j), ", but ", other, " in ", entry_name(i + next, j + next), remedy});
      entries.emplace_back(int(i / 3), int(j / 3),
                           it.value() / 6.0);  // mean over the three directions and over (i, j), (j, i)
      entries.emplace_back(int(j / 3), int(i / 3), it.value() / 6.0);
    }
  Structure::Sparse m(n, n);
  m.setFromTriplets(entries.begin(), entries.end());
  Eigen::SimplicialLDLT<Structure::Sparse> const factor(m);
  for (Index k = 0; k < n; ++k)
    if (!(factor.vectorD()[k] > 1e-13 * largest))
      throw InvalidInput(
          "structure.mass",
          {ErrorObject{"Structure"}, ": the mass matrix is not positive definite; its factorisation fails at node ",
           factor.permutationPinv().indices()[k], ". Every node needs mass: omit nodes that belong to no element."});
  return m;
}

/// Checks that rigid motions φ do not strain the structure.
/// \throws InvalidInput if ‖K φ‖ > 1e-6 ‖K‖ ‖φ‖ for a rigid motion φ.
template <class = void>
void require_free_of_rigid_work(Structure::Sparse const& stiffness, std::vector<Vec3> const& nodes) {
  Vec3 middle = Vec3::Zero();
  for (Vec3 const& r : nodes) middle += r / double(nodes.size());
  double const norm = stiffness.norm();
  for (int motion = 0; motion < 6; ++motion) {
    VecX shape(stiffness.cols());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Vec3 const unit = Vec3::Unit(motion % 3);
      shape.segment<3>(3 * Index(i)) = motion < 3 ? unit : Vec3(unit.cross(nodes[i] - middle));
    }
    VecX const force = stiffness * shape;
    if (force.norm() <= 1e-6 * norm * shape.norm()) continue;
    Index worst = 0;
    force.cwiseAbs().maxCoeff(&worst);
    throw InvalidInput(
        "structure.rigid_motion",
        {ErrorObject{"Structure"}, ": a rigid ", motion < 3 ? "displacement along " : "rotation about ",
         "xyz"[motion % 3], " strains the structure, most in row ", coordinate_name(worst),
         " of the stiffness matrix. Give the nodes in the order of the matrices and in the unit of length "
         "of the stiffness, and fix no displacement in the finite element model."});
  }
}

/// Speed of waves from node to node [m/s], accurate to a factor of two: the smallest value of h √(K_ii/m_ii)/2 over all
/// nodes. The length h is the distance of the nearest node that the stiffness couples with node i.
/// \param m (n×n) masses of the nodes [kg]
template <class = void>
double wave_speed(Structure::Sparse const& m, Structure::Sparse const& stiffness, std::vector<Vec3> const& nodes) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < Index(nodes.size()); ++i) {
    double nearest = std::numeric_limits<double>::infinity(), sum = 0.0;
    for (Index j = 3 * i; j < 3 * i + 3; ++j)
      for (Structure::Sparse::InnerIterator it(stiffness, j); it; ++it) {
        if (it.row() == j) sum += it.value() / 3.0;
        double const distance = (nodes[std::size_t(it.row() / 3)] - nodes[std::size_t(i)]).norm();
        if (it.value() != 0.0 && distance > 0.0) nearest = std::min(nearest, distance);
      }
    if (sum > 0.0) least = std::min(least, 0.5 * nearest * std::sqrt(sum / m.coeff(i, i)));
  }
  return least;
}

/// Checks the wave speed of a structure.
/// \throws InvalidInput for a wave speed above `fastest` [m/s], for example with nodes in millimetres. A wrong unit of
/// length does not affect the check of rigid motions, but multiplies the wave speed.
template <class = void>
void require_units_of_solids(double speed, double fastest) {
  if (!(speed > fastest) || !std::isfinite(speed)) return;
  throw InvalidInput(
      "structure.units",
      {ErrorObject{"Structure"}, ": nodes, masses and stiffness have inconsistent units: waves would travel at ",
       ErrorValue{speed}, " m/s, but the limit is ", fastest,
       " m/s (waves in diamond: 1.8e4 m/s). Give nodes in metres, masses in kilograms and the stiffness in N/m; nodes "
       "in millimetres make waves 1000 times as fast. For a material with faster waves, increase fastest_wave."});
}

/// Checks that the moments of mass are finite.
/// \throws InvalidInput if products of masses and positions overflow.
template <class = void>
void require_finite_moments(Structure const& s) {
  bool finite = s.first.allFinite() && s.second.allFinite();
  for (auto const& moment : s.moment)
    for (VecX const& shape : moment) finite = finite && shape.allFinite();
  if (!finite)
    throw InvalidInput("value.not_finite",
                       {ErrorObject{"Structure"},
                        ": the moments of mass are not finite. Give nodes in metres and masses in kilograms."});
}

}  // namespace detail

/// Structure of solid elements from its mass matrix [kg] and stiffness [N/m] (N×N, N = 3 × nodes; x, y, z of node 0, of
/// node 1, …), and its undeformed nodes [m]. Isoparametric elements with a consistent mass matrix give the exact
/// integrals.
///
/// Displacement and undeformed position have the same shape functions, u = Σ N_i u_i and u₀ = Σ N_i x_i. With m_ij = ∫ρ
/// N_i N_j the mass matrix is m ⊗ 1₃, and all integrals of structure.hpp follow exactly from m and the nodes:
///   ∫ρ S_kᵀ S_l: m_ij at (3i+k, 3j+l),   ∫ρ S_k: Σ_i m_ij at 3j+k,
///   ∫ρ u₀ₖ S_l: Σ_i x_ik m_ij at 3j+l,   ∫ρ u₀u₀ᵀ = Xᵀ m X.
/// \throws InvalidInput for sizes that do not fit; matrices that are not symmetric or not finite; a mass matrix that is
/// not m ⊗ 1₃ or not positive definite; a stiffness that resists rigid motions, for example with nodes in the wrong
/// order; waves faster than `fastest_wave` [m/s], for example with nodes in millimetres and a stiffness in N/m.
template <class = void>
Structure structure_of(Structure::Sparse const& mass, Structure::Sparse const& stiffness,
                       std::vector<Vec3> const& nodes, double fastest_wave = 1e5) {
  if (nodes.empty())
    throw InvalidInput("structure.no_nodes",
                       {ErrorObject{"Structure"}, ": the structure has no nodes. Give at least one position."});
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (double const x : nodes[i])
      if (!(std::abs(x) <= largest_number))
        throw InvalidInput("value.not_finite",
                           {ErrorObject{"Structure"}, ": a coordinate of node ", i, ", counted from 0,",
                            non_finite_suffix(x), " but must be a length in metres."});
  Structure s;
  s.per_node = 3;
  s.nodes = nodes;
  detail::require_symmetric(mass, s.size(), "the mass matrix");
  detail::require_symmetric(stiffness, s.size(), "the stiffness matrix");
  Structure::Sparse const m = detail::scalar_mass(mass);
  detail::require_free_of_rigid_work(stiffness, nodes);
  detail::require_units_of_solids(detail::wave_speed(m, stiffness, nodes), fastest_wave);
  s.clear();
  s.stiffness = 0.5 * (stiffness + Structure::Sparse(stiffness.transpose()));
  std::array<std::vector<Eigen::Triplet<double>>, 6> inertia;
  for (Index j = 0; j < m.cols(); ++j)
    for (Structure::Sparse::InnerIterator it(m, j); it; ++it) {
      Index const i = it.row();
      double const value = it.value();
      Vec3 const &a = nodes[std::size_t(i)], &b = nodes[std::size_t(j)];
      s.mass += value;
      s.first += value * a;
      s.second += value * a * b.transpose();
      for (std::size_t l = 0; l < 3; ++l) {
        s.translation[l][3 * j + Index(l)] += value;
        for (std::size_t k = 0; k < 3; ++k) s.moment[k][l][3 * j + Index(l)] += a[Index(k)] * value;
      }
      for (std::size_t p = 0; p < 6; ++p)
        inertia[p].emplace_back(int(3 * i) + symmetric_row[p], int(3 * j) + symmetric_column[p], value);
    }
  for (std::size_t p = 0; p < 6; ++p) s.inertia[p].setFromTriplets(inertia[p].begin(), inertia[p].end());
  detail::require_finite_moments(s);
  return s;
}

namespace detail {

/// Nodes from a file with one `x y z` [m] on each line.
/// \throws IoError for a line of another form, and for a file without nodes.
template <class = void>
std::vector<Vec3> read_nodes(std::string const& file) {
  NumberReader lines(file, '#');
  std::vector<Vec3> nodes;
  Vec3 r;
  while (lines.next("x y z of a node", r[0], r[1], r[2])) nodes.push_back(r);
  if (nodes.empty()) lines.fail("the file has no nodes; write x y z of one node on each line");
  if (nodes.size() > std::size_t(std::numeric_limits<int>::max() / 3))
    lines.fail("the file has more nodes than a sparse matrix can index");
  return nodes;
}

}  // namespace detail

/// Structure from files. `mass_file` and `stiffness_file` are in the coordinate format of Matrix Market. `nodes_file`
/// has a line `x y z` [m] for each node, in which # begins a comment.
/// \throws IoError naming file and line for a file that cannot be read, is truncated or does not fit the nodes.
/// \throws InvalidInput naming the files, in the same cases as `structure_of`, including waves faster than
/// `fastest_wave` [m/s].
template <class = void>
Structure read_structure(std::string const& mass_file, std::string const& stiffness_file, std::string const& nodes_file,
                         double fastest_wave = 1e5) {
  std::vector<Vec3> const nodes = detail::read_nodes(nodes_file);
  Index const n = 3 * Index(nodes.size());
  std::string const need =
      sentence_of({nodes.size(), " nodes of ", nodes_file, " need ", n, "×", n, ", three displacements each"});
  Structure::Sparse const mass = read_matrix(mass_file, n, n, need),
                          stiffness = read_matrix(stiffness_file, n, n, need);
  try {
    return structure_of(mass, stiffness, nodes, fastest_wave);
  } catch (InvalidInput const& error) {
    throw InvalidInput({ErrorObject{mass_file}, ", ", stiffness_file, ", ", nodes_file, ": ", ErrorCause{error}});
  }
}

}  // namespace polybody
