#include <polybody/bodies/shared/elastic_chain.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/shared/element_batches.hpp>

using namespace polybody;

namespace strain_tangent_test {

Bar bar(Damping const& damping) {
  return {.length = 0.9,
          .section = Rectangle{.height = 0.1, .width = 0.08},
          .material = Material{.density = 1200.0, .young = 1e5, .poisson = 0.3},
          .damping = damping,
          .pretension = 3.0};
}

/// Moving body of nine elements, two SIMD vectors and one, away from its reference.
template <class B>
struct Swaying {
  B body;
  VecX q, v;

  explicit Swaying(Damping const& damping) : body(B::from(bar(damping), 9)), q(body.coordinates()), v(q) {
    body.reference({q.data(), std::size_t(q.size())});
    for (Index i = 0; i < q.size(); ++i) {
      q[i] += 0.03 * std::sin(3.0 * double(i));
      v[i] = std::cos(2.0 * double(i));
    }
  }
  static std::span<double const> view(VecX const& x) { return {x.data(), std::size_t(x.size())}; }
  Vec<double, B::element_columns> force(Index e, VecX const& at, VecX const& moving) const {
    Vec<double, B::element_columns> f;
    body.template force<double>(e, view(at), view(moving), f);
    return f;
  }
};

template <class B>
struct StrainTangent : testing::Test {
  /// The undamped tangent is computed from its lower half. If one group is damped, no group uses this symmetry.
  std::array<Damping, 4> const dampings = {Damping{}, Damping{.axial = 0.01}, Damping{.bending = 0.03},
                                           Damping{.axial = 0.01, .shear = 0.02, .bending = 0.03}};
};
using Bodies_ = testing::Types<planar::AncfCable<>, AncfCable<>, AncfCable<EngineeringStrain>, AncfBeam<ElasticLine>,
                               AncfBeam<Continuum<>>>;
TYPED_TEST_SUITE(StrainTangent, Bodies_);

// Differences of fourth order: (8 (f(h) − f(−h)) − f(2h) + f(−2h))/12h with steps h of a thousandth of an element's
// length. The truncation error is some 1e-12, and the round-off of the forces contributes some 1e-13/1e-3. The force
// is linear in the velocities.
TYPED_TEST(StrainTangent, IsTheForcesGradientWhicheverGroupsAreDamped) {
  constexpr int n = TypeParam::element_columns;
  for (Damping const& damping : this->dampings) {
    Swaying<TypeParam> const s(damping);
    Mat<double, n, n> stiffness, rates, k, d;
    s.body.tangent(2, s.view(s.q), s.view(s.v), 1.0, 0.0, stiffness);
    s.body.tangent(2, s.view(s.q), s.view(s.v), 0.0, 1.0, rates);
    for (int j = 0; j < n; ++j) {
      VecX const unit = VecX::Unit(s.q.size(), s.body.first_column(2) + j);
      auto const odd = [&](double h) {
        return (s.force(2, s.q - h * unit, s.v) - s.force(2, s.q + h * unit, s.v)).eval();
      };
      k.col(j) = (8.0 * odd(1e-4) - odd(2e-4)) / 12e-4;
      d.col(j) = s.force(2, s.q, s.v - 0.5 * unit) - s.force(2, s.q, s.v + 0.5 * unit);
    }
    EXPECT_LT((stiffness - k).norm(), 1e-9 * stiffness.norm());
    EXPECT_LE((rates - d).norm(), 1e-12 * stiffness.norm());
  }
}

// A displacement of both ends does exactly no work on any other displacement. The factors of the two positions are
// opposite.
TYPED_TEST(StrainTangent, DoesNotFeelWhereAnElementIs) {
  constexpr int n = TypeParam::element_columns, half = n / 2, d = TypeParam::world == World::plane ? 2 : 3;
  for (Damping const& damping : this->dampings) {
    Swaying<TypeParam> const s(damping);
    Mat<double, n, n> k;
    s.body.tangent(2, s.view(s.q), s.view(s.v), 0.7, 0.1, k);
    EXPECT_EQ((k.template topRows<d>() + k.template middleRows<d>(half)).norm(), 0.0);
    EXPECT_EQ((k.template leftCols<d>() + k.template middleCols<d>(half)).norm(), 0.0);
    EXPECT_GT(k.template topRows<d>().norm(), 0.01 * k.norm() / n);
  }
}

// SIMD evaluation of the tangent with the mass, compared with the evaluation of single elements.
TYPED_TEST(StrainTangent, InPacksIsThatOfEachElement) {
  constexpr int n = TypeParam::element_columns;
  static_assert(IdenticalElements<TypeParam>);
  for (Damping const& damping : this->dampings) {
    Swaying<TypeParam> const s(damping);
    Index next = 0;
    for_each_element_tangent<TypeParam>(s.body, {0, 9}, {s.view(s.q), s.view(s.v)}, {1.5, 0.1, 0.7},
                                        [&](Index e, auto const& k) {
                                          ASSERT_EQ(e, next++);
                                          Mat<double, n, n> expected, mass;
                                          s.body.tangent(e, s.view(s.q), s.view(s.v), 0.7, 0.1, expected);
                                          s.body.mass(e, s.view(s.q), mass);
                                          expected += 1.5 * mass;
                                          EXPECT_LT((k - expected).norm(), 1e-13 * expected.norm());
                                        });
    EXPECT_EQ(next, 9);
  }
}

}  // namespace strain_tangent_test
