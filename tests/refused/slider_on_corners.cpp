// refused: has corners at its nodes
// The axis of linear elements is a chain of straight pieces.
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/shared/sliding.hpp>

bool sliders(polybody::Sliding<polybody::planar::Lrvf> const& body) { return body.sliders() > 0; }
