#pragma once
// Derivatives of multi-stage steps against finite differences of the same steps.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/solved_points.hpp>
#include <polybody/integrators/system_for.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

namespace polybody {

/// A model for given values of its parameters, with its initial state.
template <class M>
struct ModelAndStart {
  M model;
  State start;
};

/// Two links, the second transverse to the first, on pins that are not parallel. They rotate, and each velocity has
/// its own disturbance, so that soft links vibrate immediately. Parameters: Young's modulus, density, stiffness of
/// the pins, length of the second link, initial speed and angle.
template <class B, class Policy>
struct TwoLinks {
  static constexpr bool knows_frames = B::observes == MarkerKind::frame;
  using Pin = Joint<std::conditional_t<knows_frames, Revolute, Spherical>, Policy>;
  using M = Model<Bodies<B>, Joints<Pin>>;

  ModelAndStart<M> operator()(std::span<double const> p) const {
    M model{Gravity{0, 0, -9.81}};
    Bar bar{.length = 0.5,
            .section = Rectangle{.height = 0.02, .width = 0.03},
            .material = Material{.density = p[1], .young = p[0], .poisson = 0.3}};
    auto const first = model.add(body_of(bar), "first");
    bar.placement = Placement::at({0.5, 0, 0});
    bar.length = p[3];
    auto const second = model.add(body_of(bar), "second");
    model.connect(pin({0, 1, 0}, p[2]), model.ground().at({0, 0, 0}), first.at(0.0), "shoulder");
    model.connect(pin({0, 0.8, 0.6}, p[2]), first.at(0.5), second.at(0.0), "elbow");
    State start = model.reference_state();
    System const system(model, with<Capabilities::rigid_velocities>);
    VecX turn = start.v, next = start.q;
    system.operations().rigid_velocities(start.q, Vec3::Zero(), {0, 1, 0}, turn);
    system.plus(start.q, p[5] * turn, next);
    start.q = next;
    for (Index i = 0; i < turn.size(); ++i) start.v[i] = p[4] * turn[i] + 0.3 * std::sin(1.0 + 3.0 * double(i));
    return {std::move(model), start};
  }

 private:
  static B body_of(Bar const& bar) {
    if constexpr (requires { B::from(bar, 1); })
      return B::from(bar, 1);
    else
      return B::from(bar);
  }
  static Policy policy_of([[maybe_unused]] double stiffness) {
    if constexpr (std::is_same_v<Policy, Bushing>) {
      Bushing::Matrix const one = Bushing::Matrix::Identity();
      return Bushing{.stiffness = Bushing::Matrix(stiffness * one), .damping = Bushing::Matrix(1e-5 * stiffness * one)};
    } else if constexpr (std::is_same_v<Policy, Penalty>) {
      return Penalty{.stiffness = stiffness, .damping = 1e-4 * stiffness};
    } else {
      return Policy{};
    }
  }
  static Pin pin([[maybe_unused]] Vec3 const& axis, double stiffness) {
    Policy const policy = policy_of(stiffness);
    if constexpr (knows_frames)
      return Pin{Revolute{.axis = axis}, policy};
    else
      return Pin{Spherical{}, policy};
  }
};

/// A bar that a driving constraint rotates on two hinges of one axis, with five redundant constraints, and a rod that
/// hangs on its end. Parameters: density, length of the rod, amplitude and frequency of the drive.
struct DrivenDoor {
  struct Wave {
    double amplitude, frequency;  // [rad], [rad/s]
    Motion operator()(double t) const {
      double const s = amplitude * std::sin(frequency * t), c = amplitude * std::cos(frequency * t);
      return {s, frequency * c, -frequency * frequency * s};
    }
  };
  using Hinge = Joint<Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Wave>, Constraint>;
  using M = Model<Bodies<Rigid<>>, Joints<Hinge, Drive, Joint<Spherical, Constraint>>>;

  ModelAndStart<M> operator()(std::span<double const> p) const {
    M model{Gravity{0, 0, -9.81}};
    Bar bar{.length = 0.5,
            .section = Rectangle{.height = 0.02, .width = 0.03},
            .material = Material{.density = p[0], .young = 2e11, .poisson = 0.3}};
    auto const door = model.add(Rigid<>::from(bar), "door");
    bar.placement = Placement::at({0.5, 0, 0});
    bar.length = p[1];
    auto const rod = model.add(Rigid<>::from(bar), "rod");
    Hinge const hinge{Revolute{.axis = {0, 0, 1}}, Constraint{}};
    model.connect(hinge, model.ground().at({0, 0, 0.1}), door.at(0.0, 0.0, 0.1), "upper");
    model.connect(hinge, model.ground().at({0, 0, -0.1}), door.at(0.0, 0.0, -0.1), "lower");
    model.connect(Drive{PrescribedAngle<Wave>{.law = {p[2], p[3]}, .axis = {0, 0, 1}}, Constraint{}},
                  model.ground().at({0, 0, 0}), door.at(0.0), "drive");
    model.connect(Joint<Spherical, Constraint>{}, door.at(0.5), rod.at(0.0), "ball");
    State const start = model.reference_state();
    return {std::move(model), start};
  }
};
/// The parameters of `DrivenDoor`.
inline std::vector<Parameter> const parameters_of_door{
    {"density [kg/m³]", 2000.0, 600.0}, {"length [m]", 0.4, 0.1}, {"amplitude [rad]", 0.5}, {"frequency [rad/s]", 6.0}};

/// A mass on a spring and a damper along x, released 1 m from its equilibrium at 2 m. The stiffness and the damping
/// are the parameters.
struct DampedMass {
  using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>>;
  static constexpr double mass = 2.0;
  ModelAndStart<M> operator()(std::span<double const> p) const {
    M model;
    auto const body = model.add(planar::Rigid(mass, 1.0, Placement::at({3.0, 0, 0})), "mass");
    model.apply(SpringDamper{.stiffness = p[0], .damping = p[1], .free_length = 2.0}, model.ground().at({0, 0, 0}),
                body.at(Vec2(0, 0)), "spring");
    State const start = model.reference_state();
    return {std::move(model), start};
  }
  /// x(t) = 2 + e^(−δt) (cos ωt + δ/ω sin ωt).
  static double place(double k, double c, double t) {
    double const delta = 0.5 * c / mass, w = std::sqrt(k / mass - delta * delta);
    return 2.0 + std::exp(-delta * t) * (std::cos(w * t) + delta / w * std::sin(w * t));
  }
  /// ∂x/∂k and ∂x/∂c, by fourth-order differences of the closed form.
  static std::array<double, 2> derivatives(double k, double c, double t) {
    std::array<double, 2> out{};
    double const e = 1e-3;
    for (std::size_t i = 0; i < 4; ++i) {
      double const d = FourPoints::places[i] * e, by = FourPoints::weights[i] / e;
      out[0] += by * place(k + d, c, t);
      out[1] += by * place(k, c + d, t);
    }
    return out;
  }
};

/// Steps of `integrator` with a model for given values of the parameters. The object is not movable.
template <class Made, class I>
struct Steps {
  Made made;
  System system;
  I method;
  decltype(std::declval<I const&>().template workspace<DefaultSolver>(std::declval<System&>())) work;
  State x;
  PointEquations<> equations;

  Steps(Made m, I const& integrator, double h)
      : made(std::move(m)),
        system(system_for<I, Capabilities::implicit_step>(made.model)),
        method(integrator),
        work(method.template workspace<DefaultSolver>(system)),
        x(made.start) {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    method.start(system, x, h, work);
  }
  /// \returns true if the step covered the whole h
  bool step(double h) { return method.step(system, x, h, work).taken == h; }
};

/// The state after a step of h from x, with its own factorisations.
template <class S>
State stepped(S& full, State x, double h) {
  if constexpr (requires { full.work.reused_factorisation; }) full.work.reused_factorisation = {};
  EXPECT_EQ(full.method.step(full.system, x, h, full.work).taken, h);
  return x;
}

/// A run of steps of one length, with its derivatives by linearised steps and by finite differences of the run.
struct DerivedSteps {
  State end;
  std::vector<State> derivatives, differences;  // derivatives with respect to the parameters
  double left = 0.0;                            // error estimate from the last corrections of the steps
};

/// The increment of the differences.
inline double thousandth_of(Parameter const& p) { return 1e-3 * p.size(); }

template <class Slope, class Make, class I>
DerivedSteps derive_steps(Make const& make, std::vector<Parameter> const& parameters, I const& integrator, double h,
                          int count) {
  using S = Steps<decltype(make(std::span<double const>())), I>;
  std::vector<double> values;
  for (Parameter const& p : parameters) values.push_back(p.value);
  S full(make(values), integrator, h);
  std::vector<std::unique_ptr<S>> beside;  // four for each parameter
  for (std::size_t j = 0; j < parameters.size(); ++j)
    for (double const place : FourPoints::places) {
      std::vector<double> p = values;
      p[j] += place * thousandth_of(parameters[j]);
      beside.push_back(std::make_unique<S>(make(p), integrator, h));
    }
  auto const difference = [&](std::size_t j, auto&& part_of) {
    VecX sum = VecX::Zero(part_of(*beside[4 * j]).size());
    for (std::size_t k = 0; k < 4; ++k)
      sum += FourPoints::weights[k] / thousandth_of(parameters[j]) * part_of(*beside[4 * j + k]);
    return sum;
  };
  auto const differences = [&] {
    std::vector<State> out(parameters.size());
    for (std::size_t j = 0; j < out.size(); ++j)
      for (VecX State::* const part : {&State::q, &State::v, &State::a, &State::lambda})
        out[j].*part = difference(j, [&](S& s) -> VecX const& { return s.x.*part; });
    return out;
  };

  DerivedSteps out;
  out.derivatives = differences();
  Slope slope(full.made.model, full.system, full.method);
  for (int n = 0; n < count; ++n) {
    State const before = full.x;
    EXPECT_TRUE(full.step(h));
    StepTaken const step{before, full.x, h};
    slope.set(step);
    for (std::size_t first = 0; first < parameters.size(); first += Slope::max_directions) {
      std::vector<State*> directions;
      for (std::size_t j = first; j < std::min(first + Slope::max_directions, parameters.size()); ++j)
        directions.push_back(&out.derivatives[j]);
      out.left = std::max(out.left, slope.advance(step, directions, [&](EvaluationPoint<> const& x, std::size_t l) {
        std::size_t const j = first + l;
        for (std::size_t k = 0; k < 4; ++k) beside[4 * j + k]->equations.evaluate(beside[4 * j + k]->system, x);
        return EquationDerivative{difference(j, [](S& s) -> VecX const& { return s.equations.balance; }),
                                  difference(j, [](S& s) -> VecX const& { return s.equations.rows; }),
                                  parameters[j].size()};
      }));
    }
    for (auto& s : beside) EXPECT_TRUE(s->step(h));
  }
  out.end = full.x;
  out.differences = differences();
  return out;
}

/// Derivatives and differences agree within 1e-8, and within the accuracy of the differences. \param rounding
/// round-off of the velocities, accelerations and multipliers of a state over a thousandth. This round-off is large
/// because these values are sums of large forces. Differences divide by a thousandth of the size of the parameter.
/// Coordinates have 5e-12.
inline void expect_derivatives_of_steps(DerivedSteps const& run, std::vector<Parameter> const& parameters,
                                        double rounding) {
  EXPECT_LT(run.left, 1e-9);
  for (std::size_t j = 0; j < parameters.size(); ++j)
    for (auto const& [name, part, of_state] : {std::tuple{"q", &State::q, 5e-12},
                                               {"v", &State::v, rounding},
                                               {"a", &State::a, rounding},
                                               {"λ", &State::lambda, rounding}}) {
      VecX const &slope = run.derivatives[j].*part, &expected = run.differences[j].*part;
      double const off = (slope - expected).norm(), size = expected.norm(),
                   state = (run.end.*part).norm() / parameters[j].size();
      EXPECT_LE(off, 1e-8 * size + of_state * state) << parameters[j].name << ", " << name;
    }
}

/// The derivative of a step from x with respect to its length h, with functions that are smooth in time.
template <class Slope, class S>
State slope_by_length(S& full, Slope& slope, State const& x, double h) {
  State const after = stepped(full, x, h);
  StepTaken const step{x, after, h};
  State dx = x;
  for (VecX State::* const part : {&State::q, &State::v, &State::a, &State::lambda}) (dx.*part).setZero();
  std::vector<State*> const directions{&dx};
  double const later = 1.0, e = 1e-2 * h;
  slope.set(step);
  auto const by_time = [&](EvaluationPoint<> const& at, std::size_t) {
    EquationDerivative out{VecX::Zero(x.v.size()), VecX::Zero(x.lambda.size()), h};
    for (std::size_t k = 0; k < 4; ++k) {
      EvaluationPoint<> there = at;
      there.t += FourPoints::places[k] * e;
      full.equations.evaluate(full.system, there);
      double const by = (at.t - x.t) / h * FourPoints::weights[k] / e;
      out.balance += by * full.equations.balance;
      out.rows += by * full.equations.rows;
    }
    return out;
  };
  EXPECT_LT(slope.advance(step, directions, by_time, {&later, 1}), 1e-9);
  return dx;
}
/// The derivative with respect to the length of the third step equals that of differences of steps of nearby lengths.
/// The tolerance is 1e-8 relative, plus `rounding` of the state over the increment of the differences.
template <class Slope, class Make, class I>
void expect_derivatives_by_length(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                                  double h, double rounding) {
  std::vector<double> values;
  for (Parameter const& p : parameters) values.push_back(p.value);
  Steps<decltype(make(std::span<double const>())), I> full(make(values), integrator, h);
  for (int n = 0; n < 2; ++n) EXPECT_TRUE(full.step(h));
  State const x = full.x;
  Slope slope(full.made.model, full.system, full.method);
  State const dx = slope_by_length(full, slope, x, h);
  double const e = 2e-3 * h;
  std::vector<State> ends;
  for (double const place : FourPoints::places) ends.push_back(stepped(full, x, h + place * e));
  for (auto const& [name, part] : {std::pair{"q", &State::q}, std::pair{"v", &State::v}, std::pair{"a", &State::a},
                                   std::pair{"λ", &State::lambda}}) {
    VecX expected = VecX::Zero((x.*part).size());
    for (std::size_t k = 0; k < 4; ++k) expected += FourPoints::weights[k] / e * (ends[k].*part);
    EXPECT_LE((dx.*part - expected).norm(), 1e-8 * expected.norm() + rounding * (x.*part).norm() / e) << name;
  }
}

/// The error of (k ∂x/∂k, c ∂x/∂c) at t = 1 s with steps of one length.
template <class Slope, class I>
double error_of_derivatives(I const& integrator, int steps) {
  double const k = 50.0, c = 3.0;
  std::vector<Parameter> const parameters{{"k [N/m]", k}, {"c [N s/m]", c}};
  DerivedSteps const run = derive_steps<Slope>(DampedMass{}, parameters, integrator, 1.0 / steps, steps);
  auto const expected = DampedMass::derivatives(k, c, 1.0);
  return std::hypot(k * (run.derivatives[0].q[0] - expected[0]), c * (run.derivatives[1].q[0] - expected[1]));
}
/// Half the step leaves 2^−order of the error.
template <class Slope, class I>
void expect_order_of_derivatives(I const& integrator, int steps) {
  double const coarse = error_of_derivatives<Slope>(integrator, steps),
               fine = error_of_derivatives<Slope>(integrator, 2 * steps);
  EXPECT_NEAR(std::log2(coarse / fine), I::order, 0.2) << coarse << ", " << fine;
}

/// The parameters of `TwoLinks`, for pins of the given stiffness [N/m] and links of the given modulus [Pa]. The
/// scales of lengths and of parameters that affect frequencies are chosen such that fourth-order differences resolve
/// the phases.
inline std::vector<Parameter> parameters_of_links(double young, double stiffness) {
  return {{"young [Pa]", young, 0.3 * young},
          {"density [kg/m³]", 2000.0, 600.0},
          {"stiffness of pins [N/m]", stiffness, 0.3 * stiffness},
          {"length [m]", 0.4, 0.1},
          {"spin [rad/s]", 2.0, 20.0},
          {"turn [rad]", 0.1, 0.4}};
}

}  // namespace polybody
