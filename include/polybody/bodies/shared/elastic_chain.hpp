#pragma once
/// \file
/// Chain of nodes whose elastic and damping force follows from groups of strains (`StrainGroup`).

#include <tuple>
#include <vector>

#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/bodies/shared/strain_tangent.hpp>

namespace polybody {

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

  /// Returns true if all elements have the same reference configuration.
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

  /// Strain energy of element e [J]. With a pretension, its value in the reference configuration depends on the type of
  /// beam: zero, or the energy of the prestress.
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
