#include <polybody/bodies/ancf/mean_section_frame.hpp>

#include <gtest/gtest.h>

#include <random>

namespace polybody {
namespace mean_section_frame_test {

using D = Dual<1>;

/// Two directors that are far from orthonormal and have different lengths, with increments of both.
struct Section {
  Vec3 b, c, db, dc;
  explicit Section(unsigned seed) {
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> number(-0.4, 0.4);
    auto const any = [&] { return Vec3(number(random), number(random), number(random)); };
    b = Vec3(0, 1.3, 0) + any();
    c = Vec3(0, 0, 0.8) + any();
    db = any();
    dc = any();
  }
};
Vec<D, 3> moving(Vec3 const& x, Vec3 const& rate) {
  Vec<D, 3> out = x.cast<D>();
  for (int i = 0; i < 3; ++i) out[i].d[0] = rate[i];
  return out;
}
double const shares[] = {0.0, 0.08, 0.5, 1.0};

// The mean frame has the least distance to the directors of all rotations about the normal.
TEST(MeanSectionFrame, IsTheNearestFrameNormalToBothDirectors) {
  for (unsigned seed = 0; seed < 20; ++seed)
    for (double const p : shares) {
      Section const s(seed);
      MeanSectionFrame<double> const f(s.b, s.c, p);
      EXPECT_LT((f.R.transpose() * f.R - Mat3::Identity()).norm(), 1e-14);
      EXPECT_NEAR(f.R.determinant(), 1.0, 1e-14);
      EXPECT_LT(std::abs(f.R.col(0).dot(s.b)) + std::abs(f.R.col(0).dot(s.c)), 1e-14);
      auto const distance = [&](double turn) {
        Vec3 const y = std::cos(turn) * f.R.col(1) + std::sin(turn) * f.R.col(2), z = f.R.col(0).cross(y);
        return p * (s.b - y).squaredNorm() + (1 - p) * (s.c - z).squaredNorm();
      };
      for (double turn = 0.1; turn < 6.2; turn += 0.1) EXPECT_GT(distance(turn), distance(0.0));
    }
}

TEST(MeanSectionFrame, WithTheWholeShareFollowsTheFirstDirector) {
  Section const s(3);
  MeanSectionFrame<double> const mean(s.b, s.c, 1.0);
  SectionFrame<double> const first(s.b, s.c);
  EXPECT_LT((mean.R - first.R).norm(), 1e-15);
  Vec6 const w = mean.components(s.db, s.dc), v = first.components(s.db, s.dc);
  EXPECT_LT((mean.spin(w) - first.spin(v)).norm(), 1e-15);
  EXPECT_LT((mean.acceleration(w) - first.acceleration(v)).norm(), 1e-14);
}

/// Axial vector of RᵀR˙.
Vec3 turning(MeanSectionFrame<D> const& f) {
  Mat3 rate;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rate(i, j) = f.R(i, j).d[0];
  Mat3 const r = f.R.unaryExpr([](D const& x) { return x.v; });
  Mat3 const w = r.transpose() * rate;
  EXPECT_LT((w + w.transpose()).norm(), 1e-14);
  return {w(2, 1), w(0, 2), w(1, 0)};
}

TEST(MeanSectionFrame, SpinAndItsRateAreTheDerivativesOfTheFrame) {
  for (unsigned seed = 0; seed < 5; ++seed)
    for (double const p : shares) {
      Section const s(seed);
      MeanSectionFrame<D> const f(moving(s.b, s.db), moving(s.c, s.dc), p);
      MeanSectionFrame<double> const still(s.b, s.c, p);
      Vec6 const w = still.components(s.db, s.dc);
      Vec3 const spin = still.spin(w);
      EXPECT_LT((turning(f) - spin).norm(), 1e-14);
      EXPECT_NEAR(still.pull(Vec3(0.3, -1.1, 0.7)).dot(w), Vec3(0.3, -1.1, 0.7).dot(spin), 1e-14);
      Vec<D, 3> const later = f.spin(f.components(s.db.cast<D>(), s.dc.cast<D>()));
      Vec3 const a = still.acceleration(w);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(later[i].d[0], a[i], 1e-13);
    }
}

// m·δ̂φ for all pairs of increments.
TEST(MeanSectionFrame, SecondDerivativesAreThoseOfTheSpin) {
  Vec3 const m(0.3, -1.1, 0.7);
  for (double const p : shares) {
    Section const s(7);
    MeanSectionFrame<double> const f(s.b, s.c, p);
    Mat<double, 6, 6> const h = f.second(m);
    Mat<double, 6, 6> in_world = Mat<double, 6, 6>::Zero(), expected;
    f.add_form(h, 0, 0, in_world);
    for (int j = 0; j < 6; ++j) {
      Vec6 const by = Vec6::Unit(j);
      MeanSectionFrame<D> const g(moving(s.b, by.head<3>()), moving(s.c, by.tail<3>()), p);
      for (int i = 0; i < 6; ++i) {
        Vec6 const d = Vec6::Unit(i);
        Vec<D, 3> const phi = g.spin(g.components(Vec3(d.head<3>()).cast<D>(), Vec3(d.tail<3>()).cast<D>()));
        expected(i, j) = m[0] * phi[0].d[0] + m[1] * phi[1].d[0] + m[2] * phi[2].d[0];
      }
    }
    EXPECT_LT((in_world - expected).norm(), 1e-13 * expected.norm());
  }
}

}  // namespace mean_section_frame_test
}  // namespace polybody
