#pragma once
/// \file
/// Concepts of the strains that `StrainGroup` takes.

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/strain_map.hpp>

namespace polybody {

/// Strains that are quadratic in the parameters, ε_i = ½ Σ_st S_i,st p_s·p_t + const., shapes s and t, all of which
/// read the same vectors: then H_i = S_i ⊗ 1, and B is linear in p, so that H_i ṗ = B_i(ṗ).
template <class L>
concept QuadraticStrains = requires(Vec<double, L::strains> const n,
                                    Mat<double, L::parameters / L::components, L::parameters / L::components> s) {
  L::template add_hessian<double>(n, s);  // s += Σ n_i S_i
};

/// Strains as functions of parameters: what a group is made of.
template <class L>
concept StrainFunctions = requires(Vec<double, L::parameters> const p, Vec<double, L::strains> e,
                                   Mat<double, L::strains, L::parameters> b,
                                   Mat<double, L::parameters, L::parameters> h) {
  requires L::points >= 1 && L::reach >= 1;
  requires L::parameters % L::components == 0;  // parameters are vectors of so many entries, the shapes
  {
    L::vector(0, 0)
  } -> std::convertible_to<int>;          // the nodal vector that shape s reads as its j-th; −1: it reads fewer
  L::template evaluate<double>(p, e, b);  // ε and B
  requires QuadraticStrains<L> || requires { L::template add_hessian<double>(p, e, h); };  // h += Σ n_i H_i for given n
};

/// Strains that also know their parameters along the axis of a bar, their stiffness and their damping.
template <class L>
concept StrainLaw = StrainFunctions<L> && requires(BarConstants const c, Damping const d) {
  { L::map(0.5, 1.0) } -> std::convertible_to<typename StrainMap<L>::Factors>;  // P's factors at ξ, length l
  { L::stiffness(c) } -> std::convertible_to<Vec<double, L::strains>>;          // C
  { L::damping(d) } -> std::convertible_to<Vec<double, L::strains>>;            // τ [s]
};

/// A law that gives p_ε = P_ε(ε) ε̇ and its gradients P_ε by ε̇ and Q by ε.
template <class L>
concept HasObjectiveRate = requires(Vec<double, L::strains>& e, Mat<double, L::strains, L::strains>& m) {
  L::template objective_rate<double>(e, e);
  L::template objective_rate_gradients<double>(e, e, m, m);
};

/// A law of equal stiffness for all strains, which are components of a vector that turns with the body: gives the
/// vector's square from scalar products of its parameters.
template <class L>
concept HasSquare = requires(Vec<double, L::parameters> const p) {
  { L::template square<double>(p) } -> std::convertible_to<double>;
};

}  // namespace polybody
