#pragma once
/// \file
/// Strains and forces of the sections of the fully parameterised ANCF beam.

#include <polybody/bodies/ancf/ancf_beam.hpp>

namespace polybody {

template <class Elastic>
Vec6 AncfBeam<Elastic>::section_strains(Point const& p, std::span<double const> q) const {
  Vec3 const stretch = strains<std::tuple_element_t<0, ElasticLine::Groups>>(p, q),
             bend = strains<std::tuple_element_t<1, ElasticLine::Groups>>(p, q);
  Vec6 x;
  for (int i = 0; i < 3; ++i) {
    x[i] = stretch[i];
    x[3 + i] = bend[i];
  }
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
    for (int i = 0; i < 3; ++i) {
      n[i] *= std::get<0>(groups).stiffness()[i];
      n[3 + i] *= std::get<1>(groups).stiffness()[i];
    }
    n[0] += bar_.pretension;
    return n;
  } else {
    using T = typename std::tuple_element_t<0, Groups>::Strains::Scalar;  // double, known where this is used
    Element<T> const x = coordinates_at(p, q);
    Vec<T, 3> const by = map_of({p.element, p.xi}, 2) * x, bz = map_of({p.element, p.xi}, 3) * x;
    SectionFrame<T> const frame(by, bz);
    double const area = constants_.EA / bar_.material->young, lever = Elastic::lever(constants_);
    ancf::SectionPoints const section{std::sqrt(constants_.EI / constants_.EA),
                                      std::sqrt(constants_.EI_y.value() / constants_.EA)};
    Mat<T, 3, 3> const axis = strain({p.element, p.xi}, q);
    Vec<T, 6> n = Vec<T, 6>::Zero();
    auto const add = [&](double y, double z, Vec<T, 3> const& parts) {
      Point const at{p.element, p.xi, y, z};
      Mat<T, 3, 3> const s = Elastic::second_piola(bar_, constants_, strain(at, q), axis);
      Vec<T, 3> const t = frame.local(deformation_gradient(at, q) * s.col(0).cwiseProduct(parts));
      n.template head<3>() += 0.25 * area * t;
      n.template tail<3>() += 0.25 * area * frame.local(y * by + z * bz).cross(t);
    };
    section.for_each([&](double y, double z) {
      add(y, z, Vec<T, 3>(1, 0, 0));
      add(lever * y, lever * z, Vec<T, 3>(0, 1, 1));
    });
    return n;
  }
}

}  // namespace polybody
