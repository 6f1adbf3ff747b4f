#pragma once
/// \file
/// Data of a figure: curves, axes and text. plot.hpp writes and draws figures.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <polybody/math/errors.hpp>

namespace polybody {

/// Curve of a figure.
struct Curve {
  std::vector<double> x{}, y{};  ///< (n) coordinates of the points, n >= 1 [units of the axes]
  std::string label{};           ///< text in the legend; empty: no entry
  std::string style = "lines";   ///< lines, points, linespoints, dashed, steps, or filled (translucent area inside)
  int colour = -1;               ///< index into 8 colours, modulo 8; -1: index of the curve
  double width = 1.5;            ///< line width [pt]
};

/// Text beside a point of a figure.
struct FigureText {
  double x = 0.0, y = 0.0;  ///< point [units of the axes]
  std::string text{};       ///< printed to the right of the point
};

/// Figure with one pair of axes. All text is printed literally (UTF-8; '\n' begins a new line).
struct Figure {
  std::string title{}, x_label{}, y_label{};  ///< text above, below and left of the axes; empty: none
  std::vector<Curve> curves{};                ///< drawn in this order
  std::vector<FigureText> texts{};            ///< texts beside points
  bool equal_axes = false;                    ///< one unit of x is as long as one unit of y
  bool log_x = false, log_y = false;          ///< logarithmic axes; they omit points that are not positive
  bool legend = true;                         ///< draws a list of the curves' labels
  std::optional<std::array<double, 2>> x_range{}, y_range{};  ///< limits of the axes; empty: fit all points
  int width_px = 1000, height_px = 700;                       ///< size of the picture [pixels]
};

namespace detail {

inline constexpr std::array<std::string_view, 6> curve_styles{"lines",  "points", "linespoints",
                                                              "dashed", "steps",  "filled"};

/// Checks that all curves can be drawn. Throws InvalidInput with the figure's title and the curve's label otherwise.
template <class = void>  // compiled where it is used
void check(Figure const& figure) {
  std::string where = "figure \"" + figure.title + "\"";
  auto const need = [&](bool good, std::string_view rule) {
    if (!good) throw InvalidInput("figure.content", {ErrorObject{where}, ": ", rule});
  };
  auto const in = [](int value, int low, int high) { return low <= value && value <= high; };
  auto const is_finite = [](double value) { return std::isfinite(value); };
  need(!figure.curves.empty(), "a figure needs at least one curve");
  need(in(figure.width_px, 50, 16000) && in(figure.height_px, 50, 16000),
       sentence_of(
           {"width and height must be 50 to 16000 pixels, but are ", figure.width_px, " and ", figure.height_px}));
  need(!figure.equal_axes || !(figure.log_x || figure.log_y), "equal axes cannot be logarithmic");
  auto const check_range = [&](auto const& range, bool log, std::string const& axis) {
    if (!range) return;
    auto const [from, to] = *range;
    need(is_finite(from) && is_finite(to) && from != to,
         axis + " must be two different finite numbers, but is " + number(from) + " to " + number(to));
    need(!log || (from > 0 && to > 0), axis + " must be positive on a logarithmic axis");
  };
  check_range(figure.x_range, figure.log_x, "x_range");
  check_range(figure.y_range, figure.log_y, "y_range");
  for (FigureText const& t : figure.texts)
    need(is_finite(t.x) && is_finite(t.y), "the point of the text \"" + t.text + "\" is not finite");
  bool visible = false;
  std::string const title = where;
  for (auto const& [x, y, label, style, colour, width] : figure.curves) {
    (where = title).append(", curve \"").append(label).append("\"");
    need(x.size() == y.size(), "x has " + std::to_string(x.size()) + " numbers and y has " + std::to_string(y.size()) +
                                   "; x and y must have the same length");
    need(!x.empty(), "a curve needs at least one point");
    need(std::ranges::all_of(x, is_finite), "a number in x is not finite");
    need(std::ranges::all_of(y, is_finite), "a number in y is not finite");
    need(std::ranges::count(curve_styles, style) == 1,
         "style \"" + style + "\" is none of lines, points, linespoints, dashed, steps, filled");
    need(colour >= -1, sentence_of({"colour must be 0, 1, 2 ... or -1 for the index of the curve, but is ", colour}));
    need(is_finite(width) && width > 0, "width must be positive and finite, but is " + number(width));
    for (std::size_t i = 0; i < x.size() && !visible; ++i)
      visible = (!figure.log_x || x[i] > 0) && (!figure.log_y || y[i] > 0);
  }
  where = title;
  need(visible, "no point is positive on all logarithmic axes, so nothing can be drawn");
}

}  // namespace detail

}  // namespace polybody
