// Cost of a joint under each policy, on chains on pins that fall from a horizontal start. The links have a length of
// 0.1 m; they are rigid in space, or one cable element each in the plane. Benchmarks:
// - step: 0.1 s in steps of 1 ms, with 16 to 1024 links;
// - residual, tangent, factorisation (with its tangent) and solution: in the state after 0.1 s. The counter is the time
//   per link, also for links without joints ("free").
// `bench/table --growth` prints the exponents of growth.
#include <polybody/polybody.hpp>

#include "registered.hpp"

namespace {

using namespace polybody;

using Cable = planar::AncfCable<>;
using Laws = NonlinearBushing<LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>;
/// Chain of bodies B on pins of geometry G, with one of the policies Ps.
template <class B, class G, class... Ps>
using Chain = Model<Bodies<B>, Joints<Joint<G, Ps>...>>;
using Rods = Chain<Rigid<>, Revolute, Constraint, Penalty, PenaltyPerEquation<5>, Bushing, Laws>;
template <class... Ps>
using Cables = Chain<Cable, planar::Revolute, Ps...>;

Penalty const penalty{.stiffness = 1e7, .damping = 1e3};
PenaltyPerEquation<5> const per_row{.stiffness = Vec<double, 5>::Constant(1e7),
                                    .damping = Vec<double, 5>::Constant(1e3)};
Bushing const bushing{.stiffness = Bushing::diagonal(Vec3::Constant(1e7), Vec3::Constant(1e5)),
                      .damping = Bushing::diagonal(Vec3::Constant(1e3), Vec3::Constant(10.0))};
LinearLaw const slide{.stiffness = 1e7, .damping = 1e3}, turn{.stiffness = 1e5, .damping = 10.0};
Laws const laws{slide, slide, slide, turn, turn, turn};

template <class B>
B body(Bar const& bar) {
  if constexpr (requires { B::from(bar); })
    return B::from(bar);
  else
    return B::from(bar, 1);
}

template <class P, class B, class G, class... Ps>
Chain<B, G, Ps...> chain(Chain<B, G, Ps...> const&, P const& policy, int links, bool pinned = true) {
  Chain<B, G, Ps...> model{Gravity{0, -9.81, 0}};
  G geometry;
  if constexpr (std::is_same_v<G, Revolute>) geometry.axis = Vec3::UnitZ();
  Joint<G, P> const pin{geometry, policy};
  std::optional<BodyHandle<B>> before;
  for (int i = 0; i < links; ++i) {
    auto const link = model.add(body<B>({.length = 0.1,
                                         .section = Rectangle{.height = 0.03, .width = 0.02},
                                         .material = Material{.density = 7800.0, .young = 1e9, .poisson = 0.3},
                                         .placement = Placement::planar(0.1 * i, 0.0)}));
    if (pinned && before)
      model.connect(pin, before->at(0.1), link.at(0.0));
    else if (pinned)
      model.connect(pin, model.ground().at({0, 0, 0}), link.at(0.0));
    before = link;
  }
  return model;
}

/// Sink that copies the blocks of a tangent without further use.
struct Taken {
  std::vector<double> block;
  void add(Index, Index, BlockView const& b) {
    if (Index(block.size()) < b.rows * b.cols) block.resize(std::size_t(b.rows * b.cols));
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) block[std::size_t(j * b.rows + i)] = b(i, j);
    benchmark::ClobberMemory();
  }
};

RunOptions const options{.end_time = 0.1, .step = 1e-3};

/// Parts of an iteration in the state after 0.1 s.
template <class M>
struct Parts {
  M model;
  System system = stepped_system(model);
  State x;
  TangentSolver<DefaultSolver> solver = {};
  VecX r = VecX::Zero(system.velocities()), rhs = VecX::Ones(system.size()), y = rhs;
  Taken taken = {};

  explicit Parts(M const& of) : model(of) {
    State full = model.reference_state();
    simulate(model, full, GeneralisedAlpha{}, options).run();
    x = reduce(system, full);
    system.evaluate(x.q, x.v, x.t);
    solver.analyse(system, 1, [this](BlockSink& sink) { write(sink); });
    factorisation();
  }
  template <class Sink>
  void write(Sink& sink) {
    system.tangent({1.5, 5e-4, 2.5e-7}, SecondOrder::omitted, x.lambda, sink);
  }
  void residual() {
    system.evaluate(x.q, x.v, x.t);
    system.residual(x.a, x.lambda, r);
  }
  void tangent() { write(taken); }
  void factorisation() {
    benchmark::DoNotOptimize(solver.factor([this](BlockSink& sink) { write(sink); }));
  }
  void solution() { solver.solve(rhs, y); }
};

/// Registers the parts of an iteration of a chain that `make(links)` returns.
template <class F>
void add_parts(std::string const& name, int links, F const& make) {
  using P = Parts<decltype(make(links))>;
  auto const add = [&](char const* part, void (P::*act)()) {
    registered::add(part + name, [=](benchmark::State& state) {
      P parts(make(links));
      for (auto _ : state) (parts.*act)();
      registered::count_ns(state, "ns_per_link", links);
    });
  };
  add("residual/", &P::residual);
  add("tangent/", &P::tangent);
  add("factorisation/", &P::factorisation);
  add("solution/", &P::solution);
}

/// Registers the chains of one policy with up to `most` links.
template <class M, class P>
void add(std::string const& name, M const&, P const& policy, int most = 1024) {
  auto const make = [policy](int links) { return chain(M{}, policy, links); };
  for (int links = 16; links <= most; links *= 2) {
    std::string const size = name + "/links:" + std::to_string(links);
    registered::add("step/" + size, [=](benchmark::State& state) {
      auto const model = make(links);
      ProblemSize const counts = problem_size(model);
      State x;
      registered::time_runs(state, counts.velocities + counts.rows, [&] {
        x = model.reference_state();
        return simulate(model, x, GeneralisedAlpha{}, options);
      });
    });
    add_parts(size, links, make);
  }
}

}  // namespace

int main(int argc, char** argv) {
  using Kept = Cables<Constraint, Penalty>;
  using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;
  add_parts("rigid/free/links:64", 64, [](int links) { return chain(Rods{}, Constraint{}, links, false); });
  add_parts("cables/free/links:64", 64, [](int links) { return chain(Kept{}, Constraint{}, links, false); });
  add("rigid/Constraint", Rods{}, Constraint{});
  add("rigid/Penalty", Rods{}, penalty);
  add("rigid/PenaltyPerEquation", Rods{}, per_row, 64);
  add("rigid/Bushing", Rods{}, bushing);
  add("rigid/NonlinearBushing", Rods{}, laws, 64);
  add("rigid/JointCoordinates", Chain<Rigid<>, Revolute, JointCoordinates>{}, JointCoordinates{});
  add("rigid/JointCoordinatesBy<ArticulatedBody>", Chain<Rigid<>, Revolute, ByBodies>{}, ByBodies{});
  add("cables/Constraint", Kept{}, Constraint{});
  add("cables/Penalty", Kept{}, penalty, 64);
  add("cables/AncfLinear", Cables<AncfLinear>{}, AncfLinear{});
  return registered::run(argc, argv);
}
