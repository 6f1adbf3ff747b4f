#include <polybody/bodies/rigid/rigid_marker.hpp>

#include <gtest/gtest.h>

#include <array>

using namespace polybody;

namespace triple_test {

/// The three numbers are written between two numbers that must not change.
template <int lanes>
std::array<double, 3> numbers(Vec3Storage<lanes> const& x) {
  std::array<double, 5> to;
  to.fill(-7.0);
  x.store(to.data() + 1);
  EXPECT_EQ(to[0], -7.0);
  EXPECT_EQ(to[4], -7.0);
  return {to[1], to[2], to[3]};
}

template <int lanes>
void calculates_as_by_hand() {
  using V = Vec3Storage<lanes>;
  using Numbers = std::array<double, 3>;
  std::array<double, 3> const a{1.0, -2.0, 4.0}, b{0.5, 3.0, -1.0}, c{8.0, 0.25, 16.0}, factors{2.0, -1.0, 0.5};
  V const x = V::load(a.data()), y = V::load(b.data()), z = V::load(c.data());
  EXPECT_EQ(numbers(x + y), (Numbers{1.5, 1.0, 3.0}));
  EXPECT_EQ(numbers(V::combination(x, y, z, factors.data())), (Numbers{5.5, -6.875, 17.0}));
  // (−2)(−1) − 4·3, 4·0.5 − 1·(−1), 1·3 − (−2)·0.5
  EXPECT_EQ(numbers(cross(x, y)), (Numbers{-10.0, 3.0, 4.0}));
}

TEST(Vec3Storage, CalculatesAsByHand) {
  calculates_as_by_hand<2>();
  calculates_as_by_hand<4>();
}

template <int lanes>
void reads_and_writes_columns() {
  using V = Vec3Storage<lanes>;
  struct {
    double before = -7.0;
    Mat3 m;
    double behind = -7.0;
  } in, out;
  in.m << 1, 4, 7, 2, 5, 8, 3, 6, 9;
  out.m.setZero();
  V const x = V::column(in.m, 0), y = V::column(in.m, 1), z = V::column(in.m, 2);
  EXPECT_EQ(numbers(z), (std::array{7.0, 8.0, 9.0}));
  V::store_columns(y, z, x, out.m);
  EXPECT_EQ(out.m, (Mat3() << 4, 7, 1, 5, 8, 2, 6, 9, 3).finished());
  EXPECT_EQ(out.before, -7.0);
  EXPECT_EQ(out.behind, -7.0);
}

TEST(Vec3Storage, ReadsAndWritesColumnsAndNothingBeside) {
  reads_and_writes_columns<2>();
  reads_and_writes_columns<4>();
}

}  // namespace triple_test
