#pragma once
/// \file
/// M1: flexible four-bar mechanism with a misaligned hinge [Bauchau et al. 2016, Multibody Syst. Dyn. 37, 29–48]. Its
/// path of equilibria is compared with shooting on the exact rod equations.

#include "mechanism.hpp"
#include "support/misaligned_four_bar.hpp"

namespace polybody::long_cases {

struct FourBarRow {
  double t;
  Vec3 n, m;         ///< section forces at A
  double angles[3];  ///< θ_B, θ_C, φ_D
  double z;          ///< of the middle of BC
  Vec3 c;            ///< position of C
};
inline FourBarRow const four_bar_table[] = {{0.5,
                                             {2.7244, 13.2901, -99.5030},
                                             {21.86906, 1.05608, 1.56725},
                                             {0.2999408, -0.3000999, -0.3003933},
                                             -4.616446e-04,
                                             {0.27545376, 0.11463633, -1.014168e-03}},
                                            {1,
                                             {-2.6261, 27.9482, -230.1065},
                                             {45.86951, 20.26187, 3.26720},
                                             {0.5998058, -0.6001076, -0.6008907},
                                             -1.019265e-03,
                                             {0.30773726, 0.09902178, -2.043881e-03}},
                                            {1.5,
                                             {-19.5119, 41.1575, -395.0816},
                                             {63.40311, 60.28535, 4.82663},
                                             {0.8995484, -0.9001131, -0.9015588},
                                             -1.641887e-03,
                                             {0.33396981, 0.07453511, -3.023838e-03}},
                                            {2,
                                             {-56.7239, 46.9307, -575.3696},
                                             {62.61147, 113.90172, 5.56487},
                                             {1.1989664, -1.2004742, -1.2027047},
                                             -2.238402e-03,
                                             {0.35181124, 0.04330010, -3.834950e-03}},
                                            {2.4,
                                             {-159.2900, 42.1045, -692.9886},
                                             {43.81575, 150.88601, 5.03271},
                                             {1.4369128, -1.4425369, -1.4465912},
                                             -2.573781e-03,
                                             {0.35894186, 0.01497238, -4.223790e-03}},
                                            {2.8,
                                             {-187.3052, -41.3417, -704.1171},
                                             {8.21414, 165.51058, -4.96360},
                                             {1.8930100, -1.4647361, -1.2531695},
                                             -2.612820e-03,
                                             {0.35384836, 0.03755014, -4.210039e-03}},
                                            {3,
                                             {-93.4346, -44.8688, -654.9039},
                                             {-13.67574, 158.45799, -5.39205},
                                             {2.2349284, -1.3427500, -0.9094921},
                                             -2.497700e-03,
                                             {0.33452700, 0.07374434, -4.053580e-03}},
                                            {4,
                                             {-8.2535, -33.9803, -307.2760},
                                             {-50.80814, 60.70040, -4.04793},
                                             {3.4161361, -0.7417424, 0.2732638},
                                             -1.318706e-03,
                                             {0.20749426, 0.11547498, -2.397736e-03}},
                                            {5,
                                             {2.0490, -5.7007, -43.7000},
                                             {-11.50602, 3.77258, -0.67990},
                                             {3.9787779, -0.1416784, 0.8369658},
                                             -1.987463e-04,
                                             {0.15087162, 0.08034831, -4.295224e-04}},
                                            {6,
                                             {-15.2423, 14.2484, 104.7752},
                                             {31.48736, 7.48726, 1.76724},
                                             {4.3035330, 0.4589010, 1.1626569},
                                             5.039793e-04,
                                             {0.12988844, 0.04767547, 1.315285e-03}},
                                            {7,
                                             {-64.1607, 22.2777, 175.0707},
                                             {44.82742, 43.12960, 2.88931},
                                             {4.5373987, 1.0605832, 1.3981946},
                                             9.160198e-04,
                                             {0.12184064, 0.02067342, 2.786570e-03}},
                                            {7.5,
                                             {-159.4501, 22.1206, 181.9101},
                                             {37.47972, 60.51290, 2.87710},
                                             {4.6392907, 1.3643283, 1.5037468},
                                             1.025306e-03,
                                             {0.12033547, 0.00808854, 3.285308e-03}},
                                            {8.2,
                                             {-164.5616, -23.1825, 191.5514},
                                             {13.37596, 69.49832, -2.69644},
                                             {4.9181309, 1.3691676, 1.3671926},
                                             9.771350e-04,
                                             {0.12254984, 0.02430162, 3.271384e-03}},
                                            {10,
                                             {-8.4249, -10.2575, 72.7940},
                                             {-14.26075, 10.81613, -1.25359},
                                             {5.9999950, 0.2833922, 0.2835049},
                                             3.398944e-04,
                                             {0.20647340, 0.11521633, 8.993886e-04}},
                                            {11,
                                             {2.6609, 14.0910, -105.9254},
                                             {23.21815, 1.60676, 1.66042},
                                             {6.5999354, -0.3169171, -0.3172327},
                                             -4.905033e-04,
                                             {0.27737570, 0.11402339, -1.071959e-03}},
                                            {12,
                                             {-20.9171, 41.7492, -405.1331},
                                             {63.95526, 63.07450, 4.89841},
                                             {7.1995280, -0.9169328, -0.9184189},
                                             -1.677302e-03,
                                             {0.33521032, 0.07294037, -3.075281e-03}}};

/// Path of equilibria of the mechanism, whose crank turns by −0.6 rad/s.
template <class B>
struct FourBarPath : FourBar<B> {
  using FourBar<B>::model, FourBar<B>::ab, FourBar<B>::bc, FourBar<B>::cd, FourBar<B>::at_a, FourBar<B>::crank;
  State x = model.reference_state();

  FourBarPath(Mesh<B> const& mesh, Index n)
      : FourBar<B>(mesh, n, {[](double t) { return Motion{-0.6 * t, -0.6, 0.0}; }}) {}
  FourBarPath(FourBarPath const&) = delete;

  /// Follows the path to the crank angle at t, in steps of 0.8°, or 0.08° near the collinear configurations.
  void follow_to(double t) {
    double const degree = std::numbers::pi / 180.0 / 0.6;
    while (x.t < t) {
      double const off = std::remainder(x.t - 90.0 * degree, 180.0 * degree);
      x.t = std::min(t, x.t + (std::abs(off) < 3.5 * degree ? 0.08 : 0.8) * degree);
      equilibrium(model, x);
    }
  }
  /// N and M at A in the axes of the section: force and moment of the bar on the ground.
  Vec6 root() const {
    Wrench<> const pin = reaction(model, x, at_a), turn = reaction(model, x, crank);
    Mat3 const axes = frame(model, x, ab.at(0.0)).A;
    Vec6 out;
    out << axes.transpose() * (-pin.f - turn.f), axes.transpose() * (-pin.m - turn.m);
    return out;
  }
  /// θ_B, θ_C, φ_D near the angles of a row of the table.
  Vec3 angles(FourBarRow const& row) const {
    auto const turned = [&](auto const& marker) {
      return Mat3(frame(model, x, marker).A * frame(model, model.reference_state(), marker).A.transpose());
    };
    Vec3 const z = Vec3::UnitZ();
    Mat3 const b = turned(ab.at(0.12)).transpose() * turned(bc.at(0.0));
    Mat3 const c = turned(bc.at(0.24)).transpose() * turned(cd.at(0.0));
    return {angle_about(b, z, row.angles[0]), angle_about(c, this->lean, row.angles[1]),
            angle_about(turned(cd.at(0.12)), z, row.angles[2])};
  }
};

/// Two meshes and their extrapolation. \param ratio of their errors; \param tolerance of N₂, N₃ and M relative to
/// their size; N₁, which closes the loop in its plane, is ten times as sensitive, angles a hundred times less
template <class B>
void four_bar_follows(Mesh<B> const& mesh, Index n, double ratio, double tolerance) {
  FourBarPath<B> coarse(mesh, n), fine(mesh, 2 * n);
  std::string const name =
      mesh.name + ", " + std::to_string(n) + " and " + std::to_string(2 * n) + " elements on 0.12 m, extrapolated";
  auto const claim = [&](char const* what) {
    return Claim{"M1", what, By::independent, "shooting on the exact rod equations", name};
  };
  for (FourBarRow const& row : four_bar_table) {
    coarse.follow_to(row.t);
    fine.follow_to(row.t);
    Instance const at{equals("t", row.t)};
    auto const limit = [&](auto const& of) { return extrapolated(of(coarse), of(fine), ratio); };
    auto const force = [&](int i) { return limit([&](FourBarPath<B> const& m) { return m.root()[i]; }); };
    double const force_size = row.n.tail<2>().norm(), moment_size = row.m.norm();
    held(claim("N₁ at A [N]"), force(0), row.n[0], 10.0 * tolerance * std::max(20.0, std::abs(row.n[0])),
         {at.at, 20.0});
    for (int i : {1, 2}) {
      held(claim(i == 1 ? "N₂ at A [N]" : "N₃ at A [N]"), force(i), row.n[i], tolerance * force_size,
           {at.at, force_size});
    }
    for (int i = 0; i < 3; ++i)
      held(claim(i == 0   ? "M₁ at A [N m]"
                 : i == 1 ? "M₂ at A [N m]"
                          : "M₃ at A [N m]"),
           force(3 + i), row.m[i], tolerance * moment_size, {at.at, moment_size});
    for (int i = 0; i < 3; ++i)
      held(claim(i == 0   ? "θ_B [rad]"
                 : i == 1 ? "θ_C [rad]"
                          : "φ_D [rad]"),
           limit([&](FourBarPath<B> const& m) { return m.angles(row)[i]; }), row.angles[i], 0.01 * tolerance,
           {at.at, 1.0});
    held(claim("rise of the middle of BC [m]"),
         limit([&](FourBarPath<B> const& m) { return position(m.model, m.x, m.bc.at(0.12))[2]; }), row.z,
         tolerance * 2.6e-3, {at.at, 2.6e-3});
    Vec3 c;
    for (int i = 0; i < 3; ++i)
      c[i] = limit([&](FourBarPath<B> const& m) { return position(m.model, m.x, m.bc.at(0.24))[i]; });
    held_within(claim("place of C [m]"), (c - row.c).norm(), 0.0024 * tolerance, {at.at, 0.36});
  }
}

}  // namespace polybody::long_cases
