// refused: The axis of this body has kinks at its nodes
// The axis of linear elements is a chain of straight pieces.
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/shared/with_sliders.hpp>

bool sliders(polybody::WithSliders<polybody::planar::Lrvf> const& body) { return body.sliders() > 0; }
