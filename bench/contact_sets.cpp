// Time per ball and step of balls that collapse into a pile of five layers between walls, 0.3 s with h = 1 ms: balls of
// 1 kg and 0.1 m, k = 1e4 N/m, c = 60 N s/m beyond 1 mm. Contacts are those of
// - set: one `ContactSet`, with a grid and pairs that are kept between evaluations;
// - group: one `ContactGroup` in which every ball is also a partner, with half of the force, which tests all pairs;
// - single: one `Contact` for each pair, with blocks of all pairs in the matrix.
// Benchmarks have names such as pile/set/friction/balls:200; bench/table --growth gives the exponents.
#include <cmath>
#include <cstdio>
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "registered.hpp"

namespace {

using namespace polybody;

using Set = ContactSet<Shapes<Sphere, Plane>>;
using OnBall = Contact<SphereOnSphere>;
using OnFloor = Contact<SphereOnPlane>;
using Group = ContactGroup<OnFloor, OnBall>;

constexpr double radius = 0.1;

template <class Fs>
struct Pile {
  Model<Bodies<Rigid<>>, Joints<>, Fs> model{Gravity{0, 0, -9.81}};
  std::vector<Marker<Rigid<>>> balls;
  std::vector<Marker<Ground>> walls;

  explicit Pile(int count) {
    int const across = std::max(1, int(std::lround(std::sqrt(count / 5.0))));
    for (int i = 0; i < count; ++i) {
      int const x = i % across, y = i / across % across, z = i / (across * across);
      Vec3 const off(0.005 * std::sin(i), 0.005 * std::cos(3.0 * i), 0.0);
      Placement const at = Placement::at(Vec3(0.22 * x, 0.22 * y, radius + 0.22 * z) + off);
      balls.push_back(model.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), at)).centre());
    }
    double const far = 0.22 * (across - 1) + radius, near = -radius, quarter = 1.5707963267948966;
    auto const wall = [&](Vec3 const& at, Vec3 const& turn) {
      walls.push_back(model.ground().at(Placement::at(at, turn)));
    };
    wall({0, 0, 0}, {0, 0, 0});
    wall({near, 0, 0}, {0, quarter, 0});
    wall({far, 0, 0}, {0, -quarter, 0});
    wall({0, near, 0}, {-quarter, 0, 0});
    wall({0, far, 0}, {quarter, 0, 0});
  }
};

SpringDamperContact const law{.stiffness = 1e4, .damping = 60.0, .onset = 1e-3},
    half{.stiffness = 5e3, .damping = 30.0, .onset = 1e-3};
Friction rough(bool friction) { return friction ? Friction{.coefficient = 0.3, .slip_speed = 0.05} : Friction{}; }

Pile<Forces<Set>> with_set(int count, bool friction) {
  Pile<Forces<Set>> pile(count);
  auto const set = pile.model.apply(Set{law, rough(friction)});
  for (auto const& ball : pile.balls) pile.model.add_member(set, Sphere{.radius = radius}, ball);
  for (auto const& wall : pile.walls) pile.model.add_member(set, Plane{}, wall);
  return pile;
}
Pile<Forces<Group>> with_group(int count, bool friction) {
  Pile<Forces<Group>> pile(count);
  auto const group = pile.model.apply(Group{}, pile.balls);
  for (auto const& wall : pile.walls)
    pile.model.add_partner(group, OnFloor{{.radius = radius}, law, rough(friction)}, wall);
  OnBall const on_ball{{.radius_a = radius, .radius_b = radius}, half, rough(friction)};
  for (auto const& ball : pile.balls) pile.model.add_partner(group, on_ball, ball);
  return pile;
}
Pile<Forces<OnFloor, OnBall>> one_by_one(int count, bool friction) {
  Pile<Forces<OnFloor, OnBall>> pile(count);
  OnBall const on_ball{{.radius_a = radius, .radius_b = radius}, law, rough(friction)};
  for (std::size_t i = 0; i < pile.balls.size(); ++i) {
    for (auto const& wall : pile.walls)
      pile.model.apply(OnFloor{{.radius = radius}, law, rough(friction)}, pile.balls[i], wall);
    for (std::size_t k = 0; k < i; ++k) pile.model.apply(on_ball, pile.balls[i], pile.balls[k]);
  }
  return pile;
}

template <class Make>
void add(std::string const& kind, Make const& make, std::vector<int> const& counts) {
  for (bool const friction : {false, true})
    for (int const count : counts)
      registered::add("pile/" + kind + (friction ? "/friction" : "/smooth") + "/balls:" + std::to_string(count),
                      [=](benchmark::State& state) {
                        auto const pile = make(count, friction);
                        State x;
                        registered::time_runs(state, 6 * count, [&] {
                          x = pile.model.reference_state();
                          return simulate(pile.model, x, GeneralisedAlpha{}, {.end_time = 0.3, .step = 1e-3});
                        });
                        registered::count_ns(state, "per_ball_and_step", double(count) * state.counters["steps"].value);
                      });
}

}  // namespace

int main(int argc, char** argv) {
  add("set", with_set, {10, 200, 1000});
  add("group", with_group, {10, 200, 1000});
  add("single", one_by_one, {10, 50});
  return registered::run(argc, argv);
}
