#pragma once
// Driven link with a mass at its end, under any formulation. The link consists of sections with different heights.
// Outputs are the stresses at the beginning of each section at all times of a run, as functions of the heights.

#include <ctime>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/polybody.hpp>

namespace lighter_link {

using namespace polybody;

// Smooth rotation by `angle` without breakpoints: ½ angle (tanh((t − middle)/time) + tanh(middle/time)).
struct Turn {
  double angle, time, middle;  // [rad], [s], [s]

  Motion operator()(double t) const {
    double const x = std::tanh((t - middle) / time), slope = 1.0 - x * x, half = 0.5 * angle;
    return {half * (x + std::tanh(middle / time)), half * slope / time, -2.0 * half * x * slope / (time * time)};
  }
  // Largest angular acceleration [rad/s²], at tanh²((t − middle)/time) = 1/3.
  double peak() const { return 2.0 / (3.0 * std::sqrt(3.0)) * angle / (time * time); }
};

// Task of the link. The plane of the motion is horizontal, so gravity has no effect.
struct Task {
  double length = 1.0, width = 0.02;                    // length and width of the link [m]
  double payload = 2.0, payload_inertia = 1e-3;         // mass and moment of inertia at the end [kg], [kg m²]
  Turn turn{0.5 * std::numbers::pi, 0.1, 0.4};          // prescribed rotation of the root
  double end_time = 0.75, step = 3e-3;                  // end time and time step [s]
  double allowed = 100e6;                               // allowed stress [N/m²]
  std::size_t sections = 4;                             // number of sections, which have equal lengths
  Material material{.density = 2700.0, .young = 7e10};  // aluminium
  Damping damping{.axial = 1e-4, .shear = 1e-4, .bending = 1e-3};

  double section_length() const { return length / double(sections); }
  double mass(std::span<double const> heights) const {  // mass of the link [kg]
    double sum = 0.0;
    for (double const h : heights) sum += material.density * width * h * section_length();
    return sum;
  }
  Bar bar(double height, std::size_t i) const {
    return {.length = section_length(),
            .section = Rectangle{.height = height, .width = width},
            .material = material,
            .placement = Placement::planar(section_length() * double(i), 0.0),
            .damping = damping};
  }
};

// The link as sections of B with a given number of elements, welded to each other. The outputs are the stresses of the
// upper and the lower fibre at the beginning of each section, relative to the allowed stress: N/A ∓ M h/2I. N and M are
// multipliers of the joints at this point, so they are also available for a rigid formulation.
template <class B>
struct Link {
  Task task;
  Index elements = 1;

  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Turn>, Constraint>;
  using Weld = Joint<planar::Weld, Constraint>;
  using Held = std::conditional_t<std::is_same_v<B, planar::Rigid>, Bodies<B>, Bodies<B, planar::Rigid>>;
  using M = Model<Held, Joints<Pin, Drive, Weld>>;

  auto operator()(std::span<double const> heights) const {
    M model;
    std::vector<BodyHandle<B>> sections;
    for (std::size_t i = 0; i < task.sections; ++i)
      sections.push_back(model.add(body(task.bar(heights[i], i)), "section " + std::to_string(i + 1)));
    auto const pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), sections[0].at(0.0), "pin");
    auto const drive =
        model.connect(Drive{{task.turn}, {}}, model.ground().at({0, 0, 0}), sections[0].at(0.0), "drive");
    double const l = task.section_length();
    std::vector<ElementHandle<Weld>> welds;
    for (std::size_t i = 1; i < task.sections; ++i)
      welds.push_back(model.connect(Weld{}, sections[i - 1].at(l), sections[i].at(0.0)));
    auto const mass =
        model.add(planar::Rigid(task.payload, task.payload_inertia, Placement::planar(task.length, 0.0)), "payload");
    model.connect(Weld{}, sections.back().at(l), mass.at(Vec2(0, 0)), "grip");
    System const system(model, with<Capabilities::rigid_velocities>);
    auto const row = [&](auto const& joint) {
      return system.layout().joints[std::size_t(index_of_joint(system.layout(), joint))].row;
    };
    std::vector<Output<M>> outputs;
    for (std::size_t i = 0; i < task.sections; ++i) {
      Index const force = i == 0 ? row(pin) : row(welds[i - 1]), moment = i == 0 ? row(drive) : force + 2;
      for (double const side : {1.0, -1.0})
        outputs.push_back({"stress of section " + std::to_string(i + 1) + (side > 0.0 ? ", upper" : ", lower"),
                           [=, from = sections[i], allowed = task.allowed, width = task.width, h = heights[i]](
                               M const& m, State const& x) {
                             Vec3 const along = frame(m, x, from.at(0.0)).A.col(0);
                             double const n = along[0] * x.lambda[force] + along[1] * x.lambda[force + 1];
                             return (n / (width * h) - side * x.lambda[moment] * 6.0 / (width * h * h)) / allowed;
                           }});
    }
    State start = model.reference_state();
    system.operations().rigid_velocities(start.q, Vec3::Zero(), {0, 0, task.turn(0.0).rate}, start.v);
    return Scenario<M>{std::move(model), start, {.end_time = task.end_time, .step = task.step}, std::move(outputs)};
  }

 private:
  B body(Bar const& bar) const { return B::from(bar, {.elements = elements}); }
};

inline GeneralisedAlpha const method{.rho_inf = 0.8, .tolerance = 1e-12, .start_correction = false};

// (states × outputs) outputs of a run.
template <class Make>
MatX stresses_of(Make const& make, std::span<double const> heights) {
  auto scenario = make(heights);
  State x = scenario.start;
  std::vector<double> all;
  for (State const& now : simulate(scenario.model, x, method, scenario.options))
    for (auto const& o : scenario.outputs) all.push_back(o.value(scenario.model, now));
  auto const columns = Index(scenario.outputs.size());
  return Eigen::Map<MatX const>(all.data(), columns, Index(all.size()) / columns).transpose();
}

// Smooth upper bound of the stresses σ at all points and times, by Kreisselmeier and Steinhauser: ln(Σ exp(ρ σ))/ρ. The
// bound exceeds the largest of n stresses by at most ln(n)/ρ.
struct Aggregate {
  double sharpness = 200.0;  // ρ

  double operator()(MatX const& stresses) const {
    double const most = stresses.maxCoeff();
    return most + std::log((sharpness * (stresses.array() - most)).exp().sum()) / sharpness;
  }
  // Bound for a run with sensitivities, and the derivatives Σ w ∂σ/∂p of the bound with respect to the parameters p,
  // with the weights w = exp(ρ σ)/Σ exp(ρ σ).
  std::pair<double, VecX> derivatives(SensitivityResult const& s) const {
    double most = s.values[0].maxCoeff(), sum = 0.0;
    for (VecX const& v : s.values) most = std::max(most, v.maxCoeff());
    VecX by = VecX::Zero(Index(s.parameters.size()));
    for (std::size_t k = 0; k < s.values.size(); ++k) {
      VecX const w = (sharpness * (s.values[k].array() - most)).exp();
      sum += w.sum();
      by += s.derivatives[k].transpose() * w;
    }
    return {most + std::log(sum) / sharpness, by / sum};
  }
};

// Results of a run with derivatives for one design.
struct Loaded {
  double aggregate = 0.0, most = 0.0;  // aggregate and largest stress, relative to the allowed stress
  VecX derivatives{};                  // derivatives of the aggregate with respect to the heights [1/m]
};

// A formulation of the link with erased type.
struct Candidate {
  std::string name;
  std::function<MatX(std::span<double const>)> stresses;
  std::function<Loaded(std::span<double const>)> loaded;
};
template <class B>
Candidate candidate(std::string name, Task const& task, Aggregate const& aggregate, Index elements = 1) {
  Link<B> const all{task, elements};
  auto const stresses = [all](std::span<double const> h) { return stresses_of(all, h); };
  auto const loaded = [all, aggregate](std::span<double const> h) {
    std::vector<Parameter> parameters;
    for (double const x : h) parameters.push_back({"height " + std::to_string(parameters.size() + 1) + " [m]", x});
    SensitivityResult const s = sensitivities(all, parameters, method);
    Loaded out;
    std::tie(out.aggregate, out.derivatives) = aggregate.derivatives(s);
    for (VecX const& v : s.values) out.most = std::max(out.most, v.maxCoeff());
    return out;
  };
  return {std::move(name), stresses, loaded};
}

}  // namespace lighter_link
