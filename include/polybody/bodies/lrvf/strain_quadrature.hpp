#pragma once
/// \file
/// Where along an element `Lrvf` and `planar::Lrvf` take their strains: a policy. With linear shapes the choice decides
/// whether a slender element bends or locks [Hughes, Taylor & Kanoknukulchai 1977; Simo & Vu-Quoc 1986].

#include <array>
#include <cstddef>

#include <polybody/math/quadrature.hpp>

namespace polybody {

/// A section in which strains are taken, and what it counts in the energies of the strains.
struct StrainPoint {
  double xi;         ///< ∈ (0, 1)
  double axial;      ///< weight of Γ₁
  double shear;      ///< weight of Γ₂, Γ₃
  double curvature;  ///< weight of K
};

namespace detail {

/// The weights of each strain add up to one, and no section lies at a node.
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

/// What a section counts in the energy of ε or Γ₁, of γ or Γ₂, Γ₃, and of κ or K.
inline constexpr std::array<double StrainPoint::*, 3> strain_weights = {&StrainPoint::axial, &StrainPoint::shear,
                                                                        &StrainPoint::curvature};

/// The points in which one of them counts.
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

/// Both kinds of strain have the same points and weights.
template <class Q>
constexpr bool alike(double StrainPoint::* a, double StrainPoint::* b) {
  for (StrainPoint const& p : Q::points)
    if (p.*a != p.*b) return false;
  return true;
}

}  // namespace detail

template <class Q>
concept StrainQuadrature = requires { requires detail::is_rule(Q::points); };

/// All strains in the middle: nothing locks.
struct Reduced {
  /// ξ, and the weights of Γ₁, of Γ₂ and Γ₃, of K.
  static constexpr std::array<StrainPoint, 1> points = {{{0.5, 1.0, 1.0, 1.0}}};
};

/// All strains in both Gauss points, for comparison: it locks. Where the curvature turns the sections by φ, those of
/// the points lean by ±φ/√12 against the straight chord, which counts as shear. Bending is then stiffer by the factor
/// 1 + GA l²/(12 EI).
struct Full {
  /// ξ, and the weights of Γ₁, of Γ₂ and Γ₃, of K.
  static constexpr std::array<StrainPoint, 2> points = {
      {{gauss<2>[0].xi, 0.5, 0.5, 0.5}, {gauss<2>[1].xi, 0.5, 0.5, 0.5}}};
};

/// Γ in the middle, K in both Gauss points. Linear theory of a straight bar asks it of the shear alone, as Γ₁ = u′ is
/// constant. Otherwise Γ₁ must come along: in points that lean by ψ ± φ/√12 against the chord,
/// Γ₁ = |r′| cos(ψ ± φ/√12) − 1.
/// - The mean over both falls by φ²/24 under pure bending, and the chord stretches by as much, where that of an arc
///   shortens.
/// - The difference, 2 sin ψ sin(φ/√12), is strained by the shear ψ: EA φ²/12 stands beside GA. On a curved reference
///   that is so in linear theory, too, with its angle φ₀ an element.
/// `Objective` has one K in the whole element, and the plane one κ: there this is `Reduced`, in space at five to ten
/// times the cost.
struct Selective {
  /// ξ, and the weights of Γ₁, of Γ₂ and Γ₃, of K.
  static constexpr std::array<StrainPoint, 3> points = {
      {{gauss<2>[0].xi, 0.0, 0.0, 0.5}, {0.5, 1.0, 1.0, 0.0}, {gauss<2>[1].xi, 0.0, 0.0, 0.5}}};
};

}  // namespace polybody
