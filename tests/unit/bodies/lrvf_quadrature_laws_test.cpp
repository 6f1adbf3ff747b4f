// Law tests of all bodies and of flexible bodies for the quadratures of the spatial Lrvf other than the default.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_quadrature_laws_test {

template <class Interpolation, class Quadrature>
struct Spinning {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Lrvf<Interpolation, Quadrature> body(Bar const& bar) { return Lrvf<Interpolation, Quadrature>::from(bar, 3); }
};
template <class Interpolation, class Quadrature>
struct Elastic : Spinning<Interpolation, Quadrature> {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
bool const full = obeys<Spinning<RelativeRotation, FullQuadrature>, BodyLaws>("FullLrvf");
bool const full_elastic = obeys<Elastic<RelativeRotation, FullQuadrature>, FlexibleBodyLaws>("FullLrvf");
bool const selective = obeys<Spinning<RelativeRotation, SelectiveQuadrature>, BodyLaws>("SelectiveLrvf");
bool const selective_elastic = obeys<Elastic<RelativeRotation, SelectiveQuadrature>, FlexibleBodyLaws>("SelectiveLrvf");
bool const direct = obeys<Spinning<Direct, SelectiveQuadrature>, BodyLaws>("SelectiveDirectLrvf");
bool const direct_elastic = obeys<Elastic<Direct, SelectiveQuadrature>, FlexibleBodyLaws>("SelectiveDirectLrvf");

}  // namespace lrvf_quadrature_laws_test
}  // namespace polybody
