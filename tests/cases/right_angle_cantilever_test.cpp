// Right-angle cantilever of Simo & Vu-Quoc 1988 (D5) by Lrvf and Se3Beam.

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include "support/right_angle_cantilever.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace right_angle_cantilever_test {

using namespace right_angle_cantilever;
using Rods = RightAngle<Lrvf<>>;
using Helices = RightAngle<Se3Beam>;

TEST(RightAngleCantilever, FourElementsPerLegStayWithinThreePercent) {
  follows<Rods>(4, 0.05, 0.03, "Lrvf, 4 elements a leg, h = 0.05 s");
  follows<Helices>(4, 0.05, 0.03, "Se3Beam, 4 elements a leg, h = 0.05 s");
}
TEST(RightAngleCantilever, TenElementsPerLegStayWithinHalfAPercent) {
  follows<Rods>(10, 0.05, 0.005, "Lrvf, 10 elements a leg, h = 0.05 s");
  follows<Helices>(10, 0.05, 0.005, "Se3Beam, 10 elements a leg, h = 0.05 s");
}

// Element and integrator are of order 2. (4 fine − coarse)/3 has no error of second order. The remaining error grows
// with time: to 5e-5 of the peaks at 15 s and 3e-4 at 30 s.
template <class Frame>
void extrapolates(std::string const& body) {
  Frame coarse(16, 0.02), fine(32, 0.01);
  for (Row const& row : table) {
    coarse.run_until(row.t).run();
    fine.run_until(row.t).run();
    Vec6 const limit = (4.0 * fine.displacements() - coarse.displacements()) / 3.0;
    std::string const meshes = body + ", 16 and 32 elements a leg extrapolated, up to 30 s";
    held_displacements(limit, row, row.t > 15.0 ? 3e-4 : 5e-5, meshes);
    if (row.t >= 2.0) held_energy((4.0 * fine.total_energy() - coarse.total_energy()) / 3.0, 2e-6, row.t, meshes);
  }
}
TEST(RightAngleCantilever, TwoMeshesExtrapolateToTheExactFrame) { extrapolates<Rods>("Lrvf"); }
TEST(RightAngleCantilever, TwoMeshesOfHelicesExtrapolateToTheExactFrame) { extrapolates<Helices>("Se3Beam"); }

// Extreme values of the motion and their times.
template <class Frame>
void has_the_peaks(std::string const& body) {
  struct Peak {
    int component;
    double sign, from, to, time, height;
    double found_time = 0.0, found = -1e9;
  };
  std::vector<Peak> peaks{{2, 1, 0, 11, 3.0985, 5.51285},   {2, -1, 8, 12, 10.863, -4.05996},
                          {5, 1, 0.5, 1.6, 1.201, 0.06201}, {5, -1, 1.3, 2.2, 1.745, 0.02770},
                          {5, 1, 5, 11, 7.4364, 8.25210},   {3, -1, 5, 8, 6.4135, -1.30250},
                          {3, 1, 0, 5, 3.2048, 0.82324},    {4, -1, 5, 9, 7.681, -2.67417}};
  Frame frame(32, 0.01);
  for (State const& now : frame.run_until(11.0)) {
    Vec6 const u = frame.displacements(now);
    for (Peak& p : peaks)
      if (now.t > p.from && now.t < p.to && p.sign * u[p.component] > p.found) {
        p.found = p.sign * u[p.component];
        p.found_time = now.t;
      }
  }
  for (Peak const& p : peaks) {
    double const peak = p.component < 3 ? elbow_peak : tip_peak;
    std::string const mesh = body + ", 32 elements a leg, h = 0.01 s";
    Instance const at{equals("t", p.time), peak};
    held(exact_frame("heights of eight extremes [m]", mesh), p.sign * p.found, p.height, 5e-4 * peak, at);
    held(exact_frame("times of eight extremes [s]", mesh), p.found_time, p.time, 0.02, at);
  }
}
TEST(RightAngleCantilever, PeaksHaveTheirHeightsAndTimes) {
  has_the_peaks<Rods>("Lrvf");
  has_the_peaks<Helices>("Se3Beam");
}

}  // namespace right_angle_cantilever_test
