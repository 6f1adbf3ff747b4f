#pragma once
/// \file
/// Charts as SVG text, with linear and logarithmic axes.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <polybody/io/formulation_style.hpp>
#include <polybody/io/html_text.hpp>

namespace polybody::detail {

/// Tick of an axis. A tick without a label is a minor tick.
struct ChartTick {
  double at = 0.0;         ///< position [units of the picture]
  std::string label = {};  ///< text at the tick
};

/// Axis that maps values to positions of a picture, linearly or logarithmically.
class ChartAxis {
 public:
  /// Axis for `values` from the position `first` to the position `last` [units of the picture]. Values that are not
  /// finite, or not positive on a logarithmic axis, are omitted. `margin` is the distance of the extreme values from
  /// the ends, relative to the range of the values. `marks` are the values of the labels; empty: the axis chooses them.
  ChartAxis(std::vector<double> const& values, bool logarithmic, std::pair<double, double> ends, double margin = 0.06,
            std::vector<double> marks = {})
      : logarithmic_(logarithmic), first_(ends.first), last_(ends.second), margin_(margin) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (double const x : values)
      if (shows(x)) low = std::min(low, scaled(x)), high = std::max(high, scaled(x));
    if (!(low <= high)) low = 0.0, high = 1.0;
    widen(low, high);
    low_ = low;
    high_ = high;
    if (!marks.empty())
      mark(std::move(marks));
    else if (logarithmic_)
      mark_decades();
    else
      mark_evenly(low_, high_);
  }

  /// True if the axis has a position for x.
  bool shows(double x) const { return std::isfinite(x) && (!logarithmic_ || x > 0.0); }
  /// True if x is between the ends of the axis.
  bool contains(double x) const { return shows(x) && scaled(x) >= low_ && scaled(x) <= high_; }
  /// Position of x [units of the picture].
  double at(double x) const { return position(scaled(x)); }

  std::vector<ChartTick> const& ticks() const { return ticks_; }  ///< ticks with labels and minor ticks
  std::string const& factor() const { return factor_; }           ///< factor of the labels, such as "10³"; empty: 1
  std::string const& offset() const { return offset_; }  ///< number that is subtracted from the values; empty: 0

 private:
  double scaled(double x) const { return logarithmic_ ? std::log10(x) : x; }
  double position(double scaled) const { return first_ + (last_ - first_) * (scaled - low_) / (high_ - low_); }

  void widen(double& low, double& high) const {
    double const size = std::max(std::abs(low), std::abs(high)), margin = margin_ * (high - low);
    if (high - low > 1e-12 * size) {
      low -= margin;
      high += margin;
    } else {  // a constant
      double const around = logarithmic_ ? 0.5 : size > 0.0 ? 0.1 * size : 1.0;
      low -= around;
      high += around;
    }
  }

  /// Ticks at the given values of a horizontal axis. A label that would overlap the previous one is omitted.
  void mark(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    bool const powers = values.front() < 1e-3 &&
                        std::all_of(
                            values.begin(), values.end(),
                            [](double x) { return std::abs(std::log10(x) - std::round(std::log10(x))) < 1e-9; });
    double free = -std::numeric_limits<double>::infinity();  // end of the last label
    for (double const x : values) {
      if (!contains(x)) continue;
      std::string label = powers ? "10" + superscript(int(std::lround(std::log10(x)))) : short_text(x);
      double const half = 0.5 * (6.0 + 11.0 * double(powers ? 4 : label.size()));
      if (at(x) - half < free) label.clear();
      if (!label.empty()) free = at(x) + half;
      ticks_.push_back({at(x), std::move(label)});
    }
  }

  /// Labels at the decades, or at every n-th decade of a wide range. An axis of less than 1.6 decades also has labels
  /// at 2 and 5 times the decades. If these labels are fewer than two, equidistant labels replace them.
  void mark_decades() {
    bool const few = high_ - low_ < 1.6;
    bool const plain = high_ < 4.5 && low_ > -4.0;
    int labels = 0;
    int const first = int(std::floor(low_)), last = int(std::ceil(high_)), every = 1 + (last - first) / 9;
    for (int decade = first; decade <= last; ++decade)
      for (int k = 1; k < 10; ++k) {
        double const x = double(k) * std::pow(10.0, decade);
        if (!contains(x)) continue;
        bool const labelled = (k == 1 && (few || decade % every == 0)) || (few && (k == 2 || k == 5));
        if (k > 1 && !labelled && every > 1) continue;
        ticks_.push_back({at(x), labelled ? label_of(decade, k, plain) : std::string()});
        labels += labelled;
      }
    if (labels > 1) return;
    ticks_.clear();
    mark_evenly(std::pow(10.0, low_), std::pow(10.0, high_));
  }
  static std::string label_of(int decade, int k, bool plain) {
    if (plain) return fixed_text(double(k) * std::pow(10.0, decade), std::max(0, -decade));
    return (k == 1 ? std::string() : std::to_string(k) + "·") + "10" + superscript(decade);
  }

  /// Labels at multiples of 1, 2 or 5 times a power of ten. If the middle of the axis exceeds 2000 times its range, the
  /// labels have a common offset. If the largest label is at least 1e5 or below 0.01, the labels have a common factor.
  void mark_evenly(double low, double high) {
    double const least = (high - low) / 6.0, power = std::pow(10.0, std::floor(std::log10(least)));
    double step = 10.0 * power;
    for (double const k : {5.0, 2.0, 1.0})
      if (k * power >= least) step = k * power;
    double const coarse = std::pow(10.0, std::ceil(std::log10(high - low)));
    double const middle = std::round(0.5 * (low + high) / coarse) * coarse;
    double const shift = std::abs(middle) > 2e3 * (high - low) ? middle : 0.0;
    double const size = std::max(std::abs(low - shift), std::abs(high - shift));
    int const thousands = size >= 1e5 || size < 1e-2 ? int(std::floor(std::log10(size) / 3.0)) : 0;
    double const unit = std::pow(10.0, 3 * thousands);
    int const places = std::max(0, -int(std::floor(std::log10(step / unit) + 1e-9)));
    if (thousands != 0) factor_ = "10" + superscript(3 * thousands);
    if (shift != 0.0) offset_ = short_text(shift, 12);
    for (double k = std::ceil((low - shift) / step); k * step <= high - shift; k += 1.0)
      ticks_.push_back({at(shift + k * step), fixed_text(k * step / unit, places)});
  }

  bool logarithmic_;
  double first_, last_, margin_, low_ = 0.0, high_ = 1.0;
  std::vector<ChartTick> ticks_;
  std::string factor_, offset_;
};

/// Point of a chart with a marker and a tooltip.
struct ChartPoint {
  double x = 0.0, y = 0.0;         ///< coordinates [units of the axes]
  std::string title = {};          ///< tooltip
  bool strong = true;              ///< false: a small, pale marker
  bool ringed = false;             ///< true: a ring around the marker
  double least = y, most = least;  ///< ends of a vertical line through the point [unit of the y axis]
};

/// Curve of a chart: a line, points, or both.
struct ChartCurve {
  std::string label;                       ///< text in the legend
  std::string note = {};                   ///< further text in the legend, in grey
  std::size_t key = 0;                     ///< number of the formulation, which determines the colour
  std::optional<std::size_t> second = {};  ///< number of a second formulation, whose colour alternates with the first
  FormulationStyle style = {};             ///< marker and line pattern
  std::vector<double> x = {}, y = {};      ///< (n) points of the line [units of the axes]
  double band = 0.0;                       ///< half width of a band around the line [unit of the y axis]
  std::vector<ChartPoint> points = {};     ///< points with markers
};

/// Straight line across a chart.
struct ChartGuide {
  double at = 0.0;                      ///< value on the axis
  bool vertical = false;                ///< true: a line at x = `at`; false: a line at y = `at`
  std::string label = {};               ///< tooltip, and text at the end of a vertical line without `key`
  std::optional<std::size_t> key = {};  ///< number of the formulation, which determines the colour
};

/// Chart with one pair of axes.
struct Chart {
  std::string id, title, note;          ///< identifier in the page, heading, and explanation as HTML
  std::string x_label, y_label;         ///< names of the axes with their units in brackets
  bool log_x = false, log_y = false;    ///< true: a logarithmic axis
  std::vector<double> x_marks = {};     ///< values of the labels of the x axis; empty: chosen by the axis
  std::vector<ChartCurve> curves = {};  ///< curves, the first one at the bottom
  std::vector<ChartGuide> guides = {};  ///< lines across the chart
};

/// Pixels, with one decimal, as text in an SVG path.
inline std::string px(double x) { return number(std::round(10.0 * x) / 10.0, 6); }

/// Drawing of a chart.
class ChartDrawing {
 public:
  static constexpr double width = 600, height = 440;                       ///< size of the picture
  static constexpr double left = 72, right = 586, top = 36, bottom = 384;  ///< sides of the plot

  explicit ChartDrawing(Chart const& chart)
      : chart_(chart),
        x_(values(true), chart.log_x, {left, right}, chart.log_x ? 0.06 : 0.0, chart.x_marks),
        y_(values(false), chart.log_y, {bottom, top}) {}

  /// HTML element `figure` with heading, plot and legend.
  std::string html() const {
    std::string const id = html_escaped(chart_.id), plot = "clip-" + id;
    std::string out = "<figure class=\"chart\" id=\"" + id + "\"><figcaption><h3 id=\"" + id + "-title\">" +
                      html_escaped(chart_.title) + "</h3>" +
                      (chart_.note.empty() ? std::string() : "<p>" + chart_.note + "</p>") + "</figcaption>\n";
    out += "<svg viewBox=\"0 0 " + px(width) + ' ' + px(height) + "\" role=\"img\" aria-labelledby=\"" + id +
           "-title\"><defs><clipPath id=\"" + plot + "\"><rect x=\"" + px(left) + "\" y=\"" + px(top - 2) +
           "\" width=\"" + px(right - left) + "\" height=\"" + px(bottom - top + 2) + "\"/></clipPath></defs>\n";
    out += axes() + "<g clip-path=\"url(#" + plot + ")\">";
    for (ChartGuide const& guide : chart_.guides) out += line_across(guide);
    out += "</g>\n";
    for (std::size_t k = 0; k < chart_.curves.size(); ++k) out += curve(k, plot);
    return out + "</svg>\n" + legend() + "</figure>\n";
  }

 private:
  std::vector<double> values(bool of_x) const {
    std::vector<double> all;
    for (ChartCurve const& c : chart_.curves) {
      auto const& line = of_x ? c.x : c.y;
      all.insert(all.end(), line.begin(), line.end());
      for (ChartPoint const& p : c.points) {
        if (of_x) all.push_back(p.x);
        if (!of_x) all.insert(all.end(), {p.y, p.least, p.most});
      }
      if (of_x || !(c.band > 0.0)) continue;
      for (double const y : c.y) all.insert(all.end(), {y - c.band, y + c.band});
    }
    return all;
  }

  static std::string text(std::string const& kind, double x, double y, std::string const& content) {
    return "<text class=\"" + kind + "\" x=\"" + px(x) + "\" y=\"" + px(y) + "\">" + html_escaped(content) + "</text>";
  }

  /// Name of an axis, with the factor of its labels before the unit: "energy minus 5000 J [10⁻³ J]".
  static std::string named(std::string label, ChartAxis const& axis) {
    std::size_t const at = label.rfind(" [");
    std::string unit = at == label.npos || !label.ends_with(']') ? "" : label.substr(at + 2, label.size() - at - 3);
    if (!unit.empty()) label.resize(at);
    if (!axis.offset().empty()) label += " minus " + axis.offset() + (unit.empty() || unit == "1" ? "" : ' ' + unit);
    if (!axis.factor().empty()) unit = axis.factor() + (unit.empty() || unit == "1" ? "" : ' ' + unit);
    return unit.empty() ? label : label + " [" + unit + ']';
  }

  std::string axes() const {
    std::string grid, minor, labels;
    for (ChartTick const& tick : x_.ticks()) {
      (tick.label.empty() ? minor : grid) += "M" + px(tick.at) + ' ' + px(top) + "V" + px(bottom);
      if (!tick.label.empty()) labels += text("tick x", tick.at, bottom + 21, tick.label);
    }
    for (ChartTick const& tick : y_.ticks()) {
      (tick.label.empty() ? minor : grid) += "M" + px(left) + ' ' + px(tick.at) + "H" + px(right);
      if (!tick.label.empty()) labels += text("tick y", left - 8, tick.at + 4.5, tick.label);
    }
    return "<path class=\"minor\" d=\"" + minor + "\"/><path class=\"grid\" d=\"" + grid +
           "\"/><path class=\"frame\" d=\"M" + px(left) + ' ' + px(top) + "V" + px(bottom) + "H" + px(right) +
           "\"/>\n" + labels + text("name x", 0.5 * (left + right), height - 7, named(chart_.x_label, x_)) +
           text("name y", 4, 17, named(chart_.y_label, y_)) + '\n';
  }

  std::string line_across(ChartGuide const& guide) const {
    ChartAxis const& axis = guide.vertical ? x_ : y_;
    if (!axis.contains(guide.at)) return {};
    std::string const at = px(axis.at(guide.at)), colour = guide.key ? " f" + std::to_string(*guide.key) : "";
    std::string out =
        "<path class=\"guide" + colour + "\" d=\"" +
        (guide.vertical ? "M" + at + ' ' + px(top) + "V" + px(bottom) : "M" + px(left) + ' ' + at + "H" + px(right)) +
        "\"><title>" + html_escaped(guide.label) + "</title></path>";
    return out;
  }

  /// Points of a line. From 1000 points on, only the lowest and the highest point within each unit of x remain.
  std::vector<std::array<double, 2>> polyline(ChartCurve const& c, double shift) const {
    std::vector<std::array<double, 2>> all, out;
    for (std::size_t i = 0; i < std::min(c.x.size(), c.y.size()); ++i)
      if (x_.shows(c.x[i]) && y_.shows(c.y[i] + shift)) all.push_back({x_.at(c.x[i]), y_.at(c.y[i] + shift)});
    if (all.size() < 1000) return all;
    auto const column = [](std::array<double, 2> const& p) { return std::floor(p[0]); };
    for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
      std::size_t low = i, high = i;
      for (end = i; end < all.size() && column(all[end]) == column(all[i]); ++end) {
        if (all[end][1] < all[low][1]) low = end;
        if (all[end][1] > all[high][1]) high = end;
      }
      out.push_back(all[std::min(low, high)]);
      if (low != high) out.push_back(all[std::max(low, high)]);
    }
    return out;
  }
  static std::string path_through(std::vector<std::array<double, 2>> const& points) {
    std::string out;
    for (auto const& [x, y] : points) out += (out.empty() ? "M" : "L") + px(x) + ' ' + px(y);
    return out;
  }

  static std::string colour_class(std::size_t key) { return "f" + std::to_string(key); }
  static std::string dashed(std::string_view dash) {
    return dash.empty() ? std::string() : " stroke-dasharray=\"" + std::string(dash) + '"';
  }

  /// Elements of curve k, in a group that the legend can hide.
  std::string curve(std::size_t k, std::string const& plot) const {
    ChartCurve const& c = chart_.curves[k];
    std::string out = "<g class=\"curve " + colour_class(c.key) + "\" data-curve=\"" + std::to_string(k) +
                      "\" data-formulation=\"" + std::to_string(c.key) + "\">";
    std::string clipped;
    if (c.band > 0.0) {
      auto area = polyline(c, c.band), lower = polyline(c, -c.band);
      area.insert(area.end(), lower.rbegin(), lower.rend());
      clipped += "<path class=\"band\" d=\"" + path_through(area) + "z\"/>";
    }
    if (auto const line = polyline(c, 0.0); line.size() > 1) {
      std::string const d = " d=\"" + path_through(line) + '"';
      std::string const title = "<title>" + html_escaped(c.label + (c.note.empty() ? "" : ", " + c.note)) + "</title>";
      clipped +=
          "<path class=\"line\"" + (c.second ? std::string() : dashed(c.style.dash)) + d + '>' + title + "</path>";
      if (c.second)
        clipped += "<path class=\"line " + colour_class(*c.second) + "\" stroke-dasharray=\"9 9\"" + d + '>' + title +
                   "</path>";
    }
    if (!clipped.empty()) out += "<g clip-path=\"url(#" + plot + ")\">" + clipped + "</g>";
    for (bool const strong : {false, true})
      for (ChartPoint const& p : c.points)
        if (p.strong == strong && x_.shows(p.x) && y_.shows(p.y)) out += point(c, p);
    return out + "</g>\n";
  }

  std::string point(ChartCurve const& c, ChartPoint const& p) const {
    std::string const x = px(x_.at(p.x)), y = px(y_.at(p.y));
    std::string out;
    if (y_.shows(p.least) && p.most > p.least)
      out += "<path class=\"range\" d=\"M" + x + ' ' + px(y_.at(p.least)) + "V" + px(y_.at(p.most)) + "\"/>";
    if (p.ringed) out += "<circle class=\"ring\" cx=\"" + x + "\" cy=\"" + y + "\" r=\"8.5\"/>";
    out += "<path class=\"marker" + std::string(c.style.open() ? " open" : "") + (p.strong ? "" : " pale") +
           "\" transform=\"translate(" + x + ' ' + y + ")" + (p.strong ? "" : " scale(.7)") + "\" d=\"" +
           std::string(marker_path(c.style.marker)) + "\"><title>" + html_escaped(p.title) + "</title></path>";
    return out;
  }

  std::string legend() const {
    std::string out = "<ul class=\"legend\">";
    for (std::size_t k = 0; k < chart_.curves.size(); ++k) {
      ChartCurve const& c = chart_.curves[k];
      out += "<li><button type=\"button\" aria-pressed=\"true\" data-curve=\"" + std::to_string(k) + "\">" +
             swatch(c.style, c.key, c.second, !c.points.empty()) + "<span>" + html_escaped(c.label) +
             (c.note.empty() ? std::string() : " <small>" + html_escaped(c.note) + "</small>") +
             "</span></button></li>";
    }
    return out + "</ul>\n";
  }

 public:
  /// Small picture of a line with a marker, for legends and tables.
  static std::string swatch(FormulationStyle const& style, std::size_t key, std::optional<std::size_t> second = {},
                            bool marked = true) {
    std::string out = "<svg class=\"swatch " + colour_class(key) + "\" viewBox=\"0 0 36 14\" aria-hidden=\"true\" " +
                      "data-formulation=\"" + std::to_string(key) + "\"><path class=\"line\"" +
                      (second ? std::string() : dashed(style.dash)) + " d=\"M1 7H35\"/>";
    if (second) out += "<path class=\"line " + colour_class(*second) + "\" stroke-dasharray=\"9 9\" d=\"M1 7H35\"/>";
    if (marked && !second)
      out += "<path class=\"marker" + std::string(style.open() ? " open" : "") +
             "\" transform=\"translate(18 7)\" d=\"" + std::string(marker_path(style.marker)) + "\"/>";
    return out + "</svg>";
  }

 private:
  Chart const& chart_;
  ChartAxis x_, y_;
};

}  // namespace polybody::detail
