#pragma once
/// \file
/// Elastic force of the fully parameterised ANCF beam by three-dimensional continuum mechanics.
/// Theory: Eqs. 2.41 to 2.46.

#include <tuple>

#include <polybody/bodies/ancf/ancf_field.hpp>
#include <polybody/bodies/ancf/mean_section_frame.hpp>
#include <polybody/bodies/shared/strain_group.hpp>

namespace polybody {

namespace ancf {

/// Base class of strains that depend on `used` columns f of the deformation gradient F, and thereby on all nodal
/// vectors.
template <int used>
struct OfGradient {
  static constexpr int components = 3;
  static constexpr int parameters = 3 * used;
  static constexpr int reach = vectors - 1;
  static constexpr int difference = vectors / 2;
  static constexpr int vector(int, int j) { return j + 1; }
  /// Factors N of the map P (`StrainMap`) to the columns `which` of F, from the gradients `g` of the shape functions.
  static Mat<double, used, vectors - 1> map(Mat<double, vectors, 3> const& g, std::array<int, used> const& which) {
    Mat<double, used, vectors - 1> n;
    for (int v = 1; v < vectors; ++v)
      for (int s = 0; s < used; ++s) n(s, v - 1) = g(v, which[std::size_t(s)]);
    return n;
  }
};

/// Axial Green strain E₁₁ = ½ (f₁·f₁ − 1), with p = f₁.
struct AlongStrain : OfGradient<1> {
  static constexpr int points = 12;
  static constexpr int strains = 1;

  template <KernelScalar T>
  static void evaluate(Vec<T, 3> const& p, Vec<T, 1>& strain, Mat<T, 1, 3>& b) {
    strain[0] = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * 0.5 - 0.5;
    for (int i = 0; i < 3; ++i) b(0, i) = p[i];
  }
  template <KernelScalar T>
  static void add_hessian(Vec<T, 1> const& n, Mat<T, 1, 1>& s) {
    s(0, 0) += n[0];
  }
};

/// Shear strains (2E₁₂, 2E₁₃) = (f₁·f₂, f₁·f₃), with p = (f₁, f₂, f₃).
struct ShearStrains : OfGradient<3> {
  static constexpr int points = 12;
  static constexpr int strains = 2;

  template <KernelScalar T>
  static void evaluate(Vec<T, 9> const& p, Vec<T, 2>& strain, Mat<T, 2, 9>& b) {
    for (int j = 0; j < 2; ++j) {
      int const f = 3 + 3 * j;
      strain[j] = p[0] * p[f] + p[1] * p[f + 1] + p[2] * p[f + 2];
      for (int i = 0; i < 3; ++i) {
        b(j, i) = p[f + i];
        b(j, f + i) = p[i];
        b(j, 6 - 3 * j + i) = T(0.0);
      }
    }
  }
  template <KernelScalar T>
  static void add_hessian(Vec<T, 2> const& n, Mat<T, 3, 3>& s) {
    for (int j = 0; j < 2; ++j) {
      s(0, 1 + j) += n[j];
      s(1 + j, 0) += n[j];
    }
  }
};

/// Green strains (tr E, E₁₁, E₂₂, E₃₃, 2E₂₃, 2E₁₃, 2E₁₂), with p = (f₁, f₂, f₃).
template <int at_points>
struct GreenStrains : OfGradient<3> {
  static constexpr int points = at_points;
  static constexpr int strains = 7;

  template <KernelScalar T>
  static void evaluate(Vec<T, 9> const& p, Vec<T, 7>& strain, Mat<T, 7, 9>& b) {
    for (int i = 0; i < 7; ++i)
      for (int k = 0; k < 9; ++k) b(i, k) = T(0.0);
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;  // shear in the plane normal to axis i
      strain[1 + i] = T(-0.5);
      strain[4 + i] = T(0.0);
      for (int a = 0; a < 3; ++a) {
        strain[1 + i] += p[3 * i + a] * p[3 * i + a] * 0.5;
        strain[4 + i] += p[3 * j + a] * p[3 * k + a];
        b(0, 3 * i + a) = b(1 + i, 3 * i + a) = p[3 * i + a];
        b(4 + i, 3 * j + a) = p[3 * k + a];
        b(4 + i, 3 * k + a) = p[3 * j + a];
      }
    }
    strain[0] = strain[1] + strain[2] + strain[3];
  }
  template <KernelScalar T>
  static void add_hessian(Vec<T, 7> const& n, Mat<T, 3, 3>& s) {
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      s(i, i) += n[0] + n[1 + i];
      s(j, k) += n[4 + i];
      s(k, j) += n[4 + i];
    }
  }
};

}  // namespace ancf

/// Treatment of locking in a `Continuum` beam: the element locks (`present`), or does not (`cured`).
enum class Locking { present, cured };

namespace ancf {

/// Strain groups of a `Continuum` by name. A declaration of `Continuum` alone compiles none of them.
template <Locking>
struct ContinuumGroups;
/// All strains at the points of the volume.
template <>
struct ContinuumGroups<Locking::present> {
  using Number = double;                         ///< scalar type of the stiffness and the damping times
  using Volume = StrainGroup<GreenStrains<12>>;  ///< all strains at 12 points
  using type = std::tuple<Volume>;               ///< the groups of an element
};
/// Axial strain and shear strains at points of the volume; the other strains on the axis.
template <>
struct ContinuumGroups<Locking::cured> {
  using Number = double;                          ///< scalar type of the stiffness and the damping times
  using Along = StrainGroup<AlongStrain>;         ///< E₁₁ at 12 points
  using Shear = StrainGroup<ShearStrains>;        ///< 2E₁₂, 2E₁₃ at 12 points, see `Continuum::lever`
  using Across = StrainGroup<GreenStrains<2>>;    ///< the other terms of Hooke's law, on the axis at both nodes
  using type = std::tuple<Along, Shear, Across>;  ///< the groups of an element
};

}  // namespace ancf

/// Stress at a point.
struct Stress {
  Mat3 second_piola;  ///< S, in the axes of the reference section [N/m²]
  Mat3 cauchy;        ///< F S Fᵀ/det F, world axes [N/m²]
};

/// Elastic force by general continuum mechanics. Green–Lagrange strain E = ½ (FᵀF − 1) relative to the reference, with
/// F = J J₀⁻¹, and St. Venant–Kirchhoff stress S = D : (E + τ Ė) with Hooke's law in three dimensions. For τ = 0 the
/// energy ½ S : E is a sum of squares of seven strains, one of which is tr E. Each of these strains has its own
/// stiffness:
///   S : E = λ (tr E)² + 2μ Σ E_ii² + 4μ Σ_{i<j} E_ij².
///
/// Quadrature: three Gauss points along x, exact for the quartic energy of linear theory (r_x is quadratic), and four
/// points of the section (`SectionPoints`). The section points are exact for the stretch, bending and twist of the
/// field. `Locking::present` uses this quadrature for all strains. In bending, E₁₁ varies linearly with y and z,
/// whereas E₂₂ and E₃₃ are constant across the section. Bending therefore has the modulus λ + 2μ in place of E, and the
/// deflection of a slender cantilever is (1 + ν)(1 − 2ν)/(1 − ν) times the correct one.
///
/// `Locking::cured` splits D = D⁰ + Dᵛ [Gerstmayr, Matikainen & Mikkola 2008]:
///   Young's modulus times E₁₁², over the volume, as in a bar under uniaxial stress;
///   the other terms of Hooke's law for normal strains, and E₂₃, on the axis at the nodes (trapezoidal rule). Between
///   the nodes of a bent element, interpolation along the chord gives |r_y| < 1, which would add stiffness;
///   the shears 2E₁₂, 2E₁₃ with the corrected shear stiffnesses GA, GA_z of the bar, at four points of the section.
///   The distance of these points from the axis is scaled so that the torsional stiffness equals GJ of the bar. The
///   quadrature has three points along x. With two, a mode would have no energy; with three, the element does not lock
///   (explained at `ElasticLine`).
///
/// Kelvin–Voigt times: axial for normal strains and therefore also for bending; shear for shears. Ė is objective.
/// `Damping::bending` has no effect.
template <Locking locking = Locking::cured>
struct Continuum {
  static constexpr char const* name = "AncfBeam<Continuum>";  ///< name of the body type in messages
  static constexpr bool cured = locking == Locking::cured;    ///< true if D is split so that bending does not lock

  using Parts = ancf::ContinuumGroups<locking>;  ///< the strain groups by name
  using Groups = typename Parts::type;           ///< the strain groups of an element

  /// Checks the data of the bar.
  /// \throws InvalidInput without section and material, for ν ≥ 0.5, and for a shear factor under `Locking::present`.
  static void check(Bar const& bar, BarConstants const&) {
    if (!bar.material)
      throw InvalidInput("bar.no_section", {ErrorObject{name},
                                            ": the continuum needs the bar's section and material. Give them, or use "
                                            "AncfBeam<ElasticLine>, which accepts constants."});
    if (!(bar.material->poisson < 0.5))
      throw InvalidInput("bar.poisson_ratio",
                         {ErrorObject{name}, ": Poisson's ratio must be below 0.5, but is ",
                          ErrorValue{bar.material->poisson}, ". At 0.5 the bulk modulus is infinite."});
    if (!cured && bar.shear_factor)
      throw InvalidInput("bar.shear_factor", {ErrorObject{name},
                                              ": Locking::present uses Hooke's law for shear, without a shear factor. "
                                              "Omit the factor, or use Continuum<Locking::cured>."});
  }

  /// Strain groups of an element with the reference `ref`.
  static Groups make(Bar const& bar, BarConstants const& c, ancf::Reference const& ref) {
    Moduli const m(bar);
    double const area = c.EA / m.young, y = std::sqrt(c.EI / c.EA), z = std::sqrt(c.EI_y.value() / c.EA);
    double const axial = bar.damping.axial, shear = bar.damping.shear;
    Vec<typename Parts::Number, 7> times, stiffness;
    for (int i = 0; i < 7; ++i) {
      times[i] = i < 4 ? axial : shear;
      stiffness[i] = i == 0 ? m.lambda : i < 4 ? 2.0 * m.mu : m.mu;
    }
    double const stretch = -bar.pretension / c.EA;  // strain at which the prestressed bar is free of stress
    ancf::SectionPoints const section{.y = y, .z = z};
    if constexpr (cured) {
      stiffness[1] -= m.young;
      stiffness[5] = stiffness[6] = 0.0;
      typename Parts::Across across(area * stiffness, times);
      for (int node = 0; node < 2; ++node) {
        auto const at = ref.gradients(node, 0.0, 0.0);
        across.set_point(node, 0.5 * ref.l, ancf::GreenStrains<2>::map(at.g, {0, 1, 2}), uniaxial(stretch, m.poisson));
      }
      using N = typename Parts::Number;
      typename Parts::Along along(Vec<N, 1>(double(c.EA)), Vec<N, 1>(axial));
      typename Parts::Shear shears(Vec<N, 2>(c.GA, c.GA_z.value()), Vec<N, 2>(shear, shear));
      double const lever = Continuum::lever(c);
      int k = 0;
      for (GaussPoint const& g : gauss<3>)
        section.for_each([&](double a, double b) {
          double const weight = 0.25 * g.weight * ref.l;
          auto const at = ref.gradients(g.xi, a, b), off_axis = ref.gradients(g.xi, lever * a, lever * b);
          along.set_point(k, weight * at.volume, ancf::AlongStrain::map(at.g, {0}),
                          Vec<typename Parts::Number, 1>(stretch));
          shears.set_point(k++, weight * off_axis.volume, ancf::ShearStrains::map(off_axis.g, {0, 1, 2}));
        });
      return {along, shears, across};
    } else {
      typename Parts::Volume volume(area * stiffness, times);
      int k = 0;
      for (GaussPoint const& g : gauss<3>)
        section.for_each([&](double a, double b) {
          auto const at = ref.gradients(g.xi, a, b);
          volume.set_point(k++, 0.25 * g.weight * ref.l * at.volume, ancf::GreenStrains<12>::map(at.g, {0, 1, 2}),
                           uniaxial(stretch, m.poisson));
        });
      return {volume};
    }
  }

  /// Distance of a point of the shear strains from the axis, divided by that of its section point (`SectionPoints`).
  static double lever(BarConstants const& c) {
    if constexpr (cured)
      return std::sqrt(c.GJ * c.EA / (c.GA * c.EI_y.value() + c.GA_z.value() * c.EI));
    else
      return 1.0;
  }

  /// Second Piola–Kirchhoff stress [N/m²] for the strain `e`, without damping. `at_axis` is the strain at the centre of
  /// the same section.
  template <class T = double>  // compiled only if used
  static Mat3 second_piola(Bar const& bar, BarConstants const& c, Mat3 const& e, Mat3 const& at_axis) {
    Moduli const m(bar);
    Mat<T, 3, 3> const axis = at_axis;
    Mat<T, 3, 3> s = m.lambda * axis.trace() * Mat<T, 3, 3>::Identity() + 2.0 * m.mu * e;
    if constexpr (cured) {
      s(0, 0) = m.young * e(0, 0) + m.lambda * axis.trace() + (2.0 * m.mu - m.young) * axis(0, 0);
      s(0, 1) = s(1, 0) = c.GA * m.young / c.EA * 2.0 * e(0, 1);
      s(0, 2) = s(2, 0) = c.GA_z.value() * m.young / c.EA * 2.0 * e(0, 2);
    } else {
      s += m.lambda * (e - axis).trace() * Mat<T, 3, 3>::Identity();
    }
    s(0, 0) += bar.pretension * m.young / c.EA;
    return s;
  }

  /// Fraction p of the torque that r_y carries. If r_y rotates by α and r_z by β, then 2E₁₂ = −z β′, 2E₁₃ = y α′ and
  /// 2E₂₃ = α − β. The torsional stiffnesses are D_y = GA_z y² for α and D_z = GA z² for β, coupled by GA. Under a
  /// torque both rotations are equal in the bar, and r_y carries p = D_y/(D_y + D_z). A joint or a moment at an end may
  /// apply another fraction p̂. Due to the shear 2E₂₃, p̂ − p decays over the length ℓ with ℓ² = D_y D_z/((D_y + D_z)
  /// GA). Under a torque T the marker at this end rotates by an additional angle (p̂ − p)² ℓ/(p (1 − p)) T/GJ.
  static double share(BarConstants const& c) {
    double const y = c.EI * (cured ? c.GA_z.value() : 1.0), z = c.EI_y.value() * (cured ? c.GA : 1.0);
    return y / (y + z);
  }
  /// Frame of markers on a section with r_y = b, r_z = c: the mean frame with the weight `share` of r_y.
  template <KernelScalar T>
  static MeanSectionFrame<T> frame(Vec<T, 3> const& b, Vec<T, 3> const& c, BarConstants const& bar) {
    return {b, c, share(bar)};
  }

  /// Strains Γ = Rᵀ r_x and K = axial(Rᵀ R_x) relative to the reference, with the frame R of the markers.
  template <class T = double>  // compiled only if used
  static Vec6 section_strains(BarConstants const& c, ancf::Deformation const& field, double xi) {
    Vec6 const now = stretch_and_bend<T>(c, field.e, field.reference.l, xi),
               then = stretch_and_bend<T>(c, field.reference.x, field.reference.l, xi);
    Vec6 x;
    for (int i = 0; i < 6; ++i) x[i] = now[i] - then[i];
    return x;
  }

  /// Section forces from the traction t = F S e₁ on the section, in the axes of the deformed section:
  ///   N = ∫ Rᵀt dA,  M = ∫ Rᵀ(r − r₀) × Rᵀt dA.
  /// The integration points are those of the energy: the four points of the section for the normal stress, and the
  /// scaled points for the shear stress.
  template <class T = double>  // compiled only if used
  static Vec6 section_forces(Bar const& bar, BarConstants const& c, ancf::Deformation const& field, double xi) {
    Vec<T, 3> const by = director<T>(field.e, 2, xi), bz = director<T>(field.e, 3, xi);
    MeanSectionFrame<T> const frame = Continuum::frame<T>(by, bz, c);
    double const area = c.EA / bar.material->young, lever = Continuum::lever(c);
    ancf::SectionPoints const section{.y = std::sqrt(c.EI / c.EA), .z = std::sqrt(c.EI_y.value() / c.EA)};
    Mat<T, 3, 3> const axis = field.strain(xi, 0.0, 0.0);
    Vec<T, 6> n = Vec<T, 6>::Zero();
    auto const add = [&](double y, double z, Vec<T, 3> const& parts) {
      Mat<T, 3, 3> const s = second_piola(bar, c, field.strain(xi, y, z), axis);
      Vec<T, 3> const t = frame.local(field.gradient(xi, y, z) * s.col(0).cwiseProduct(parts));
      n.template head<3>() += 0.25 * area * t;
      n.template tail<3>() += 0.25 * area * frame.local(y * by + z * bz).cross(t);
    };
    section.for_each([&](double y, double z) {
      add(y, z, Vec<T, 3>(1, 0, 0));
      add(lever * y, lever * z, Vec<T, 3>(0, 1, 1));
    });
    return n;
  }

 private:
  struct Moduli {
    double young, poisson, lambda, mu;  ///< E [N/m²], ν, and Lamé's λ and μ [N/m²]
    explicit Moduli(Bar const& bar) : young(bar.material->young), poisson(bar.material->poisson) {
      mu = young / (2.0 * (1.0 + poisson));
      lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
    }
  };
  /// Strains (Rᵀ r_x, axial(Rᵀ R_x)) on the axis.
  template <class T>  // compiled only if used
  static Vec<T, 6> stretch_and_bend(BarConstants const& c, ancf::Coordinates const& e, double l, double xi) {
    Mat<double, ancf::vectors, 4> const n = ancf::shape(xi, 0.0, 0.0, l);
    Vec<T, 3> along = detail::zeros<Vec<T, 3>>(), by, bz;  // r_x; r_y′ and r_z′
    for (int i = 0; i < 3; ++i) {
      for (int a = 0; a < ancf::vectors; ++a) along[i] += n(a, 1) * e[3 * a + i];
      by[i] = (e[18 + i] - e[6 + i]) / l;
      bz[i] = (e[21 + i] - e[9 + i]) / l;
    }
    MeanSectionFrame<T> const f = Continuum::frame<T>(director<T>(e, 2, xi), director<T>(e, 3, xi), c);
    Vec<T, 3> const stretch = f.local(along), bend = f.spin(f.components(by, bz));
    return {stretch[0], stretch[1], stretch[2], bend[0], bend[1], bend[2]};
  }
  /// Director r_y (v = 2) or r_z (v = 3) at ξ.
  template <class T>  // compiled only if used
  static Vec<T, 3> director(ancf::Coordinates const& e, int v, double xi) {
    Vec<T, 3> d;
    for (int i = 0; i < 3; ++i) d[i] = (1.0 - xi) * e[3 * v + i] + xi * e[12 + 3 * v + i];
    return d;
  }
  /// Strains of uniaxial stress with axial strain e.
  static Vec<double, 7> uniaxial(double e, double nu) {
    Vec<double, 7> strain = Vec<double, 7>::Zero();
    strain[0] = (1.0 - 2.0 * nu) * e;
    strain[1] = e;
    strain[2] = strain[3] = -nu * e;
    return strain;
  }
};

}  // namespace polybody
