#include <polybody/compare/equal_error.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/marker_frames.hpp>

#include "support/refusal.hpp"

namespace equal_error_test {

using namespace polybody;

// y_k = 1 + t + A(t) s^p with p = 2 and, for the first results, a term of fourth order.
std::vector<std::vector<double>> results(std::vector<double> const& sizes) {
  std::vector<std::vector<double>> out;
  for (double const s : sizes) {
    std::vector<double> y;
    for (double const t : {0.0, 0.5, 1.0}) y.push_back(1.0 + t + (0.3 - t) * s * s + 0.01 * s * s * s * s);
    out.push_back(y);
  }
  return out;
}

TEST(EqualError, ExtrapolationFindsOrderAndLimit) {
  std::vector<double> const sizes{0.4, 0.2, 0.1, 0.05};
  std::vector<std::vector<double>> const y = results(sizes);
  std::vector<std::vector<double> const*> views;
  for (auto const& one : y) views.push_back(&one);
  detail::Extrapolation const e = detail::extrapolate(views, sizes, 1e-14);
  ASSERT_TRUE(e.converges);
  EXPECT_NEAR(e.order, 2.0, 1e-3);
  for (std::size_t k = 0; k < 3; ++k) {
    double const t = 0.5 * double(k), error = std::abs(y.back()[k] + e.correction[k] - (1.0 + t));
    EXPECT_LT(error, e.error) << t;
    EXPECT_LT(error, 2e-6) << t;
  }
  // with unequal ratios of the sizes, and without the finest result
  std::vector<double> const uneven{0.4, 0.25, 0.1};
  std::vector<std::vector<double>> const three = results(uneven);
  detail::Extrapolation const coarse = detail::extrapolate({&three[0], &three[1], &three[2]}, uneven, 1e-14);
  EXPECT_NEAR(coarse.order, 2.0, 0.02);
  EXPECT_GE(coarse.error, 0.9 * 0.7 * 0.01);  // the correction itself, 0.7 s²
}

// Clamped beam of 1 m under a moment at its tip that grows slowly to a quarter turn. EI/(EA L²) = 1/1200.
constexpr double EI = 1.0, EA = 1200.0, moment = 0.5 * std::numbers::pi * EI;

struct Bending {
  double GA = 1e5, rotary_inertia = 1e-9, end_time = 24.0;

  template <class F>
  auto operator()(F const& f) const {
    using Clamp = Joint<planar::Weld, typename F::PolicyType>;
    using M = Model<Bodies<typename F::BodyType>, Joints<Clamp>, Forces<PointMoment<Ramp>>>;
    M model;
    auto const beam = model.add(
        f.body(Bar{
            .length = 1.0,
            .constants =
                BarConstants{.EA = EA, .EI = EI, .mass_per_length = 1.0, .GA = GA, .rotary_inertia = rotary_inertia},
            .damping = {.axial = 0.3, .shear = 0.0, .bending = 0.3}}),
        "beam");
    model.connect(Clamp{{}, f.policy}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
    model.apply(PointMoment<Ramp>{.moment = {0, 0, moment},
                                  .law = {.target = 1.0, .duration = 12.0, .start = 6.0, .rounding = 12.0}},
                beam.at(1.0), "moment");
    State const start = model.reference_state();
    auto const tip = beam.at(1.0);
    return Scenario<M>{std::move(model),
                       start,
                       {.end_time = end_time, .step = 0.1},
                       {{"tip x [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[0]; }}}};
  }
};

template <class B>
using Implicit = Formulation<B, Constraint, GeneralisedAlpha>;
using Lrvf = Implicit<planar::Lrvf>;
using Green = Implicit<planar::AncfCable<planar::GreenStrain>>;
using Engineering = Implicit<planar::AncfCable<planar::EngineeringStrain>>;

// Tip of the bent beam at rest: an arc with the stretch λ and the rotation θ′ per reference length.
double tip(double stretch, double rate) { return stretch / rate * std::sin(rate); }
// U = ½ EA ((λ² − 1)/2)² + ½ EI (θ′/λ)² − M θ′ is stationary at λ² = 1 + 2 M²/(EA EI), θ′ = M λ²/EI.
double green_tip() {
  double const squared = 1.0 + 2.0 * moment * moment / (EA * EI);
  return tip(std::sqrt(squared), moment * squared / EI);
}

TEST(EqualError, SeparatesModelDifferenceFromMeshError) {
  EqualErrorStudy study({.elements = {2, 4, 8, 16}, .steps = {0.2, 0.1, 0.05}, .errors = {1e-1, 1e-2}, .repeats = 1});
  study.add(Bending{}, Lrvf{"LRVF without shear"}, {.model = "rotations, no shear"});
  study.add(Bending{}, Green{"Green"}, {.model = "Green strain"});
  study.add(Bending{}, Engineering{"engineering"}, {.model = "engineering strain"});
  EqualErrorReport const r = study.run();
  ASSERT_EQ(r.references.size(), 3u);
  ASSERT_EQ(r.differences.size(), 3u);
  for (StudiedFormulation const& f : r.formulations) EXPECT_TRUE(f.remarks.empty()) << f.name << ": " << f.remarks[0];
  // Both have the same physical model: the difference is below its error bound.
  ModelDifference const& same = r.differences[1];  // LRVF and engineering strain
  EXPECT_FALSE(same.resolved()) << same.difference << " of " << same.error;
  EXPECT_LT(same.error, 1e-3);
  // Green strain stretches in pure bending: closed form at rest.
  ModelDifference const& other = r.differences[2];
  double const expected = std::abs(green_tip() - tip(1.0, moment / EI));
  EXPECT_TRUE(other.resolved());
  EXPECT_NEAR(other.difference, expected, 0.02 * expected);
  // The polygon of the LRVF converges with second order.
  EXPECT_NEAR(r.formulations[0].mesh_order, 2.0, 0.2);
  for (Ranking const& ranking : r.rankings) {
    EXPECT_EQ(ranking.ranked.size(), 3u);
    for (CheapestRun const& c : ranking.ranked) {
      StudyRun const& run = r.formulations[c.formulation].runs[c.run];
      EXPECT_LE(run.error, ranking.wanted * r.span);
      EXPECT_GT(run.unknowns, 0);
      EXPECT_GT(run.iterations, 0);
    }
  }
  EXPECT_GT(r.formulations[0].runs[r.rankings[1].ranked[0].run].mesh, 0);
  std::ostringstream text;
  text << r;
  EXPECT_TRUE(has(text.str(), "not resolved")) << text.str();
}

// The bent beam. The name of the formulation selects the fault of the output.
struct Flawed {
  template <class F>
  auto operator()(F const& f) const {
    auto scenario = Bending{.end_time = 1.0}(f);
    using M = decltype(scenario.model);
    std::string const name = f.name;
    double const elements = double(f.mesh.elements.value_or(0));
    auto const tip = scenario.outputs[0].value;
    scenario.outputs[0].value = [=](M const& m, State const& x) {
      double const y = tip(m, x) + std::sin(x.t);
      if (name == "fails") throw InvalidInput("test.failure", {ErrorObject{"gauge"}, " is broken."});
      if (name == "jumps") return x.t < 0.51 ? y : y + 1.0;
      // order 0.17 in the mesh: the finest result, with 8 elements, is 1.4 m from the limit at 1 s
      if (name == "slow") return y + 2.0 * x.t * (std::pow(elements, -0.17) - std::pow(8.0, -0.17));
      return name == "diverges" ? y + elements * x.t : y;
    };
    return scenario;
  }
};

// Results without an order have a limit if their changes are small compared with the span.
TEST(EqualError, BoundsSmallChangesWithoutAnOrder) {
  StudiedFormulation f;
  f.step_name = "step [s]";
  for (double const y : {1.0, 1.0001, 0.9999})
    f.runs.push_back({.step = 0.1 / double(f.runs.size() + 1), .y = {0.0, y}});
  StudiedFormulation coarse = f;
  EqualErrorReport r;
  r.output = "tip x [m]";
  r.span = 1.0;
  detail::find_limit(r, f);
  EXPECT_EQ(f.limit, f.runs.back().y);
  EXPECT_NEAR(f.limit_error, 3.0 * 2e-4, 1e-12);
  EXPECT_TRUE(std::isnan(f.step_order));
  EXPECT_TRUE(has(f.remarks.at(0), "three times the larger change"));
  r.span = 0.1;
  detail::find_limit(r, coarse);
  EXPECT_TRUE(coarse.limit.empty());
  EXPECT_TRUE(has(coarse.remarks.at(0), "no reference: the output does not converge with the steps"));
}

TEST(EqualError, KeepsTheOtherResultsIfAFormulationFails) {
  EqualErrorStudy study({.elements = {2, 4, 8}, .steps = {0.05, 0.025, 0.0125}, .errors = {1e-2}, .repeats = 1});
  for (char const* name : {"fails", "diverges", "jumps", "sound", "slow"})
    study.add(Flawed{}, Engineering{name}, {.model = name});
  EqualErrorReport const r = study.run();
  ASSERT_EQ(r.references.size(), 1u);
  EXPECT_EQ(r.references[0].model, "sound");
  EXPECT_TRUE(has(r.formulations[0].remarks.at(0), "gauge is broken"));
  EXPECT_TRUE(has(r.formulations[1].remarks.at(0), "does not converge with the meshes. It changes by 4 m between"));
  EXPECT_TRUE(has(r.formulations[2].remarks.at(0), "is not smooth"));
  EXPECT_TRUE(has(r.formulations[2].remarks.at(0), " m, but the smallest wanted error is 0.0"));
  EXPECT_TRUE(std::isnan(r.formulations[4].limit_error));
  std::string const slow = r.formulations[4].remarks.at(0);
  EXPECT_TRUE(has(slow,
                  "the output \"tip x [m]\" of \"slow\" does not converge. The error bound of its limit, 1.4 m, "
                  "exceeds the span, 0.84"))
      << slow;
  EXPECT_TRUE(has(slow, " m. The observed order is 0.17 in the mesh and ")) << slow;
  ASSERT_EQ(r.rankings[0].ranked.size(), 1u);
  EXPECT_EQ(r.rankings[0].ranked[0].formulation, 3u);
  EXPECT_EQ(r.rankings[0].missing.size(), 4u);
}

// If each formulation fails, the report has the reasons and no ranking.
TEST(EqualError, ReportsReasonsIfAllFormulationsFail) {
  EqualErrorStudy study({.elements = {2, 4, 8}, .steps = {0.05, 0.025, 0.0125}, .repeats = 1});
  study.add(Flawed{}, Engineering{"fails"}, {.model = "fails"});
  EqualErrorReport const r = study.run();
  EXPECT_TRUE(r.rankings.empty());
  std::ostringstream text;
  text << r;
  EXPECT_TRUE(has(text.str(), "No run with the finest mesh and the shortest step is complete."));
  EXPECT_TRUE(has(text.str(), "gauge is broken"));
}

// Speed and acceleration of the output jump at a breakpoint of the load. Cubics do not cross it.
TEST(EqualError, InterpolationDoesNotCrossBreakpoints) {
  OutputHistory y;
  y.breakpoints = {0.35};
  for (double const t : {0.0, 0.1, 0.2, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8}) {
    y.times.push_back(t);
    y.values.push_back(t < 0.35 ? t * t : 0.1225 - 3.0 * (t - 0.35) + std::pow(t - 0.35, 3));
  }
  for (double const t : {0.05, 0.29, 0.34}) EXPECT_NEAR(y(t), t * t, 1e-14) << t;
  EXPECT_NEAR(y(0.35), 0.1225, 1e-14);
  for (double const t : {0.36, 0.45, 0.77}) EXPECT_NEAR(y(t), 0.1225 - 3.0 * (t - 0.35) + std::pow(t - 0.35, 3), 1e-14);
  // no state between two breakpoints
  y.breakpoints = {0.35, 0.42, 0.48};
  EXPECT_NEAR(y(0.45), -0.175, 0.02);
}

TEST(EqualError, RefusesSettingsFromWhichNoOrderFollows) {
  auto const add = [](EqualErrorOptions options) {
    return refusal([&] { EqualErrorStudy(options).add(Bending{}, Engineering{"cable"}, {.model = "cable"}); });
  };
  EXPECT_TRUE(has(add({.elements = {4, 8}, .steps = {0.2, 0.1, 0.05}}),
                  "cable: the list of elements needs at least three entries to observe an order, but has 2"));
  EXPECT_TRUE(has(add({.elements = {4, 8, 8}, .steps = {0.2, 0.1, 0.05}}),
                  "must be positive and ascending, but entry 2, counted from 0, is 8"));
  EXPECT_TRUE(has(add({.elements = {4, 8, 16}, .steps = {0.1, 0.2, 0.05}}),
                  "must be positive and descending, but entry 1, counted from 0, is 0.2"));
  EXPECT_TRUE(has(refusal([] { EqualErrorStudy({}).run(); }), "there are no formulations"));
  EXPECT_TRUE(has(refusal([] { EqualErrorStudy({.errors = {0.0}}); }), "a wanted error must be positive"));
}

// The output of the rigid body is constant. The span of the elastic beam makes its errors relative.
TEST(EqualError, AcceptsAConstantOutputBesideOthers) {
  EqualErrorStudy study({.elements = {2, 4, 8}, .steps = {0.05, 0.025, 0.0125}, .errors = {1e-1}, .repeats = 1});
  study.add(Bending{.end_time = 8.0}, Implicit<planar::Rigid>{"rigid"}, {.model = "rigid"});
  study.add(Bending{.end_time = 8.0}, Engineering{"cable"}, {.model = "cable"});
  EqualErrorReport const r = study.run();
  EXPECT_TRUE(r.formulations[0].remarks.empty()) << r.formulations[0].remarks.at(0);
  ASSERT_EQ(r.differences.size(), 1u);
  EXPECT_TRUE(r.differences[0].resolved());
  EXPECT_EQ(r.rankings[0].ranked.size(), 2u);
}

// A rigid body has no mesh. Here it does not move, so relative errors are undefined.
TEST(EqualError, RefusesAConstantOutput) {
  using RigidBody = Implicit<planar::Rigid>;
  static_assert(!RigidBody::has_mesh && Engineering::has_mesh && !Engineering::has_modes);
  EqualErrorStudy study({.steps = {0.1, 0.05, 0.025}, .repeats = 1});
  study.add(Bending{.end_time = 1.0}, RigidBody{"rigid"}, {.model = "rigid"});
  EXPECT_TRUE(has(refusal([&] { study.run(); }), "\"tip x [m]\" is constant"));
  EqualErrorReport zero;
  zero.output = "lag [m]";
  zero.formulations.emplace_back().runs.emplace_back().y = {0.0, 0.0};
  EXPECT_TRUE(has(refusal([&] { detail::find_span(zero, [](auto const&) { return true; }); }), "\"lag [m]\" is const"));
}

}  // namespace equal_error_test
