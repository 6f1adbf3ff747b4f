// Mooring line with a part on the sea bed, compared with the catenary with a grounded part.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/shared/catenary.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

#include <gtest/gtest.h>

namespace polybody {
namespace mooring_line_test {

/// Anchor at (0, 0) on a smooth bed z = 0, fairlead at (x, z); w the weight per length in water.
struct Line {
  double length, w, EA, x, z;
};
/// Force on the fairlead, grounded length and abscissa of the touch-down.
struct Hang {
  double H, V, grounded, touch_down;
};

/// The part on the bed has the tension H. The suspended part has the length V/w and begins horizontally:
///   z = (√(H² + V²) − H)/w + V²/(2 w EA),  x = (L − V/w) + H/w asinh(V/H) + H L/EA [Jonkman 2007, §2.5].
Hang closed_form(Line const& c) {
  double low = 1e-3 * c.w * c.length, high = 1e2 * c.w * c.length;
  Hang out{};
  for (int k = 0; k < 200; ++k) {
    out.H = 0.5 * (low + high);
    double bottom = 0.0, top = c.w * c.length;  // V from z
    for (int i = 0; i < 200; ++i) {
      out.V = 0.5 * (bottom + top);
      double const z = (std::hypot(out.H, out.V) - out.H) / c.w + 0.5 * out.V * out.V / (c.w * c.EA);
      (z > c.z ? top : bottom) = out.V;
    }
    out.grounded = c.length - out.V / c.w;
    double const x = out.grounded + out.H / c.w * std::asinh(out.V / out.H) + out.H * c.length / c.EA;
    (x > c.x ? high : low) = out.H;
  }
  out.touch_down = out.grounded * (1.0 + out.H / c.EA);
  return out;
}

Line const small{100.0, 50.0, 1e6, 85.0, 30.0}, spar{902.2, 698.094, 384.243e6, 848.67, 250.0};

// The published numbers of both lines are those of the closed form.
TEST(MooringLine, ClosedFormGivesThePublishedNumbers) {
  Hang const a = closed_form(small), b = closed_form(spar);
  EXPECT_NEAR(a.H, 885.0560, 1e-4);
  EXPECT_NEAR(a.V, 2212.1263, 1e-4);
  EXPECT_NEAR(a.grounded, 55.75747, 1e-5);
  EXPECT_NEAR(a.touch_down, 55.80682, 1e-5);
  EXPECT_NEAR(b.H, 736938.0, 1.0);
  EXPECT_NEAR(b.V, 535727.0, 1.0);
  EXPECT_NEAR(b.grounded, 134.7855, 1e-4);
}

enum class Start { straight, catenary };

/// 40 elements. Nodes rest on springs of the bed, which deflect by 1 mm under the weight of an element.
template <class Cable>
void expect_published(Line const& c, Start start) {
  using Ball = Joint<Spherical, Constraint>;
  using Touch = Contact<SphereOnPlane>;
  Index const n = 40;
  Vec3 const fairlead(c.x, 0.0, c.z);
  Model<Bodies<Cable>, Joints<Ball>, Forces<Touch>> model{Gravity{0, 0, -9.81}};
  Bar const bar{.length = c.length, .constants = BarConstants{.EA = c.EA, .EI = 1.0, .mass_per_length = c.w / 9.81}};
  auto const line = model.add(
      start == Start::straight ? Cable::from(bar, n) : Cable::from(bar, n, catenary(fairlead, c.length, {0, 0, -1})),
      "line");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), line.at(0.0), "anchor");
  auto const far = model.connect(Ball{}, model.ground().at(fairlead), line.at(c.length), "fairlead");
  double const radius = 1e-3, element = c.length / double(n);
  Touch const bed{.geometry = {.radius = radius}, .normal = {.stiffness = c.w * element / 1e-3, .damping = 0.0}};
  for (Index i = 0; i <= n; ++i)
    model.apply(bed, line.at(c.length * double(i) / double(n)), model.ground().at({0, 0, -radius}));
  State x = model.reference_state();
  EquilibriumReport const report = equilibrium(model, x);
  EXPECT_EQ(report.negative_pivots, 0);
  Hang const exact = closed_form(c);
  Vec3 const f = reaction(model, x, far).f;
  EXPECT_NEAR(f[0], exact.H, 5e-3 * exact.H) << int(start);
  EXPECT_NEAR(f[2], exact.V, 5e-3 * exact.V) << int(start);
  EXPECT_NEAR(f[1], 0.0, 1e-6 * exact.H);
  // height h above the bed at the distance d after the touch-down: h = a (cosh(d/a) − 1), a = H/w
  double s = exact.grounded;
  while (position(model, x, line.at(s))[2] < 0.02 * c.z) s += 1e-3 * element;
  Vec3 const above = position(model, x, line.at(s));
  double const a = exact.H / c.w;
  EXPECT_NEAR(above[0] - a * std::acosh(1.0 + above[2] / a), exact.touch_down, 0.2 * c.length / 100.0) << int(start);
}

TEST(MooringLine, LiesAndHangsAsTheCatenary) {
  for (Line const& line : {small, spar})
    for (Start const start : {Start::straight, Start::catenary}) {
      expect_published<AncfCable<EngineeringStrain>>(line, start);
      expect_published<AncfCable<GreenStrain>>(line, start);
    }
}

// Points at 80 m and 60 m of the small line.
TEST(MooringLine, PointsOfTheClosedFormAreThePublishedOnes) {
  Hang const c = closed_form(small);
  for (auto const& [s, x, z] : {std::tuple{80.0, 75.65625, 12.33073}, std::tuple{60.0, 60.01350, 0.50177}}) {
    double const v = small.w * (s - c.grounded), a = c.H / small.w;
    EXPECT_NEAR(c.grounded + a * std::asinh(v / c.H) + c.H * s / small.EA, x, 1e-5);
    EXPECT_NEAR((std::hypot(c.H, v) - c.H) / small.w + 0.5 * v * v / (small.w * small.EA), z, 1e-5);
  }
}

}  // namespace mooring_line_test
}  // namespace polybody
