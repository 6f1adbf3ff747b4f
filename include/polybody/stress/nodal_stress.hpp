#pragma once
/// \file
/// Stress at named nodes of a solid structure, from its nodal displacements.
/// Theory: Eq. 11.17.

#include <cmath>
#include <limits>
#include <string_view>

#include <polybody/bodies/ffr/matrix_file.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

// Von Mises stress of a three-dimensional stress state.

/// Von Mises stress √(½ ((σ_xx − σ_yy)² + (σ_yy − σ_zz)² + (σ_zz − σ_xx)²) + 3 (τ_xy² + τ_yz² + τ_zx²)) [Pa] of a
/// stress s with the components xx, yy, zz, xy, yz, zx [von Mises 1913].
inline double von_mises(Vec6 const& s) {
  Vec3 const difference(s[0] - s[1], s[1] - s[2], s[2] - s[0]);
  return std::sqrt(0.5 * difference.squaredNorm() + 3.0 * s.tail<3>().squaredNorm());
}

/// Stress at named nodes of a solid structure (bodies/ffr/matrix_structure.hpp), linear in its nodal displacements u:
///   σ = D B(ξ_node) u,   xx, yy, zz, xy, yz, zx in the structure's axes [Pa],
/// averaged over the elements that share the node, with the elasticity matrix D and the strain matrix B. The finite
/// element program or a script writes the matrix, for example `examples/track_stress/fe_link/stress_operator.py`. A
/// small rigid motion causes no stress. The result is therefore independent of the frame of the displacements.
///
///     auto const stress = NodalStress::read("link.stress.mtx", "link.stress_nodes.txt", structure.size());
///     stress.von_mises("middle, wheel side", decoupled.displacements());  // stress/decoupled_stress.hpp
///     stress.modal(shapes).of("middle, wheel side", q);                   // coordinates of a floating frame
///
/// Displacements are (N×samples), modal coordinates q (n×samples).
class NodalStress {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;  ///< stresses per nodal coordinate
  /// Named node of the structure.
  struct Spot {
    Index node = 0;    ///< index of the node in the structure, from 0
    std::string name;  ///< name of the node
  };

  /// Constructs the stress from a `matrix` with six rows for each of the spots, in their order, and one column per
  /// coordinate (6k×N) [Pa/m].
  /// \throws InvalidInput for another number of rows, an entry that is not finite, no spots, or two spots with the same
  /// name.
  template <class = void>  // compiled where it is used
  NodalStress(Matrix const& matrix, std::vector<Spot> spots) : matrix_(matrix), spots_(std::move(spots)) {
    Index const k = Index(spots_.size());
    if (k == 0)
      throw InvalidInput("nodal_stress.nodes",
                         {ErrorObject{"NodalStress"}, ": at least one node is needed, but the list is empty."});
    if (matrix_.rows() != 6 * k)
      throw InvalidInput("nodal_stress.size",
                         {ErrorObject{"NodalStress"}, ": the matrix has ", ErrorValue{matrix_.rows()}, " rows, but ", k,
                          " nodes need ", 6 * k, ", six stresses per node."});
    for (Index row = 0; row < matrix_.rows(); ++row)
      for (Matrix::InnerIterator it(matrix_, row); it; ++it)
        if (!std::isfinite(it.value()))
          throw InvalidInput(
              "value.not_finite",
              {ErrorObject{"NodalStress"}, ": row ", row, ", column ", it.col(), " of the matrix is ",
               ErrorValue{it.value()}, ". Rows and columns are counted from 0. Give finite numbers, in Pa/m."});
    for (auto spot = spots_.begin(); spot != spots_.end(); ++spot)
      if (spot != find(spot->name))
        throw InvalidInput("nodal_stress.nodes", {ErrorObject{"NodalStress"}, ": duplicate node name \"", spot->name,
                                                  "\". Give each node a different name."});
  }

  /// Reads `matrix_file` in the Matrix Market format (6k×`coordinates`) and `names_file`, a text with a line
  /// `node name` for each of the k nodes. Nodes are counted from 0; # begins a comment. A structure has three
  /// coordinates per node: `Structure::size()`.
  /// \throws IoError naming file and line if a file cannot be read, is truncated or has the wrong size; InvalidInput if
  /// `coordinates` is not a positive multiple of three.
  template <class = void>
  static NodalStress read(std::string const& matrix_file, std::string const& names_file, Index coordinates) {
    if (coordinates < 3 || coordinates % 3 != 0 || coordinates > std::numeric_limits<int>::max())
      throw InvalidInput("nodal_stress.size", {ErrorObject{"NodalStress"}, ": ", ErrorValue{coordinates},
                                               " coordinates are not three displacements per node. Give "
                                               "Structure::size() of a structure from matrices."});
    std::vector<Spot> spots = read_spots(names_file, coordinates / 3);
    Index const rows = 6 * Index(spots.size());
    return {read_matrix(matrix_file, rows, coordinates,
                        sentence_of({spots.size(), " nodes of ", names_file, " need ", rows, "×", coordinates,
                                     ", six stresses per node as functions of all displacements"})),
            std::move(spots)};
  }

  std::vector<Spot> const& spots() const { return spots_; }  ///< named nodes, in the order of the rows
  /// Stress matrix (6k×N) [Pa/m].
  Matrix const& matrix() const { return matrix_; }
  Index coordinates() const { return matrix_.cols(); }  ///< number of coordinates of the structure

  /// Stress of every named node (6k×samples) [Pa] under `displacements` (N×samples) [m]. \throws InvalidInput unless
  /// there are N rows.
  template <class = void>
  MatX of(MatX const& displacements) const {
    require_rows(displacements, "displacements");
    return matrix_ * displacements;
  }
  /// Stress history of the node `name` under these `displacements` (N×samples) [m].
  /// \throws InvalidInput unless there are N rows, and for a name that does not exist.
  template <class = void>
  std::vector<Vec6> of(std::string_view name, MatX const& displacements) const {
    Index const first = row_of(name);
    require_rows(displacements, "displacements");
    Mat<double, 6, Eigen::Dynamic> const history = matrix_.middleRows(first, 6) * displacements;
    std::vector<Vec6> out(std::size_t(history.cols()));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = history.col(Index(i));
    return out;
  }
  /// History of the von Mises stress [Pa] of the node `name` under these `displacements`. \throws InvalidInput like
  /// `of`.
  template <class = void>
  std::vector<double> von_mises(std::string_view name, MatX const& displacements) const {
    std::vector<double> out;
    for (Vec6 const& s : of(name, displacements)) out.push_back(polybody::von_mises(s));
    return out;
  }

  /// Stress at the same nodes as a function of modal coordinates q (n×samples). The displacements are `shapes` (N×n)
  /// times q. The new matrix is (6k×n), so a stress needs only six scalar products of length n. \throws InvalidInput
  /// unless the shapes have N rows.
  template <class = void>
  NodalStress modal(MatX const& shapes) const {
    require_rows(shapes, "shapes");
    MatX const reduced = matrix_ * shapes;
    return {reduced.sparseView(), spots_};
  }

 private:
  template <class = void>
  static std::vector<Spot> read_spots(std::string const& file, Index nodes) {
    NumberReader lines(file, '#');
    std::vector<Spot> spots;
    Index node = 0;
    NumberReader::Rest name;
    while (lines.next("the number of a node and its name", node, name)) {
      if (node < 0 || node >= nodes)
        lines.fail(sentence_of({"node ", node, " does not exist; the structure has nodes 0 to ", nodes - 1}));
      for (Spot const& other : spots)
        if (other.name == name.text)
          lines.fail("duplicate node name \"" + name.text + "\"; give each node a different name");
      spots.push_back({node, name.text});
    }
    if (spots.empty()) lines.fail("the file names no nodes; write the number and the name of one node in each line");
    return spots;
  }

  template <class = void>
  std::vector<Spot>::const_iterator find(std::string_view name) const {
    return std::find_if(spots_.begin(), spots_.end(), [&](Spot const& spot) { return spot.name == name; });
  }
  template <class = void>
  Index row_of(std::string_view name) const {
    auto const spot = find(name);
    if (spot != spots_.end()) return 6 * Index(spot - spots_.begin());
    std::string known;
    for (Spot const& s : spots_) known += (known.empty() ? "\"" : ", \"") + s.name + '"';
    throw InvalidInput("nodal_stress.no_node", {"NodalStress: no node is called \"", ErrorObject{std::string(name)},
                                                "\". The named nodes are ", known, "."});
  }
  template <class = void>
  void require_rows(MatX const& x, char const* what) const {
    if (x.rows() != matrix_.cols())
      throw InvalidInput("nodal_stress.size",
                         {ErrorObject{"NodalStress"}, ": the ", what, " have ", ErrorValue{x.rows()},
                          " rows, but the stress matrix has ", matrix_.cols(),
                          " columns. Give a row for each coordinate of the structure."});
  }

  Matrix matrix_;  ///< (6k×N)
  std::vector<Spot> spots_;
};

}  // namespace polybody
