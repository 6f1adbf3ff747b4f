// Law tests of all bodies and of flexible bodies for the spatial Lrvf with direct interpolation of directors.

#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_director_laws_test {

template <class Quadrature>
struct Spinning {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Lrvf<Directors, Quadrature> body(Bar const& bar) { return Lrvf<Directors, Quadrature>::from(bar, 3); }
};
template <class Quadrature>
struct Elastic : Spinning<Quadrature> {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
};
bool const reduced = obeys<Spinning<ReducedQuadrature>, BodyLaws>("DirectorsLrvf");
bool const reduced_elastic = obeys<Elastic<ReducedQuadrature>, FlexibleBodyLaws>("DirectorsLrvf");
bool const selective = obeys<Spinning<SelectiveQuadrature>, BodyLaws>("SelectiveDirectorsLrvf");
bool const selective_elastic = obeys<Elastic<SelectiveQuadrature>, FlexibleBodyLaws>("SelectiveDirectorsLrvf");

}  // namespace lrvf_director_laws_test
}  // namespace polybody
