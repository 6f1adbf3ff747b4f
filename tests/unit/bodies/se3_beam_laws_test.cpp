// Law tests of all bodies and of flexible bodies for Se3Beam, straight and curved.

#include <polybody/bodies/se3/se3_beam.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace se3_beam_laws_test {

struct Case {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Se3Beam body(Bar const& bar) { return Se3Beam::from(bar, 3); }
};
struct Elastic : Case {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
bool const beam = obeys<Case, BodyLaws>("Se3Beam");
bool const elastic = obeys<Elastic, FlexibleBodyLaws>("Se3Beam");

}  // namespace se3_beam_laws_test
}  // namespace polybody
