// A part of the library m113_compiled: tracks at rest (see m113/compiled.hpp).
#include "../compiled.hpp"

namespace polybody {

template m113::TrackStart m113::settled_track(m113::VehicleOptions, FlatGround const&);
template m113::TrackStart m113::settled_track(m113::VehicleOptions, BumpCourse const&);

}  // namespace polybody
