// Law tests of all bodies and of flexible bodies for the spatial Lrvf with direct interpolation of rotation vectors.
// Three of them concern rigid motions of a bent body and fail. lrvf_direct_test.cpp measures the errors.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_direct_laws_test {

struct DirectLrvfCase {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Lrvf<Direct> body(Bar const& bar) { return Lrvf<Direct>::from(bar, 3); }
};
bool const lrvf_direct_laws_obeys = obeys<DirectLrvfCase, BodyLaws>("DirectLrvf");

struct ElasticDirectCase : DirectLrvfCase {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
bool const lrvf_direct_laws_elastic_obeys = obeys<ElasticDirectCase, FlexibleBodyLaws>("DirectLrvf");

}  // namespace lrvf_direct_laws_test
}  // namespace polybody
