// Program of tests/tools/walk: one step, one connection, the start of a run and a gradient, with a record of all
// functions that are entered. Compiled with -finstrument-functions.
#include <cstdio>
#include <cstdlib>
#include <polybody/gradients.hpp>
#include <polybody/polybody.hpp>
#include <span>
#include <vector>

namespace {

FILE* trace = nullptr;  // a line for each call: address and depth
int depth = 0;

[[gnu::no_instrument_function]] void begin(char const* name) {
  trace = std::fopen(name, "w");
  if (!trace) std::abort();
  depth = 0;
}
[[gnu::no_instrument_function]] void end() {
  std::fclose(trace);
  trace = nullptr;
}

}  // namespace

extern "C" {
[[gnu::no_instrument_function]] void __cyg_profile_func_enter(void* function, void*) {
  ++depth;
  if (trace) std::fprintf(trace, "%p %d\n", function, depth);
}
[[gnu::no_instrument_function]] void __cyg_profile_func_exit(void*, void*) { --depth; }
}

using namespace polybody;

int main() {
  {
    using Link = Rigid<>;
    using Pin = Joint<Revolute, Constraint>;
    using Ground = Contact<SphereOnPlane>;
    Model<Bodies<Link>, Joints<Pin>, Forces<Ground>> model{Gravity{0, 0, -9.81}};
    Bar const bar{
        .length = 0.5, .section = Circle{.radius = 0.02}, .material = Material{.density = 7800, .young = 2e11}};
    std::vector<BodyHandle<Link>> links;
    for (int i = 0; i < 4; ++i) {
      Bar at = bar;
      at.placement = Placement::at({0.5 * i, 0, 0});
      links.push_back(model.add(Link::from(at)));
    }
    Pin const pin{Revolute{.axis = Vec3::UnitY()}};
    model.connect(pin, model.ground().at({0, 0, 0}), links[0].at(0.0));
    for (std::size_t i = 1; i < 3; ++i) model.connect(pin, links[i - 1].at(0.5), links[i].at(0.0));
    begin("connect.txt");
    model.connect(pin, links[2].at(0.5), links[3].at(0.0));
    end();
    model.apply(Ground{.geometry = {.radius = 0.1}, .normal = {.stiffness = 1e4}}, links[3].at(0.5),
                model.ground().at({0, 0, -0.3}));
    State x = model.reference_state();
    begin("start.txt");
    auto run = simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.0, .step = 1e-4});
    end();
    for (int i = 0; i < 5; ++i) run.advance();
    begin("step.txt");
    run.advance();
    end();
    std::fprintf(stderr, "step: %d Newton iterations\n", run.report().last.iterations);
  }
  int models = 0;
  using Link = planar::Rigid;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Chain = Model<Bodies<Link>, Joints<Pin>>;
  auto const chain = [&models](std::span<double const> lengths) {
    ++models;
    Chain model{Gravity{0, -9.81, 0}};
    std::vector<BodyHandle<Link>> links;
    double end = 0.0;  // of the last link
    for (double const length : lengths) {
      links.push_back(model.add(Link::from({.length = length,
                                            .section = Circle{.radius = 0.01},
                                            .material = Material{.density = 7800, .young = 2e11},
                                            .placement = Placement::at({end, 0, 0})})));
      end += length;
      if (links.size() == 1)
        model.connect(Pin{}, model.ground().at({0, 0, 0}), links.back().at(0.0));
      else
        model.connect(Pin{}, links[links.size() - 2].at(lengths[links.size() - 2]), links.back().at(0.0));
    }
    State const start = model.reference_state();
    auto const height = [tip = links.back(), length = lengths.back()](auto const& m, auto const& x) {
      return position(m, x, tip.at(length))[1];
    };
    return with_objective(Scenario<Chain>{std::move(model), start, {.end_time = 0.01, .step = 1e-3}}, height);
  };
  begin("gradient.txt");
  gradient(chain, {{"a [m]", 0.5}, {"b [m]", 0.5}, {"c [m]", 0.5}}, GeneralisedAlpha{.rho_inf = 0.8});
  end();
  std::printf("models %d\n", models);
}
