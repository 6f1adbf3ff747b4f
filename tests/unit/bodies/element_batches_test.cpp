#include <polybody/bodies/shared/element_batches.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <vector>

using namespace polybody;

namespace element_batches_test {

static_assert(IdenticalElements<planar::AncfCable<>> &&
              IdenticalElements<planar::AncfCable<planar::EngineeringStrain>>);
static_assert(IdenticalElements<planar::Lrvf> && IdenticalElements<planar::Se3Beam> && !IdenticalElements<Lrvf<>>);

template <class B>
struct Swaying {
  B body;
  std::vector<double> q, v, a;

  explicit Swaying(Index elements, double sway = 0.01)
      : body(B::from({.length = 1.2,
                      .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300},
                      .damping = {.axial = 0.1, .bending = 0.2}},
                     elements)),
        q(std::size_t(body.coordinates())),
        v(q.size()),
        a(q.size()) {
    body.reference(q);
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += sway * std::sin(3.0 * double(i));
      v[i] = std::cos(2.0 * double(i));
      a[i] = std::sin(5.0 * double(i));
    }
  }
  using View = std::span<double const>;
  View qs() const { return q; }
  View vs() const { return v; }
  View as() const { return a; }
};

template <class B>
struct ElementBatches : testing::Test {};
using Bodies_ =
    testing::Types<planar::AncfCable<>, planar::AncfCable<planar::EngineeringStrain>, planar::Lrvf, planar::Se3Beam>;
TYPED_TEST_SUITE(ElementBatches, Bodies_);

// SIMD vectors of elements and the remaining elements give the results of single elements, in order, for small and
// large relative rotations of the nodes.
TYPED_TEST(ElementBatches, EqualElementsOneByOne) {
  constexpr int n = TypeParam::element_columns;
  for (Index const elements : {1, 2, 3, 4, 5, 7, 8, 11, 24}) {
    Swaying<TypeParam> const s(elements, elements == 24 ? 1.8 : 0.01);
    Index next = 0;
    for_each_residual<TypeParam, double>(s.body, {0, elements}, {s.qs(), s.vs(), s.as()},
                                         [&](Index e, Vec<double, n> const& x) {
                                           ASSERT_EQ(e, next++);
                                           Vec<double, n> inertia, force;
                                           s.body.template inertia<double>(e, s.qs(), s.as(), inertia);
                                           s.body.template force<double>(e, s.qs(), s.vs(), force);
                                           EXPECT_LT((x - (inertia - force)).norm(), 1e-13 * force.norm());
                                         });
    EXPECT_EQ(next, elements);
    next = 0;
    for_each_element_tangent<TypeParam>(s.body, {0, elements}, {s.qs(), s.vs()}, {1.5, 0.1, 0.7},
                                        [&](Index e, auto const& k) {
                                          ASSERT_EQ(e, next++);
                                          Mat<double, n, n> expected, mass;
                                          s.body.tangent(e, s.qs(), s.vs(), 0.7, 0.1, expected);
                                          s.body.mass(e, s.qs(), mass);
                                          expected += 1.5 * mass;
                                          EXPECT_LT((k - expected).norm(), 1e-13 * expected.norm());
                                        });
    EXPECT_EQ(next, elements);
  }
}

// A loop may be divided at any multiple of the SIMD vector. The results of each element are bitwise identical.
TYPED_TEST(ElementBatches, DoNotDependOnHowALoopIsCut) {
  constexpr int n = TypeParam::element_columns;
  Index const elements = 4 * 5 + 3;
  Swaying<TypeParam> const s(elements);
  std::vector<Vec<double, n>> whole, parts;
  auto const run = [&](std::vector<Vec<double, n>>& out, Index begin, Index end) {
    for_each_residual<TypeParam, double>(s.body, {begin, end}, {s.qs(), s.vs(), s.as()},
                                         [&](Index, Vec<double, n> const& x) { out.push_back(x); });
  };
  run(whole, 0, elements);
  for (Index const cut : {4, 8, 20}) {
    parts.clear();
    run(parts, 0, cut);
    run(parts, cut, elements);
    EXPECT_EQ(parts, whole) << cut;
  }
}

}  // namespace element_batches_test
