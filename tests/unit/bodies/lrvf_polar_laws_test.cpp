// Law tests of all bodies and of flexible bodies for the spatial Lrvf with orthonormalised directors.

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/polar_interpolation.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_polar_laws_test {

template <class Quadrature>
struct Spinning {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Lrvf<Polar, Quadrature> body(Bar const& bar) { return Lrvf<Polar, Quadrature>::from(bar, 3); }
};
template <class Quadrature>
struct Elastic : Spinning<Quadrature> {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
bool const reduced = obeys<Spinning<ReducedQuadrature>, BodyLaws>("PolarLrvf");
bool const reduced_elastic = obeys<Elastic<ReducedQuadrature>, FlexibleBodyLaws>("PolarLrvf");
bool const selective = obeys<Spinning<SelectiveQuadrature>, BodyLaws>("SelectivePolarLrvf");
bool const selective_elastic = obeys<Elastic<SelectiveQuadrature>, FlexibleBodyLaws>("SelectivePolarLrvf");

}  // namespace lrvf_polar_laws_test
}  // namespace polybody
