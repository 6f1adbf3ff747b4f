#pragma once
/// \file
/// Chain of nodes whose elastic and damping force follows from groups of strains (`StrainGroup`), with its tangent in
/// blocks for pairs of nodal vectors.
/// Theory: Eqs. 2.19 to 2.23.

#include <tuple>
#include <utility>
#include <vector>

#include <polybody/bodies/shared/node_chain.hpp>
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
/// only the blocks on and below the diagonal are computed. If the strains read the vector `difference` relative to
/// vector 0 (`StrainMap`), the blocks of vector 0 follow from those of `difference`: block (0, 0) is equal, and the
/// other blocks are negative.
template <KernelScalar T, int n, class... Groups>
void tangent_of(std::tuple<Groups...> const& groups, Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd,
                Mat<T, n, n>& k) {
  using P = typename std::tuple_element_t<0, std::tuple<Groups...>>::P;
  constexpr int d = P::d, difference = std::max({Groups::P::difference...}), first = difference > 0 ? 1 : 0;
  static_assert(
      ((Groups::P::difference == difference || !Groups::P::reads(0)) && ...),
      "Every strain group of an element must either use the same position difference or not read nodal vector 0.");
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

/// Chain of nodes with elastic and damping forces. `Groups` is the tuple of the strain groups of an element. The chain
/// stores one such tuple if all elements are alike, otherwise one for each element.
template <int columns, class Groups>
class ElasticChain : public NodeChain<columns> {
 public:
  using Chain = NodeChain<columns>;  ///< nodes and their columns
  using Chain::element_columns, Chain::first_column;
  template <class T>
  using Element = Vec<T, element_columns>;
  using ElementMatrix = Mat<double, element_columns, element_columns>;

  /// Returns true if all elements have the same strain groups, such as those of a straight bar.
  bool alike() const { return groups_.size() == 1; }
  /// Returns true if all elements of both chains have the same strain groups.
  bool same_strains(ElasticChain const& other) const { return alike() && groups_ == other.groups_; }

  /// Elastic and damping force of one element from its coordinates `x` and velocities `xd`, if all elements are alike.
  template <KernelScalar T>
  void element_force(Element<T> const& x, Element<T> const& xd, Element<T>& out) const {
    add_force<T>(groups_[0], x, xd, out);
  }
  /// Tangent ck (−∂f/∂x) + cd (−∂f/∂xd) of one element, if all elements are alike.
  template <KernelScalar T>
  void element_tangent(Element<T> const& x, Element<T> const& xd, double ck, double cd,
                       Mat<T, element_columns, element_columns>& k) const {
    tangent_of<T, element_columns>(groups_[0], x, xd, ck, cd, k);
  }

  template <StateScalar T>
  void force(Index e, std::span<T const> q, std::span<T const> v, Element<T>& out) const {
    add_force<T>(groups_of(e), of_element(e, q), of_element(e, v), out);
  }
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               ElementMatrix& k) const {
    tangent_of<double, element_columns>(groups_of(e), of_element(e, q), of_element(e, v), ck, cd, k);
  }

  /// Discrete-gradient force over a step from q0 to q1 with the coefficients `means`: f·Δq = −ΔU minus the dissipated
  /// energy.
  void discrete_force(Index e, std::span<double const> q0, std::span<double const> q1, DiscreteDerivative const& means,
                      Element<double>& out) const {
    Element<double> const x0 = of_element(e, q0), x1 = of_element(e, q1);
    out.setZero();
    for_each_group(e, [&](auto const& group) { group.add_mean_force(x0, x1, means, out); });
  }
  /// Approximate tangent ck (−∂f/∂q1) of `discrete_force` from q0 to q1; not symmetric.
  void discrete_tangent(Index e, std::span<double const> q0, std::span<double const> q1,
                        DiscreteDerivative const& means, double ck, ElementMatrix& k) const {
    Element<double> const x0 = of_element(e, q0), x1 = of_element(e, q1);
    k.setZero();
    for_each_group(e, [&](auto const& group) { group.add_mean_tangent(x0, x1, means, ck, k); });
  }

  /// Strain energy of element e [J]. With a pretension N, an undeformed element of length l has the energy N² l/(2 EA)
  /// in `AncfBeam`, and zero in `AncfBeam<CoupledLine>`, cables and planar beams.
  double strain_energy(Index e, std::span<double const> q) const {
    Element<double> const x = of_element(e, q);
    double u = 0.0;
    for_each_group(e, [&](auto const& group) { u += group.energy(x); });
    return u;
  }

 protected:
  /// Chain of n elements; the strain groups can be added later.
  explicit ElasticChain(Index n, std::vector<Groups> groups = {}) : Chain(n), groups_(std::move(groups)) {}
  void add_groups(Groups const& groups) { groups_.push_back(groups); }          ///< adds the groups of one more element
  void set_groups(std::vector<Groups> groups) { groups_ = std::move(groups); }  ///< one for all elements, or one each

  Groups const& groups_of(Index e) const { return groups_[alike() ? 0 : std::size_t(e)]; }  ///< groups of element e
  /// Entries of x (coordinates or generalised velocities) that belong to element e.
  template <class T>
  Element<T> of_element(Index e, std::span<T const> x) const {
    return part<element_columns>(x, first_column(e));
  }
  /// Overload for spans of `double`.
  Element<double> of_element(Index e, std::span<double const> x) const {
    return part<element_columns>(x, first_column(e));
  }

  /// Calls f(group) for each group of element e.
  template <class F>
  void for_each_group(Index e, F&& f) const {
    std::apply([&](auto const&... group) { (f(group), ...); }, groups_of(e));
  }

 private:
  template <KernelScalar T>
  static void add_force(Groups const& groups, Element<T> const& x, Element<T> const& xd, Element<T>& out) {
    for (int i = 0; i < element_columns; ++i) out[i] = T(0.0);
    std::apply([&](auto const&... group) { (group.template add_force<T>(x, xd, out), ...); }, groups);
  }

  std::vector<Groups> groups_;
};

}  // namespace polybody
