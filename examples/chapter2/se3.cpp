#include <polybody/se3_beam.hpp>

#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::helicoidal_beams(Mechanism m) {
  return on_policies<planar::Se3Beam>(m, "se3", "rigid sections");
}
std::vector<chapter2::BodyOnPolicy> chapter2::spatial_helicoidal_beams(Mechanism m) {
  return on_policies<Se3Beam>(m, "se3-space", "rigid sections");
}
