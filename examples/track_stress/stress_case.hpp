#pragma once
// The case of Chapter 4 for `compare`: the tracked vehicle, whose watched link tells its strain.
#include <polybody/compare/compare.hpp>
#include <polybody/io/checkpoint.hpp>
#include <polybody/run/body_record.hpp>
#include <polybody/vehicle/link_strain.hpp>

#include "stress_runs.hpp"
#include "surface.hpp"

namespace chapter4 {

double cpu_of(auto&& work) {
  std::clock_t const begin = std::clock();
  work();
  return double(std::clock() - begin) / CLOCKS_PER_SEC;
}

// The recorded link as a structure: with its mass, also where its section is another.
template <class = void>  // compiled where it is used
Structure structure_of_link(Options const& o) {
  Bar bar = m113::link_bar({}, section_height(o));
  double const heavier = o.section == 1.0 ? 1.0 : o.masses.link.mass / flexible_mass(o);
  bar.material->density = heavier * bar.material->density;
  return m113::link_structure(bar);
}
// A link of another height has another moment of inertia about its pins, by up to a sixth.
inline StructureLoadOptions loads(Options const& o) {
  return o.section == 1.0 ? StructureLoadOptions{} : StructureLoadOptions{.unbalance = 0.2};
}

// The strain of a link by its vibrations under what was recorded, stepped as the run was.
template <class = void>
DecoupledStress vibrating(Options const& o, BodyRecord const& record) {
  return DecoupledStress::vibrating(structure_of_link(o), record, integrator(o),
                                    {.frame = ReferenceConditions::simply_supported(0, 2)}, loads(o));
}
template <class = void>
DecoupledStress recovered(Options const& o, BodyRecord const& record) {
  if (o.recovery == "vibrating") return vibrating(o, record);
  return DecoupledStress::quasi_static(structure_of_link(o), record, loads(o));
}

// The watched link's strain and bending at one moment of a run of flexible links.
template <class V>
void watch(Options const& o, V const& vehicle, State const& x, LinkHistory& h) {
  auto const& link = vehicle.side(m113::Side::left).links[watched_link];
  h.strain.push_back(m113::link_strain(vehicle.model, x, link));
  Vec3 const lateral = vehicle.hull(x).A.col(1);
  h.bending.push_back(m113::link_bending(vehicle.model, x, link, lateral, section_height(o)));
}
// The same of a finite element link.
template <class V>
void watch_elements(Options const& o, V const& vehicle, State const& x, LinkHistory& h) {
  auto const& link = vehicle.side(m113::Side::left).links[watched_link];
  add_surface(h, o, x.q.segment(vehicle.model.entry(link).q0 + 7, link.body().deformations()));
}

struct StressCase {
  Options const& options;
  std::vector<Outcome>* outcomes;
  std::vector<std::shared_ptr<LinkHistory>>* histories;

  template <class F>
  auto operator()(F const& f) const {
    using M = typename VehicleOf<F>::ModelType;
    TrackCase const track{options, outcomes};
    auto const built = track.build(f);
    auto scenario = track.scenario(f, built);
    auto const vehicle = built.vehicle;
    auto const history = std::make_shared<LinkHistory>();
    histories->push_back(history);
    auto const link = vehicle->side(m113::Side::left).links[watched_link];
    if constexpr (HasRigidPoints<typename F::BodyType>) {
      auto const recorder = std::make_shared<LoadRecorder>(vehicle->model);
      recorder->add(link);
      scenario.observer = [=, before = scenario.observer](M const& model, State const& x) {
        before(model, x);
        history->recording += cpu_of([&] { recorder->record(x); });
      };
      // The recorder looks into the model: it lives as long as this.
      history->recover = [=, keep = vehicle, o = options](LinkHistory& h) {
        h.recovery = cpu_of([&] {
          DecoupledStress const stress = recovered(o, recorder->of(link));
          h.strain = m113::link_strain(stress);
          h.bending = m113::link_bending(stress, section_height(o));
          if (o.surface) add_surface(h, o, recorder->of(link));
        });
        h.vibration = cpu_of([&] { h.vibrating = m113::link_strain(vibrating(o, recorder->of(link))); });
      };
    } else if constexpr (requires { f.links.model; }) {
      bool const of_elements = bool(f.links.model);
      scenario.observer = [=, o = options, before = scenario.observer](M const& model, State const& x) {
        before(model, x);
        if (of_elements)
          watch_elements(o, *vehicle, x, *history);
        else
          watch(o, *vehicle, x, *history);
      };
    } else {
      scenario.observer = [=, o = options, before = scenario.observer](M const& model, State const& x) {
        before(model, x);
        watch(o, *vehicle, x, *history);
      };
    }
    return scenario;
  }
};

// The run of one formulation.
template <class F>
StressRuns run(Options const& o, F const& formulation) {
  StressRuns runs;
  runs.comparison = compare(StressCase{o, &runs.outcomes, &runs.links}, formulation);
  for (auto const& link : runs.links)
    if (link->recover) link->recover(*link);
  return runs;
}

// Runs to the end and puts the first state from `at` [s] on away in a file; returns its time.
inline double put_away(Simulation<GeneralizedAlpha>& run, double at, fs::path const& file) {
  double done_at = -1.0;
  while (!run.done()) {
    run.advance();
    if (done_at >= 0.0 || run.state().t < at) continue;
    write_checkpoint(file, run.snapshot());
    done_at = run.state().t;
  }
  return done_at;
}

// Half of the run, put away in a file, and the other half from there: what the whole run leads to, bit by bit.
template <class F>
void restart(Options const& o, F const& f) {
  std::vector<Outcome> outcomes;
  TrackCase const track{o, &outcomes};
  auto const built = track.build(f);
  auto const scenario = track.scenario(f, built);
  fs::path const file = o.out / (f.name + ".checkpoint");
  State x = scenario.start;
  auto whole = simulate(scenario.model, x, f.integrator, scenario.options);
  double const at = put_away(whole, 0.5 * o.until, file);
  State y = scenario.start;
  auto rest = resume(scenario.model, y, f.integrator, scenario.options, read_checkpoint(file));
  while (!rest.done()) rest.advance();
  bool const same = x.t == y.t && x.q == y.q && x.v == y.v && x.a == y.a && x.lambda == y.lambda;
  std::printf("%s: put away at %.4g s, taken up again, run to %.4g s: %s\n", f.name.c_str(), at, y.t,
              same ? "the same bits" : "NOT the same");
  if (!same) throw Error("The run that was taken up again ended in another state.");
}

// Why links of Body cannot hang together by pins of Policy; empty where they can. Model::connect states the same.
template <class Body, class Policy>
constexpr char const* refusal() {
  using Pin = Joint<Revolute, Policy>;
  if constexpr (LinearInCoordinates<Policy> && !HasLinearPoints<Body>)
    return "the frames of its ends are not linear in its coordinates";
  else if constexpr (!MayBeCarried<Policy, Body>)
    return "it has no frame that a joint could carry";
  else if constexpr (!TellsEnoughFirst<Pin, Body> || !TellsEnoughSecond<Pin, Body>)
    return "its ends have an axis and no frame, so that nothing tells where a pin points";
  else
    return "";
}

// How links of Body are made under these options.
template <class Body>
using LinksMade = std::function<m113::LinkOf<Body>(Options const&)>;

template <class Body, class Policy>
Combination combination(std::string const& links, std::string const& pins, bool usual, Policy const& policy,
                        LinksMade<Body> const& made) {
  Combination c{links, pins, usual, refusal<Body, Policy>(), Body::observes != Observes::axis};
  if constexpr (*refusal<Body, Policy>() == '\0') {
    auto const formulation = [=, name = usual ? links : links + ", " + pins](Options const& o) {
      return LinkFormulation<Body, Policy>{{name, policy, integrator(o)}, made(o)};
    };
    c.run = [=](Options const& o) { return run(o, formulation(o)); };
    c.restart = [=](Options const& o) { restart(o, formulation(o)); };
  }
  return c;
}

template <class Body>
m113::LinkOf<Body> with_section(Options const& o) {
  m113::LinkOf<Body> links;
  if constexpr (requires { links.height; }) links.height = section_height(o);
  return links;
}

// Links of Body under each policy of the pins, in the order of all_pins.
template <class Body, Policy Usual>
std::vector<Combination> links_of(std::string const& name, LinksMade<Body> const& made = with_section<Body>) {
  auto const by = [&](std::size_t pins, auto const& policy) {
    bool const usual = std::is_same_v<std::remove_cvref_t<decltype(policy)>, Usual>;
    return combination<Body>(name, all_pins[pins], usual, policy, made);
  };
  return {by(0, Constraint{}), by(1, m113::penalty_pin(m113::pin_stiffness)),
          by(2, m113::bushing_pin(m113::pin_stiffness)), by(3, AncfLinear{}), by(4, Recursive{})};
}

}  // namespace chapter4
