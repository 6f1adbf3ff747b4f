#pragma once
/// \file
/// Loops over the entries of long vectors, a pack at a time. g++ at -O2 takes a plain loop entry by entry.

#include <cstdint>

#include <polybody/math/pack.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// A place in vectors: `pack_size` entries from `first` on.
struct PackPlace {
  Index first;  ///< number of the first of these entries
  Pack<> operator()(double const* x) const { return Pack<>::load(x + first); }       ///< reads them from x
  Pack<> operator()(VecX const& x) const { return Pack<>::load(x.data() + first); }  ///< reads them from x
  void set(double* x, Pack<> const& value) const { value.store(x + first); }         ///< writes them to x
  void set(VecX& x, Pack<> const& value) const { value.store(x.data() + first); }    ///< writes them to x
};
/// One entry.
struct EntryPlace {
  Index first;                                                        ///< number of the entry
  double operator()(double const* x) const { return x[first]; }       ///< reads it from x
  double operator()(VecX const& x) const { return x.data()[first]; }  ///< reads it from x
  void set(double* x, double value) const { x[first] = value; }       ///< writes `value` to x
  void set(VecX& x, double value) const { x.data()[first] = value; }  ///< writes `value` to x
};

/// Calls f(at) over n entries, in packs as far as they reach, then one by one. `at(x)` reads what stands at a place in
/// x, `at.set(x, value)` writes it. What f captures by value stays in the registers.
template <class F>
[[gnu::always_inline]] inline void for_packs(Index n, F f) {
  Index i = 0;
  for (; i + pack_size <= n; i += pack_size) f(PackPlace{i});
  for (; i < n; ++i) f(EntryPlace{i});
}

/// A sum over the places of `for_packs`.
class PackSum {
 public:
  void add(Pack<> const& x) { packs_ += x; }  ///< adds a pack, kept as a pack until `total`
  void add(double x) { rest_ += x; }          ///< adds the number `x`
  /// The sum of all that was added.
  double total() const {
    double sum = rest_;
    for (int i = 0; i < pack_size; ++i) sum += packs_[i];
    return sum;
  }

 private:
  Pack<> packs_ = Pack<>();
  double rest_ = 0.0;
};

/// Σ xᵢ² of the n entries at `x`.
inline double squares(double const* x, Index n) {
  PackSum sum;
  for_packs(n, [&](auto at) {
    auto const entry = at(x);
    sum.add(entry * entry);
  });
  return sum.total();
}
/// Σ xᵢ².
inline double squares(VecX const& x) { return squares(x.data(), x.size()); }

/// 1 or −1 for entry i, by a pattern that no model shares.
inline double scattered_sign(Index i) { return (std::uint32_t(i + 1) * 2654435769u >> 31) != 0 ? 1.0 : -1.0; }

/// Whether no entry of `x` is NaN, infinite or beyond `largest_number`.
inline bool all_finite(VecX const& x) {
  return squares(x) <= largest_number * largest_number || first_not_finite(x) < 0;
}

}  // namespace polybody
