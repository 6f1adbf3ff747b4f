// Balls (0.1 m, 1 kg) that nothing connects, on a plane with friction 0.8, for 0.5 s: rolling, sliding, and landing
// with slip from 0.02 to 0.32 m. Counters:
// - per_ball: time per ball and step [ns]; its ratio to that of one ball is the cost of other independent balls;
// - error: root mean square distance of the first 200 balls at 0.5 s from their places in a run of the same code with
//   steps of 1/64 ms [m]. The contact laws of the codes differ, so that each code has its own reference.
// Contacts are `Contact`, or one `ContactSet`. If MuJoCo is found (Debian: libmujoco-dev), it moves the landing balls
// too. Its stiffness and damping of the normal motion are the same; its friction acts on the slip with a soft
// constraint.
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "registered.hpp"
#ifdef POLYBODY_HAS_MUJOCO
#include <mujoco/mujoco.h>
#endif

namespace {

using namespace polybody;

enum class BallMotion { rolling, sliding, landing };

constexpr double radius = 0.1, mass = 1.0, moment = 0.004, end_time = 0.5;  // [m], [kg], [kg m²], [s]
constexpr double stiffness = 1e5, damping = 100.0, friction = 0.8;          // of a contact [N/m], [N s/m], [1]

/// Place, velocity and angular velocity of ball i at the start.
struct Start {
  Vec3 r, v, w = Vec3::Zero();

  Start(BallMotion motion, int i) {
    double const height = motion == BallMotion::landing ? 0.02 + 0.3 * std::fmod(0.618034 * i, 1.0) : -1e-4;
    double const speed = 1.0 + std::fmod(0.618034 * i, 1.0),
                 direction = 2.0 * std::numbers::pi * std::fmod(0.414 * i, 1.0);
    r = {0.5 * (i % 40), 0.5 * (i / 40), radius + height};
    v = {speed * std::cos(direction), speed * std::sin(direction), 0.0};
    if (motion == BallMotion::rolling) w = {-v[1] / radius, v[0] / radius, 0.0};
  }
};

using Single = Contact<SphereOnPlane>;
using Set = ContactSet<Shapes<Sphere, Plane>>;

/// Balls in polybody, with contacts of type F.
template <class F>
class Balls {
 public:
  Balls(BallMotion motion, int count) {
    SpringDamperContact const normal{.stiffness = stiffness, .damping = damping};
    Friction const rough{.coefficient = friction, .slip_speed = 0.01};
    auto const plane = model_.ground().at({0, 0, 0});
    std::vector<Marker<Rigid<>>> balls;
    for (int i = 0; i < count; ++i)
      balls.push_back(model_.add(Rigid<>(mass, moment * Mat3::Identity(), Placement::at(Start(motion, i).r))).centre());
    if constexpr (std::same_as<F, Set>) {
      auto const set = model_.apply(Set{normal, rough});
      for (auto const& ball : balls) model_.add_member(set, Sphere{.radius = radius}, ball, "", 1);
      model_.add_member(set, Plane{}, plane);
    } else {
      for (auto const& ball : balls) model_.apply(Single{{radius}, normal, rough}, ball, plane);
    }
    start_ = model_.reference_state();
    for (int i = 0; i < count; ++i) {
      Start const at(motion, i);
      start_.v.segment<3>(6 * i) = at.v;
      start_.v.segment<3>(6 * i + 3) = at.w;
    }
  }
  /// Runs with steps of h [s]. `timed` calls the function that it receives.
  template <class Timed>
  void run(double h, Timed const& timed) {
    x_ = start_;
    auto simulation = simulate(model_, x_, GeneralisedAlpha{}, {.end_time = end_time, .step = h});
    timed([&] { simulation.run(); });
    report_ = simulation.report();
  }
  Vec3 place(int i) const { return x_.q.segment<3>(7 * i); }
  void count(benchmark::State& state) const { registered::count(state, report_, start_.v.size()); }

 private:
  Model<Bodies<Rigid<>>, Joints<>, Forces<F>> model_{Gravity{0, 0, -9.81}};
  State start_, x_;
  RunReport report_;
};

#ifdef POLYBODY_HAS_MUJOCO
/// Balls in MuJoCo with sparse Jacobians. The balls have no contacts among each other. The stack of version 2.2.2 grows
/// with the square of the number of balls: 1.2 GB for 1000 balls.
class InMujoco {
 public:
  InMujoco(BallMotion motion, int count) : motion_(motion), count_(count) {
    std::string text = "<mujoco><size njmax='" + std::to_string(4 * count) + "' nconmax='" + std::to_string(count) +
                       "' nstack='" + std::to_string(1000000L + 150L * count * count) +
                       "'/><option cone='elliptic' jacobian='sparse'/>" +
                       "<default><geom solref='-1e5 -100' solimp='0.99 0.99 0.001' friction='0.8 0 0'/></default>" +
                       "<worldbody><geom type='plane' size='100 100 1' contype='1' conaffinity='0'/>";
    for (int i = 0; i < count; ++i)
      text +=
          "<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='0.004 0.004 0.004'/>"
          "<geom type='sphere' size='0.1' contype='0' conaffinity='1'/></body>";
    text += "</worldbody></mujoco>";
    auto const files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "balls.xml", int(text.size()));
    std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[0]));
    char error[500] = "";
    model_.reset(mj_loadXML("balls.xml", files.get(), error, sizeof error));
    mj_deleteVFS(files.get());
    if (!model_) throw InvalidInput("bench.mujoco", {error});
    data_.reset(mj_makeData(model_.get()));
  }
  template <class Timed>
  void run(double h, Timed const& timed) {
    model_->opt.timestep = h;
    mj_resetData(model_.get(), data_.get());
    for (int i = 0; i < count_; ++i) {
      Start const at(motion_, i);
      std::copy_n(at.r.data(), 3, data_->qpos + 7 * i);
      std::copy_n(at.v.data(), 3, data_->qvel + 6 * i);
      std::copy_n(at.w.data(), 3, data_->qvel + 6 * i + 3);
    }
    timed([&] {
      for (long left = std::lround(end_time / h); left > 0; --left) mj_step(model_.get(), data_.get());
    });
    steps_ = std::lround(end_time / h);
  }
  Vec3 place(int i) const { return {data_->qpos[7 * i], data_->qpos[7 * i + 1], data_->qpos[7 * i + 2]}; }
  void count(benchmark::State& state) const { state.counters["steps"] = double(steps_); }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  BallMotion motion_;
  int count_;
  long steps_ = 0;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};
#endif

/// Places of the first balls at the end of a run with steps of 1/64 ms.
template <class Code>
std::vector<Vec3> const& converged(BallMotion motion, int count) {
  static std::map<std::pair<BallMotion, int>, std::vector<Vec3>> known;
  auto const [places, is_new] = known.try_emplace({motion, count});
  if (is_new) {
    Code balls(motion, count);
    balls.run(1e-3 / 64.0, [](auto const& steps) { steps(); });
    for (int i = 0; i < count; ++i) places->second.push_back(balls.place(i));
  }
  return places->second;
}

template <class Code>
void add(std::string const& code, std::string const& name, BallMotion motion, int count, double h = 1e-3) {
  registered::add("balls/" + name + "/" + code + "/balls:" + std::to_string(count), [=](benchmark::State& state) {
    Code balls(motion, count);
    for (auto _ : state) {
      state.PauseTiming();
      balls.run(h, [&](auto const& steps) {
        state.ResumeTiming();
        steps();
        state.PauseTiming();
      });
      state.ResumeTiming();
    }
    balls.count(state);
    registered::count_ns(state, "per_ball", end_time / h * count);
    int const few = std::min(count, 200);
    double sum = 0.0;
    for (int i = 0; i < few; ++i) sum += (balls.place(i) - converged<Code>(motion, few)[std::size_t(i)]).squaredNorm();
    state.counters["error"] = std::sqrt(sum / few);
  })->Unit(benchmark::kMillisecond);
}

/// Landing balls in all codes.
void add_landing(std::string const& name, int count, double h) {
  add<Balls<Single>>("GeneralisedAlpha", name, BallMotion::landing, count, h);
  add<Balls<Set>>("GeneralisedAlpha/ContactSet", name, BallMotion::landing, count, h);
#ifdef POLYBODY_HAS_MUJOCO
  if (count <= 1000) add<InMujoco>("MuJoCo", name, BallMotion::landing, count, h);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::AddCustomContext("contact", "k = 1e5 N/m, c = 100 N s/m, friction 0.8; polybody: slip speed 0.01 m/s");
#ifdef POLYBODY_HAS_MUJOCO
  benchmark::AddCustomContext(
      "MuJoCo", std::string(mj_versionString()) +
                    ", Euler, Newton, sparse Jacobians, elliptic cones, tolerance 1e-8, solref -1e5 -100, "
                    "solimp 0.99");
#endif
  for (int const count : {1, 200, 1000}) {
    add<Balls<Single>>("GeneralisedAlpha", "rolling", BallMotion::rolling, count);
    add<Balls<Single>>("GeneralisedAlpha", "sliding", BallMotion::sliding, count);
  }
  for (int const count : {1, 200, 1000, 5000}) add_landing("landing", count, 1e-3);
  for (double const h : {2.0, 0.5, 0.25, 0.125}) {
    char name[40];
    std::snprintf(name, sizeof name, "landing_%g_ms", h);
    add_landing(name, 200, 1e-3 * h);
  }
  return registered::run(argc, argv);
}
