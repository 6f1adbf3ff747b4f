#pragma once
/// \file
/// Grouping of elements of several bodies into SIMD vectors. A track of many links with one element each then fills
/// SIMD vectors like one long body.

#include <polybody/bodies/shared/element_batches.hpp>
#include <polybody/bodies/shared/time_varying.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/pools.hpp>

namespace polybody::detail {

/// Element of a pool: index of its body's entry, and index in the body.
struct PlacedElement {
  Index entry, element;
};

/// Distribution of the elements of a pool over the kernels. Consecutive bodies share SIMD vectors if their elements are
/// equal and each body has fewer elements than a SIMD vector has lanes. Other bodies are evaluated separately.
struct PoolBatches {
  Sequence<Index> bodies;  ///< bodies that are evaluated separately
  Sequence<std::array<PlacedElement, std::size_t(simd_size)>> filled;
  Sequence<PlacedElement> singles;  ///< elements that do not fill a SIMD vector
  bool alone = true;                ///< true if each body in `filled` or `singles` has one element only
};

/// True if the pool has at least `least` bodies and each of them has one element.
template <class B>
bool has_single_elements(BodyPool<B> const& pool, Index least) {
  if (Index(pool.entries.size()) < least) return false;
  for (auto const& e : pool.entries)
    if (e.body.elements() != 1) return false;
  return true;
}

template <class B>
[[gnu::cold]] PoolBatches batches_of(BodyPool<B> const& pool) {
  PoolBatches out;
  Sequence<PlacedElement> alike;
  auto const close = [&] {
    std::size_t i = 0;
    for (; i + std::size_t(simd_size) <= alike.size(); i += std::size_t(simd_size)) {
      std::array<PlacedElement, std::size_t(simd_size)> batch;
      std::copy_n(alike.begin() + i, simd_size, batch.begin());
      out.filled.push_back(batch);
    }
    for (; i < alike.size(); ++i) out.singles.push_back(alike[i]);
    alike.clear();
  };
  for (std::size_t b = 0; b < pool.entries.size(); ++b) {
    B const& body = pool.entries[b].body;
    if (!are_alike(body) || body.elements() >= simd_size) {
      out.bodies.push_back(Index(b));
      continue;
    }
    if (!alike.empty() && !body.has_same_elements(pool.entries[std::size_t(alike.back().entry)].body)) close();
    out.alone = out.alone && body.elements() == 1;
    for (Index i = 0; i < body.elements(); ++i) alike.push_back({Index(b), i});
  }
  close();
  return out;
}

/// Pointers to the first coordinate, velocity and acceleration of each element of a SIMD vector.
template <class B>
SimdMotion motion_of(BodyPool<B> const& pool, std::array<PlacedElement, std::size_t(simd_size)> const& batch,
                     double const* q, double const* v, double const* a) {
  SimdMotion motion;
  for (std::size_t l = 0; l < batch.size(); ++l) {
    auto const& e = pool.entries[std::size_t(batch[l].entry)];
    Index const column = e.body.first_column(batch[l].element);
    motion.q[l] = q + e.q0 + column;
    motion.v[l] = v + e.v0 + column;
    motion.a[l] = a + e.v0 + column;
  }
  return motion;
}

}  // namespace polybody::detail
