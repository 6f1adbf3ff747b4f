// accepted
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/shared/sliding.hpp>

bool sliders(polybody::Sliding<polybody::planar::AncfCable<>> const& body) { return body.sliders() > 0; }
