// Elements of several bodies in one SIMD vector.
#include <polybody/system/pool_batches.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;

namespace pool_batches_test {

static_assert(ComparableElements<AncfCable<>> && ComparableElements<AncfBeam<ElasticLine>> &&
              !ComparableElements<Rigid<>>);

Bar bar(double y, double young = 1e7) {
  return {.length = 0.3,
          .section = Rectangle{.height = 0.02, .width = 0.03},
          .material = Material{.density = 2000.0, .young = young, .poisson = 0.3},
          .placement = Placement::at({0, y, 0}),
          .damping = {.axial = 1e-3, .bending = 1e-3}};
}

template <class B>
Model<Bodies<B>, Joints<>, Forces<>> bodies(std::vector<B> const& all) {
  Model<Bodies<B>, Joints<>, Forces<>> model{Gravity{0, 0, -9.81}};
  for (std::size_t i = 0; i < all.size(); ++i) model.add(all[i], "body " + std::to_string(i));
  return model;
}

template <class B>
detail::PoolBatches batches(std::vector<B> const& all) {
  auto const model = bodies(all);
  return detail::batches_of(std::get<0>(model.body_pools()));
}

// Bodies with fewer elements than the lanes of a SIMD vector share SIMD vectors; bodies with as many do not.
TEST(PoolBatches, FillPacksFromBodiesThatAreAlike) {
  using B = AncfCable<>;
  std::vector<B> all;
  for (int i = 0; i < 2 * simd_size + 1; ++i) all.push_back(B::from(bar(i), 1));
  all.push_back(B::from(bar(-1), simd_size));
  detail::PoolBatches const found = batches(all);
  EXPECT_EQ(found.filled.size(), 2u);
  ASSERT_EQ(found.singles.size(), 1u);
  EXPECT_EQ(found.singles[0].entry, 2 * simd_size);
  ASSERT_EQ(found.bodies.size(), 1u);
  EXPECT_EQ(found.bodies[0], 2 * simd_size + 1);
}

// Elements with another material or another length are in another SIMD vector.
TEST(PoolBatches, KeepBodiesApartThatDiffer) {
  using B = AncfCable<>;
  std::vector<B> all;
  for (int i = 0; i < simd_size; ++i) all.push_back(B::from(bar(i, i % 2 == 0 ? 1e7 : 2e7), 1));
  EXPECT_EQ(batches(all).filled.size(), 0u);
  EXPECT_EQ(batches(all).singles.size(), std::size_t(simd_size));
  std::vector<B> lengths;
  for (int i = 0; i < simd_size; ++i) {
    Bar one = bar(i);
    one.length = i % 2 == 0 ? 0.3 : 0.4;
    lengths.push_back(B::from(one, 1));
  }
  EXPECT_EQ(batches(lengths).filled.size(), 0u);
}

/// q, v and v̇ that bend and rotate all bodies.
State swaying(State x) {
  for (Index i = 0; i < x.q.size(); ++i) x.q[i] += 0.01 * std::sin(3.0 * double(i));
  for (Index i = 0; i < x.v.size(); ++i) {
    x.v[i] = std::cos(2.0 * double(i));
    x.a[i] = std::sin(5.0 * double(i));
  }
  return x;
}

struct DenseSink {
  MatX a;
  void add(Index row, Index col, BlockView const& b) {
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) a(row + i, col + j) += b(i, j);
  }
};

template <class B>
void expect_sums_of_bodies(std::vector<B> const& all) {
  auto const model = bodies(all);
  State const x = swaying(model.reference_state());
  System system(model, with<Capabilities::implicit_step>);
  system.evaluate(x.q, x.v, 0.0);
  VecX r(model.velocities());
  system.residual(x.a, x.lambda, r);
  DenseSink sum{MatX::Zero(model.velocities(), model.velocities())};
  BlockSink sink(sum);
  system.tangent({1.5, 0.1, 0.7}, SecondOrder::omitted, x.lambda, sink);

  Index first = 0;
  for (B const& body : all) {
    Index const n = body.velocities();
    auto const only = bodies(std::vector<B>{body});
    State part = only.reference_state();
    part.q = x.q.segment(first, n);
    part.v = x.v.segment(first, n);
    System alone(only, with<Capabilities::implicit_step>);
    alone.evaluate(part.q, part.v, 0.0);
    VecX of_part(n);
    alone.residual(VecX(x.a.segment(first, n)), part.lambda, of_part);
    DenseSink of_body{MatX::Zero(n, n)};
    BlockSink to(of_body);
    alone.tangent({1.5, 0.1, 0.7}, SecondOrder::omitted, part.lambda, to);
    EXPECT_LT((r.segment(first, n) - of_part).norm(), 1e-12 * of_part.norm());
    EXPECT_LT((sum.a.block(first, first, n, n) - of_body.a).norm(), 1e-12 * of_body.a.norm());
    first += n;
  }
}

// Each body has the forces and the tangent that it has alone, for any grouping of elements. The bodies have one or
// more elements, of two materials. Their order fills SIMD vectors, leaves a remainder and divides bodies.
TEST(PoolBatches, GiveEachBodyItsForcesAndTangent) {
  std::vector<AncfCable<>> cables;
  std::vector<AncfBeam<ElasticLine>> beams;
  for (int i = 0; i < 11; ++i) {
    cables.push_back(AncfCable<>::from(bar(i, i < 6 ? 1e7 : 3e7), 1 + i % 2));
    beams.push_back(AncfBeam<ElasticLine>::from(bar(i, i < 5 ? 1e7 : 3e7), 1));
  }
  cables.push_back(AncfCable<>::from(bar(20), 9));
  expect_sums_of_bodies(cables);
  expect_sums_of_bodies(beams);
}

}  // namespace pool_batches_test
