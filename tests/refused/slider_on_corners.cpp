// refused: has corners at its nodes
// Linear elements: the axis is a chain of straight pieces.
#include <polybody/bodies/planar/lrvf.hpp>
#include <polybody/bodies/sliding.hpp>

bool sliders(polybody::Sliding<polybody::planar::Lrvf> const& body) { return body.sliders() > 0; }
