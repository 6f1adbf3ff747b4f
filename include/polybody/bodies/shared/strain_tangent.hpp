#pragma once
/// \file
/// Tangent of an element from all its strain groups, in blocks for pairs of nodal vectors. Each entry is written once.

#include <tuple>
#include <utility>

#include <polybody/bodies/shared/strain_group.hpp>

namespace polybody {

namespace detail {
/// Sets block (v, w) of k to `block`, or to −`block` if `negative`. If `mirror`, also sets block (w, v) to the
/// transpose.
template <bool negative, class T, int d, int n>
void set_block(int v, int w, Mat<T, d, d> const& block, bool mirror, Mat<T, n, n>& k) {
  T* const at = k.data() + d * (v + n * w);
  T* const opposite = k.data() + d * (w + n * v);
#pragma GCC unroll 4
  for (int j = 0; j < d; ++j)
#pragma GCC unroll 4
    for (int i = 0; i < d; ++i) at[n * j + i] = negative ? -block(i, j) : block(i, j);
  if (!mirror) return;
#pragma GCC unroll 4
  for (int i = 0; i < d; ++i)
#pragma GCC unroll 4
    for (int j = 0; j < d; ++j) opposite[n * i + j] = negative ? -block(i, j) : block(i, j);
}
}  // namespace detail

/// Tangent k = ck (−∂f/∂x) + cd (−∂f/∂xd) of the groups of an element. Without damping the tangent is symmetric, and
/// only the blocks on and below the diagonal are computed. The blocks of the first nodal vector are the negative blocks
/// of the vector `difference`, which is read relative to the first one (`StrainMap`).
template <KernelScalar T, int n, class... Groups>
void tangent_of(std::tuple<Groups...> const& groups, Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd,
                Mat<T, n, n>& k) {
  using P = typename std::tuple_element_t<0, std::tuple<Groups...>>::P;
  constexpr int d = P::d, difference = std::max({Groups::P::difference...}), first = difference > 0 ? 1 : 0;
  static_assert(
      ((Groups::P::difference == difference || !Groups::P::reads(0)) && ...),
      "An element may have at most two strain groups: one of nodal positions and one of position differences.");
  bool const symmetric = std::apply([](auto const&... group) { return !(group.damped() || ...); }, groups);
  std::tuple<typename Groups::template Prepared<T>...> prepared;
  auto const for_each = [&]<std::size_t... I>(std::index_sequence<I...>, auto&& f) {
    (f(std::get<I>(groups), std::get<I>(prepared)), ...);
  };
  constexpr auto all = std::index_sequence_for<Groups...>();
  for_each(all, [&](auto const& group, auto& of) { group.template prepare<T, n>(x, xd, ck, cd, symmetric, of); });
  auto const set = [&](int v, int w) {
    Mat<T, d, d> block;
    P::for_each_entry([&](int i, int j) { block(i, j) = T(0.0); });
    for_each(all, [&](auto const& group, auto const& of) { group.template add_block<T>(v, w, of, block); });
    bool const mirror = symmetric && v != w;
    detail::set_block<false, T, d, n>(v, w, block, mirror, k);
    if constexpr (difference > 0) {
      if (v == difference) detail::set_block<true, T, d, n>(0, w, block, mirror, k);
      if (w == difference) detail::set_block<true, T, d, n>(v, 0, block, mirror, k);
      if (v == difference && w == difference) detail::set_block<false, T, d, n>(0, 0, block, false, k);
    }
  };
  if constexpr (d == 1) {  // most entries are one product, and unrolled loops make its indices constants
#pragma GCC unroll 8
    for (int v = first; v < n; ++v)
#pragma GCC unroll 8
      for (int w = first; w < n; ++w)
        if (w <= v || !symmetric) set(v, w);
  } else {
    for (int v = first; v < n / d; ++v)
      for (int w = first; w < (symmetric ? v + 1 : n / d); ++w) set(v, w);
  }
}

}  // namespace polybody
