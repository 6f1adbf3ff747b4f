#pragma once
/// \file
/// What a linear solver offers: it receives the blocks of the matrix, by `add` or in the slots that it names.

#include <algorithm>
#include <span>
#include <type_traits>

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// analyse (once, allocates) → begin → add… → factor → solve…; the blocks come in the analysed order.
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

/// What takes the place of S for matrices that are not symmetric: `S::Unsymmetric`, where S reads one half only.
template <LinearSolver S>
using UnsymmetricSolver = typename detail::ReadsBothHalves<S>::type;

/// Writes the matrix into the solver and factors it; twice where the solver asks for it in another order.
/// Returns −1, or the column without a usable pivot.
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
