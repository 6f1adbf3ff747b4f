#pragma once
/// \file
/// Sections of a bar about their centres of mass, from a shape, constants or matrices.
/// Theory: Eqs. 2.121 to 2.124.

#include <algorithm>
#include <string>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody::detail {

/// Returns true if the section of the bar is a function of the arc length.
inline bool section_varies(Bar const& bar) {
  auto const* const along = std::get_if<SectionAlong>(&bar.section);
  return along && !along->target<Section6>();
}

/// Damping times of the six strains of a bar [s].
template <class = void>  // compiled only if used
[[gnu::cold]] Vec6 damping_times(Damping const& d) {
  Vec6 times;
  for (int i = 0; i < 6; ++i) times[i] = i == 0 ? d.axial : i < 4 ? d.shear : d.bending;
  return times;
}

/// Constants of a section, without its couplings and about its centre of mass.
template <class = void>  // compiled only if used
[[gnu::cold]] BarConstants constants_without_couplings(CentredSection const& section) {
  Mat<double, 6, 6> const& k = section.stiffness;
  Mat3 const& j = section.inertia;
  return {.EA = k(0, 0),
          .EI = k(5, 5),
          .mass_per_length = section.mass,
          .GA = k(1, 1),
          .GJ = k(3, 3),
          .rotary_inertia = j(2, 2),
          .EI_y = k(4, 4),
          .GA_z = k(2, 2),
          .rotary_inertia_y = j(1, 1),
          .polar_inertia = j(0, 0)};
}

/// Section of a bar from a shape or constants.
/// \throws InvalidInput as `constants`, and without all stiffnesses; `body` begins the message.
template <class = void>  // compiled only if used
[[gnu::cold]] CentredSection section_of_constants(Bar const& bar, BarConstants const& c, std::string const& body) {
  CentredSection section{.mass = c.mass_per_length};
  Vec3 const rotary = rotary_inertias(c);
  Vec6 const times = damping_times(bar.damping);
  double const stiffness[] = {c.EA, c.GA, c.GA_z.value_or(c.GA), c.GJ, c.EI_y.value_or(c.EI), c.EI};
  char const* const names[] = {"EA", "GA", "GA_z", "GJ", "EI_y", "EI"};
  for (int i = 0; i < 6; ++i) {
    require_positive(stiffness[i], body + ": the stiffness " + names[i] + " of the bar");
    section.stiffness(i, i) = stiffness[i];
    section.damping(i, i) = stiffness[i] * times[i];
    if (i < 3) section.inertia(i, i) = rotary[i];
  }
  return section;
}

/// Checks a bar with matrices.
/// \throws InvalidInput for other data of the bar that are not valid, and for an empty function; `body` begins the
/// message.
template <class = void>  // compiled only if used
[[gnu::cold]] void check_matrices(Bar const& bar, std::string const& body) {
  check_bar(bar);
  if (!std::get<SectionAlong>(bar.section))
    throw InvalidInput("section.missing", {ErrorObject{body},
                                           ": the section of the bar is an empty function. Pass a "
                                           "function that returns a Section6 for each arc length."});
}

/// Section of a bar at the arc length `s`.
/// \throws InvalidInput as `constants` and `centred`; `body` begins the message.
template <class = void>  // compiled only if used
[[gnu::cold]] CentredSection section_at(Bar const& bar, double s, std::string const& body) {
  auto const* const along = std::get_if<SectionAlong>(&bar.section);
  if (!along) return section_of_constants(bar, constants(bar), body);
  check_matrices(bar, body);
  return centred((*along)(s), damping_times(bar.damping), s);
}

/// Matrix about the axis of the bar, from that about the centre of mass of the section.
template <class T = double>  // compiled only if used
Mat<T, 6, 6> about_axis(Mat<T, 6, 6> const& matrix, CentredSection const& section) {
  return at_point<T>(matrix, Vec3(0.0, -section.centre[1], -section.centre[2]));
}

/// Sections of the elements and nodes of a bar, about their centres of mass.
struct ChainSections {
  BarConstants constants;                ///< of the first element; without couplings, if the bar has matrices
  std::vector<CentredSection> elements;  ///< in the middle of each element, or one for all
  std::vector<CentredSection> nodes;     ///< at each node, or one for all
};

/// Sections of a bar of n elements.
/// \throws InvalidInput as `constants` and `centred`, and for a section of a shape or constants without all
/// stiffnesses; `body` begins the message.
template <class = void>  // compiled only if used
[[gnu::cold]] ChainSections chain_sections(Bar const& bar, Index n, std::string const& body) {
  auto const* const along = std::get_if<SectionAlong>(&bar.section);
  if (!along) {
    BarConstants const c = constants(bar);
    CentredSection const section = section_of_constants(bar, c, body);
    return {c, {section}, {section}};
  }
  check_matrices(bar, body);
  Vec6 const times = damping_times(bar.damping);
  std::vector<CentredSection> elements, nodes;
  bool const varies = section_varies(bar);
  double const l = bar.length / double(n);
  for (Index e = 0; e < (varies ? n : 1); ++e) {
    double const s = (double(e) + 0.5) * l;
    elements.push_back(centred((*along)(s), times, s));
  }
  for (Index i = 0; i < (varies ? n + 1 : 1); ++i) {
    double const s = double(i) * l;
    nodes.push_back(varies ? centred((*along)(s), times, s) : elements[0]);
  }
  return {constants_without_couplings(elements[0]), elements, nodes};
}

}  // namespace polybody::detail
