#pragma once
// Functions that create vehicles of any formulation for the case in tracked_vehicle.hpp.
#include "m113/vehicle.hpp"
#include "m113/visual.hpp"
#include "tracked_vehicle.hpp"

namespace chapter3 {

template <class Body, class Policy, class Links = m113::LinkOf<Body>>
auto made_vehicle(Policy const& pins, VehicleParts const& parts, Links const& links = {}) {
  return std::make_shared<m113::Vehicle<Body, Policy, BumpCourse> const>(pins, parts.drives, parts.options,
                                                                         parts.ground, links);
}

// Erases the types of links and pins of a vehicle. \param by list of the integrators that the vehicle's model supports
template <class V, class... Is>
AnyVehicle any_vehicle(std::shared_ptr<V const> const& vehicle, SteppedBy<Is...> by) {
  auto const& side = vehicle->side(m113::Side::left);
  return {vehicle, AnyModel(std::shared_ptr<typename V::ModelType const>(vehicle, &vehicle->model), by),
          side.pins[watched_pin].name, side.drive[0].name, [vehicle] { return m113::vehicle_visual(*vehicle); }};
}

}  // namespace chapter3
