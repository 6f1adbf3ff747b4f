// refused: EnergyMomentum and EnergyDecaying need the potential of a force for general scalars
// Its potential accepts doubles only.
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;

struct Well {
  static constexpr int markers = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr bool is_load = false;
  template <StateScalar T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const& at, double) const {
    return {Wrench<T>{.f = Vec<T, 3>(-at[0].r)}};
  }
  double potential(std::array<Frame<double>, 1> const& at, double) const { return 0.5 * at[0].r.squaredNorm(); }
  void check(std::string const&) const {}
};
using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<Well>>;

void run(M const& model, State& x) { simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}).run(); }
