#pragma once
/// \file
/// Elements of several bodies side by side: a track of many links of one element each fills packs as one long body
/// does.

#include <polybody/bodies/shared/element_batches.hpp>
#include <polybody/bodies/shared/time_varying.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/pools.hpp>

namespace polybody::detail {

/// An element of a pool.
struct PlacedElement {
  Index entry, element;
};

/// How the elements of a pool go through their kernels. Bodies with fewer elements than fill a pack share packs with
/// the bodies behind them, as far as these have the same elements; the others go by themselves.
struct PoolBatches {
  Sequence<Index> bodies;  ///< that go by themselves
  Sequence<std::array<PlacedElement, std::size_t(pack_size)>> packs;
  Sequence<PlacedElement> singles;  ///< that are left over
  bool alone = true;                ///< no body is in two packs
};

/// At least so many bodies, of one element each.
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
    for (; i + std::size_t(pack_size) <= alike.size(); i += std::size_t(pack_size)) {
      std::array<PlacedElement, std::size_t(pack_size)> pack;
      std::copy_n(alike.begin() + i, pack_size, pack.begin());
      out.packs.push_back(pack);
    }
    for (; i < alike.size(); ++i) out.singles.push_back(alike[i]);
    alike.clear();
  };
  for (std::size_t b = 0; b < pool.entries.size(); ++b) {
    B const& body = pool.entries[b].body;
    if (!are_alike(body) || body.elements() >= pack_size) {
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

/// Where the numbers of a pack's elements begin, in vectors by coordinates, speeds and speeds.
template <class B>
SimdMotion motion_of(BodyPool<B> const& pool, std::array<PlacedElement, std::size_t(pack_size)> const& pack,
                     double const* q, double const* v, double const* a) {
  SimdMotion motion;
  for (std::size_t l = 0; l < pack.size(); ++l) {
    auto const& e = pool.entries[std::size_t(pack[l].entry)];
    Index const column = e.body.first_column(pack[l].element);
    motion.q[l] = q + e.q0 + column;
    motion.v[l] = v + e.v0 + column;
    motion.a[l] = a + e.v0 + column;
  }
  return motion;
}

}  // namespace polybody::detail
