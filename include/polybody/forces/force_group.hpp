#pragma once
/// \file
/// Force elements with any number of markers, such as contacts with many candidates.

#include <polybody/forces/force_element.hpp>

namespace polybody {

/// Value of `F::markers` if the number of markers is known only when the model is built.
inline constexpr int any_number = -1;

namespace detail {
/// Placeholder arguments for the checks of a concept.
struct AnyFrame {
  Frame<double> const& operator()(Index marker) const;
};
struct AnyVisit {
  template <ForceElement Law>
    requires(Law::markers == 2)
  void operator()(Index i, Index j, Law const& law) const;
};
}  // namespace detail

/// Force element that is the sum of forces between pairs of its markers.
///
/// `for_each_pair(frame, visit)` calls visit(i, j, law) for all pairs of its markers i, j that may interact in their
/// present position. The law is a force element of two markers, and frame(i) is the frame of marker i.
/// `for_each_candidate(visit)` calls visit(i, j, law) for all pairs that can ever interact.
///
/// The matrix of a time step contains the blocks of each body of a pair, but not the blocks that couple the two
/// bodies. The interacting pairs can therefore change from step to step without a change of the sparsity pattern or the
/// elimination order.
template <class F>
concept ForceGroup = requires(F const group, std::string const name) {
  requires F::markers == any_number;
  { F::needs } -> std::convertible_to<MarkerKind>;
  { F::is_load } -> std::convertible_to<bool>;
  group.for_each_pair(detail::AnyFrame{}, detail::AnyVisit{});
  group.for_each_candidate(detail::AnyVisit{});
  group.check(name);
};

/// Force group whose pairs (i, j) can be visited in parts, by several threads: i is one of the first `many()` markers
/// of the group, and j is another marker.
template <class F>
concept PartitionedForceGroup = ForceGroup<F> && requires(F const group) {
  { group.many() } -> std::convertible_to<Index>;
  group.for_each_pair(detail::AnyFrame{}, detail::AnyVisit{}, Index(0), Index(0));  // for i in [begin, end)
};

/// Force group that finds its pairs by a search. A `F::Search` keeps the result between evaluations, so that an
/// evaluation searches only after sufficient motion.
template <class F>
concept SearchingForceGroup = ForceGroup<F> && requires(F const group, typename F::Search search) {
  group.for_each_pair(search, detail::AnyFrame{}, detail::AnyVisit{});
};

/// Force of a model: a force element or a group.
template <class F>
concept AppliedForce = ForceElement<F> || ForceGroup<F>;

/// Force element of two markers that approximates its tangent −(ck ∂w/∂pose + cd ∂w/∂twist) at each marker, with the
/// coefficients ck of the stiffness and cd of the damping. The approximations are symmetric, positive semidefinite 6×6
/// matrices, added to `of_a` and `of_b`. They are cheaper than the exact tangent by dual numbers and sufficient for
/// Newton's method.
template <class F>
concept HasOwnStiffness = ForceElement<F> && F::markers == 2 &&
                          requires(F const force, std::array<Frame<double>, 2> const frames, Mat<double, 6, 6> of_a,
                                   Mat<double, 6, 6> of_b) { force.own_stiffness(frames, 1.0, 1.0, of_a, of_b); };

}  // namespace polybody
