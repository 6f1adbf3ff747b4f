#pragma once
/// \file
/// Concepts of strain laws: the strains of a `StrainGroup`, with their derivatives.

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/strain_map.hpp>

namespace polybody {

/// Strains that are quadratic in the parameters, ε_i = ½ Σ_st S_i,st p_s·p_t + const. All shapes p_s (`StrainMap`) read
/// the same nodal vectors. Then H_i = S_i ⊗ 1, and B is linear in p, so that H_i ṗ = B_i(ṗ).
template <class L>
concept QuadraticStrains = requires(Vec<double, L::strains> const n,
                                    Mat<double, L::parameters / L::components, L::parameters / L::components> s) {
  L::template add_hessian<double>(n, s);  // s += Σ n_i S_i
};

/// Strains as functions of parameters, for the groups of an element.
template <class L>
concept StrainFunctions = requires(Vec<double, L::parameters> const p, Vec<double, L::strains> e,
                                   Mat<double, L::strains, L::parameters> b,
                                   Mat<double, L::parameters, L::parameters> h) {
  requires L::points >= 1 && L::reach >= 1;
  requires L::parameters % L::components == 0;      // parameters are vectors with `components` entries, the shapes
  { L::vector(0, 0) } -> std::convertible_to<int>;  // j-th nodal vector that shape s reads; −1 if it reads fewer
  L::template evaluate<double>(p, e, b);            // ε and B
  requires QuadraticStrains<L> || requires { L::template add_hessian<double>(p, e, h); };  // h += Σ n_i H_i for n = e
};

/// Strains with a parameter map along the axis of a bar, a stiffness and a damping.
template <class L>
concept StrainLaw = StrainFunctions<L> && requires(BarConstants const c, Damping const d) {
  { L::map(0.5, 1.0) } -> std::convertible_to<typename StrainMap<L>::Factors>;  // factors of P at ξ for length l
  { L::stiffness(c) } -> std::convertible_to<Vec<double, L::strains>>;          // C
  { L::damping(d) } -> std::convertible_to<Vec<double, L::strains>>;            // τ [s]
};

/// Law with the objective rate P_ε ε̇ of its strains and two derivatives of this rate: P_ε with respect to ε̇, Q with
/// respect to ε.
template <class L>
concept HasObjectiveRate = requires(Vec<double, L::strains>& e, Mat<double, L::strains, L::strains>& m) {
  L::template objective_rate<double>(e, e);
  L::template objective_rate_gradients<double>(e, e, m, m);
};

/// Law of a strain vector that rotates with the body, with equal stiffness for all components. `square` returns the
/// square of the vector, computed from scalar products of the parameters.
template <class L>
concept HasSquare = requires(Vec<double, L::parameters> const p) {
  { L::template square<double>(p) } -> std::convertible_to<double>;
};

}  // namespace polybody
