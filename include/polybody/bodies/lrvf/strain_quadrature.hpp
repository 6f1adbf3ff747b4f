#pragma once
/// \file
/// Policies for the quadrature of the strains of `Lrvf` and `planar::Lrvf` along an element. With linear shapes the
/// quadrature determines whether a slender element locks [Hughes, Taylor & Kanoknukulchai 1977; Simo & Vu-Quoc 1986].
/// Theory: Eq. 2.54.

#include <array>
#include <cstddef>

#include <polybody/math/element_functions.hpp>

namespace polybody {

/// Section at which strains are evaluated, with its weights in the energies of the strains.
struct StrainPoint {
  double xi;         ///< position ξ ∈ (0, 1)
  double axial;      ///< weight of Γ₁
  double shear;      ///< weight of Γ₂, Γ₃
  double curvature;  ///< weight of K
};

namespace detail {

/// Returns true if the weights of each strain add up to one, and no section lies at a node.
template <std::size_t n>
constexpr bool is_rule(std::array<StrainPoint, n> const& points) {
  double axial = 0.0, shear = 0.0, curvature = 0.0;
  for (StrainPoint const& p : points) {
    if (!(p.xi > 0.0 && p.xi < 1.0)) return false;
    axial += p.axial;
    shear += p.shear;
    curvature += p.curvature;
  }
  auto const one = [](double sum) { return sum > 1.0 - 1e-12 && sum < 1.0 + 1e-12; };
  return one(axial) && one(shear) && one(curvature);
}

/// Weights of a section in the energy of the strains: of ε or Γ₁; of γ or Γ₂, Γ₃; of κ or K.
inline constexpr std::array<double StrainPoint::*, 3> strain_weights = {&StrainPoint::axial, &StrainPoint::shear,
                                                                        &StrainPoint::curvature};

/// Quadrature rule for one kind of strain: the points at which its weight is not zero.
template <class Q, double StrainPoint::* weight>
constexpr auto rule_of() {
  constexpr auto counts = [] {
    std::size_t n = 0;
    for (StrainPoint const& p : Q::points) n += p.*weight != 0.0 ? 1 : 0;
    return n;
  };
  std::array<GaussPoint, counts()> rule{};
  std::size_t n = 0;
  for (StrainPoint const& p : Q::points)
    if (p.*weight != 0.0) rule[n++] = {p.xi, p.*weight};
  return rule;
}

/// Returns true if both kinds of strain have the same points and weights.
template <class Q>
constexpr bool alike(double StrainPoint::* a, double StrainPoint::* b) {
  for (StrainPoint const& p : Q::points)
    if (p.*a != p.*b) return false;
  return true;
}

}  // namespace detail

/// Quadrature rule along an element: `Q::points` (`StrainPoint`), with weights that add up to one for each strain.
template <class Q>
concept StrainQuadrature = requires { requires detail::is_rule(Q::points); };

/// All strains are evaluated in the middle of the element, which does not lock.
struct ReducedQuadrature {
  /// Position ξ, and the weights of Γ₁, of Γ₂ and Γ₃, and of K.
  static constexpr std::array<StrainPoint, 1> points = {{{0.5, 1.0, 1.0, 1.0}}};
};

/// All strains are evaluated at both Gauss points, for comparison. The element locks. If the sections of the two nodes
/// differ by the angle φ, those of the Gauss points are inclined by ±φ/√12 to the straight chord. This angle acts as a
/// shear strain. The bending stiffness is then too large by the factor 1 + GA l²/(12 EI).
struct FullQuadrature {
  /// Position ξ, and the weights of Γ₁, of Γ₂ and Γ₃, and of K.
  static constexpr std::array<StrainPoint, 2> points = {
      {{gauss<2>[0].xi, 0.5, 0.5, 0.5}, {gauss<2>[1].xi, 0.5, 0.5, 0.5}}};
};

/// Γ is evaluated in the middle, K at both Gauss points. In the linear theory of a straight bar only the shear must be
/// evaluated in the middle, because Γ₁ = u′ is constant. In general Γ₁ must be evaluated in the middle as well. If the
/// sections of the two nodes differ by the angle φ, those of the Gauss points are inclined to the chord by ψ ± φ/√12,
/// with the shear ψ, and Γ₁ = |r′| cos(ψ ± φ/√12) − 1.
/// - The mean of Γ₁ over both points decreases by φ²/24 under pure bending. The chord becomes longer by the same
///   fraction, whereas the chord of an arc of constant length becomes shorter.
/// - The difference of Γ₁ between both points, 2 sin ψ sin(φ/√12), depends on ψ: it adds EA φ²/12 to GA. On a curved
///   reference this stiffening also occurs in linear theory, with the angle φ₀ between the sections of the nodes in the
///   reference.
/// With `RelativeRotation` K is constant in the element, and in the planar beam κ is constant. In these cases the
/// results equal those of `ReducedQuadrature`, and in space the cost is five to ten times higher.
struct SelectiveQuadrature {
  /// Position ξ, and the weights of Γ₁, of Γ₂ and Γ₃, and of K.
  static constexpr std::array<StrainPoint, 3> points = {
      {{gauss<2>[0].xi, 0.0, 0.0, 0.5}, {0.5, 1.0, 1.0, 0.0}, {gauss<2>[1].xi, 0.0, 0.0, 0.5}}};
};

}  // namespace polybody
