#pragma once
/// \file
/// Strains and forces of the sections of the fully parameterised ANCF beam.

#include <polybody/bodies/ancf_beam.hpp>

namespace polybody {

template <class Elastic>
Vec6 AncfBeam<Elastic>::section_strains(Point const& p, std::span<double const> q) const {
  Vec6 x;
  x << strains<std::tuple_element_t<0, ElasticLine::Groups>>(p, q),
      strains<std::tuple_element_t<1, ElasticLine::Groups>>(p, q);
  return x;
}

/// `Continuum`: with the traction t = F S e₁ on the section, in the axes of the deformed one,
///   N = ∫ Rᵀt dA,  M = ∫ Rᵀ(r − r₀) × Rᵀt dA,
/// over the points that the energy uses: normal stress at the four of the section, shear stress at those that twist
/// meets GJ with.
template <class Elastic>
Vec6 AncfBeam<Elastic>::section_forces(Point const& p, std::span<double const> q) const {
  if constexpr (std::same_as<Elastic, ElasticLine>) {
    Groups const& groups = groups_of(p.element);
    Vec6 n = section_strains(p, q);
    n.head<3>() = n.head<3>().cwiseProduct(std::get<0>(groups).stiffness());
    n.tail<3>() = n.tail<3>().cwiseProduct(std::get<1>(groups).stiffness());
    n[0] += bar_.pretension;
    return n;
  } else {
    Element<double> const x = coordinates_at(p, q);
    Vec3 const by = map_of({p.element, p.xi}, 2) * x, bz = map_of({p.element, p.xi}, 3) * x;
    SectionFrame<double> const frame(by, bz);
    double const area = constants_.EA / bar_.material->young, lever = Elastic::lever(constants_);
    ancf::SectionPoints const section{std::sqrt(constants_.EI / constants_.EA),
                                      std::sqrt(constants_.EI_y.value() / constants_.EA)};
    Mat3 const axis = strain({p.element, p.xi}, q);
    Vec6 n = Vec6::Zero();
    auto const add = [&](double y, double z, Vec3 const& parts) {
      Point const at{p.element, p.xi, y, z};
      Mat3 const s = Elastic::second_piola(bar_, constants_, strain(at, q), axis);
      Vec3 const t = frame.local(deformation_gradient(at, q) * s.col(0).cwiseProduct(parts));
      n.head<3>() += 0.25 * area * t;
      n.tail<3>() += 0.25 * area * frame.local(y * by + z * bz).cross(t);
    };
    section.for_each([&](double y, double z) {
      add(y, z, Vec3(1, 0, 0));
      add(lever * y, lever * z, Vec3(0, 1, 1));
    });
    return n;
  }
}

}  // namespace polybody
