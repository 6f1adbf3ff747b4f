// Law tests of all bodies and of flexible bodies for the spatial Lrvf.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_laws_test {

struct SpatialLrvfCase {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Lrvf<> body(Bar const& bar) { return Lrvf<>::from(bar, 3); }
};
bool const lrvf_laws_obeys = obeys<SpatialLrvfCase, BodyLaws>("SpatialLrvf");

struct ElasticLrvfCase : SpatialLrvfCase {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
bool const lrvf_laws_elastic_obeys = obeys<ElasticLrvfCase, FlexibleBodyLaws>("SpatialLrvf");

}  // namespace lrvf_laws_test
}  // namespace polybody
