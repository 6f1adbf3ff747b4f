// Law tests of bodies for the planar floating frame of reference.
#include <polybody/bodies/ffr/planar_ffr.hpp>

#include <polybody/testing/differences.hpp>
#include <polybody/testing/flexible_body_laws.hpp>

namespace polybody {
using namespace laws;
namespace planar_ffr_laws_test {

struct PlanarFfrCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 400.0, .EI = 30.0, .mass_per_length = 0.7, .rotary_inertia = 0.02},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.02, .bending = 0.01}};
  }
  static planar::Ffr body(Bar const& bar) { return planar::Ffr::from(bar, 2, {.stiffening = false}); }
};
struct StiffenedPlanarFfrCase : PlanarFfrCase {
  static constexpr double deformation = 0.2;  // second-order theory
  static planar::Ffr body(Bar const& bar) { return planar::Ffr::from(bar, 2, {.stiffening = true}); }
};

// A bar beside the origin of its frame: foreshortening moves mass perpendicular to u₀, and H˙ q̇ is not zero.
TEST(PlanarFfr, OfABarBesideTheOriginHasTheForcesOfTheBodyInSpace) {
  Bar const bar{.length = 1.3,
                .constants = BarConstants{.EA = 4e5, .EI = 30.0, .mass_per_length = 0.7, .GJ = 20.0},
                .placement = Placement::planar(0.4, 0.9, 0.3)};
  Structure const s = structure_of(std::vector{bar}, {2});
  MatX const shapes = nodal_coordinates(s, ReferenceConditions::clamped().restrict_to_plane());
  FfrOptions const options{.stiffening = true};
  planar::Ffr const plane(s, shapes, options);
  Ffr const space(s, shapes, options);
  Index const n = plane.deformations();
  MatX const& by = plane.integrals().coupling_by;
  EXPECT_GT((by + by.transpose()).norm(), 1e-3 * by.norm());
  laws::Numbers number;
  VecX q = VecX::Zero(3 + n), v(3 + n), a(3 + n), qs = VecX::Zero(7 + n), vs = VecX::Zero(6 + n), as = vs;
  for (Index i = 0; i < 3 + n; ++i) {
    v[i] = number();
    a[i] = number();
    if (i > 2) q[i] = 0.1 * number();
  }
  qs[3] = 1.0;
  qs.tail(n) = q.tail(n);
  vs.head<2>() = v.head<2>();
  as.head<2>() = a.head<2>();
  vs[5] = v[2];
  as[5] = a[2];
  vs.tail(n) = v.tail(n);
  as.tail(n) = a.tail(n);
  auto const span = [](VecX const& x) { return std::span<double const>(x.data(), std::size_t(x.size())); };
  auto const in_plane = [&](VecX const& f) {
    VecX out(3 + n);
    out << f[0], f[1], f[5], f.tail(n);
    return out;
  };
  VecX f(3 + n), m(3 + n), fs = VecX::Zero(6 + n), ms = fs;
  plane.force<double>(0, span(q), span(v), f);
  plane.inertia<double>(0, span(q), span(a), m);
  space.force<double>(0, span(qs), span(vs), fs);
  space.inertia<double>(0, span(qs), span(as), ms);
  EXPECT_LT((f - in_plane(fs)).norm(), 1e-12 * f.norm());
  EXPECT_LT((m - in_plane(ms)).norm(), 1e-12 * m.norm());
  MatX k;
  plane.tangent(0, span(q), span(v), 0.0, 1.0, k);
  for (Index j = 0; j < 3 + n; ++j) {  // forces are quadratic in v: central differences are exact
    VecX const e = VecX::Unit(3 + n, j), after = v + e, before = v - e;
    VecX next(3 + n), last(3 + n);
    plane.force<double>(0, span(q), span(after), next);
    plane.force<double>(0, span(q), span(before), last);
    EXPECT_LT((k.col(j) + 0.5 * (next - last)).norm(), 1e-9 * (1.0 + k.norm())) << j;
  }
}

bool const planar_ffr_laws_obey[] = {obeys<PlanarFfrCase, BodyLaws, FlexibleBodyLaws>("PlanarFfr"),
                                     obeys<StiffenedPlanarFfrCase, BodyLaws, FlexibleBodyLaws>("StiffenedPlanarFfr")};

}  // namespace planar_ffr_laws_test
}  // namespace polybody
