#include <polybody/bodies/shared/strain_group.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/shared/elastic_chain.hpp>
#include <random>

using namespace polybody;

namespace strain_group_test {

// Law test of the strain energy by dual numbers, for every strain group of every theory.
template <class Law_, int columns>
struct Group {
  using Law = Law_;
  static constexpr int n = columns;
};
using Green = planar::HermiteCable<planar::GreenStrain>;
using Engineering = planar::HermiteCable<planar::EngineeringStrain>;
using Groups = testing::Types<
    Group<Green::Axial, 8>, Group<Green::Bending, 8>, Group<Engineering::Axial, 8>, Group<Engineering::Bending, 8>,
    Group<planar::SimoVuQuoc::Section, 6>, Group<planar::SectionIn<FullQuadrature, 0, 3>, 6>,
    Group<planar::SectionIn<SelectiveQuadrature, 0, 2>, 6>, Group<planar::SectionIn<SelectiveQuadrature, 2, 1>, 6>,
    Group<planar::SectionIn<FullQuadrature, 1, 1>, 6>, Group<CableAxial<GreenStrain, 5>, 12>,
    Group<CableAxial<EngineeringStrain, 5>, 12>, Group<CableBending<GreenStrain, 3>, 12>,
    Group<CableBending<EngineeringStrain, 3>, 12>>;

template <class G>
struct StrainGroupLaws : testing::Test {
  using Law = typename G::Law;
  static constexpr int np = Law::parameters, m = Law::strains, n = G::n;

  std::mt19937 random{7};
  BarConstants const constants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300};
  Damping const damping{.axial = 0.3, .shear = 0.2, .bending = 0.4};
  Vec<double, m> const initial = numbers<m>();
  StrainGroup<Law> const group{constants, damping, 0.7, initial};

  double number() { return std::uniform_real_distribution<double>(-0.2, 0.2)(random); }
  template <int k>
  Vec<double, k> numbers() {
    Vec<double, k> x;
    for (int i = 0; i < k; ++i) x[i] = number();
    return x;
  }
  Vec<double, np> parameters() {
    Vec<double, np> p = numbers<np>();
    p[0] += 1.1;  // r′ is near a unit vector along x
    return p;
  }
  Vec<double, n> coordinates() {
    Vec<double, n> x = numbers<n>();
    if constexpr (n == 8 || n == 12) {  // a cable's slopes
      x[n / 4] += 1.0;
      x[3 * n / 4] += 1.0;
    }
    x[n / 2] += 0.7;
    return x;
  }
};
TYPED_TEST_SUITE(StrainGroupLaws, Groups);

TYPED_TEST(StrainGroupLaws, BAndItsGradientAreDerivatives) {
  using Law = typename TypeParam::Law;
  constexpr int np = Law::parameters, m = Law::strains;
  using D = Dual<np>;
  Vec<double, np> const p = this->parameters();
  Vec<double, m> const weights = this->template numbers<m>();
  Vec<D, np> moved;
  for (int i = 0; i < np; ++i) moved[i] = D::variable(p[i], i);
  Vec<D, m> strain;
  Mat<D, m, np> b;
  Law::template evaluate<D>(moved, strain, b);
  Mat<double, np, np> h = Mat<double, np, np>::Zero(), expected = h;
  Law::template add_hessian<double>(p, weights, h);
  for (int i = 0; i < m; ++i)
    for (int k = 0; k < np; ++k) {
      EXPECT_NEAR(b(i, k).v, strain[i].d[k], 1e-14);
      expected.row(k) += weights[i] * b(i, k).d.matrix().transpose();
    }
  EXPECT_LT((h - expected).norm(), 1e-14 * (1.0 + expected.norm()));
}

TYPED_TEST(StrainGroupLaws, ForceIsTheEnergysSlopeAndTangentItsGradient) {
  constexpr int n = TypeParam::n;
  using D = Dual<2 * n>;
  Vec<double, n> const x = this->coordinates(), xd = this->template numbers<n>();
  Vec<D, n> moved, moving, force = Vec<D, n>::Zero();
  for (int i = 0; i < n; ++i) {
    moved[i] = D::variable(x[i], i);
    moving[i] = D::variable(xd[i], n + i);
  }
  this->group.template add_force<D>(moved, moving, force);
  Mat<double, n, n> stiffness, damping;
  tangent_of(std::tuple(this->group), x, xd, 1.0, 0.0, stiffness);
  tangent_of(std::tuple(this->group), x, xd, 0.0, 1.0, damping);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      EXPECT_NEAR(stiffness(i, j), -force[i].d[j], 1e-12 * stiffness.norm());
      EXPECT_NEAR(damping(i, j), -force[i].d[n + j], 1e-12 * damping.norm());
    }
  // without velocities f = −∂U/∂x, by central differences of the energy
  Vec<double, n> const rest = Vec<double, n>::Zero();
  Vec<double, n> still = rest;
  this->group.template add_force<double>(x, rest, still);
  for (int i = 0; i < n; ++i) {
    double const e = 1e-5;
    Vec<double, n> up = x, down = x;
    up[i] += e;
    down[i] -= e;
    EXPECT_NEAR(still[i], -(this->group.energy(up) - this->group.energy(down)) / (2 * e), 1e-7 * (1.0 + still.norm()));
  }
}

// SIMD vectors evaluate four elements with the same arithmetic.
TYPED_TEST(StrainGroupLaws, PacksCalculateWithEachElement) {
  constexpr int n = TypeParam::n;
  Vec<SimdVector<>, n> x, xd, force = Vec<SimdVector<>, n>::Zero();
  Mat<SimdVector<>, n, n> tangent;
  std::array<Vec<double, n>, simd_size> each, rate;
  for (int l = 0; l < simd_size; ++l) {
    each[std::size_t(l)] = this->coordinates();
    rate[std::size_t(l)] = this->template numbers<n>();
    for (int i = 0; i < n; ++i) {
      x[i].set(l, each[std::size_t(l)][i]);
      xd[i].set(l, rate[std::size_t(l)][i]);
    }
  }
  this->group.template add_force<SimdVector<>>(x, xd, force);
  tangent_of(std::tuple(this->group), x, xd, 0.7, 0.1, tangent);
  for (int l = 0; l < simd_size; ++l) {
    Vec<double, n> f = Vec<double, n>::Zero();
    Mat<double, n, n> k;
    this->group.template add_force<double>(each[std::size_t(l)], rate[std::size_t(l)], f);
    tangent_of(std::tuple(this->group), each[std::size_t(l)], rate[std::size_t(l)], 0.7, 0.1, k);
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(force[i][l], f[i], 1e-13 * f.norm());
      for (int j = 0; j < n; ++j) EXPECT_NEAR(tangent(i, j)[l], k(i, j), 1e-13 * k.norm());
    }
  }
}

}  // namespace strain_group_test
