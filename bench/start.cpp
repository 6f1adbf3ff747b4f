// Times before the first step of large models: adding the parts, `simulate` (assembly check, elimination order, first
// accelerations), and the first step, `summary` and `diagnose`. The models are chains of planar bodies on pins, chains
// with every pin doubled, and many pins at one point. The number in brackets is the exponent of growth between two
// rows: 1 is linear. Processor time of one run.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cstdio>
#include <ctime>
#include <functional>
#include <polybody/polybody.hpp>
#include <polybody/run/diagnose.hpp>
#include <polybody/run/summary.hpp>
#include <sstream>

namespace {

using namespace polybody;

template <class Policy>
using Pin = Joint<planar::Revolute, Policy>;
template <class Policy>
using Chain = Model<Bodies<planar::Rigid>, Joints<Pin<Policy>>>;

double processor_time() { return double(std::clock()) / CLOCKS_PER_SEC; }

double seconds(std::function<void()> const& act) {
  double const start = processor_time();
  act();
  return processor_time() - start;
}

/// Bars of 1 m and 1 kg in a row. `copies` equal pins connect each bar to the previous bar.
template <class Policy>
Chain<Policy> chain(int bodies, int copies = 1) {
  Chain<Policy> model{Gravity{0, -9.81, 0}};
  BodyHandle<planar::Rigid> before;
  for (int i = 0; i < bodies; ++i) {
    auto const bar = model.add(planar::Rigid(1.0, 1.0 / 12.0, Placement::planar(0.5 + i, 0.0)));
    for (int copy = 0; copy < copies; ++copy)
      if (i == 0)
        model.connect(Pin<Policy>{}, model.ground().at({0, 0, 0}), bar.at(Vec2(-0.5, 0)));
      else
        model.connect(Pin<Policy>{}, before.at(Vec2(0.5, 0)), bar.at(Vec2(-0.5, 0)));
    before = bar;
  }
  return model;
}

/// One body with this number of `pins` at one point.
Chain<Constraint> pinned(int pins) {
  Chain<Constraint> model{Gravity{0, -9.81, 0}};
  auto const hub = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0.5, 0.0)), "hub");
  for (int i = 0; i < pins; ++i) model.connect(Pin<Constraint>{}, model.ground().at({0, 0, 0}), hub.at(Vec2(-0.5, 0)));
  return model;
}

/// Printer of lines of times [s], with the exponents of growth from the previous line.
class Table {
 public:
  void add(int size, std::vector<double> const& times) {
    std::printf("%8d", size);
    for (std::size_t k = 0; k < times.size(); ++k) {
      std::printf("  %9.3f", times[k]);
      if (k < before_.size() && before_[k] > 0.0 && times[k] > 0.0)
        std::printf(" (%4.2f)", std::log(times[k] / before_[k]) / std::log(double(size) / size_));
      else
        std::printf("       ");
    }
    std::printf("\n");
    std::fflush(stdout);
    size_ = size;
    before_ = times;
  }

 private:
  int size_ = 0;
  std::vector<double> before_;
};

template <class Policy>
void chains(char const* title) {
  std::printf(
      "\n%s [s] (exponent)\n  bodies  adding            simulate          first step        summary           "
      "diagnose\n",
      title);
  Table table;
  for (int const bodies : {1000, 3000, 10000, 20000, 100000}) {
    malloc_trim(0);  // each size starts without cached memory
    std::optional<Chain<Policy>> model;
    std::vector<double> times{seconds([&] { model = chain<Policy>(bodies); })};
    State x = model->reference_state();
    State const start = x;
    using Run = decltype(simulate(*model, x, GeneralisedAlpha{}, RunOptions{.end_time = 1.0, .step = 1e-3}));
    std::unique_ptr<Run> run;
    times.push_back(seconds([&] {
      run.reset(new Run(simulate(*model, x, GeneralisedAlpha{}, RunOptions{.end_time = 1.0, .step = 1e-3})));
    }));
    times.push_back(seconds([&] { run->advance(); }));
    times.push_back(seconds([&] { benchmark::DoNotOptimize(summary(*model)); }));
    times.push_back(seconds([&] { benchmark::DoNotOptimize(diagnose(*model, start)); }));
    table.add(bodies, times);
  }
}

/// Times of models with redundant equations; model_of(n) returns the model of size n.
template <class ModelOf>
void redundant(char const* title, std::initializer_list<int> sizes, ModelOf model_of) {
  std::printf("\n%s [s] (exponent)\n    size  simulate          redundancy\n", title);
  Table table;
  for (int const n : sizes) {
    Chain<Constraint> const model = model_of(n);
    State x = model.reference_state();
    double const start = seconds([&] { simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}); });
    double const rank = seconds([&] { benchmark::DoNotOptimize(redundancy(model, x)); });
    table.add(n, {start, rank});
  }
}

void start(benchmark::State& state) {
  for (auto _ : state) {
    chains<Constraint>("chain, Constraint");
    chains<JointCoordinates>("chain, JointCoordinates");
    redundant("chain, every pin doubled", {100, 200, 400, 800, 1600, 10000},
              [](int n) { return chain<Constraint>(n, 2); });
    redundant("pins at one point", {100, 200, 400, 800, 1600}, pinned);
  }
}
BENCHMARK(start)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace

BENCHMARK_MAIN();
