#pragma once
/// \file
/// Colour, marker and line pattern of each formulation, equal in all figures.

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <polybody/bodies/shared/family.hpp>
#include <polybody/io/plot.hpp>

namespace polybody {

/// Drawing style of a formulation. The family of the body determines the colour and the marker, the policy determines
/// the line pattern. The style applies to gnuplot figures (`Curve::colour = style.colour`) and to SVG figures.
struct FormulationStyle {
  std::string_view family;  ///< family of the body, see bodies/shared/family.hpp
  int colour = 0;           ///< index into the colours of plot.hpp [Okabe & Ito 2008]; −1: grey
  int marker = 0;           ///< point type of gnuplot; an even number from 4 on is an open marker
  std::string_view dash;    ///< lengths of strokes and gaps, as in stroke-dasharray of SVG; empty: a solid line

  /// Colour in the form #rrggbb.
  std::string_view rgb() const { return colour < 0 ? "#8A8A8A" : detail::palette[std::size_t(colour)]; }
  /// True if the area of the marker has the colour of the background.
  bool open() const { return marker >= 4 && marker % 2 == 0; }
};

/// Styles of all families. A colour has the marker that plot.hpp gives to it. If two families share a colour, one of
/// them has an open marker, the other one a filled marker, and the line of the second one is dashed.
inline constexpr std::array<FormulationStyle, 12> formulation_styles{{
    {families::lrvf, 0, detail::point_types[0], ""},
    {families::lrvf_in_space, 0, detail::point_types[0] - 1, "9 3"},
    {families::cable_engineering, 1, detail::point_types[1], ""},
    {families::beam_elastic_line, 2, detail::point_types[2], ""},
    {families::cable_green, 3, detail::point_types[3], ""},
    {families::ffr_nodal, 4, detail::point_types[4], ""},
    {families::ffr_modal, 4, detail::point_types[4] - 1, "9 3"},
    {families::beam_continuum, 5, detail::point_types[5], ""},
    {families::rigid, 6, detail::point_types[6], ""},
    {families::se3_beam, 7, detail::point_types[7], ""},
    {families::se3_beam_in_space, 7, detail::point_types[7] + 1, "9 3"},
    {families::other, -1, 2, ""},
}};

/// Line pattern of each policy by its name, in the form of `FormulationStyle::dash`.
inline constexpr std::array<std::array<std::string_view, 2>, 6> policy_dashes{{{"JointCoordinates", "14 3"},
                                                                               {"AncfLinear", "5 2"},
                                                                               {"Penalty", "2 3"},
                                                                               {"PenaltyPerEquation", "2 3"},
                                                                               {"Bushing", "8 3 2 3"},
                                                                               {"NonlinearBushing", "8 3 2 3 2 3"}}};

/// Colour of each policy by its name, an index into the colours of plot.hpp. It applies if the formulations that a film
/// or figure compares have the same body.
inline constexpr std::array<std::pair<std::string_view, int>, 6> policy_colours{{{"Constraint", 0},
                                                                                 {"Penalty", 1},
                                                                                 {"PenaltyPerEquation", 1},
                                                                                 {"Bushing", 2},
                                                                                 {"NonlinearBushing", 2},
                                                                                 {"JointCoordinates", 4}}};

/// Style of the formulation whose body has the `family`, with the line pattern of the `policy`. A family without a
/// style has that of `families::other`. A policy that is not in `policy_dashes` has the line pattern of the family.
template <class = void>  // compiled where it is used
FormulationStyle formulation_style(std::string_view family, std::string_view policy = "Constraint") {
  FormulationStyle style = formulation_styles.back();
  for (FormulationStyle const& known : formulation_styles)
    if (known.family == family) style = known;
  for (auto const& [name, dash] : policy_dashes)
    if (name == policy) style.dash = dash;
  return style;
}

/// Colour of a formulation by its `name`, which is a family or a policy: an index into the colours of plot.hpp, or −1
/// for other names.
template <class = void>
int formulation_colour(std::string_view name) {
  for (auto const& [policy, colour] : policy_colours)
    if (policy == name) return colour;
  return formulation_style(name).colour;
}

namespace detail {

/// Outline of a marker around (0, 0), as a path of SVG. `type` is a point type of gnuplot.
inline std::string_view marker_path(int type) {
  switch (type / 2) {
    case 2:
      return "M-3.5-3.5h7v7h-7z";
    case 3:
      return "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z";
    case 4:
      return "M0-5L4.6 3.4H-4.6z";
    case 5:
      return "M0 5L4.6-3.4H-4.6z";
    case 6:
      return "M0-5L4.6 0L0 5L-4.6 0z";
    case 7:
      return "M0-4.7L4.5-1.4L2.8 3.8H-2.8L-4.5-1.4z";
    default:
      return "M-3.5-3.5L3.5 3.5M-3.5 3.5L3.5-3.5";
  }
}

}  // namespace detail

}  // namespace polybody
