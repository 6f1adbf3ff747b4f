#pragma once
/// \file
/// "Decoupled" stress: stress of a recorded rigid body, computed after the run [Wallin 2016, §4.3.5].
/// Theory: Eqs. 11.14 to 11.16, 11.19.

#include <polybody/bodies/ffr/attachment_modes.hpp>
#include <polybody/bodies/shared/sections.hpp>
#include <polybody/stress/structure_vibration.hpp>

namespace polybody {

// Stress at a point of a bar's section from the section forces (N, Q_y, Q_z, M_x, M_y, M_z) of
// bodies/shared/sections.hpp; principal stresses and von Mises stress. Saint-Venant's theory is used, which is valid
// away from the ends and from point loads.

/// Stress at a point of the cross section of a bar.
struct SectionStress {
  double axial = 0.0;         ///< σ_x [N/m²]
  Vec2 shear = Vec2::Zero();  ///< (τ_xy, τ_xz) [N/m²]

  /// Principal stresses σ₁ ≥ 0 ≥ σ₃, σ/2 ± √((σ/2)² + τ²) [N/m²]; the middle one is zero.
  Vec2 principal() const {
    double const half = 0.5 * axial, radius = std::hypot(half, shear.norm());
    return {half + radius, half - radius};
  }
  /// Von Mises stress √(σ² + 3 τ²) [von Mises 1913].
  double von_mises() const { return std::hypot(axial, std::sqrt(3.0) * shear.norm()); }
};

namespace detail {

/// Shear stress in a circular section of radius r, with Poisson's ratio ν, I = π r⁴/4 and I_p = 2 I. Torque: τ = M_x
/// (−z, y)/I_p. Force P along x of section axes x, y [Timoshenko & Goodier 1970, §121]:
///   τ_x = (3+2ν)/(8(1+ν)) P/I (r² − x² − (1−2ν)/(3+2ν) y²),   τ_y = −(1+2ν)/(4(1+ν)) P/I x y.
inline Vec2 shear_of(Circle const& c, double nu, Vec6 const& n, double y, double z) {
  double const r2 = c.radius * c.radius, i = 0.25 * std::numbers::pi * r2 * r2;
  double const k = (3.0 + 2.0 * nu) / (8.0 * (1.0 + nu)) / i, ratio = (1.0 - 2.0 * nu) / (3.0 + 2.0 * nu),
               across = -(1.0 + 2.0 * nu) / (4.0 * (1.0 + nu)) / i * y * z;
  return Vec2(-z, y) * (0.5 * n[3] / i) + Vec2(n[1] * k * (r2 - y * y - ratio * z * z) + n[2] * across,
                                               n[2] * k * (r2 - z * z - ratio * y * y) + n[1] * across);
}

/// Shear stress in a rectangular section of height h, width w and area A. Force Q along y: 3/2 Q/A (1 − (2y/h)²), exact
/// for Poisson's ratio ν = 0. Torque: τ = (φ_z, −φ_y),
///   φ = Gϑ [h²/4 − y² − (8h²/π³) Σ_odd (−1)^((k−1)/2)/k³ · cosh(kπz/h)/cosh(kπw/2h) · cos(kπy/h)],   Gϑ = M_x/J
/// [Timoshenko & Goodier 1970, §109]. The axis y is parallel to the shorter side, so that the series converges fast.
inline Vec2 shear_of(Rectangle const& s, double torsion, Vec6 const& n, double y, double z) {
  double const area = s.height * s.width, pi = std::numbers::pi;
  bool const swap = s.height > s.width;
  double const h = swap ? s.width : s.height, w = swap ? s.height : s.width, a = swap ? z : y, b = swap ? y : z;
  double by_a = -2.0 * a, by_b = 0.0;  // derivatives of φ/Gϑ
  for (int k = 1; k < 60; k += 2) {
    double const p = k * pi / h, sign = (k - 1) % 4 == 0 ? 1.0 : -1.0,
                 scale = sign * 8.0 * h * h / (pi * pi * pi) / std::pow(k, 3);
    double const up = std::exp(p * (std::abs(b) - 0.5 * w)), down = std::exp(-p * (std::abs(b) + 0.5 * w)),
                 full = 1.0 + std::exp(-p * w);
    by_a += scale * p * (up + down) / full * std::sin(p * a);
    by_b -= scale * p * std::copysign(up - down, b) / full * std::cos(p * a);
  }
  Vec2 const turn = (n[3] / torsion) * (swap ? Vec2(by_a, -by_b) : Vec2(by_b, -by_a));
  auto const parabola = [&](double q, double x, double side) {
    return 1.5 * q / area * (1.0 - 4.0 * x * x / (side * side));
  };
  return turn + Vec2(parabola(n[1], y, s.height), parabola(n[2], z, s.width));
}

}  // namespace detail

/// Stress at the point (y, z) [m] of the section under section `forces` (N, Q_y, Q_z, M_x, M_y, M_z) [N], [N m].
/// \throws InvalidInput for a bar given by constants, and for a point outside the section.
template <class = void>
SectionStress section_stress(Bar const& bar, Vec6 const& forces, double y, double z) {
  SectionStress out;
  out.axial = fibre_stress(bar, forces, y, z);
  if (auto const* c = std::get_if<Circle>(&bar.section)) {
    if (!(std::hypot(y, z) <= c->radius * (1.0 + 1e-9)))
      throw InvalidInput("section.outside",
                         {ErrorObject{"section_stress"}, ": the point (", y, ", ", z, ") m lies outside the circle."});
    out.shear = detail::shear_of(*c, bar.material->poisson, forces, y, z);
  } else {
    Rectangle const& s = std::get<Rectangle>(bar.section);
    if (!(std::abs(y) <= 0.5 * s.height * (1.0 + 1e-9) && std::abs(z) <= 0.5 * s.width * (1.0 + 1e-9)))
      throw InvalidInput("section.outside", {ErrorObject{"section_stress"}, ": the point (", y, ", ", z,
                                             ") m lies outside the rectangle."});
    BarConstants const k = constants(bar);
    double const g = bar.material->young / (2.0 * (1.0 + bar.material->poisson));
    out.shear = detail::shear_of(s, k.GJ / g, forces, y, z);
  }
  return out;
}

namespace detail {

/// Mass points (see `mass_points`) of the part of a beam from its start to ξ.
template <class = void>  // compiled where it is used
std::array<MassPoint, 4> mass_points_before(Structure const& s, Structure::Beam const& beam, double xi) {
  std::array<MassPoint, 4> points;
  for (std::size_t i = 0; i < 4; ++i)
    points[i] = mass_point(s, beam, gauss<4>[i].xi * xi, gauss<4>[i].weight * xi * beam.length);
  return points;
}

}  // namespace detail

/// Histories of section forces, strains and stresses of a recorded rigid body (body_record.hpp), at the times of the
/// record. The deformation solves the linear problem [Wallin 2016, §4.3.5]
///   M q̈ + D q̇ + K q = Q_f − m_fr q̈_r − C_qfᵀ λ
/// with the right-hand side of structure_loads.hpp, by any integrator, in nodal or modal coordinates e = Φ q. The
/// deformation has no effect on the recorded motion.
///
/// Only the accelerations q̈ of the solution are used, or q, q̇ and q̈ if `Vibration::follows_deformation` is true. K e
/// = Q − M Φ q̈, with the nodal loads Q, yields all nodal displacements e. The forces in a beam follow from the forces
/// at its ends and the loads along it by equilibrium. The stress of static loads is then exact in every section, for
/// any number of elements and modes ("mode acceleration" [Williams 1945]).
///
/// Example of a filtered history (signals/filter.hpp):
///   low_pass(stress.times(), stress.axial_strain(0.1), {.cut_off = 15.0})
class DecoupledStress {
 public:
  /// Quasi-static stress from K e = Q at each sample. The result is valid if the loads change slowly compared with the
  /// structure's vibrations. The stress is independent of `frame`, because recorded loads are balanced. The
  /// displacements are relative to `frame`.
  /// \throws InvalidInput like `StructureLoads`, for a structure with pretension, and for a frame that restrains some,
  /// but not all rigid motions.
  template <class = void>
  static DecoupledStress quasi_static(Structure structure, BodyRecord const& record,
                                      StructureLoadOptions const& options = {},
                                      ReferenceConditions const& frame = ReferenceConditions::none());
  /// Stress with vibrations, computed with the options `how`. \throws InvalidInput like `StructureLoads` and
  /// `vibration_of`, and for a structure with pretension. Exceptions of the integrator are passed on.
  template <LinearSolver Solver = DenseLu, class I>
  static DecoupledStress vibrating(Structure structure, BodyRecord const& record, I const& integrator,
                                   Vibration const& how, StructureLoadOptions const& options = {});

  std::vector<double> const& times() const { return loads_.times(); }  ///< times of the samples [s]
  StructureLoads const& loads() const { return loads_; }               ///< loads on the structure
  /// Nodal displacements (N×samples) in the structure's axes [m], [rad]. With damping these are the static
  /// displacements under the elastic and damping forces.
  MatX const& displacements() const { return e_; }

  /// Section forces (N, Q_y, Q_z, M_x, M_y, M_z) [N], [N m] at arc length s [m] of bar number `bar`, counted from 0
  /// (see sections.hpp), including damping forces. If a load acts at this section, the values just beyond the load are
  /// returned. At the end of the bar, the values just before the load are returned. \throws InvalidInput outside the
  /// bar, and for a structure without bars.
  template <class = void>
  std::vector<Vec6> section_forces(double s, Index bar = 0) const {
    auto const [index, xi] = locate(s, bar);
    Structure const& structure = loads_.structure();
    Structure::Beam const& beam = structure.beams[std::size_t(index)];
    bool const last = xi == 1.0;
    Vec3 const start = structure.nodes[std::size_t(beam.a)], cut = start + beam.axes.col(0) * (xi * beam.length);
    auto const full = mass_points(structure, beam), before = detail::mass_points_before(structure, beam, xi);
    BeamMatrix const stiff = beam_stiffness(beam, section_stiffness(beam));
    std::vector<Vec6> out;
    for (std::size_t i = 0; i < times().size(); ++i) {
      Local const at = local(beam, i);
      Vec<double, 12> ends = stiff * at.e;  // forces of the other parts of the structure on the beam's ends
      for (MassPoint const& g : full) {
        auto const a = acceleration(at, g);
        ends += g.m * (g.axis.transpose() * a[0]);
        for (std::size_t k = 0; k < 3; ++k) ends += g.spread[k].w * (g.spread[k].turning.transpose() * a[k + 1]);
      }
      for (StructureLoads::Load const& l : loads_.loads(i))
        if (l.beam == index) ends -= loads_.on_beam(l);
      Vec3 force = ends.head<3>(), moment = ends.segment<3>(3) + (start - cut).cross(ends.head<3>());
      for (MassPoint const& g : before) {
        auto const a = acceleration(at, g);
        force -= g.m * a[0];
        moment -= (g.at - cut).cross(g.m * a[0]);
        for (std::size_t k = 0; k < 3; ++k) moment -= g.spread[k].w * g.spread[k].direction.cross(a[k + 1]);
      }
      for (StructureLoads::Load const& l : loads_.loads(i))
        if (l.beam == index && (last ? l.xi < 1.0 - same : l.xi <= xi + same)) {
          force += l.f;
          moment += l.m + (start + beam.axes.col(0) * (l.xi * beam.length) - cut).cross(l.f);
        }
      Vec6 n;
      n << beam.axes.transpose() * force, beam.axes.transpose() * moment;
      out.push_back(-n);
    }
    return out;
  }

  /// Axial strain [1] of the fibre (y, z) [m] at arc length s [m] of bar number `bar`, N/EA − y M_z/EI + z M_y/EI_y, or
  /// ε − y κ_z + z κ_y with the strains of a section by matrices.
  /// With damping this is the static strain under `section_forces`. \throws InvalidInput like `section_forces`.
  template <class = void>
  std::vector<double> axial_strain(double s, double y = 0.0, double z = 0.0, Index bar = 0) const {
    Structure::Beam const& beam = loads_.structure().beams[std::size_t(locate(s, bar).first)];
    BarConstants const& c = beam.constants;
    std::vector<double> out;
    for (Vec6 const& n : section_forces(s, bar))
      if (beam.section) {
        Vec6 const strains = section_stiffness(beam).llt().solve(n);
        out.push_back(strains[0] - y * strains[5] + z * strains[4]);
      } else {
        out.push_back(n[0] / c.EA - y * n[5] / c.EI + z * n[4] / c.EI_y.value_or(c.EI));
      }
    return out;
  }
  /// Axial stress [N/m²] of the fibre (y, z) [m] at arc length s [m] of bar number `bar`, with the section and material
  /// of the bar `of`. \throws InvalidInput like `section_forces`, and for a bar given by constants.
  template <class = void>
  std::vector<double> axial_stress(Bar const& of, double s, double y = 0.0, double z = 0.0, Index bar = 0) const {
    std::vector<double> out;
    for (Vec6 const& n : section_forces(s, bar)) out.push_back(fibre_stress(of, n, y, z));
    return out;
  }
  /// Axial and shear stress at the point (y, z) [m] of the section at arc length s [m] of bar number `bar`, with the
  /// section and material of the bar `of`. The result yields the principal stresses and the von Mises stress. \throws
  /// InvalidInput like `section_forces` and `section_stress`.
  template <class = void>
  std::vector<SectionStress> stress(Bar const& of, double s, double y, double z, Index bar = 0) const {
    std::vector<SectionStress> out;
    for (Vec6 const& n : section_forces(s, bar)) out.push_back(section_stress(of, n, y, z));
    return out;
  }

 private:
  static constexpr double same = 1e-9;  ///< largest difference of ξ between a load and a section at the same position

  /// State of one beam at one sample: nodal displacements of its ends and their time derivatives (12).
  struct Local {
    StructureLoads::Motion const& motion;
    Vec<double, 12> e, deformed, rate, acceleration;
  };

  template <class = void>
  explicit DecoupledStress(StructureLoads loads) : loads_(std::move(loads)) {
    if (!loads_.structure().initial_force.isZero(0.0))
      throw InvalidInput("stress.pretension",
                         {"Stress of \"", ErrorObject{loads_.name()},
                          "\": the stress of a pretension is not computed. Define the structure "
                          "without the pretension, and add the stress of the pretension to the result."});
  }

  /// Solves K e = loads with the restraints of `frame`. If these permit a rigid motion, the restraints of
  /// `statically_determinate` are used.
  template <class = void>
  void settle(ReferenceConditions const& frame, MatX const& loads) {
    Structure const& s = loads_.structure();
    std::vector<Index> free = frame.free_coordinates(s);
    bool const loose = Index(free.size()) == s.size();  // without restraints, zero pivots are round-off of either sign
    SparseFactor factor;
    if (!loose) factor.compute(submatrix(s.stiffness, free, free));
    if (loose || factor.info() != Eigen::Success ||
        !(factor.vectorD().minCoeff() > 1e-13 * factor.vectorD().maxCoeff())) {
      free = statically_determinate(s, frame).free_coordinates(s);
      factor_positive(factor, submatrix(s.stiffness, free, free),
                      "parts of the held structure move without strain. Connect them.");
    }
    MatX rhs(Index(free.size()), loads.cols());
    for (std::size_t i = 0; i < free.size(); ++i) rhs.row(Index(i)) = loads.row(free[i]);
    e_ = scatter_rows(factor.solve(rhs), free, s.size());
  }

  template <class = void>
  std::pair<Index, double> locate(double s, Index bar) const {
    Structure const& structure = loads_.structure();
    std::string const who = sentence_of({"Stress of \"", loads_.name(), "\""});
    if (bar < 0 || bar >= Index(structure.bar_lengths.size()))
      throw InvalidInput("ffr.no_bar",
                         {ErrorObject{who}, ": bar ", ErrorValue{bar}, " does not exist; the structure has ",
                          structure.bar_lengths.size(), " bars, counted from 0."});
    double const inside = require_inside(s, structure.bar_lengths[std::size_t(bar)], who);
    Index found = -1;
    for (std::size_t i = 0; i < structure.beams.size(); ++i) {
      Structure::Beam const& b = structure.beams[i];
      if (b.bar == bar && (found < 0 || b.start <= inside + same * b.length)) found = Index(i);
    }
    Structure::Beam const& b = structure.beams[std::size_t(found)];
    double const xi = std::clamp((inside - b.start) / b.length, 0.0, 1.0);
    return {found, xi > 1.0 - same ? 1.0 : xi};
  }

  template <class = void>
  Local local(Structure::Beam const& beam, std::size_t sample) const {
    auto const of = [&](MatX const& m) {
      Vec<double, 12> x = Vec<double, 12>::Zero();
      for (int j = 0; j < 12 && m.size() > 0; ++j) x[j] = m(6 * (j < 6 ? beam.a : beam.b) + j % 6, Index(sample));
      return x;
    };
    return {loads_.motion(sample), of(e_), of(vibration_.deformed), of(vibration_.rate), of(vibration_.acceleration)};
  }

  /// Acceleration minus gravity at the centre of mass, and its derivatives along the directions of the moments of mass.
  template <class = void>
  std::array<Vec3, 4> acceleration(Local const& x, MassPoint const& g) const {
    Mat3 const& B = x.motion.B;
    std::array<Vec3, 4> a;
    for (std::size_t i = 0; i < 4; ++i) {
      Mat<double, 3, 12> const& shapes = i == 0 ? g.axis : g.spread[i - 1].turning;
      a[i] = i == 0 ? Vec3(x.motion.b + B * g.at) : Vec3(B * g.spread[i - 1].direction);
      a[i] += shapes * x.acceleration + B * (shapes * x.deformed) + 2.0 * x.motion.omega.cross(shapes * x.rate);
    }
    return a;
  }

  StructureLoads loads_;
  VibrationHistory vibration_;
  MatX e_;  ///< (N×samples)
};

template <class>
DecoupledStress DecoupledStress::quasi_static(Structure structure, BodyRecord const& record,
                                              StructureLoadOptions const& options, ReferenceConditions const& frame) {
  DecoupledStress out(StructureLoads(std::move(structure), record, options));
  Structure const& s = out.loads_.structure();
  std::vector<Index> const free = frame.free_coordinates(s);
  if (Index(free.size()) < s.size()) require_held(submatrix(s.stiffness, free, free));
  out.settle(frame, out.loads_.nodal());
  return out;
}

template <LinearSolver Solver, class I>
DecoupledStress DecoupledStress::vibrating(Structure structure, BodyRecord const& record, I const& integrator,
                                           Vibration const& how, StructureLoadOptions const& options) {
  DecoupledStress out(StructureLoads(std::move(structure), record, options));
  out.vibration_ = vibration_of<Solver>(out.loads_, integrator, how);
  out.settle(how.frame, out.loads_.nodal() - out.vibration_.inertia(out.loads_));
  return out;
}

}  // namespace polybody
