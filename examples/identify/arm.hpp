#pragma once
// Flexible arm on a rubber mount that permits translation and rotation, released under its weight. Stiffness and
// damping of the mount are identified from the motion of the tip, under any formulation of the arm.

#include <ctime>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/polybody.hpp>
#include <random>

#include "../support/least_squares.hpp"

namespace identify {

using namespace polybody;

// Unknown parameters of the mount: translation along x and y, and rotation about z.
inline std::array<char const*, 4> constexpr names{"k [N/m]", "c [N s/m]", "k_t [N m/rad]", "c_t [N m s/rad]"};
using Numbers = std::array<double, 4>;

// A strip of steel, horizontal at the start.
inline Bar strip() {
  return {.length = 1.0,
          .section = Rectangle{.height = 0.005, .width = 0.03},
          .material = Material{.density = 7850.0, .young = 2.1e11, .poisson = 0.3},
          .damping = {.axial = 1e-4, .shear = 1e-4, .bending = 1e-3}};
}

struct Experiment {
  double end_time = 1.5, step = 2e-3;  // end time and step of the fitted runs [s]
  double sampling = 1e-2;              // sampling interval of the record, a multiple of the step [s]
};

// Scenario of the arm as a body B with `elements` elements, for the parameters p of the mount.
template <class B>
struct Arm {
  Experiment experiment;
  Index elements = 1;

  auto operator()(std::span<double const> p) const {
    using Mount = Joint<planar::Weld, Bushing>;
    using M = Model<Bodies<B>, Joints<Mount>>;
    M model{Gravity{0, -9.81, 0}};
    Bar const bar = strip();
    auto const arm = model.add(B::from(bar, {.elements = elements}), "arm");
    Vec3 const slides(p[0], p[0], 0.0), slows(p[1], p[1], 0.0), turns(0.0, 0.0, p[2]), brakes(0.0, 0.0, p[3]);
    model.connect(Mount{{}, {Bushing::diagonal(slides, turns), Bushing::diagonal(slows, brakes)}},
                  model.ground().at({0, 0, 0}), arm.at(0.0), "mount");
    State const start = model.reference_state();
    auto const tip = [arm, l = double(bar.length)](int axis) {
      return [arm, l, axis](M const& m, State const& x) { return position(m, x, arm.at(l))[axis]; };
    };
    std::vector<Output<M>> outputs{{"tip x [m]", tip(0)}, {"tip y [m]", tip(1)}};
    return Scenario<M>{
        std::move(model), start, {.end_time = experiment.end_time, .step = experiment.step}, std::move(outputs)};
  }
};

// Coordinates of the tip at the multiples of the sampling interval [m]: x, y, x, y, ….
template <class Make, class I>
VecX tip_of(Make const& make, std::span<double const> p, I const& integrator) {
  auto scenario = make(p);
  State x = scenario.start;
  std::vector<double> tip;
  auto const every = std::size_t(std::lround(make.experiment.sampling / scenario.options.step));
  std::size_t step = 0;
  for (State const& now : simulate(scenario.model, x, integrator, scenario.options)) {
    if (step > 0 && step % every == 0)
      for (auto const& o : scenario.outputs) tip.push_back(o.value(scenario.model, now));
    ++step;
  }
  return Eigen::Map<VecX const>(tip.data(), Index(tip.size()));
}

// The relative discretisation error of a smooth motion is about 1e-5. The tolerance of Newton's method is much smaller,
// so that its error does not affect differences of runs.
inline GeneralisedAlpha const method{.rho_inf = 0.9, .tolerance = 1e-12, .start_correction = false};

// Derivatives of `tip_of` with respect to the parameters. The rows are in the order of `tip_of`.
template <class Make>
MatX derivatives_of_tip(Make const& make, std::span<double const> p) {
  std::vector<Parameter> parameters;
  for (std::size_t j = 0; j < names.size(); ++j) parameters.push_back({names[j], p[j]});
  SensitivityResult const s = sensitivities(make, parameters, method);
  auto const every = std::size_t(std::lround(make.experiment.sampling / make.experiment.step));
  MatX out(Index(2 * ((s.times.size() - 1) / every)), Index(names.size()));
  for (std::size_t k = every, row = 0; k < s.times.size(); k += every, row += 2)
    out.middleRows<2>(Index(row)) = s.derivatives[k];
  return out;
}

// A formulation of the arm with erased type.
struct Candidate {
  std::string name{};
  std::function<VecX(std::span<double const>)> tip;
  std::function<MatX(std::span<double const>)> derivatives;
};
template <class B>
Candidate candidate(std::string name, Experiment const& experiment, Index elements = 1) {
  Arm<B> const arm{experiment, elements};
  return {std::move(name), [arm](std::span<double const> p) { return tip_of(arm, p, method); },
          [arm](std::span<double const> p) { return derivatives_of_tip(arm, p); }};
}

// Record of the experiment without noise: a formulation that is not among the fitted ones (engineering strain, 16
// elements), with an integrator of order five.
inline VecX exact_record(Experiment experiment, Numbers const& truth) {
  experiment.step = 1e-3;
  return tip_of(Arm<planar::AncfCable<EngineeringStrain>>{experiment, 16}, truth, Radau{});
}
// Adds Gaussian noise with this standard `deviation` [m] by the formula of Box and Muller. The random numbers are the
// same on every machine.
inline VecX with_noise(VecX record, double deviation, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  auto const uniform = [&] { return (double(generator() >> 11) + 0.5) * 0x1p-53; };
  for (Index i = 0; i < record.size(); ++i) {
    double const radius = std::sqrt(-2.0 * std::log(uniform())), angle = 2.0 * std::numbers::pi * uniform();
    record[i] += deviation * radius * std::cos(angle);
  }
  return record;
}

struct Estimate {
  std::string name{};
  Numbers value{};                                           // estimated parameters of the mount
  Mat<double, 4, 4> covariance = Mat<double, 4, 4>::Zero();  // covariance of the parameters
  double deviation = 0.0;                                    // standard deviation of the record from the fit [m]
  std::vector<double> sums{};                                // ½ Σ r² after each iteration [m²]
  int runs = 0, gradients = 0;
  double seconds = 0.0;  // processor time of the fit [s]
  bool converged = false;

  // Half width of the 95 % confidence interval of parameter i.
  double interval(std::size_t i) const { return 1.96 * std::sqrt(covariance(Index(i), Index(i))); }
};

// Fits the variables x = 1 + 2 ln(p/start), so that the parameters p remain positive and the variables have similar
// magnitudes.
inline Estimate estimate(Candidate const& c, VecX const& record, Numbers const& start) {
  auto const numbers = [&](VecX const& x) {
    Numbers p{};
    for (std::size_t j = 0; j < p.size(); ++j) p[j] = start[j] * std::exp(0.5 * (x[Index(j)] - 1.0));
    return p;
  };
  auto const factors = [&](VecX const& x) {
    Numbers const p = numbers(x);
    return VecX(0.5 * Eigen::Map<Vec4 const>(p.data()));
  };
  LeastSquares const problem{[&](VecX const& x) { return VecX(c.tip(numbers(x)) - record); },
                             [&](VecX const& x) { return MatX(c.derivatives(numbers(x)) * factors(x).asDiagonal()); }};
  std::clock_t const begin = std::clock();
  LeastSquaresFit const fit = least_squares(problem, VecX::Ones(Index(start.size())));
  Estimate e{.name = c.name, .value = numbers(fit.at), .deviation = fit.deviation(), .sums = fit.sums};
  e.covariance = factors(fit.at).asDiagonal() * fit.covariance() * factors(fit.at).asDiagonal();
  e.runs = fit.runs;
  e.gradients = fit.slope_runs;
  e.seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
  e.converged = fit.converged;
  return e;
}

}  // namespace identify
