// refused: has corners at its nodes
// Linear elements: the axis is a chain of straight pieces.
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/shared/sliding.hpp>

bool sliders(polybody::Sliding<polybody::planar::Lrvf> const& body) { return body.sliders() > 0; }
