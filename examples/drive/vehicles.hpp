#pragma once
// Vehicles with throttles, one function for each formulation of the links. Each function is compiled in a separate
// file.
#include <polybody/run/any_model.hpp>
#include <polybody/vehicle/terrain.hpp>

#include "m113/track_frames.hpp"
#include "m113/vehicle.hpp"
#include "throttle.hpp"

namespace drive {

using namespace polybody;

struct DrivenVehicle {
  std::shared_ptr<m113::TrackedVehicle const> tracks;
  AnyModel model;
};
using Throttles = std::array<Throttle, 2>;  // left, right

DrivenVehicle rigid_links(Throttles const& throttles, m113::VehicleOptions const& options, BumpCourse const& ground);
DrivenVehicle cable_links(Throttles const& throttles, m113::VehicleOptions const& options, BumpCourse const& ground);
DrivenVehicle modal_links(Throttles const& throttles, m113::VehicleOptions const& options, BumpCourse const& ground);

template <class Link, class Policy>
DrivenVehicle driven(Throttles const& throttles, m113::VehicleOptions const& options, BumpCourse const& ground) {
  using V = m113::Vehicle<Link, Policy, BumpCourse, Throttle>;
  auto const vehicle = std::make_shared<V const>(Policy{}, throttles, options, ground, m113::LinkOf<Link>{});
  return {vehicle, AnyModel(std::shared_ptr<typename V::ModelType const>(vehicle, &vehicle->model),
                            stepped_by<GeneralisedAlpha>)};
}

}  // namespace drive
