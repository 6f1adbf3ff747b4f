#pragma once
/// \file
/// Physical specification of a straight prismatic bar, from which every body formulation can be made.
/// Theory: Eq. 3.13.

#include <functional>
#include <numbers>
#include <optional>
#include <variant>

#include <polybody/bodies/shared/section6.hpp>

namespace polybody {

/// Solid circular section.
struct Circle {
  Required<double> radius;  ///< [m]
};

/// Solid rectangle: `height` along y (bending in the x–y plane), `width` along z.
struct Rectangle {
  Required<double> height;  ///< along y [m]
  Required<double> width;   ///< along z [m]
};

/// Linear elastic isotropic material.
struct Material {
  Required<double> density;  ///< [kg/m³]
  Required<double> young;    ///< E [N/m²]
  double poisson = 0.3;      ///< ν, in (−1, 0.5]
};

/// Stiffness and inertia of a section. Most published examples give these constants. The axes y and z are those of the
/// section; a planar bar bends about z.
struct BarConstants {
  Required<double> EA;                          ///< axial stiffness [N]
  Required<double> EI;                          ///< bending stiffness about z [N m²]
  Required<double> mass_per_length;             ///< Aρ [kg/m]
  double GA = 0.0;                              ///< shear stiffness k G A along y [N]; 0 if not given
  double GJ = 0.0;                              ///< torsional stiffness [N m²]; 0 if not given
  double rotary_inertia = 0.0;                  ///< Iρ about z, per length [kg m]
  std::optional<double> EI_y = {};              ///< bending stiffness about y [N m²]; EI if not given
  std::optional<double> GA_z = {};              ///< shear stiffness along z [N]; GA if not given
  std::optional<double> rotary_inertia_y = {};  ///< Iρ about y, per length [kg m]; `rotary_inertia` if not given
  std::optional<double> polar_inertia = {};     ///< Iρ about the axis, per length [kg m]; Iρ_y + Iρ_z if not given
};

/// Rotary inertias Iρ of a section about x (the axis of the bar), y and z, per length [kg m].
template <class = void>  // compiled only if used
Vec3 rotary_inertias(BarConstants const& c) {
  double const z = c.rotary_inertia, y = c.rotary_inertia_y.value_or(z);
  return Vec3(c.polar_inertia.value_or(y + z), y, z);
}

/// Kelvin–Voigt damping: stress = stiffness · (strain + time · strain rate). Rigid motions of the bar cause no damping.
struct Damping {
  double axial = 0.0;    ///< damping time of the axial strain [s]
  double shear = 0.0;    ///< damping time of shear and torsion [s]
  double bending = 0.0;  ///< damping time of the curvatures [s]
};

/// Straight bar with its first end at the origin of the placement and its axis along the x axis of the placement. The
/// data of the bar are a shape as `section` with its `material`, or matrices as `section` (`Section6`), or `constants`.
struct Bar {
  Required<double> length;  ///< [m], from 1e-100 to 1e100, so that its cube is finite and not zero
  /// shape, or a `Section6` or function of the arc length that returns one; empty if the bar has `constants`
  std::variant<std::monostate, Circle, Rectangle, SectionAlong> section = {};
  std::optional<Material> material = {};       ///< material of the section
  std::optional<BarConstants> constants = {};  ///< constants that replace section and material
  Placement placement = {};  ///< placement of the first end; the bar lies along the x axis of the placement
  Damping damping = {};      ///< damping of the material
  double pretension = 0.0;   ///< axial force in the reference configuration [N]
  std::optional<double> shear_factor = {};  ///< factor k of k G A, with `section` only; default: Cowper's formula
};

/// Mesh of a body that is made from a bar: `B::from(bar, {.elements = 8})`. Every body type accepts a mesh. The number
/// of elements has no effect on a rigid body.
///
/// Without a number of elements, `B::from(bar)` uses `B::default_elements`: 8 if the axis is cubic without shear (ANCF
/// cables, floating frames), 16 if the axis is cubic with shear (`AncfBeam`), 32 if it is linear (`Lrvf`). The lowest
/// bending frequency of a pinned bar is then within 0.2 % of its exact value, and the second one within 0.7 %.
struct BarMesh {
  std::optional<Index> elements = {};  ///< number of elements of equal length, at least 1
};

/// Curved reference: function that returns the placement of the section at arc length s ∈ [0, length], in the axes of
/// the bar (x along the tangent). The placement at s = 0 usually is `Placement{}`.
using ReferenceCurve = std::function<Placement(double)>;

namespace detail {

template <class = void>  // compiled only if used
[[gnu::cold]] BarConstants constants_of_section(Bar const& bar) {
  Material const& m = *bar.material;
  require_positive(m.density, "Bar: the material's density");
  require_positive(m.young, "Bar: Young's modulus");
  if (!(m.poisson > -1.0 && m.poisson <= 0.5))
    throw InvalidInput("bar.poisson_ratio", {ErrorObject{"Bar"}, ": Poisson's ratio must lie in (-1, 0.5], but is ",
                                             ErrorValue{m.poisson}, "."});
  double const nu = m.poisson;
  double area = 0, iz = 0, iy = 0, torsion = 0, shear = 0;
  if (auto const* c = std::get_if<Circle>(&bar.section)) {
    require_positive(c->radius, "Bar: the circle's radius");
    double const r2 = c->radius * c->radius;
    area = std::numbers::pi * r2;
    iz = iy = 0.25 * area * r2;
    torsion = 2.0 * iz;
    shear = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);  // Cowper 1966
  } else {
    Rectangle const& s = std::get<Rectangle>(bar.section);
    require_positive(s.height, "Bar: the rectangle's height");
    require_positive(s.width, "Bar: the rectangle's width");
    double const h = s.height, w = s.width;
    area = h * w;
    iz = w * h * h * h / 12.0;
    iy = h * w * w * w / 12.0;
    shear = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);  // Cowper 1966
    // Torsion constant of Saint-Venant, J = a b³ (1/3 − (64/π⁵)(b/a) Σ tanh((2k+1)πa/2b)/(2k+1)⁵) with sides a ≥ b
    // [Timoshenko & Goodier 1970, §109, with half sides a and b]
    double const a = std::max(h, w), b = std::min(h, w);
    double sum = 0.0;
    for (int k = 1; k < 40; k += 2) sum += std::tanh(k * std::numbers::pi * a / (2.0 * b)) / std::pow(k, 5);
    torsion = a * b * b * b * (1.0 / 3.0 - 64.0 / std::pow(std::numbers::pi, 5) * b / a * sum);
  }
  if (bar.shear_factor) {
    shear = *bar.shear_factor;
    if (!(shear >= 1e-9 && shear <= 1e9))
      throw InvalidInput(
          "bar.shear_factor",
          {ErrorObject{"Bar"}, ": the shear factor must lie in [1e-09, 1e+09], but is ", ErrorValue{shear}, "."});
  }
  double const e = m.young, g = e / (2.0 * (1.0 + nu)), rho = m.density;
  return {.EA = e * area,
          .EI = e * iz,
          .mass_per_length = rho * area,
          .GA = shear * g * area,
          .GJ = g * torsion,
          .rotary_inertia = rho * iz,
          .EI_y = e * iy,
          .GA_z = shear * g * area,
          .rotary_inertia_y = rho * iy};
}

/// Checks the magnitudes of the constants of a bar.
/// \throws InvalidInput for a constant that is neither zero nor in [1e-150, 1e150]; `of` begins the message.
template <class = void>  // compiled only if used
[[gnu::cold]] void require_sizes(BarConstants const& c, std::string const& of) {
  struct {
    double x;
    char const* what;
  } const all[] = {{c.EA, "EA"},
                   {c.EI, "EI"},
                   {c.mass_per_length, "mass per length"},
                   {c.GA, "GA"},
                   {c.GJ, "GJ"},
                   {c.rotary_inertia, "rotary inertia"},
                   {c.EI_y.value_or(0.0), "EI_y"},
                   {c.GA_z.value_or(0.0), "GA_z"},
                   {c.rotary_inertia_y.value_or(0.0), "rotary_inertia_y"},
                   {c.polar_inertia.value_or(0.0), "polar_inertia"}};
  for (auto const& [x, what] : all) require_size(x, of + what);
}
/// Checks the constants of a bar that follow from its section and material.
/// \throws InvalidInput if EA, EI or the mass per length is not positive, or for a constant that `require_sizes`
/// refuses.
template <class = void>  // compiled only if used
[[gnu::cold]] void require_section_sizes(Bar const& bar, BarConstants const& c) {
  std::string of = "Bar: with a section of ";
  if (auto const* circle = std::get_if<Circle>(&bar.section)) of += sentence_of({"radius ", circle->radius});
  if (auto const* r = std::get_if<Rectangle>(&bar.section))
    of += sentence_of({"height ", r->height, " m and width ", r->width});
  of += sentence_of({" m and a material of density ", bar.material->density, " kg/m³ and Young's modulus ",
                     bar.material->young, " N/m², "});
  require_positive(c.EA, of, "EA");
  require_positive(c.EI, of, "EI");
  require_positive(c.mass_per_length, of, "mass per length");
  require_sizes(c, of);
}

/// Constants of a section that is given by matrices.
/// \throws InvalidInput for matrices that vary along the bar, with couplings, offsets or damping times, and as
/// `centred`.
template <class = void>  // compiled only if used
[[gnu::cold]] BarConstants uncoupled_constants(SectionAlong const& along) {
  auto const refuse = [](char const* fault) {
    throw InvalidInput("section.coupled", {ErrorObject{"Bar"}, ": the section given by matrices ", fault,
                                           ". This body needs a constant section without couplings. Use Se3Beam, Lrvf, "
                                           "AncfBeam<CoupledLine> or Ffr, which accept couplings, or give constants."});
  };
  Section6 const* const section = along.target<Section6>();
  if (!section) refuse("is a function of the arc length");
  CentredSection const c = centred(*section, Vec6::Zero(), 0.0);
  for (int i = 0; i < 6; ++i) {
    if (section->damping_times[i] != 0.0) refuse("has damping times of its own");
    for (int j = 0; j < 6; ++j) {
      if (i != j && section->stiffness(i, j) != 0.0) refuse("couples strains");
      if (i != j && section->mass(i, j) != 0.0) refuse("has an offset or products of inertia");
    }
  }
  Mat<double, 6, 6> const& k = section->stiffness;
  return {.EA = k(0, 0),
          .EI = k(5, 5),
          .mass_per_length = c.mass,
          .GA = k(1, 1),
          .GJ = k(3, 3),
          .rotary_inertia = c.inertia(2, 2),
          .EI_y = k(4, 4),
          .GA_z = k(2, 2),
          .rotary_inertia_y = c.inertia(1, 1),
          .polar_inertia = c.inertia(0, 0)};
}

/// Warning of section matrices that are probably not in SI units, at the first of five arc lengths with such a section;
/// empty for other bars.
template <class = void>  // compiled only if used
[[gnu::cold]] std::string unit_warning(Bar const& bar) {
  auto const* const along = std::get_if<SectionAlong>(&bar.section);
  std::string found;
  if (!along || !*along) return found;
  int const last = along->target<Section6>() ? 0 : 4;
  for (int i = 0; i <= last && found.empty(); ++i) {
    double const s = 0.25 * i * bar.length;
    found = unit_warning((*along)(s), s);
  }
  return found;
}

/// Checks a damping time [s].
/// \throws InvalidInput naming `what` unless 0 ≤ `time` ≤ `largest_number`.
template <class = void>  // compiled only if used
void require_damping_time(double time, std::string const& what) {
  require_not_negative(time, what);
  if (time > largest_number)
    throw InvalidInput(
        "bar.period", {ErrorObject{what}, " must be at most ", largest_number, " s, but is ", ErrorValue{time}, " s."});
}

}  // namespace detail

namespace detail {

/// Checks all data of a bar except for its section.
/// \throws InvalidInput naming the quantity that is not valid.
template <class = void>  // compiled only if used
[[gnu::cold]] void check_bar(Bar const& bar) {
  require_positive(bar.length, "Bar: the length");
  if (!(bar.length >= 1e-100 && bar.length <= 1e100))
    throw InvalidInput("bar.length", {ErrorObject{"Bar"}, ": the length must lie in [1e-100, 1e+100] m, but is ",
                                      ErrorValue{bar.length}, " m."});
  bar.placement.check("Bar");
  detail::require_damping_time(bar.damping.axial, "Bar: the axial damping time");
  detail::require_damping_time(bar.damping.shear, "Bar: the shear damping time");
  detail::require_damping_time(bar.damping.bending, "Bar: the bending damping time");
  require_finite(bar.pretension, "Bar: the pretension");
  if (std::abs(bar.pretension) > largest_number)
    throw InvalidInput("value.magnitude", {ErrorObject{"Bar"}, ": the pretension is ", ErrorValue{bar.pretension},
                                           " N, beyond ", largest_number, " N, the largest allowed magnitude."});
  bool const by_matrices = std::holds_alternative<SectionAlong>(bar.section);
  bool const by_section = !by_matrices && !std::holds_alternative<std::monostate>(bar.section);
  if (by_section != bar.material.has_value() || (by_section || by_matrices) == bar.constants.has_value())
    throw InvalidInput(
        "bar.section_or_constants",
        {ErrorObject{"Bar"},
         ": give either a shape with a material, or matrices (Section6), or constants; not two of these, and not a "
         "shape without a material."});
  if (bar.shear_factor && !by_section)
    throw InvalidInput("bar.shear_factor",
                       {ErrorObject{"Bar"},
                        ": a shear factor needs a shape. Constants and matrices already contain the shear stiffness."});
}

}  // namespace detail

/// Stiffness and inertia of the section of a bar.
/// \throws InvalidInput naming the quantity that is not valid, and for matrices that vary along the bar or have
/// couplings or offsets.
template <class = void>  // compiled only if used
[[gnu::cold]] BarConstants constants(Bar const& bar) {
  detail::check_bar(bar);
  if (bar.material) {
    BarConstants const c = detail::constants_of_section(bar);
    detail::require_section_sizes(bar, c);
    return c;
  }
  if (!bar.constants) return detail::uncoupled_constants(std::get<SectionAlong>(bar.section));
  BarConstants const& c = *bar.constants;
  require_positive(c.EA, "Bar: EA");
  require_positive(c.EI, "Bar: EI");
  require_positive(c.mass_per_length, "Bar: mass per length");
  require_not_negative(c.GA, "Bar: GA");
  require_not_negative(c.GJ, "Bar: GJ");
  require_not_negative(c.rotary_inertia, "Bar: rotary inertia");
  require_not_negative(c.EI_y.value_or(0.0), "Bar: EI_y");
  require_not_negative(c.GA_z.value_or(0.0), "Bar: GA_z");
  require_not_negative(c.rotary_inertia_y.value_or(0.0), "Bar: rotary_inertia_y");
  require_not_negative(c.polar_inertia.value_or(0.0), "Bar: polar_inertia");
  detail::require_sizes(c, "Bar: ");
  return c;
}

/// Checks the polar inertia of a body whose mass is distributed over material points.
/// \throws InvalidInput naming `what` unless the polar inertia is that of the points, ∫ρ(y² + z²) over the section.
template <class = void>  // compiled only if used
void require_polar_inertia_of_points(BarConstants const& c, std::string const& what) {
  Vec3 const i = rotary_inertias(c);
  if (std::abs(i[0] - (i[1] + i[2])) > 1e-9 * (i[1] + i[2]))
    throw InvalidInput("bar.polar_inertia",
                       {ErrorObject{what}, ": the polar inertia is ", ErrorValue{i[0]},
                        " kg m, but the material points of this body have ", "Iρ_y + Iρ_z = ", i[1] + i[2],
                        " kg m. Omit polar_inertia, or use Lrvf or Rigid, whose sections are rigid."});
}

/// Checks the number n of elements of a bar.
/// \throws InvalidInput naming `what` unless n = 1 … 10⁷.
inline void require_elements(Index n, std::string_view what) {
  if (n < 1)
    throw InvalidInput("body.elements",
                       {ErrorObject{what}, ": at least one element is needed, but there are ", ErrorValue{n}, "."});
  if (n > 10'000'000)
    throw InvalidInput("body.elements", {ErrorObject{what}, ": ", ErrorValue{n},
                                         " elements do not fit into the memory. Use at most 10000000."});
}

/// Checks the reference curve of a body.
/// \throws InvalidInput naming `what` for an empty function.
inline void require_curve(ReferenceCurve const& curve, std::string_view what) {
  if (!curve)
    throw InvalidInput("reference_curve.missing", {ErrorObject{what},
                                                   ": the reference curve is an empty function. Pass a function that "
                                                   "returns a Placement for each arc length s."});
}

/// Returns s limited to the bar, 0 ≤ s ≤ length.
/// \throws InvalidInput naming `what` if s lies outside by more than 1e-12 of the length.
inline double require_inside(double s, double length, std::string_view what) {
  double const slack = 1e-12 * length;
  if (!(s >= -slack && s <= length + slack))
    throw InvalidInput("body.outside", {ErrorObject{what}, ": s = ", ErrorValue{s},
                                        " m lies outside the body, 0 <= s <= ", length, " m."});
  return std::min(std::max(s, 0.0), length);
}

}  // namespace polybody
