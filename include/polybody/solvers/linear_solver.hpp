#pragma once
/// \file
/// Interface of linear solvers. A solver receives the blocks of the matrix through calls of `add`, or at the addresses
/// that `slots` returns.

#include <algorithm>
#include <span>
#include <type_traits>

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Linear solver. Order of calls: analyse (once, allocates) → begin → add… → factor → solve…. Blocks are added in the
/// analysed order.
template <class S>
concept LinearSolver = requires(S s, std::span<Block const> blocks, Mat3 const block, VecX const b, VecX x) {
  s.analyse(Index(1), blocks);
  s.begin();
  s.add(Index(0), Index(0), block);
  { s.factor() } -> std::convertible_to<Index>;  // −1, or the column without a usable pivot
  s.solve(b, x);
};

namespace detail {
template <class S>
struct ReadsBothHalves : std::type_identity<S> {};
template <class S>
  requires requires { typename S::Unsymmetric; }
struct ReadsBothHalves<S> : std::type_identity<typename S::Unsymmetric> {};
}  // namespace detail

/// Solver for unsymmetric matrices: `S::Unsymmetric` if S reads only one half of the matrix; otherwise S.
template <LinearSolver S>
using UnsymmetricSolver = typename detail::ReadsBothHalves<S>::type;

/// Writes the matrix into the solver and factorises it. Repeats both if the solver changes its elimination order.
/// Returns −1 on success, otherwise the index of the column without a usable pivot.
template <LinearSolver S>
Index write_and_factor(S& solver, BlockWriter const& write) {
  for (;;) {
    solver.begin();
    BlockSink sink(solver);
    write(sink);
    Index const bad = solver.factor();
    if constexpr (requires { solver.reordered(); })
      if (bad >= 0 && solver.reordered()) continue;
    return bad;
  }
}

}  // namespace polybody
