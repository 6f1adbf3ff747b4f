#pragma once
/// \file
/// Distributing coupling of several nodes of a structure, such as the seat of a pin or the area under a wheel.
/// Theory: Eq. 2.98.

#include <polybody/bodies/ffr/structure.hpp>

namespace polybody {

/// Nodes within `distance` [m] of the position `at` (3) [m].
template <class = void>  // compiled only if used
std::vector<Index> nodes_within(Structure const& s, Vec3 const& at, double distance) {
  std::vector<Index> nodes;
  for (std::size_t i = 0; i < s.nodes.size(); ++i)
    if ((s.nodes[i] - at).norm() <= distance) nodes.push_back(Index(i));
  return nodes;
}

/// Distributing coupling: a point that follows the mean motion of several nodes. With weights w_i, Σ w_i = 1, a wrench
/// (f, m) about the centre of the nodes c = Σ w_i r_i is distributed as
///   f_i = w_i (f + θ × d_i),   θ = (Σ w (d² 1 − d dᵀ))⁻¹ m,   d_i = r_i − c.
/// These nodal forces have the least Σ f_i²/w_i of all forces with this resultant. The motion (u, ϑ) of the patch is
/// work-conjugate to (f, m):
///   u = Σ w_i u_i,   ϑ = (Σ w (d² 1 − d dᵀ))⁻¹ Σ w_i d_i × u_i.
class NodePatch {
 public:
  /// Displacement [m] and small rotation [rad] of a point for each unit deformation coordinate.
  struct Motion {
    Mat<double, 3, Eigen::Dynamic> displacement, rotation;  ///< (3×n), in the axes of the structure
  };

  /// Patch of `nodes`.
  /// \param weights one for each node, such as its area; empty for equal weights.
  /// \throws InvalidInput, with a message that begins with `who`, for nodes that do not exist, and for fewer than three
  /// nodes or nodes on one line. The weights must be positive, one for each node.
  template <class = void>
  NodePatch(Structure const& s, std::vector<Index> nodes, std::string const& who, std::vector<double> weights = {})
      : per_node_(s.per_node), nodes_(std::move(nodes)), weights_(std::move(weights)) {
    for (Index const i : nodes_) s.require_node(i, who);
    normalise(who);
    for (std::size_t k = 0; k < nodes_.size(); ++k) middle_ += weights_[k] * s.nodes[std::size_t(nodes_[k])];
    Mat3 spread = Mat3::Zero();
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      Vec3 const d = s.nodes[std::size_t(nodes_[k])] - middle_;
      arms_.push_back(d);
      spread += weights_[k] * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
    if (!(spread.determinant() > 1e-9 * std::pow(spread.trace() / 3.0, 3)))
      throw InvalidInput(
          "structure.patch",
          {ErrorObject{who}, ": a patch needs at least three nodes that are not in line, but this patch has ",
           ErrorValue{nodes_.size()}, nodes_.size() < 3 ? "" : " nodes in line", ". Enlarge the patch."});
    by_moment_ = spread.inverse();
  }

  std::vector<Index> const& nodes() const { return nodes_; }  ///< indices of the nodes in the structure
  Vec3 const& middle() const { return middle_; }              ///< c = Σ w_i r_i, in the axes of the structure [m]

  /// Force on node k of the patch [N] due to a wrench, f (3) [N] and m (3) [N m], about the point `at`.
  template <class = void>
  Vec3 force(std::size_t k, Vec3 const& at, Vec3 const& f, Vec3 const& m) const {
    Vec3 const theta = by_moment_ * (m + (at - middle_).cross(f));
    return weights_[k] * (f + theta.cross(arms_[k]));
  }
  /// Nodal forces (N×6) of the unit forces and unit moments about `at`, for a structure of N = `size` coordinates.
  template <class = void>
  MatX loads(Vec3 const& at, Index size) const {
    MatX out = MatX::Zero(size, 6);
    for (int c = 0; c < 6; ++c) {
      Vec3 const f = c < 3 ? Vec3(Vec3::Unit(c)) : Vec3(Vec3::Zero()),
                 m = c < 3 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(c - 3));
      for (std::size_t k = 0; k < nodes_.size(); ++k) out.block<3, 1>(per_node_ * nodes_[k], c) = force(k, at, f, m);
    }
    return out;
  }
  /// Motion of the point `at`, fixed to the patch, for the shapes (N×n) of the structure.
  template <class = void>
  Motion motion(Vec3 const& at, MatX const& shapes) const {
    Mat<double, 3, Eigen::Dynamic> mean(3, shapes.cols()), turn(3, shapes.cols());
    mean.setZero();
    turn.setZero();
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      auto const u = shapes.middleRows<3>(per_node_ * nodes_[k]);
      mean += weights_[k] * u;
      turn += weights_[k] * skew<double>(arms_[k]) * u;
    }
    turn = (by_moment_ * turn).eval();
    return {mean - skew<double>(Vec3(at - middle_)) * turn, turn};
  }

 private:
  template <class = void>
  void normalise(std::string const& who) {
    if (weights_.empty()) weights_.assign(nodes_.size(), 1.0);
    if (weights_.size() != nodes_.size())
      throw InvalidInput("structure.patch",
                         {ErrorObject{who}, ": a patch of ", nodes_.size(), " nodes has ", ErrorValue{weights_.size()},
                          " weights. Give one weight for each node, or none."});
    double sum = 0.0;
    for (double const w : weights_) {
      require_positive(w, who, ": the weight of a node");
      sum += w;
    }
    for (double& w : weights_) w /= sum;
  }

  Index per_node_;
  std::vector<Index> nodes_;
  std::vector<double> weights_;  ///< their sum is 1
  std::vector<Vec3> arms_;
  Vec3 middle_ = Vec3::Zero();
  Mat3 by_moment_;
};

}  // namespace polybody
