// Springs of every kind under every integrator, at steps from 1/100 to 10 times the stability limit. Either the
// energy of the run stays within 10 % of its largest value, or the run is refused, or its report warns.
#include <gtest/gtest.h>

#include <cstdlib>

#include <polybody/polybody.hpp>

namespace polybody::hostile_springs_test {
namespace {

constexpr double mass = 1.0, stiffness = 1e4, omega = 100.0;  // [kg], [N/m], [rad/s]

/// −k (x − 1 m) along x, without a potential.
auto const pull = user_force<1>([](auto const& frames, double) {
  using T = std::decay_t<decltype(frames[0].r[0])>;
  Wrench<T> w;
  w.f[0] = (frames[0].r[0] - T(1.0)) * -stiffness;
  return std::array{w};
});
using Pull = std::remove_const_t<decltype(pull)>;
using Pin = Joint<planar::Revolute, Penalty>;
using Mount = Joint<Weld, Bushing>;
using Floor = Contact<SphereOnPlane>;

/// A mass in the plane, at rest with its spring stretched by 0.1 m.
struct InPlane {
  enum Kind { spring_damper, user, penalty, axial, maxwell, kinds };
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<SpringDamper, Pull, AxialSpring, MaxwellElement>> model;
  State x;
  Kind kind;

  explicit InPlane(int of) : kind(Kind(of)) {
    auto const body = model.add(planar::Rigid(mass, 1.0, Placement::planar(1.1, 0)), "mass");
    auto const at = body.at(Vec2(0, 0));
    auto const ground = model.ground().at({0, 0, 0});
    if (kind == spring_damper) model.apply(SpringDamper{.stiffness = stiffness, .free_length = 1.0}, ground, at);
    if (kind == user) model.apply(pull, at);
    if (kind == penalty)
      model.connect(Pin{{}, {.stiffness = stiffness, .damping = 0.0}}, model.ground().at({1, 0, 0}), at, "pin");
    if (kind == axial) model.apply(AxialSpring{.stiffness = stiffness, .preload = -stiffness}, ground, at);
    if (kind == maxwell)
      model.apply(MaxwellElement{.stiffness = stiffness, .damping = 1e9, .free_length = 1.0}, ground, at);
    x = model.reference_state();
  }
  /// T + V, with the potential of the user force [J].
  double energy_of(State const& now) const {
    double const stretch = now.q[0] - 1.0, hidden = kind == user ? 0.5 * stiffness * stretch * stretch : 0.0;
    return energy(model, now).total() + hidden + (kind == axial ? 0.5 * stiffness : 0.0);  // zero at rest
  }
};

/// A body in space on a bushing, or a ball that bounces on an elastic floor.
struct InSpace {
  enum Kind { bushing, contact, user, kinds };
  Model<Bodies<Rigid<>>, Joints<Mount>, Forces<Floor, Pull>> model;
  State x;
  Kind kind;

  explicit InSpace(int of) : model(of == contact ? Gravity{0, 0, -9.81} : Gravity{}), kind(Kind(of)) {
    Mat3 const inertia = Mat3::Identity();
    auto const body = model.add(Rigid<>(mass, inertia, Placement::at({1.1, 0, 0.05})), "mass");
    auto const at = body.at(Vec3(0, 0, 0));
    if (kind == bushing)
      model.connect(Mount{{},
                          {.stiffness = Bushing::diagonal({stiffness, stiffness, stiffness}, {1e3, 1e3, 1e3}),
                           .damping = Bushing::Matrix::Zero()}},
                    model.ground().at({1, 0, 0.05}), at, "mount");
    if (kind == contact)
      model.apply(Floor{.geometry = {.radius = 0.01}, .normal = {.stiffness = stiffness}}, at,
                  model.ground().at({0, 0, 0}), "floor");
    if (kind == user) model.apply(pull, at);
    x = model.reference_state();
  }
  double energy_of(State const& now) const {
    double const stretch = now.q[0] - 1.0;
    return energy(model, now).total() + (kind == user ? 0.5 * stiffness * stretch * stretch : 0.0);
  }
};

struct Count {
  int runs = 0, refused = 0, warned = 0, wrong = 0;
};

/// One run of 10 periods, or of 100 steps if these are longer. `limit` is the largest stable ωh.
template <class Case, class I>
void run_one(I const& integrator, int kind, double factor, double limit, Count& count) {
  Case setup(kind);
  double const h = factor * limit / omega, end_time = std::max(10.0 * 6.3 / omega, 100.0 * h);
  double const start = setup.energy_of(setup.x);
  double most = start;
  ++count.runs;
  try {
    auto run = simulate(setup.model, setup.x, integrator, {.end_time = end_time, .step = h, .max_step = h});
    for (State const& now : run) most = std::max(most, setup.energy_of(now));
    if (!run.report().warnings.empty()) {
      ++count.warned;
      return;
    }
  } catch (Error const&) {
    ++count.refused;
    return;
  }
  double const off = std::abs(setup.energy_of(setup.x) - start);
  if (off <= 0.1 * most) return;
  ++count.wrong;
  ADD_FAILURE() << I::name << ", kind " << kind << (std::is_same_v<Case, InPlane> ? " in the plane" : " in space")
                << ", ωh = " << factor * limit << ": the energy ends off by " << off << " J, at most it is " << most
                << " J, and the run says nothing";
}

template <class Case, class I>
void sweep(I const& integrator, Count& count, double limit = 2.0) {
  if constexpr (HasStabilityLimit<I>) limit = I::stability_limit;
  bool const all = std::getenv("POLYBODY_HOSTILE") != nullptr;
  std::vector<double> factors{0.05, 0.3, 0.9, 0.999, 1.004, 1.1, 3.0, 10.0};
  if (all)
    for (double factor = 0.01; factor < 10.0; factor *= 1.07) factors.push_back(factor);
  for (int kind = 0; kind < Case::kinds; ++kind)
    for (double const factor : factors) run_one<Case>(integrator, kind, factor, limit, count);
}

template <class I>
void sweep_both(I const& integrator, Count& count) {
  sweep<InPlane>(integrator, count);
  sweep<InSpace>(integrator, count);
}

TEST(HostileSprings, NoIntegratorChangesTheEnergyWithoutAWord) {
  Count count;
  sweep_both(GeneralisedAlpha{}, count);
  sweep_both(HhtAlpha{}, count);
  sweep_both(Newmark{.gamma = 0.6, .beta = 0.3025}, count);
  sweep_both(Trapezoidal{}, count);
  sweep_both(Radau{}, count);
  sweep_both(RungeKutta4<>{}, count);
  sweep_both(DormandPrince<>{}, count);
  sweep_both(AdamsBashforthMoulton<>{}, count);
  sweep_both(CentralDifference<>{}, count);
  sweep_both(SymplecticEuler{}, count);
  sweep_both(Rattle{}, count);
  sweep<InPlane>(EnergyMomentum{}, count);
  sweep<InPlane>(EnergyDecaying{}, count);
  std::cout << count.runs << " runs, " << count.refused << " refused, " << count.warned << " with a warning, "
            << count.wrong << " wrong without a word\n";
  EXPECT_EQ(count.wrong, 0);
}

}  // namespace
}  // namespace polybody::hostile_springs_test
