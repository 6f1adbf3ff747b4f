#pragma once
/// \file
/// Force elements among any number of markers, such as contacts of many candidates.

#include <polybody/forces/force_element.hpp>

namespace polybody {

/// `F::markers` of a force element whose markers are known only when the model is built.
inline constexpr int any_number = -1;

namespace detail {
/// Arguments for the checks of a concept.
struct AnyFrame {
  Frame<double> const& operator()(Index marker) const;
};
struct AnyVisit {
  template <ForceElement Law>
    requires(Law::markers == 2)
  void operator()(Index i, Index j, Law const& law) const;
};
}  // namespace detail

/// A force element that is the sum of forces between two of its markers each:
///   for_each_pair(frame, visit)  calls visit(i, j, law), law a force element of two markers, for all pairs of its
///   markers i, j that
///                                may act on each other as they stand: frame(i) is marker i's;
///   for_each_candidate(visit)    the same for all pairs that may ever act.
/// The matrix of a time step holds the blocks of each body of a pair, not those that couple the two: which pairs act
/// changes from step to step, while the pattern of the matrix and the order of its elimination stay.
template <class F>
concept ForceGroup = requires(F const group, std::string const name) {
  requires F::markers == any_number;
  { F::needs } -> std::convertible_to<Observes>;
  { F::is_load } -> std::convertible_to<bool>;
  group.for_each_pair(detail::AnyFrame{}, detail::AnyVisit{});
  group.for_each_candidate(detail::AnyVisit{});
  group.check(name);
};

/// A group that goes through its pairs by parts, which threads share: i is one of its first `many()` markers, j
/// another.
template <class F>
concept PairsByParts = ForceGroup<F> && requires(F const group) {
  { group.many() } -> std::convertible_to<Index>;
  group.for_each_pair(detail::AnyFrame{}, detail::AnyVisit{}, Index(0), Index(0));  // of i in [begin, end)
};

/// A force that a model may hold.
template <class F>
concept AppliedForce = ForceElement<F> || ForceGroup<F>;

/// A force element of two markers that approximates its own stiffness at each of them, −(ck ∂w/∂pose + cd ∂w/∂twist),
/// by symmetric, positive semidefinite 6×6 matrices, added to `of_a` and `of_b`. They are cheaper than the exact
/// gradient by dual numbers and good enough for Newton's method.
template <class F>
concept HasOwnStiffness = ForceElement<F> && F::markers == 2 &&
                          requires(F const force, std::array<Frame<double>, 2> const frames, Mat<double, 6, 6> of_a,
                                   Mat<double, 6, 6> of_b) { force.own_stiffness(frames, 1.0, 1.0, of_a, of_b); };

}  // namespace polybody
