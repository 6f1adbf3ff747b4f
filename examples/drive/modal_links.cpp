#include <polybody/polybody.hpp>

#include "m113/modal_links.hpp"
#include "vehicles.hpp"

drive::DrivenVehicle drive::modal_links(Throttles const& throttles, m113::VehicleOptions const& options,
                                        BumpCourse const& ground) {
  return driven<Ffr, Constraint>(throttles, options, ground);
}
