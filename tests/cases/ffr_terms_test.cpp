// Simplifications of Wallin 2016, §4.3, one by one. The tests check the terms that each switch of `FfrTerms` omits,
// the tangent of each variant, and the conservation of energy.
#include <gtest/gtest.h>

#include <random>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/block_factor.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace ffr_terms_test {

Bar const bar{.length = 0.8,
              .constants = BarConstants{
                  .EA = 3e4, .EI = 6.0, .mass_per_length = 0.7, .GJ = 3.0, .rotary_inertia = 2e-3, .EI_y = 9.0}};

struct Switch {
  char const* name;
  bool FfrTerms::* of;
};
Switch const switches[] = {{"coupling", &FfrTerms::coupling},
                           {"onto_frame", &FfrTerms::onto_frame},
                           {"deformed_inertia", &FfrTerms::deformed_inertia},
                           {"frame_velocities", &FfrTerms::frame_velocities},
                           {"coriolis", &FfrTerms::coriolis},
                           {"centrifugal", &FfrTerms::centrifugal},
                           {"spin", &FfrTerms::spin}};
FfrTerms without(bool FfrTerms::* of) {
  FfrTerms terms;
  terms.*of = false;
  return terms;
}
FfrTerms const none{.coupling = false,
                    .onto_frame = false,
                    .deformed_inertia = false,
                    .frame_velocities = false,
                    .coriolis = false,
                    .centrifugal = false,
                    .spin = false};

template <class B>
B body(FfrTerms const& terms, bool stiffening = true) {
  return B::from(bar, 2, {.terms = terms, .frame = FfrFrame::clamped, .stiffening = stiffening});
}

/// Moving and deformed body: coordinates, velocities and accelerations.
template <class B>
struct Moved {
  static constexpr int frame = B::world == World::plane ? 3 : 7, velocities = B::world == World::plane ? 3 : 6;
  VecX q, v, a;

  explicit Moved(unsigned seed) {
    B const b = body<B>({});
    std::mt19937 engine(seed);
    auto const draw = [&](double size) { return std::uniform_real_distribution<>(-size, size)(engine); };
    q = VecX::Zero(b.coordinates());
    v = VecX::Zero(b.velocities());
    a = v;
    for (int i = 0; i < frame; ++i) q[i] = draw(1.0);
    if (frame == 7) q.segment<4>(3).normalize();
    for (Index i = frame; i < q.size(); ++i) q[i] = draw(0.02);
    for (double& x : v) x = draw(3.0);
    for (double& x : a) x = draw(5.0);
  }
};
std::span<double const> span(VecX const& x) { return {x.data(), std::size_t(x.size())}; }

/// M a − f without elastic forces; the equations of the frame come first.
template <class B>
VecX inertia_forces(FfrTerms const& terms, Moved<B> const& at) {
  B const b = body<B>(terms);
  MatX m;
  b.mass(0, span(at.q), m);
  VecX f(b.velocities()), ma = f, still = VecX::Zero(b.velocities()), elastic = f;
  b.template force<double>(0, span(at.q), span(at.v), f);
  b.template force<double>(0, span(at.q), span(still), elastic);
  b.template inertia<double>(0, span(at.q), span(at.a), ma);
  EXPECT_LT((ma - m * at.a).norm(), 1e-12 * ma.norm());
  return ma - (f - elastic);
}

/// Terms by their definition, from the integrals at q: Wallin 2016, Eqs. 4.1 and 4.2 with the omissions.
struct Terms {
  Mat3 A, J, J0, spin, j_rate = Mat3::Zero();
  Vec3 omega, c, c0, cd = Vec3::Zero(), cdd = cd, hd = cd, h = cd, rr, alpha;
  Mat<double, 3, Eigen::Dynamic> C, H;
  VecX xd, xdd;

  Terms(FfrIntegrals const& i, Moved<Ffr> const& at)
      : A(rotation_matrix<double>(at.q.segment<4>(3).eval())),
        J0(i.inertia),
        spin(skew<double>(at.v.segment<3>(3).eval())),
        omega(at.v.segment<3>(3)),
        c0(i.first),
        rr(at.a.head<3>()),
        alpha(at.a.segment<3>(3)),
        xd(at.v.tail(i.size())),
        xdd(at.a.tail(i.size())) {
    VecX const x = at.q.tail(i.size());
    FfrIntegrals::Moments<double> m;
    i.moments<double>(x.data(), m);
    c = m.c;
    J = m.J;
    C = H = MatX::Zero(3, i.size());
    for (Index k = 0; k < i.size(); ++k) {
      Vec3 ck, hk;
      i.columns<double>(x.data(), k, ck, hk);
      C.col(k) = ck;
      H.col(k) = hk;
    }
    cd = C * xd;
    h = H * xd;
    for (int p = 0; p < 3; ++p) {
      cdd[p] = -xd.dot(i.first_second[std::size_t(p)] * xd);
      hd[p] = xd.dot(i.coupling_by[std::size_t(p)] * xd);
    }
    // J˙ by a central difference along the motion, which is exact because J is quadratic in q
    FfrIntegrals::Moments<double> up, down;
    VecX const ahead = x + xd, behind = x - xd;
    i.moments<double>(ahead.data(), up);
    i.moments<double>(behind.data(), down);
    j_rate = 0.5 * (up.J - down.J);
  }
  VecX rows(Vec3 const& of_r, Vec3 const& of_turn, VecX const& of_q) const {
    VecX out(6 + xd.size());
    out << A * of_r, of_turn, of_q;
    return out;
  }
};

void expect_left_out(char const* what, FfrTerms const& terms, Moved<Ffr> const& at, VecX const& expected) {
  VecX const full = inertia_forces<Ffr>({}, at), left = inertia_forces<Ffr>(terms, at);
  EXPECT_LT((full - left - expected).norm(), 1e-11 * full.norm()) << what;
  EXPECT_GT(expected.norm(), 1e-4 * full.norm()) << what;
}

TEST(FfrTerms, EachSwitchLeavesOutItsTerms) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    Moved<Ffr> const at(seed);
    FfrIntegrals const i = body<Ffr>({}).integrals();
    Terms const t(i, at);
    Index const n = i.size();
    VecX const nothing = VecX::Zero(n);
    Vec3 const zero = Vec3::Zero(), along = t.A.transpose() * t.rr;
    Vec3 const velocities_r = 2.0 * t.spin * t.cd + t.cdd, velocities_turn = t.spin * t.h + t.hd;
    VecX const pulled = t.rows(t.C * t.xdd + velocities_r, t.H * t.xdd + velocities_turn, nothing);
    expect_left_out("onto_frame", without(&FfrTerms::onto_frame), at, pulled);
    expect_left_out("coupling", without(&FfrTerms::coupling), at,
                    pulled + t.rows(zero, zero, t.C.transpose() * along + t.H.transpose() * t.alpha));
    Vec3 const c = t.c - t.c0;
    Mat3 const J = t.J - t.J0;
    expect_left_out("deformed_inertia", without(&FfrTerms::deformed_inertia), at,
                    t.rows(t.alpha.cross(c) + t.spin * (t.spin * c),
                           c.cross(along) + J * t.alpha + t.spin * (J * t.omega) + t.j_rate * t.omega, nothing));
    expect_left_out("frame_velocities", without(&FfrTerms::frame_velocities), at,
                    t.rows(velocities_r, velocities_turn + t.j_rate * t.omega, nothing));
    VecX gyroscopic = nothing, spin = nothing, growing = nothing;
    VecX const x = at.q.tail(n);
    for (int p = 0; p < 3; ++p) {
      MatX const& m = i.coupling_by[std::size_t(p)];
      gyroscopic += t.omega[p] * (m - m.transpose()).transpose() * t.xd;
    }
    for (std::size_t p = 0; p < 6; ++p) {
      int const a = symmetric_row[p], b = symmetric_column[p];
      double const product = (a == b ? 0.5 : 1.0) * t.omega[a] * t.omega[b];
      spin -= product * i.inertia_by[p];
      growing -= 2.0 * product * i.inertia_second[p] * x;
    }
    expect_left_out("coriolis", without(&FfrTerms::coriolis), at, t.rows(zero, zero, gyroscopic));
    expect_left_out("spin", without(&FfrTerms::spin), at, t.rows(zero, zero, spin));
    expect_left_out("centrifugal", without(&FfrTerms::centrifugal), at, t.rows(zero, zero, growing));
  }
}

// The planar body agrees with the spatial body in the same motion.
TEST(FfrTerms, LeaveOutTheSameInThePlane) {
  for (Switch const& s : switches) {
    Moved<planar::Ffr> const flat(3);
    planar::Ffr const b = body<planar::Ffr>({});
    Ffr const in_space(Ffr::from(bar, 2, {.stiffening = true}).structure(),
                       nodal_coordinates(structure_of(bar, 2), ReferenceConditions::clamped().restrict_to_plane()),
                       {.terms = without(s.of), .stiffening = true});
    Index const n = b.deformations();
    ASSERT_EQ(in_space.deformations(), n);
    VecX q = VecX::Zero(7 + n), v = VecX::Zero(6 + n), a = v;
    q.head<2>() = flat.q.head<2>();
    q.segment<4>(3) << std::cos(0.5 * flat.q[2]), 0.0, 0.0, std::sin(0.5 * flat.q[2]);
    q.tail(n) = flat.q.tail(n);
    for (auto const& [from, to] : {std::pair(&flat.v, &v), {&flat.a, &a}}) {
      to->head<2>() = from->head<2>();
      (*to)[5] = (*from)[2];
      to->tail(n) = from->tail(n);
    }
    VecX f(6 + n), ma = f, still = VecX::Zero(6 + n), elastic = f;
    in_space.force<double>(0, span(q), span(v), f);
    in_space.force<double>(0, span(q), span(still), elastic);
    in_space.inertia<double>(0, span(q), span(a), ma);
    VecX const full = ma - (f - elastic), rows = inertia_forces<planar::Ffr>(without(s.of), flat);
    VecX expected(3 + n);
    expected << full.head<2>(), full[5], full.tail(n);
    EXPECT_LT((rows - expected).norm(), 1e-11 * rows.norm()) << s.name;
  }
}

template <class B>
void expect_tangents() {
  std::vector<FfrTerms> variants{{}, none};
  for (Switch const& s : switches) variants.push_back(without(s.of));
  for (bool const stiffening : {false, true})
    for (FfrTerms const& terms : variants) {
      B const b = body<B>(terms, stiffening);
      Moved<B> const at(7);
      Index const n = b.velocities();
      MatX k, expected(n, n);
      double const ck = 0.3, cd = 0.7, h = 1e-6;
      b.tangent(0, span(at.q), span(at.v), ck, cd, k);
      auto const force = [&](Index j, double by) {
        VecX q(b.coordinates()), v = at.v, delta = VecX::Zero(n), f(n);
        delta[j] = ck * by;
        v[j] += cd * by;
        if constexpr (B::world == World::plane)
          q = at.q + delta;
        else
          b.template plus<double>(span(at.q), span(delta), std::span<double>(q.data(), std::size_t(q.size())));
        b.template force<double>(0, span(q), span(v), f);
        return f;
      };
      for (Index j = 0; j < n; ++j) expected.col(j) = (force(j, -h) - force(j, h)) / (2.0 * h);
      EXPECT_LT((k - expected).norm(), 1e-7 * expected.norm());
    }
}
TEST(FfrTerms, TangentsAreThoseOfTheVariants) {
  expect_tangents<Ffr>();
  expect_tangents<planar::Ffr>();
}

/// Change of the energy of a free rotating body within 0.2 s, relative to its initial kinetic energy.
double defect(FfrTerms const& terms) {
  Bar stiff = bar;
  BarConstants c = *stiff.constants;
  c.EA = 3e5;
  c.EI = 400.0;
  c.EI_y = 600.0;
  c.GJ = 200.0;
  stiff.constants = c;
  Model<Bodies<Ffr>, Joints<>> model;
  model.add(Ffr::from(stiff, 2, {.terms = terms, .frame = FfrFrame::clamped, .stiffening = true}));
  State x = model.reference_state();
  x.v.head<6>() << 0.3, -0.2, 0.5, 4.0, 6.0, -3.0;
  x.v[7] = 0.4;
  x.v[13] = 0.3;
  System system(model);
  double const start = energy(system, x).total();
  simulate<BlockLu>(model, x, RungeKutta4<>{}, {.end_time = 0.2, .step = 1e-5}).run();
  return energy(system, x).total() / start - 1.0;
}
TEST(FfrTerms, WhatFollowsFromALagrangianConservesEnergy) {
  held({"closed forms", "energy of a free spinning Ffr, all terms, of the start's", By::closed_form, "it is constant",
        "Ffr, 12 coordinates, stiffening, RungeKutta4"},
       1.0 + defect({}), 1.0, 1e-8);
  held({"closed forms", "energy of a free spinning Ffr, no term of the coupling, of the start's", By::closed_form,
        "it is constant", "Ffr, 12 coordinates, stiffening, RungeKutta4"},
       1.0 + defect(none), 1.0, 1e-8);
  std::printf("energy after 0.2 s of a free spinning Ffr without one of its terms, of that at the start\n");
  for (Switch const& s : switches) {
    double const lost = defect(without(s.of));
    std::printf("  %-17s %+.2e\n", s.name, lost);
    if (s.of == &FfrTerms::coriolis)
      EXPECT_LT(std::abs(lost), 1e-8);  // W is skew-symmetric: these forces do no work
    else
      EXPECT_GT(std::abs(lost), 1e-7) << s.name;
  }
}

// Without any coupling the frame is a rigid body, and the deformation vibrates as in a frame at rest.
TEST(FfrTerms, WithoutCouplingTheFrameIsARigidBody) {
  Model<Bodies<Ffr>, Joints<>> model;
  auto const free = model.add(body<Ffr>(none));
  FfrIntegrals const i = free.body().integrals();
  Vec3 const centre = i.first / i.mass;
  Mat3 const about_centre =
      i.inertia - i.mass * (centre.squaredNorm() * Mat3::Identity() - centre * centre.transpose());
  Model<Bodies<Rigid<>>, Joints<>> twin;
  auto const rigid =
      twin.add(Rigid<>({.mass = i.mass, .inertia = about_centre, .placement = Placement::at(centre, {0, 0, 0})}));
  State x = model.reference_state(), y = twin.reference_state();
  Vec3 const omega(4.0, 6.0, -3.0);
  x.v.segment<3>(3) = omega;
  y.v.head<3>() = omega.cross(centre);
  y.v.segment<3>(3) = omega;
  simulate(model, x, RungeKutta4<>{}, {.end_time = 0.5, .step = 1e-5}).run();
  simulate(twin, y, RungeKutta4<>{}, {.end_time = 0.5, .step = 1e-5}).run();
  EXPECT_LT((position(model, x, free.at(0.4)) - position(twin, y, rigid.at(Vec3(0.4, 0, 0) - centre))).norm(), 1e-9);
  EXPECT_EQ(x.q.tail(i.size()).norm(), 0.0);
}

}  // namespace ffr_terms_test
