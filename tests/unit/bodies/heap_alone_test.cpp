// Absence of heap allocations in a step: every function of every body, with Eigen's check of its own allocations.
// This is a separate program, because the macros must be defined before the first header of Eigen.
#undef NDEBUG
#define EIGEN_RUNTIME_NO_MALLOC
#include <stdexcept>
#define eigen_assert(condition) \
  if (!(condition)) throw std::logic_error(#condition)

#include <gtest/gtest.h>

#include <array>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include "support/measured_sections.hpp"

namespace polybody {
namespace {

struct NoHeap {
  NoHeap() { Eigen::internal::set_is_malloc_allowed(false); }
  ~NoHeap() { Eigen::internal::set_is_malloc_allowed(true); }
  NoHeap(NoHeap const&) = delete;
  NoHeap& operator=(NoHeap const&) = delete;
};

template <Body B>
void expect_no_heap(B const& body) {
  constexpr int n = B::element_columns, np = B::point_columns;
  std::array<double, 32> q_memory{}, v_memory{}, out_memory{};
  std::span<double const> const q(q_memory.data(), std::size_t(body.coordinates()));
  std::span<double const> const v(v_memory.data(), std::size_t(body.velocities()));
  body.reference(std::span<double>(q_memory.data(), q.size()));
  body.rigid_velocity(q, Vec3(1, 2, 0), Vec3(0, 0, 3), std::span<double>(v_memory.data(), v.size()));
  auto const point = body.at(0.4, 0.01);
  Mat3 const axes = Mat3::Identity();
  Wrench<double> const wrench{Vec3(1, 2, 3), Vec3(4, 5, 6)};
  Mat<double, 6, 3> const wrenches = Mat<double, 6, 3>::Ones();
  VecX generalised(np);
  MatX matrix(np, 3);

  NoHeap const watch;
  Vec<double, n> x;
  Mat<double, n, n> m;
  Mat<double, np, np> k;
  std::array<double, 6 * np> jacobian;
  MarkerKinematics<double> published;
  published.jacobian = jacobian.data();
  EXPECT_NO_THROW({
    body.template plus<double>(q, v, std::span<double>(out_memory.data(), q.size()));
    body.template local_rate<double>(v, v, std::span<double>(out_memory.data(), v.size()));
    for (Index e = 0; e < body.elements(); ++e) {
      body.mass(e, q, m);
      body.template inertia<double>(e, q, v, x);
      body.template force<double>(e, q, v, x);
      body.tangent(e, q, v, 1.0, 1.0, m);
      body.template gravity<double>(e, q, Vec3(0, -9.81, 0), x);
      (void)(body.kinetic_energy(e, q, v) + body.strain_energy(e, q) + body.gravity_energy(e, q, Vec3::UnitY()));
    }
    body.template evaluate_marker<double>(point, axes, q, v, published);
    published.pull(wrenches, matrix);
    published.pull(wrenches.col(0), generalised);
    body.load_stiffness(point, q, wrench, k);
  });
}

Bar const bar{.length = 1.2,
              .section = Circle{.radius = 0.02},
              .material = Material{.density = 7800, .young = 2e11},
              .damping = {.axial = 1e-3, .shear = 1e-3, .bending = 1e-3}};

// Check of the check: an allocation is detected.
TEST(Heap, TheWatchSeesAnAllocation) {
  NoHeap const watch;
  EXPECT_THROW(VecX(100).setZero(), std::logic_error);
}

TEST(Heap, RigidTakesNone) { expect_no_heap(Rigid<>::from(bar)); }
TEST(Heap, PlanarRigidTakesNone) { expect_no_heap(planar::Rigid::from(bar)); }
TEST(Heap, SpatialLrvfTakesNone) {
  expect_no_heap(Lrvf<RelativeRotation>::from(bar, 3));
  expect_no_heap(Lrvf<Direct>::from(bar, 3));
  expect_no_heap(Lrvf<Polar>::from(bar, 3));
  expect_no_heap(Lrvf<Directors>::from(bar, 3));
  expect_no_heap(Lrvf<RelativeRotation, SelectiveQuadrature>::from(bar, 3));
}
TEST(Heap, Se3BeamTakesNone) { expect_no_heap(Se3Beam::from(bar, 3)); }
TEST(Heap, PlanarSe3BeamTakesNone) { expect_no_heap(planar::Se3Beam::from(bar, 3)); }
TEST(Heap, SectionsFromMatricesTakeNone) {
  Section6 section = composite().placed(0.02, -0.03);
  section.damping_times << 1e-3, 4e-3, 2e-3, 7e-3, 3e-3, 5e-3;
  Bar const measured{.length = 1.2, .section = section};
  expect_no_heap(Se3Beam::from(measured, 3));
  expect_no_heap(Lrvf<RelativeRotation>::from(measured, 3));
}
TEST(Heap, LrvfTakesNone) { expect_no_heap(planar::Lrvf::from(bar, 3)); }
TEST(Heap, GreenCableTakesNone) { expect_no_heap(planar::AncfCable<>::from(bar, 3)); }
TEST(Heap, EngineeringCableTakesNone) { expect_no_heap(planar::AncfCable<planar::EngineeringStrain>::from(bar, 3)); }

}  // namespace
}  // namespace polybody
