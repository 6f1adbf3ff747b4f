#pragma once
/// \file
/// Loops over the elements of a body. Where all elements are alike, neighbours go through the kernel side by side in
/// packs (structure of arrays); what is left over, and bodies of other kinds, one by one.

#include <array>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/math/pack.hpp>

namespace polybody {

/// A body whose elements differ in nothing but their coordinates, which each reads at its own columns, q as v: its
/// kernels take an element's own coordinates and may run on packs. Where that depends on the body, its `alike()` says
/// so.
template <class B>
concept AlikeElements = requires(B const b, Vec<Pack<>, B::element_columns> x, Vec<Pack<>, B::element_columns>& out,
                                 Mat<Pack<>, B::element_columns, B::element_columns>& k) {
  requires B::packs_pay;                              // measured: the kernel is arithmetic, not sines
  { B::element_stride } -> std::convertible_to<int>;  // from an element's first column to that of the next
  b.template element_inertia<Pack<>>(x, out);
  b.template element_force<Pack<>>(x, x, out);
  b.template element_tangent<Pack<>>(x, x, 1.0, 1.0, k);
};

namespace detail {

/// The coordinates of `pack_size` neighbours; `x` points to the first one's.
template <int n, int stride>
Vec<Pack<>, n> side_by_side(double const* x) {
  static_assert(n % pack_size == 0);
  Vec<Pack<>, n> packed;
  std::array<Pack<>, pack_size> part;
  for (int k = 0; k < n; k += pack_size) {
    for (int l = 0; l < pack_size; ++l) part[std::size_t(l)] = Pack<>::load(x + l * stride + k);
    transpose(part);
    for (int l = 0; l < pack_size; ++l) packed[k + l] = part[std::size_t(l)];
  }
  return packed;
}
/// The other way: each of `pack_size` vectors or matrices gets its numbers, on top of those of `same`.
template <class Packed, class Each>
void take_apart(Packed const& packed, Each const& same, std::array<Each, pack_size>& each) {
  static_assert(Packed::SizeAtCompileTime % pack_size == 0);
  std::array<Pack<>, pack_size> part;
  for (int k = 0; k < Packed::SizeAtCompileTime; k += pack_size) {
    for (int l = 0; l < pack_size; ++l) part[std::size_t(l)] = packed.data()[k + l];
    transpose(part);
    Pack<> const base = Pack<>::load(same.data() + k);
    for (int l = 0; l < pack_size; ++l) (part[std::size_t(l)] + base).store(each[std::size_t(l)].data() + k);
  }
}

/// All elements differ in nothing but their coordinates.
template <class B>
bool are_alike(B const& body) {
  if constexpr (requires { body.alike(); })
    return body.alike();
  else
    return AlikeElements<B>;
}

/// How many of the elements [begin, end) go in packs: packs begin at multiples of their size, so that an element's
/// kernel does not depend on how a loop is cut.
template <class B>
Index packed_until(B const& body, Index begin, Index end) {
  if constexpr (AlikeElements<B>) {
    if (!are_alike(body)) return begin;
    Index const whole = body.elements() / pack_size * pack_size;
    return std::max(begin, std::min(end, whole));
  } else {
    return begin;
  }
}

/// M a − force of the `pack_size` elements from `first` on; what stands at `columns` is the first one's.
template <class B>
void unbalance_of_pack(B const& body, Index columns, std::span<double const> q, std::span<double const> v,
                       std::span<double const> a, std::array<Vec<double, B::element_columns>, pack_size>& each) {
  constexpr int n = B::element_columns, stride = B::element_stride;
  Vec<Pack<>, n> inertia, elastic;
  body.template element_inertia<Pack<>>(side_by_side<n, stride>(a.data() + columns), inertia);
  body.template element_force<Pack<>>(side_by_side<n, stride>(q.data() + columns),
                                      side_by_side<n, stride>(v.data() + columns), elastic);
  for (int k = 0; k < n; ++k) inertia[k] -= elastic[k];
  Vec<double, n> const zero = Vec<double, n>::Zero();
  take_apart(inertia, zero, each);
}

/// The same of one element, into scratch.x.
template <class B, StateScalar T>
void unbalance_of_one(B const& body, Index e, std::span<T const> q, std::span<T const> v, std::span<T const> a,
                      ForceScratch<B, T>& scratch) {
  body.template inertia<T>(e, q, a, scratch.x);
  body.template force<T>(e, q, v, scratch.force);
  for (int k = 0; k < int(scratch.x.size()); ++k) scratch.x[k] -= scratch.force[k];
}

/// m + ck K + cd D of the elements of a pack.
template <class B>
void tangent_of_pack(B const& body, Index columns, std::span<double const> q, std::span<double const> v, double cd,
                     double ck, Mat<double, B::element_columns, B::element_columns> const& m,
                     std::array<Mat<double, B::element_columns, B::element_columns>, pack_size>& each) {
  constexpr int n = B::element_columns, stride = B::element_stride;
  Mat<Pack<>, n, n> packs;
  body.template element_tangent<Pack<>>(side_by_side<n, stride>(q.data() + columns),
                                        side_by_side<n, stride>(v.data() + columns), ck, cd, packs);
  take_apart(packs, m, each);
}

}  // namespace detail

/// Calls f(e, M a − force) for the elements [begin, end); `begin` is a multiple of `pack_size`, and `end` too unless it
/// is the last.
template <Body B, StateScalar T, class F>
void for_each_unbalance(B const& body, Index begin, Index end, std::span<T const> q, std::span<T const> v,
                        std::span<T const> a, ForceScratch<B, T>& scratch, F&& f) {
  if constexpr (AlikeElements<B> && std::same_as<T, double>) {
    Index const packed = detail::packed_until(body, begin, end);
    std::array<Vec<double, B::element_columns>, pack_size> each;
    for (; begin < packed; begin += pack_size) {
      detail::unbalance_of_pack(body, body.first_column(begin), q, v, a, each);
      for (int l = 0; l < pack_size; ++l) f(begin + l, each[std::size_t(l)]);
    }
  }
  for (; begin < end; ++begin) {
    detail::unbalance_of_one<B, T>(body, begin, q, v, a, scratch);
    f(begin, scratch.x);
  }
}

template <Body B, StateScalar T, class F>
void for_each_unbalance(B const& body, Index begin, Index end, std::span<T const> q, std::span<T const> v,
                        std::span<T const> a, F&& f) {
  ForceScratch<B, T> scratch(body);
  for_each_unbalance<B, T>(body, begin, end, q, v, a, scratch, f);
}

/// Calls f(e, cm M + cd D + ck K) for the elements [begin, end), cut as above.
template <Body B, class F>
void for_each_element_tangent(B const& body, Index begin, Index end, std::span<double const> q,
                              std::span<double const> v, double cm, double cd, double ck, TangentScratch<B>& scratch,
                              F&& f) {
  constexpr int n = B::element_columns;
  Mat<double, n, n>&k = scratch.k, &m = scratch.m;
  bool const alike = detail::are_alike(body);
  bool first_mass = true;
  auto const inertia = [&](Index e) {
    if (first_mass || !alike) {
      body.mass(e, q, m);
      m *= cm;
    }
    first_mass = false;
  };
  if constexpr (AlikeElements<B>) {
    Index const packed = detail::packed_until(body, begin, end);
    std::array<Mat<double, n, n>, pack_size> each;
    if (begin < packed) inertia(begin);
    for (; begin < packed; begin += pack_size) {
      detail::tangent_of_pack(body, body.first_column(begin), q, v, cd, ck, m, each);
      for (int l = 0; l < pack_size; ++l) f(begin + l, each[std::size_t(l)]);
    }
  }
  for (; begin < end; ++begin) {
    body.tangent(begin, q, v, ck, cd, k);
    if (cm != 0.0) {
      inertia(begin);
      k += m;
    }
    f(begin, k);
  }
}

template <Body B, class F>
void for_each_element_tangent(B const& body, Index begin, Index end, std::span<double const> q,
                              std::span<double const> v, double cm, double cd, double ck, F&& f) {
  TangentScratch<B> scratch(body);
  for_each_element_tangent<B>(body, begin, end, q, v, cm, cd, ck, scratch, f);
}

}  // namespace polybody
