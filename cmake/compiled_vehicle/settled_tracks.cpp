// A part of polybody::compiled_vehicle: tracks at rest (see polybody/compiled_vehicle.hpp).
#include <polybody/compiled_vehicle.hpp>

namespace polybody {

template m113::TrackStart m113::settled_track(m113::VehicleOptions, FlatGround const&);
template m113::TrackStart m113::settled_track(m113::VehicleOptions, BumpCourse const&);

}  // namespace polybody
