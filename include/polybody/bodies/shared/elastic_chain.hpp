#pragma once
/// \file
/// A chain of nodes whose elastic and damping force comes from groups of strains (`StrainGroup`).

#include <tuple>
#include <vector>

#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/bodies/shared/strain_tangent.hpp>

namespace polybody {

/// `Groups` is the tuple of an element's groups: one for all elements where they are alike, or one for each.
template <int columns, class Groups>
class ElasticChain : public NodeChain<columns> {
 public:
  using Chain = NodeChain<columns>;  ///< the nodes and their columns
  using Chain::element_columns, Chain::first_column;
  template <class T>
  using Element = Vec<T, element_columns>;
  using ElementMatrix = Mat<double, element_columns, element_columns>;

  /// All elements have the same reference.
  bool alike() const { return groups_.size() == 1; }
  /// Elements feel strains as those of `other` do.
  bool same_strains(ElasticChain const& other) const { return alike() && groups_ == other.groups_; }

  /// Elastic and damping force from an element's own coordinates and speeds, for elements that are alike.
  template <KernelScalar T>
  void element_force(Element<T> const& x, Element<T> const& xd, Element<T>& out) const {
    add_force<T>(groups_[0], x, xd, out);
  }
  /// ck (−∂f/∂x) + cd (−∂f/∂xd), for elements that are alike.
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

  /// Force over a step from q0 to q1 as `StepMeans` say: f·Δq = −ΔU less what is damped.
  void mean_force(Index e, std::span<double const> q0, std::span<double const> q1, StepMeans const& means,
                  Element<double>& out) const {
    Element<double> const x0 = of_element(e, q0), x1 = of_element(e, q1);
    out.setZero();
    for_each_group(e, [&](auto const& group) { group.add_mean_force(x0, x1, means, out); });
  }
  /// ck (−∂f/∂q1) of `mean_force` from q0 to q1, nearly; not symmetric.
  void mean_tangent(Index e, std::span<double const> q0, std::span<double const> q1, StepMeans const& means, double ck,
                    ElementMatrix& k) const {
    Element<double> const x0 = of_element(e, q0), x1 = of_element(e, q1);
    k.setZero();
    for_each_group(e, [&](auto const& group) { group.add_mean_tangent(x0, x1, means, ck, k); });
  }

  /// A pretensioned bar has energy in its reference.
  double strain_energy(Index e, std::span<double const> q) const {
    Element<double> const x = of_element(e, q);
    double u = 0.0;
    for_each_group(e, [&](auto const& group) { u += group.energy(x); });
    return u;
  }

 protected:
  /// n elements; groups may follow.
  explicit ElasticChain(Index n, std::vector<Groups> groups = {}) : Chain(n), groups_(std::move(groups)) {}
  void add_groups(Groups const& groups) { groups_.push_back(groups); }          ///< of one more element
  void set_groups(std::vector<Groups> groups) { groups_ = std::move(groups); }  ///< one, or one for each element

  Groups const& groups_of(Index e) const { return groups_[alike() ? 0 : std::size_t(e)]; }  ///< of element e
  /// An element's own part of coordinates or speeds x.
  template <class T>
  Element<T> of_element(Index e, std::span<T const> x) const {
    return part<element_columns>(x, first_column(e));
  }
  /// The same for spans of `double`.
  Element<double> of_element(Index e, std::span<double const> x) const {
    return part<element_columns>(x, first_column(e));
  }

  /// Calls f(group) for the groups of element e.
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
