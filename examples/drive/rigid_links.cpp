#include <polybody/polybody.hpp>

#include "vehicles.hpp"

drive::DrivenVehicle drive::rigid_links(Throttles const& throttles, m113::VehicleOptions const& options,
                                        BumpCourse const& ground) {
  return driven<Rigid<>, Constraint>(throttles, options, ground);
}
