#include <polybody/math/simd_vector.hpp>

#include <gtest/gtest.h>

#include <polybody/math/types.hpp>

using namespace polybody;

namespace pack_test {

static_assert(KernelScalar<SimdVector<2>> && KernelScalar<SimdVector<4>> && KernelScalar<double>);
static_assert(!KernelScalar<std::string>);
template <class T>
concept HasValue = requires(T const x) { value_of(x); };
static_assert(!HasValue<SimdVector<>>, "A kernel that branches must not compile for packs.");

template <int N>
SimdVector<N> some(double first) {
  SimdVector<N> p;
  for (int i = 0; i < N; ++i) p.set(i, first + 0.37 * i);
  return p;
}

/// f of a SIMD vector is f of each of its numbers.
template <int N, class F>
void expect_each(F&& f) {
  SimdVector<N> const a = some<N>(0.6), b = some<N>(1.9), c = f(a, b);
  for (int i = 0; i < N; ++i) EXPECT_DOUBLE_EQ(c[i], f(a[i], b[i])) << N << ' ' << i;
}
template <class F>
void expect_each(F&& f) {
  expect_each<2>(f);
  expect_each<4>(f);
}

TEST(SimdVector, CalculatesWithEachNumber) {
  using std::cos, std::sin, std::sqrt;
  expect_each([](auto a, auto b) { return a + b; });
  expect_each([](auto a, auto b) { return a - b; });
  expect_each([](auto a, auto b) { return a * b; });
  expect_each([](auto a, auto b) { return a / b; });
  expect_each([](auto a, auto b) { return -a * +b; });
  expect_each([](auto a, auto b) { return 2.0 * a - b / 3.0 + 1.0; });
  expect_each([](auto a, auto) { return sqrt(a); });
  expect_each([](auto a, auto) { return sin(a); });
  expect_each([](auto a, auto) { return cos(a); });
}

TEST(SimdVector, IsZeroOrConstantWhenMade) {
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(SimdVector<4>()[i], 0.0);
    EXPECT_EQ(SimdVector<4>(2.5)[i], 2.5);
  }
}

/// The rows of an N × N matrix with (i, j) = 10 i + j become its columns.
template <int N>
void expect_transposed() {
  std::array<double, 2 * N> memory{};
  std::array<SimdVector<N>, std::size_t(N)> packs;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) memory[std::size_t(1 + j)] = 10.0 * i + j;
    packs[std::size_t(i)] = SimdVector<N>::load(memory.data() + 1);  // not aligned
  }
  transpose(packs);
  for (int i = 0; i < N; ++i) {
    packs[std::size_t(i)].store(memory.data() + 1);
    for (int j = 0; j < N; ++j) EXPECT_EQ(memory[std::size_t(1 + j)], 10.0 * j + i);
  }
}
TEST(SimdVector, GoesToMemoryAndBackAndIsTransposedWithOthers) {
  expect_transposed<2>();
  expect_transposed<4>();
}

TEST(SimdVector, IsAScalarOfEigen) {
  Mat<SimdVector<>, 2, 2> m;
  m << some<simd_size>(1.0), SimdVector<>(2.0), SimdVector<>(0.0), some<simd_size>(-1.0);
  Vec<SimdVector<>, 2> const x(SimdVector<>(1.0), SimdVector<>(3.0)), y = m * x;
  for (int i = 0; i < simd_size; ++i) {
    EXPECT_DOUBLE_EQ(y[0][i], 7.0 + 0.37 * i);
    EXPECT_DOUBLE_EQ(y[1][i], 3.0 * (-1.0 + 0.37 * i));
  }
}

}  // namespace pack_test
