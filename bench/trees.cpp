// Joint coordinates of a tree by articulated bodies, on a chain that falls from a horizontal start: links of 0.1 m and
// 1 kg on pins. Benchmarks:
// - call: (q, q˙) → q¨; counter: acceleration of the last joint [rad/s²];
// - step: run in steps of 1 ms by Runge–Kutta 4 (four calls per step), by generalised-α, and by generalised-α with full
//   Newton iterations;
// - second: one second with a relative tolerance; counter: distance of the tip from that with a tolerance of 1e-12 [m].
// If Simbody is found (Debian: libsimbody-dev), it solves the same chain in `call` and `second`.
#include <map>
#include <polybody/polybody.hpp>

#include "registered.hpp"
#include "trees/simbody_chain.hpp"

namespace {

using namespace polybody;
using namespace falling_chain;

using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;
using Pin = Joint<Revolute, ByBodies>;
using Chain = Model<Bodies<Rigid<>>, Joints<Pin>>;

Chain chain(int links) {
  Chain model{Gravity{0, -weight, 0}};
  Pin const pin{Revolute{.axis = {0, 0, 1}}, {}};
  std::optional<BodyHandle<Rigid<>>> before;
  for (int i = 0; i < links; ++i) {
    auto const link = model.add(Rigid<>({.mass = mass,
                                         .inertia = Vec3(moments[0], moments[1], moments[2]).asDiagonal(),
                                         .placement = Placement::at({length * (i + 0.5), 0, 0})}));
    Vec3 const end(0.5 * length, 0, 0);
    if (before)
      model.connect(pin, before->at(end), link.at(Vec3(-end)));
    else
      model.connect(pin, model.ground().at({0, 0, 0}), link.at(Vec3(-end)));
    before = link;
  }
  return model;
}

Second second(int links) {
  return [model = chain(links), links](double tolerance) -> Tip {
    State x = model.reference_state();
    simulate(model, x, DormandPrince<>{.relative_tolerance = tolerance, .absolute_tolerance = tolerance},
             {.end_time = 1.0, .step = 1e-2})
        .run();
    Index const last = 7 * (links - 1);
    return {x.q[last], x.q[last + 1]};
  };
}

/// The bent chain with the workspace of a call.
struct Bent {
  Chain model;
  System system = stepped_system(model);
  State x = reduce(system, model.reference_state());
  ForwardDynamics<> forward{system};

  explicit Bent(int links) : model(chain(links)) {
    for (int i = 0; i < links; ++i) {
      x.q[i] = angle(i);
      x.v[i] = rate(i);
    }
  }
};
Call call(int links) {
  return [bent = std::make_shared<Bent>(links), links] {
    State& x = bent->x;
    bent->forward.accelerations(bent->system, {x.q, x.v, 0.0}, x.a, x.lambda);
    return x.a[links - 1];
  };
}

std::string of(int links) { return "/links:" + std::to_string(links); }

void add_call(std::string const& code, int links, Call (*make)(int)) {
  registered::add("call/" + code + of(links), [=](benchmark::State& state) {
    Call const evaluate = make(links);
    double last = 0.0;
    for (auto _ : state) last = evaluate();
    state.counters["last_acceleration"] = last;
  });
}

template <class I>
void add_steps(std::string const& name, int links, I const& integrator) {
  registered::add("step/" + name + of(links), [=](benchmark::State& state) {
    Chain const model = chain(links);
    int const steps = std::clamp(20000 / links, 100, 2000);
    State x;
    registered::time_runs(state, links, [&] {
      x = model.reference_state();
      return simulate(model, x, integrator, {.end_time = 1e-3 * steps, .step = 1e-3});
    });
  });
}

void add_second(std::string const& code, int links, double tolerance, Second (*make)(int)) {
  char exponent[24];
  std::snprintf(exponent, sizeof exponent, "/tolerance:%.0e", tolerance);
  registered::add("second/" + code + of(links) + exponent, [=](benchmark::State& state) {
    static std::map<std::string, Tip> references;
    Second const run = make(links);
    auto const [reference, is_new] = references.try_emplace(code + of(links));
    if (is_new) reference->second = run(1e-12);
    Tip tip = {};
    for (auto _ : state) tip = run(tolerance);
    state.counters["error"] = std::hypot(tip[0] - reference->second[0], tip[1] - reference->second[1]);
  });
}

}  // namespace

int main(int argc, char** argv) {
  for (int const links : {4, 16, 64, 256}) {
    add_call("polybody", links, call);
#ifdef POLYBODY_HAS_SIMBODY
    add_call("Simbody", links, simbody_call);
#endif
    add_steps("RungeKutta4", links, RungeKutta4<>{});
  }
  for (int const links : {16, 64, 256, 1024, 4096}) {
    add_steps("GeneralisedAlpha", links, GeneralisedAlpha{});
    add_steps("GeneralisedAlpha/full_Newton", links, GeneralisedAlpha{.newton = {.always_refactor = true}});
  }
  for (int const links : {4, 16, 64})
    for (double const tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
      add_second("polybody", links, tolerance, second);
#ifdef POLYBODY_HAS_SIMBODY
      add_second("Simbody", links, tolerance, simbody_second);
#endif
    }
  return registered::run(argc, argv);
}
