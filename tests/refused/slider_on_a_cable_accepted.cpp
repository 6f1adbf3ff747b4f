// accepted
#include <polybody/bodies/planar/ancf_cable.hpp>
#include <polybody/bodies/sliding.hpp>

bool sliders(polybody::Sliding<polybody::planar::AncfCable<>> const& body) { return body.sliders() > 0; }
