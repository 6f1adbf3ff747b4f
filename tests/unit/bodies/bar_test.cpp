#include <polybody/bodies/shared/bar.hpp>

#include <gtest/gtest.h>

#include <functional>

#include "support/refusal.hpp"

using namespace polybody;

namespace bar_test {

double const pi = std::numbers::pi;
double const nan_ = std::numeric_limits<double>::quiet_NaN();
double const infinity = std::numeric_limits<double>::infinity();

Bar circular() {
  return {.length = 2.0,
          .section = Circle{.radius = 0.01},
          .material = Material{.density = 7800, .young = 2.1e11, .poisson = 0.3}};
}
Bar rectangular(double height, double width) {
  return {.length = 2.0,
          .section = Rectangle{.height = height, .width = width},
          .material = Material{.density = 7800, .young = 2.1e11, .poisson = 0.25}};
}
Bar given() { return {.length = 10.0, .constants = BarConstants{.EA = 2.8e7, .EI = 1.4e4, .mass_per_length = 1.2}}; }

/// J = GJ/G of a rectangle.
double torsion_constant(double height, double width) {
  return constants(rectangular(height, width)).GJ / (2.1e11 / 2.5);
}

// Physical constants have no default.
static_assert(!std::is_default_constructible_v<Bar>);
static_assert(!std::is_default_constructible_v<Circle>);
static_assert(!std::is_default_constructible_v<Rectangle>);
static_assert(!std::is_default_constructible_v<Material>);
static_assert(!std::is_default_constructible_v<BarConstants>);

TEST(Bar, CircleHasTheConstantsOfATextbook) {
  BarConstants const c = constants(circular());
  double const r = 0.01, area = pi * r * r, inertia = pi * r * r * r * r / 4.0, g = 2.1e11 / 2.6;
  EXPECT_DOUBLE_EQ(c.EA, 2.1e11 * area);
  EXPECT_DOUBLE_EQ(c.EI, 2.1e11 * inertia);
  EXPECT_DOUBLE_EQ(c.EI_y.value(), 2.1e11 * inertia);
  EXPECT_DOUBLE_EQ(c.GJ, g * 2.0 * inertia);
  EXPECT_DOUBLE_EQ(c.mass_per_length, 7800 * area);
  EXPECT_DOUBLE_EQ(c.rotary_inertia, 7800 * inertia);
  EXPECT_DOUBLE_EQ(c.rotary_inertia_y.value(), 7800 * inertia);
}

// Shear coefficients at ν = 0.3: circle 0.886, rectangle at ν = 0.25: 0.8474  [Cowper 1966, Table 1].
TEST(Bar, ShearCoefficientsAreThoseOfCowper) {
  EXPECT_NEAR(constants(circular()).GA / (2.1e11 / 2.6 * pi * 1e-4), 7.8 / 8.8, 1e-14);
  BarConstants const c = constants(rectangular(0.03, 0.02));
  EXPECT_NEAR(c.GA / (2.1e11 / 2.5 * 6e-4), 12.5 / 14.75, 1e-14);
  EXPECT_DOUBLE_EQ(c.GA_z.value(), c.GA);
}

// `height` is the dimension along y. It enters EI about z, the bending stiffness of the plane, with its third power.
TEST(Bar, RectangleBendsAboutZOverItsHeight) {
  double const h = 0.03, w = 0.02;
  BarConstants const c = constants(rectangular(h, w));
  EXPECT_DOUBLE_EQ(c.EA, 2.1e11 * h * w);
  EXPECT_DOUBLE_EQ(c.EI, 2.1e11 * w * h * h * h / 12.0);
  EXPECT_DOUBLE_EQ(c.EI_y.value(), 2.1e11 * h * w * w * w / 12.0);
  EXPECT_DOUBLE_EQ(c.mass_per_length, 7800 * h * w);
  EXPECT_DOUBLE_EQ(c.rotary_inertia, 7800 * w * h * h * h / 12.0);
  EXPECT_DOUBLE_EQ(c.rotary_inertia_y.value(), 7800 * h * w * w * w / 12.0);
}

// Torsion constant 0.1406 a⁴ of a square, and 0.229 (sides 2 : 1) and 0.312 (10 : 1) times a b³  [Timoshenko &
// Goodier 1970, §109, Table]; further digits from the series.
TEST(Bar, RectangleTwistsAsSaintVenantSays) {
  EXPECT_NEAR(torsion_constant(1.0, 1.0), 0.1405770, 1e-7);
  EXPECT_NEAR(torsion_constant(2.0, 1.0) / 2.0, 0.2287, 5e-5);
  EXPECT_NEAR(torsion_constant(10.0, 1.0) / 10.0, 0.3123, 5e-5);
  EXPECT_DOUBLE_EQ(torsion_constant(2.0, 1.0), torsion_constant(1.0, 2.0));  // independent of the order of the sides
  double const b = 100.0, t = 1.0;                                           // a thin strip: b t³/3 (1 − 0.630 t/b)
  EXPECT_NEAR(torsion_constant(b, t), b * t * t * t / 3.0 * (1.0 - 0.630248 * t / b), 1e-5);
}

TEST(Bar, GivenConstantsPassThrough) {
  Bar bar = given();
  bar.constants->GA = 1e7;
  bar.constants->GJ = 3e3;
  bar.constants->rotary_inertia = 6e-4;
  bar.constants->EI_y = 5.0;
  BarConstants const c = constants(bar);
  EXPECT_EQ(c.EA, 2.8e7);
  EXPECT_EQ(c.EI, 1.4e4);
  EXPECT_EQ(c.mass_per_length, 1.2);
  EXPECT_EQ(c.GA, 1e7);
  EXPECT_EQ(c.GJ, 3e3);
  EXPECT_EQ(c.rotary_inertia, 6e-4);
  EXPECT_EQ(c.EI_y, 5.0);
  EXPECT_FALSE(c.GA_z.has_value());
}

// Each number outside its range is refused, and the message names it.
struct BadBar {
  char const* quantity;
  std::function<Bar(double)> make;
  bool zero_allowed = false;
};

std::vector<BadBar> const bad_bars = {
    {"length",
     [](double x) {
       Bar b = circular();
       b.length = x;
       return b;
     }},
    {"circle's radius",
     [](double x) {
       Bar b = circular();
       b.section = Circle{.radius = x};
       return b;
     }},
    {"rectangle's height", [](double x) { return rectangular(x, 0.02); }},
    {"rectangle's width", [](double x) { return rectangular(0.03, x); }},
    {"density",
     [](double x) {
       Bar b = circular();
       b.material->density = x;
       return b;
     }},
    {"Young's modulus",
     [](double x) {
       Bar b = circular();
       b.material->young = x;
       return b;
     }},
    {"EA",
     [](double x) {
       Bar b = given();
       b.constants->EA = x;
       return b;
     }},
    {"EI",
     [](double x) {
       Bar b = given();
       b.constants->EI = x;
       return b;
     }},
    {"mass per length",
     [](double x) {
       Bar b = given();
       b.constants->mass_per_length = x;
       return b;
     }},
    {"GA",
     [](double x) {
       Bar b = given();
       b.constants->GA = x;
       return b;
     },
     true},
    {"GJ",
     [](double x) {
       Bar b = given();
       b.constants->GJ = x;
       return b;
     },
     true},
    {"rotary inertia",
     [](double x) {
       Bar b = given();
       b.constants->rotary_inertia = x;
       return b;
     },
     true},
    {"EI_y",
     [](double x) {
       Bar b = given();
       b.constants->EI_y = x;
       return b;
     },
     true},
    {"GA_z",
     [](double x) {
       Bar b = given();
       b.constants->GA_z = x;
       return b;
     },
     true},
    {"rotary_inertia_y",
     [](double x) {
       Bar b = given();
       b.constants->rotary_inertia_y = x;
       return b;
     },
     true},
    {"axial damping",
     [](double x) {
       Bar b = given();
       b.damping.axial = x;
       return b;
     },
     true},
    {"shear damping",
     [](double x) {
       Bar b = given();
       b.damping.shear = x;
       return b;
     },
     true},
    {"bending damping",
     [](double x) {
       Bar b = given();
       b.damping.bending = x;
       return b;
     },
     true},
};

TEST(Bar, RefusesNumbersThatCannotBeMeant) {
  for (BadBar const& bad : bad_bars) {
    EXPECT_NO_THROW((void)constants(bad.make(0.5))) << bad.quantity;
    for (double const x : {-0.01, nan_, infinity, -infinity})
      EXPECT_TRUE(has(refusal([&] { (void)constants(bad.make(x)); }), bad.quantity)) << x;
  }
}

TEST(Bar, ZeroIsRefusedWhereNothingWouldBeLeft) {
  for (BadBar const& bad : bad_bars) {
    if (bad.zero_allowed)
      EXPECT_NO_THROW((void)constants(bad.make(0.0))) << bad.quantity;
    else
      EXPECT_TRUE(has(refusal([&] { (void)constants(bad.make(0.0)); }), bad.quantity));
  }
}

TEST(Bar, RefusesPoissonsRatioOutOfRange) {
  auto const with = [](double nu) {
    Bar bar = circular();
    bar.material->poisson = nu;
    return bar;
  };
  for (double const nu : {-0.999, 0.0, 0.5}) EXPECT_NO_THROW((void)constants(with(nu))) << nu;
  for (double const nu : {-1.0, -1.5, 0.51, nan_, infinity})
    EXPECT_TRUE(has(refusal([&] { (void)constants(with(nu)); }), "Poisson's ratio")) << nu;
}

TEST(Bar, WantsEitherASectionWithMaterialOrConstants) {
  Bar const section_alone{.length = 1.0, .section = Circle{.radius = 0.1}};
  Bar const material_alone{.length = 1.0, .material = Material{.density = 1, .young = 1}};
  Bar const nothing{.length = 1.0};
  Bar both = circular(), constants_and_material = given(), constants_and_section = given();
  both.constants = given().constants;
  constants_and_material.material = circular().material;
  constants_and_section.section = circular().section;
  for (Bar const& bar : {section_alone, material_alone, nothing, both, constants_and_material, constants_and_section})
    EXPECT_TRUE(has(refusal([&] { (void)constants(bar); }),
                    "either a shape with a material, or matrices (Section6), or constants"));
}

TEST(Bar, RefusesAPlacementThatIsNone) {
  Bar bar = given();
  bar.placement.axes(0, 0) = 2.0;
  EXPECT_TRUE(has(refusal([&] { (void)constants(bar); }), "orthonormal"));
  bar = given();
  bar.placement.axes.col(1) *= -1.0;
  EXPECT_TRUE(has(refusal([&] { (void)constants(bar); }), "right-handed"));
  bar = given();
  bar.placement.origin.y() = nan_;
  EXPECT_TRUE(has(refusal([&] { (void)constants(bar); }), "origin"));
}

TEST(Bar, InsideForgivesRoundingAndClamps) {
  EXPECT_EQ(require_inside(0.7, 2.0, "rod"), 0.7);
  EXPECT_EQ(require_inside(-1e-13, 2.0, "rod"), 0.0);
  EXPECT_EQ(require_inside(2.0 + 1e-13, 2.0, "rod"), 2.0);
  for (double const s : {-1e-9, 2.0 + 1e-9, nan_, infinity})
    EXPECT_TRUE(has(refusal([&] { (void)require_inside(s, 2.0, "rod"); }), "rod: s = ")) << s;
}

}  // namespace bar_test
