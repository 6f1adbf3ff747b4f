#include <polybody/bodies/ffr/node_patch.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

using namespace polybody;

namespace node_patch_test {

/// Seven non-coplanar nodes without stiffness or mass.
Structure cloud(int per_node) {
  Structure s;
  s.per_node = per_node;
  for (int i = 0; i < 7; ++i) s.nodes.push_back(Vec3(std::sin(3.0 * i), std::cos(1.7 * i), 0.3 * i * std::sin(i)));
  s.clear();
  return s;
}

TEST(NodePatch, SharesAWrenchWithItsResultant) {
  Structure const s = cloud(3);
  NodePatch const patch(s, {0, 2, 3, 6}, "test");
  Vec3 const at(0.4, -0.2, 1.0), f(1.0, -2.0, 3.0), m(-0.5, 0.7, 0.2);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t k = 0; k < patch.nodes().size(); ++k) {
    Vec3 const part = patch.force(k, at, f, m);
    force += part;
    moment += (s.nodes[std::size_t(patch.nodes()[k])] - at).cross(part);
  }
  EXPECT_LT((force - f).norm(), 1e-13);
  EXPECT_LT((moment - m).norm(), 1e-13);
}

TEST(NodePatch, TakesTheLeastForces) {  // adds self-balanced pairs of forces
  Structure const s = cloud(3);
  NodePatch const patch(s, {0, 1, 4, 5}, "test");
  Vec3 const f(1.0, -2.0, 3.0), m(-0.5, 0.7, 0.2), along = s.nodes[1] - s.nodes[0];
  double product = 0.0;
  for (std::size_t k = 0; k < 2; ++k) product += (k == 0 ? 1.0 : -1.0) * patch.force(k, Vec3::Zero(), f, m).dot(along);
  EXPECT_NEAR(product, 0.0, 1e-13);
}

TEST(NodePatch, MovesAsItsForcesWork) {  // also for nodes with rotations, which are not used
  for (int const per_node : {3, 6}) {
    Structure const s = cloud(per_node);
    NodePatch const patch(s, {1, 2, 5, 6}, "test");
    Vec3 const at(0.1, 0.3, -0.7);
    MatX const shapes = MatX::Random(s.size(), 4), loads = patch.loads(at, s.size());
    auto const [u, turn] = patch.motion(at, shapes);
    MatX motion(6, 4);
    motion << u, turn;
    EXPECT_LT((loads.transpose() * shapes - motion).norm(), 1e-13);
  }
}

TEST(NodePatch, FollowsARigidMotion) {
  Structure const s = cloud(3);
  Vec3 const shift(0.3, 0.1, -0.2), turn(0.02, -0.01, 0.03), at(1.0, 2.0, 3.0);
  MatX shape(s.size(), 1);
  for (Index i = 0; i < 7; ++i) shape.block<3, 1>(3 * i, 0) = shift + turn.cross(s.nodes[std::size_t(i)]);
  auto const motion = NodePatch(s, nodes_within(s, Vec3::Zero(), 1.5), "test").motion(at, shape);
  EXPECT_LT((motion.displacement - (shift + turn.cross(at))).norm(), 1e-14);
  EXPECT_LT((motion.rotation - turn).norm(), 1e-14);
}

TEST(NodePatch, SharesByWeights) {  // also the resultant and the virtual work
  Structure const s = cloud(3);
  std::vector<double> const weights{3.0, 1.0, 2.0, 2.0};
  NodePatch const patch(s, {0, 2, 3, 6}, "test", weights);
  Vec3 const f(1.0, -2.0, 3.0);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT((patch.force(k, patch.middle(), f, Vec3::Zero()) - weights[k] / 8.0 * f).norm(), 1e-14);
  Vec3 const at(0.4, -0.2, 1.0), m(-0.5, 0.7, 0.2);
  Vec3 moment = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    moment += (s.nodes[std::size_t(patch.nodes()[k])] - at).cross(patch.force(k, at, f, m));
  EXPECT_LT((moment - m).norm(), 1e-13);
  MatX const shapes = MatX::Random(s.size(), 3);
  auto const [u, turn] = patch.motion(at, shapes);
  MatX motion(6, 3);
  motion << u, turn;
  EXPECT_LT((patch.loads(at, s.size()).transpose() * shapes - motion).norm(), 1e-13);
}

TEST(NodePatch, RefusesNodesThatTakeNoMoment) {
  Structure s = cloud(3);
  s.nodes[2] = 0.5 * (s.nodes[0] + s.nodes[1]);
  EXPECT_TRUE(has(refusal([&] { NodePatch(s, {0, 1, 2}, "Link"); }),
                  "Link: a patch needs at least three nodes that are not in line, but this patch has 3 nodes in line. "
                  "Enlarge the patch."));
  EXPECT_TRUE(has(refusal([&] { NodePatch(s, {}, "Link"); }), "but this patch has 0."));
  EXPECT_TRUE(has(refusal([&] { NodePatch(s, {0, 1, 7}, "Link"); }), "Link: node 7 does not exist"));
  EXPECT_TRUE(has(refusal([&] { NodePatch(s, {0, 1, 3}, "Link", {1.0, 1.0}); }), "of 3 nodes has 2 weights."));
  EXPECT_TRUE(has(refusal([&] { NodePatch(s, {0, 1, 3}, "Link", {1.0, 0.0, 1.0}); }), "the weight of a node"));
}

}  // namespace node_patch_test
