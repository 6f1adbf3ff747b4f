#pragma once
/// \file
/// Loops over the elements of a body. If all elements are alike, the kernel processes several neighbouring elements at
/// once in SIMD vectors (structure of arrays). The remaining elements, and the elements of other bodies, are processed
/// one by one.

#include <algorithm>
#include <array>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/math/simd_vector.hpp>

namespace polybody {

/// Body whose elements differ only in their coordinates. Each element reads q and v at its own columns. The kernels
/// take the coordinates of one element and can run on SIMD vectors. If only some bodies of the type have this property,
/// `alike()` returns true for them.
template <class B>
concept IdenticalElements =
    requires(B const b, Vec<SimdVector<>, B::element_columns> x, Vec<SimdVector<>, B::element_columns>& out,
             Mat<SimdVector<>, B::element_columns, B::element_columns>& k) {
      requires B::vectorised_kernels;                     // false for kernels that branch on values
      { B::element_stride } -> std::convertible_to<int>;  // from the first column of an element to that of the next
      b.template element_inertia<SimdVector<>>(x, out);
      b.template element_force<SimdVector<>>(x, x, out);
      b.template element_tangent<SimdVector<>>(x, x, 1.0, 1.0, k);
    };

/// Body that compares its elements with those of another body, so that elements of several bodies can share a SIMD
/// vector.
template <class B>
concept ComparableElements = IdenticalElements<B> && requires(B const b) {
  { b.has_same_elements(b) } -> std::convertible_to<bool>;
};

/// Elements [begin, end) of a body. `begin` is a multiple of `simd_size`. `end` is a multiple of `simd_size` or the
/// number of elements.
struct ElementRange {
  Index begin, end;  ///< the first element, and one past the last
};
/// Coefficients of cm M + cd D + ck K, with D = −∂f/∂v and K = −∂f/∂q.
struct ElementCoefficients {
  double mass, damping, stiffness;  ///< factors cm, cd and ck of M, D and K
};

namespace detail {

/// Addresses of the coordinates or velocities of `simd_size` elements.
using SimdPointers = std::array<double const*, std::size_t(simd_size)>;
/// Addresses of the data of `simd_size` neighbouring elements, `stride` doubles apart; `x` is the address for the first
/// one.
template <int stride>
SimdPointers neighbours(double const* x) {
  SimdPointers from;
  for (int l = 0; l < simd_size; ++l) from[std::size_t(l)] = x + l * stride;
  return from;
}
/// Addresses of the coordinates, velocities and accelerations of `simd_size` elements.
struct SimdMotion {
  SimdPointers q, v, a;
};

/// Calls f(k) for parts of `simd_size` numbers, k to k + simd_size − 1, that cover n numbers. The last two parts
/// overlap unless n is a multiple of `simd_size`.
template <int n, class F>
void for_each_part(F&& f) {
  static_assert(n >= simd_size);
  for (int k = 0; k < n; k += simd_size) f(std::min(k, n - simd_size));
}

/// Combines n numbers of each of `simd_size` elements into n SIMD vectors.
template <int n>
Vec<SimdVector<>, n> side_by_side(SimdPointers const& x) {
  Vec<SimdVector<>, n> packed;
  std::array<SimdVector<>, simd_size> part;
  for_each_part<n>([&](int k) {
    for (int l = 0; l < simd_size; ++l) part[std::size_t(l)] = SimdVector<>::load(x[std::size_t(l)] + k);
    transpose(part);
    for (int l = 0; l < simd_size; ++l) packed[k + l] = part[std::size_t(l)];
  });
  return packed;
}
/// Inverse of `side_by_side`: sets `each[l]`, the vector or matrix of element l, to the numbers of this element plus
/// `same`.
template <class Packed, class Each>
void take_apart(Packed const& packed, Each const& same, std::array<Each, simd_size>& each) {
  std::array<SimdVector<>, simd_size> part;
  for_each_part<Packed::SizeAtCompileTime>([&](int k) {
    for (int l = 0; l < simd_size; ++l) part[std::size_t(l)] = packed.data()[k + l];
    transpose(part);
    SimdVector<> const base = SimdVector<>::load(same.data() + k);
    for (int l = 0; l < simd_size; ++l) (part[std::size_t(l)] + base).store(each[std::size_t(l)].data() + k);
  });
}

/// Returns true if all elements differ only in their coordinates.
template <class B>
bool are_alike(B const& body) {
  if constexpr (requires { body.alike(); })
    return body.alike();
  else
    return IdenticalElements<B>;
}

/// Index after the last element of `range` that a SIMD vector processes. Each SIMD vector begins at a multiple of
/// `simd_size`, so that the kernel of an element does not depend on the subdivision of a loop.
template <class B>
Index batches_end(B const& body, ElementRange range) {
  if constexpr (IdenticalElements<B>) {
    if (!are_alike(body)) return range.begin;
    Index const whole = body.elements() / simd_size * simd_size;
    return std::max(range.begin, std::min(range.end, whole));
  } else {
    return range.begin;
  }
}

/// Residuals M a − force of `simd_size` elements, which differ from those of `body` only in their coordinates.
template <class B>
void residuals_of_batch(B const& body, SimdMotion const& x,
                        std::array<Vec<double, B::element_columns>, simd_size>& each) {
  constexpr int n = B::element_columns;
  Vec<SimdVector<>, n> inertia, elastic;
  body.template element_inertia<SimdVector<>>(side_by_side<n>(x.a), inertia);
  body.template element_force<SimdVector<>>(side_by_side<n>(x.q), side_by_side<n>(x.v), elastic);
  for (int k = 0; k < n; ++k) inertia[k] -= elastic[k];
  Vec<double, n> const zero = Vec<double, n>::Zero();
  take_apart(inertia, zero, each);
}

/// Residual M a − force of one element, written to scratch.x.
template <class B, StateScalar T>
void residual_of_one(B const& body, Index e, BodyMotion<T> const& x, ForceScratch<B, T>& scratch) {
  if constexpr (requires { body.template residual<T>(x, scratch.workspace, scratch.force, scratch.x); })
    return body.template residual<T>(x, scratch.workspace, scratch.force, scratch.x);
  else
    body.template inertia<T>(e, x.q, x.a, scratch.x);
  body.template force<T>(e, x.q, x.v, scratch.force);
  for (int k = 0; k < int(scratch.x.size()); ++k) scratch.x[k] -= scratch.force[k];
}

/// Tangents `inertia` + cd D + ck K of `simd_size` elements, which differ from those of `body` only in their
/// coordinates.
template <class B>
void tangents_of_batch(B const& body, SimdMotion const& x, ElementCoefficients c,
                       Mat<double, B::element_columns, B::element_columns> const& inertia,
                       std::array<Mat<double, B::element_columns, B::element_columns>, simd_size>& each) {
  constexpr int n = B::element_columns;
  Mat<SimdVector<>, n, n> filled;
  body.template element_tangent<SimdVector<>>(side_by_side<n>(x.q), side_by_side<n>(x.v), c.stiffness, c.damping,
                                              filled);
  take_apart(filled, inertia, each);
}

/// Addresses of the motion of `simd_size` neighbouring elements of a body, from element `first` on.
template <class B>
SimdMotion motion_of_neighbours(B const& body, Index first, BodyMotion<> const& x) {
  constexpr int stride = B::element_stride;
  Index const column = body.first_column(first);
  double const* const a = x.a.empty() ? nullptr : x.a.data() + column;
  return {neighbours<stride>(x.q.data() + column), neighbours<stride>(x.v.data() + column),
          a ? neighbours<stride>(a) : SimdPointers{}};
}

}  // namespace detail

/// Calls f(e, M a − force) for the elements of a range.
template <Body B, StateScalar T, class F>
void for_each_residual(B const& body, ElementRange range, BodyMotion<T> const& x, ForceScratch<B, T>& scratch, F&& f) {
  auto [e, end] = range;
  if constexpr (IdenticalElements<B> && std::same_as<T, double>) {
    Index const packed = detail::batches_end(body, range);
    std::array<Vec<double, B::element_columns>, simd_size> each;
    for (; e < packed; e += simd_size) {
      detail::residuals_of_batch(body, detail::motion_of_neighbours(body, e, x), each);
      for (int l = 0; l < simd_size; ++l) f(e + l, each[std::size_t(l)]);
    }
  }
  for (; e < end; ++e) {
    detail::residual_of_one<B, T>(body, e, x, scratch);
    f(e, scratch.x);
  }
}

/// Overload that creates the workspace: calls f(e, M a − force) for the elements of a range.
template <Body B, StateScalar T, class F>
void for_each_residual(B const& body, ElementRange range, BodyMotion<T> const& x, F&& f) {
  ForceScratch<B, T> scratch(body);
  for_each_residual<B, T>(body, range, x, scratch, f);
}

/// Calls f(e, cm M + cd D + ck K) for the elements of a range.
template <Body B, class F>
void for_each_element_tangent(B const& body, ElementRange range, BodyMotion<> const& x, ElementCoefficients c,
                              TangentScratch<B>& scratch, F&& f) {
  constexpr int n = B::element_columns;
  Mat<double, n, n>&k = scratch.k, &m = scratch.m;
  bool const alike = detail::are_alike(body);
  bool first_mass = true;
  auto const inertia = [&](Index e) {
    if (first_mass || !alike) {
      body.mass(e, x.q, m);
      for (Index i = 0; i < m.size(); ++i) m.data()[i] *= c.mass;
    }
    first_mass = false;
  };
  auto [e, end] = range;
  if constexpr (IdenticalElements<B>) {
    Index const packed = detail::batches_end(body, range);
    std::array<Mat<double, n, n>, simd_size> each;
    if (e < packed) inertia(e);
    for (; e < packed; e += simd_size) {
      detail::tangents_of_batch(body, detail::motion_of_neighbours(body, e, x), c, m, each);
      for (int l = 0; l < simd_size; ++l) f(e + l, each[std::size_t(l)]);
    }
  }
  for (; e < end; ++e) {
    body.tangent(e, x.q, x.v, c.stiffness, c.damping, k);
    if (c.mass != 0.0) {
      inertia(e);
      for (Index i = 0; i < k.size(); ++i) k.data()[i] += m.data()[i];
    }
    f(e, k);
  }
}

/// Overload that creates the workspace: calls f(e, cm M + cd D + ck K) for the elements of a range.
template <Body B, class F>
void for_each_element_tangent(B const& body, ElementRange range, BodyMotion<> const& x, ElementCoefficients c, F&& f) {
  TangentScratch<B> scratch(body);
  for_each_element_tangent<B>(body, range, x, c, scratch, f);
}

}  // namespace polybody
