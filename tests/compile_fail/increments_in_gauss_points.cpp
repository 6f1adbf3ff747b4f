// refused: stores one section per element, in its middle
// Rotation and strain are undefined between the nodes and the middle.
#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>

polybody::Lrvf<polybody::Incremental, polybody::FullQuadrature> const beam =
    polybody::Lrvf<polybody::Incremental, polybody::FullQuadrature>::from({.length = 1.0}, 2);
