#include "simbody_chain.hpp"

#include <Simbody.h>

#include <memory>

namespace falling_chain {
namespace {

struct Chain {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::Force::UniformGravity gravity{forces, matter, SimTK::Vec3(0, -weight, 0)};
  SimTK::State start;
  SimTK::MobilizedBodyIndex last{0};

  explicit Chain(int links) {
    SimTK::Body::Rigid const body(
        SimTK::MassProperties(mass, SimTK::Vec3(0), SimTK::Inertia(moments[0], moments[1], moments[2])));
    SimTK::Vec3 const end(0.5 * length, 0, 0);
    for (int i = 0; i < links; ++i) {
      SimTK::MobilizedBody before = matter.updMobilizedBody(last);
      SimTK::MobilizedBody::Pin const pin(before, SimTK::Transform(i == 0 ? SimTK::Vec3(0) : end), body,
                                          SimTK::Transform(-end));
      last = pin.getMobilizedBodyIndex();
    }
    start = system.realizeTopology();
    system.realizeModel(start);
  }
};

}  // namespace

Call simbody_call(int links) {
  auto const chain = std::make_shared<Chain const>(links);
  SimTK::State x = chain->start;
  for (int i = 0; i < links; ++i) {
    x.updQ()[i] = angle(i);
    x.updU()[i] = rate(i);
  }
  return [=]() mutable {
    x.updQ()[0] = angle(0);  // invalidates the results of the previous call
    chain->system.realize(x, SimTK::Stage::Acceleration);
    return x.getUDot()[links - 1];
  };
}

Second simbody_second(int links) {
  auto const chain = std::make_shared<Chain const>(links);
  return [=](double tolerance) -> Tip {
    SimTK::RungeKuttaMersonIntegrator method(chain->system);
    method.setAccuracy(tolerance);
    SimTK::TimeStepper run(chain->system, method);
    run.initialize(chain->start);
    run.stepTo(1.0);
    chain->system.realize(run.getState(), SimTK::Stage::Position);
    SimTK::Vec3 const r = chain->matter.getMobilizedBody(chain->last).getBodyOriginLocation(run.getState());
    return {r[0], r[1]};
  };
}

}  // namespace falling_chain
