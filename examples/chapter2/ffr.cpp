#include <polybody/bodies/ffr/planar_ffr.hpp>

#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::floating_frames(Mechanism m) {
  std::string const model = "small deformation in a floating frame";
  std::vector<BodyOnPolicy> all = on_policies<planar::Ffr>(m, "ffr", model);
  for (BodyOnPolicy& one : on_policies<planar::Ffr, MeshKind::modes>(m, "ffr-modal", model))
    all.push_back(std::move(one));
  return all;
}
