// Composite box beam with a printed 6×6 stiffness: extension couples with twist, and bending with shear. The tip of a
// cantilever under each load follows in closed form from the compliance of the section.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_coupled_line.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/bodies/shared/family.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

#include <gtest/gtest.h>

#include "support/held.hpp"
#include "support/measured_sections.hpp"

using namespace polybody;

namespace composite_box_beam_test {

/// Flexibility (6×6) of the tip of a cantilever of length l with the compliance S. The section forces at the distance a
/// from the tip are T(a) f, T = 1 + a E, so that ∫ TᵀST da = l S + ½ l² (EᵀS + S E) + ⅓ l³ EᵀS E.
Mat<double, 6, 6> tip_flexibility(Section6 const& section, double l) {
  Mat<double, 6, 6> const s = section.stiffness.inverse();
  Mat<double, 6, 6> e = Mat<double, 6, 6>::Zero();
  e(4, 2) = -1.0;  // M_y from Q_z
  e(5, 1) = 1.0;   // M_z from Q_y
  return l * s + 0.5 * l * l * (e.transpose() * s + s * e) + l * l * l / 3.0 * (e.transpose() * s * e);
}

template <class B>
class CompositeBoxBeam : public testing::Test {};
using LinearBodies = testing::Types<Se3Beam, Lrvf<>, AncfBeam<CoupledLine>, Ffr>;
TYPED_TEST_SUITE(CompositeBoxBeam, LinearBodies);

// Loads so small that third-order terms, about (w/l)², are below 1e-9. Two meshes are extrapolated, because the error
// of elements with constant strains is exactly proportional to l² under linear moments. In the ANCF beam r₀′ is
// continuous and the curvature is constant in an element, so that a coupling of both adds an error of higher order.
TYPED_TEST(CompositeBoxBeam, TipUnderEachLoad) {
  double const l = 30.0;
  struct {
    Section6 section;
    char const* where;
  } const rows[] = {{box_beam(), "axis in the box"},
                    {box_beam().placed(0.3, -0.2, 0.5), "axis beside the box, turned"}};
  for (auto const& [section, where] : rows) {
    Mat<double, 6, 6> const exact = tip_flexibility(section, l);
    auto const tip = [&](Index elements, int load) {
      double const size = load < 3 ? 1e-3 : 1e-2;
      Vec6 screw = Vec6::Zero();
      for (double const sign : {1.0, -1.0}) {  // the difference has no terms of even order
        Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>, Forces<PointForce<>, PointMoment<>>> model;
        auto const arm = model.add(TypeParam::from({.length = l, .section = section}, elements), "arm");
        model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), arm.at(0.0), "clamp");
        Vec3 const unit = sign * size * Vec3::Unit(load % 3);
        if (load < 3)
          model.apply(PointForce<>{.force = unit}, arm.at(l), "force");
        else
          model.apply(PointMoment<>{.moment = unit}, arm.at(l), "moment");
        State x = model.reference_state();
        equilibrium(model, x);
        Frame<double> const end = frame(model, x, arm.at(l));
        screw.head<3>() += sign / (2.0 * size) * (end.r - Vec3(l, 0, 0));
        screw.tail<3>() += sign / (2.0 * size) * log_so3<double>(end.A);
      }
      return screw;
    };
    bool const ancf = std::same_as<TypeParam, AncfBeam<CoupledLine>>;
    Index const n = ancf ? 16 : 4;
    for (int load = 0; load < 6; ++load) {
      Vec6 const found = (4.0 * tip(2 * n, load) - tip(n, load)) / 3.0;
      for (int i = 0; i < 6; ++i) {
        double const scale = std::sqrt(exact(i, i) * exact(load, load));
        held({"composite box beam", "flexibility of the tip [in/lb], [1/lb], [1/(lb in)]", By::closed_form,
              "∫ TᵀST da with the compliance S of Yu, Hodges & Ho 2012",
              std::string(formulation_family<TypeParam>) + ", " + std::to_string(n) + " and " + std::to_string(2 * n) +
                  " elements, extrapolated"},
             found[i], exact(i, load), (ancf ? 5e-4 : 1e-6) * scale,
             {"entry (" + std::to_string(i + 1) + ", " + std::to_string(load + 1) + "), " + where, scale});
      }
    }
  }
}

// An axial force twists the box, and a lateral force bends it in both planes. The two-node element of a floating frame
// is exact with one element.
TEST(CompositeBoxBeam, OneElementOfAFloatingFrameIsExact) {
  double const l = 30.0;
  Section6 const section = box_beam().placed(0.3, -0.2, 0.5);
  Mat<double, 6, 6> const
      exact = tip_flexibility(section, l),
      found = MatX(structure_of({.length = l, .section = section}, 1).stiffness).bottomRightCorner(6, 6).inverse();
  EXPECT_LT((found - exact).norm(), 1e-9 * exact.norm());
}

}  // namespace composite_box_beam_test
