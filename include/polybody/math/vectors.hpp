#pragma once
/// \file
/// Loops over long vectors with SIMD operations. g++ at -O2 does not vectorise loops of run-time length.

#include <cstdint>

#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Position of `simd_size` successive entries in a vector.
struct SimdIndex {
  Index first;  ///< index of the first entry
  /// Loads entries of `x`.
  SimdVector<> operator()(double const* x) const { return SimdVector<>::load(x + first); }
  SimdVector<> operator()(VecX const& x) const { return (*this)(x.data()); }             ///< loads entries of `x`
  void set(double* x, SimdVector<> const& value) const { value.store(x + first); }       ///< stores entries of `x`
  void set(VecX& x, SimdVector<> const& value) const { value.store(x.data() + first); }  ///< stores entries of `x`
};
/// Position of one entry in a vector.
struct EntryIndex {
  Index first;                                                        ///< index of the entry
  double operator()(double const* x) const { return x[first]; }       ///< entry of x
  double operator()(VecX const& x) const { return x.data()[first]; }  ///< entry of x
  void set(double* x, double value) const { x[first] = value; }       ///< stores `value` in x
  void set(VecX& x, double value) const { x.data()[first] = value; }  ///< stores `value` in x
};

/// Calls f(at) for n entries: first for SIMD vectors, then for the remaining single entries. `at(x)` reads the entries
/// of x at the position `at`, and `at.set(x, value)` writes them. Variables that f captures by value remain in
/// registers.
template <class F>
[[gnu::always_inline]] inline void for_each_simd_block(Index n, F f) {
  Index i = 0;
  for (; i + simd_size <= n; i += simd_size) f(SimdIndex{i});
  for (; i < n; ++i) f(EntryIndex{i});
}

/// Sum over the entries in a loop of `for_each_simd_block`.
class SimdSum {
 public:
  void add(SimdVector<> const& x) { lanes_ += x; }  ///< adds a SIMD vector; its entries are summed in `total`
  void add(double x) { rest_ += x; }                ///< adds the number `x`
  /// Sum of all added numbers.
  double total() const {
    double sum = rest_;
    for (int i = 0; i < simd_size; ++i) sum += lanes_[i];
    return sum;
  }

 private:
  SimdVector<> lanes_ = SimdVector<>();
  double rest_ = 0.0;
};

/// Sum of squares Σ xᵢ² of the n entries at `x`.
inline double squares(double const* x, Index n) {
  SimdSum sum;
  for_each_simd_block(n, [&](auto at) {
    auto const entry = at(x);
    sum.add(entry * entry);
  });
  return sum.total();
}
/// Sum of squares Σ xᵢ².
inline double squares(VecX const& x) { return squares(x.data(), x.size()); }

/// Pseudorandom sign, 1 or −1, of entry i.
inline double scattered_sign(Index i) { return (std::uint32_t(i + 1) * 2654435769u >> 31) != 0 ? 1.0 : -1.0; }

/// True if all entries of `x` are finite, with magnitudes up to `largest_number`.
inline bool all_finite(VecX const& x) {
  return squares(x) <= largest_number * largest_number || first_not_finite(x) < 0;
}

}  // namespace polybody
