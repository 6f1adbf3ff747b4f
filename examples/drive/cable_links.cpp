#include <polybody/polybody.hpp>

#include "vehicles.hpp"

drive::DrivenVehicle drive::cable_links(Throttles const& throttles, m113::VehicleOptions const& options,
                                        BumpCourse const& ground) {
  return driven<AncfCable<>, AncfLinear>(throttles, options, ground);
}
