// accepted
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/shared/with_sliders.hpp>

bool sliders(polybody::WithSliders<polybody::planar::AncfCable<>> const& body) { return body.sliders() > 0; }
