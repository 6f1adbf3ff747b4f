#pragma once
// Common parts of the small mechanisms: the check of a known number, and a picture of the moving parts.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <polybody/polybody.hpp>

namespace mechanism {

// Prints a number beside its known value. The exit code of a program is 0 if they agree within the tolerance.
inline int compare(char const* quantity, double value, double known, double tolerance) {
  bool const good = std::abs(value - known) <= tolerance;
  std::printf("%s: %.6g, known %.6g%s\n", quantity, value, known, good ? "" : ": they differ");
  return good ? 0 : 1;
}

// Picture of moving parts: lines through points at several times. Axes u and v are 0, 1 or 2 for x, y or z.
class Picture {
 public:
  Picture(std::string title, int u, int v) : u_(u), v_(v) {
    char const* const names[] = {"x [m]", "y [m]", "z [m]"};
    figure_ = {
        .title = std::move(title), .x_label = names[u], .y_label = names[v], .equal_axes = true, .legend = false};
    figure_.width_px = 700;
    figure_.height_px = 500;
  }
  // Adds a line through points at the time t [s]. A time that is not negative is written beside the point `label`, by
  // default the second of a few points or the last of many.
  void line(std::vector<polybody::Vec3> const& points, int colour, double t = -1.0, int label = -1) {
    polybody::Curve c{.style = points.size() > 1 ? "lines" : "points", .colour = colour, .width = 2.5};
    for (polybody::Vec3 const& p : points) c.x.push_back(p[u_]), c.y.push_back(p[v_]);
    std::size_t const last = points.size() - 1, few = points.size() > 5 ? last : std::min<std::size_t>(1, last);
    std::size_t const at = label < 0 ? few : std::size_t(label);
    if (t >= 0.0) figure_.texts.push_back({c.x[at], c.y[at], polybody::number(t, 3) + " s"});
    figure_.curves.push_back(std::move(c));
  }
  // Adds the area inside a closed line, translucent, with its outline.
  void area(std::vector<polybody::Vec3> const& points, int colour) {
    line(points, colour);
    figure_.curves.push_back(figure_.curves.back());
    figure_.curves.back().style = "filled";
  }
  // Adds a text at the right of a point.
  void text(polybody::Vec3 const& p, std::string words) { figure_.texts.push_back({p[u_], p[v_], std::move(words)}); }
  // Writes out/mechanisms/NAME.png, with its data and script. A flat picture gets a height of a third of its width, and
  // a tall one a width of its height. A text that would cover an earlier one is omitted.
  void write(std::string const& name) {
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (polybody::Curve const& c : figure_.curves)
      for (std::size_t i = 0; i < c.x.size(); ++i) {
        low[0] = std::min(low[0], c.x[i]), high[0] = std::max(high[0], c.x[i]);
        low[1] = std::min(low[1], c.y[i]), high[1] = std::max(high[1], c.y[i]);
      }
    double const width = high[0] - low[0], height = high[1] - low[1], size = std::max(width, height);
    double const least[2] = {height, 0.35 * width}, margin = 0.06 * size;
    for (int k = 0; k < 2; ++k) {
      double const missing = std::max(0.0, least[k] - (high[k] - low[k]));
      low[k] -= margin + 0.5 * missing, high[k] += margin + 0.5 * missing;
    }
    std::vector<polybody::FigureText> kept;
    for (polybody::FigureText& text : figure_.texts) {
      text.y += 0.02 * size;
      bool const covers = std::ranges::any_of(kept, [&](polybody::FigureText const& other) {
        return std::abs(text.x - other.x) < 0.18 * size && std::abs(text.y - other.y) < 0.05 * size;
      });
      if (!covers) kept.push_back(std::move(text));
    }
    figure_.texts = std::move(kept);
    if (!figure_.texts.empty()) high[0] += 0.08 * size;  // room for a text at the right
    figure_.x_range = {low[0], high[0]};
    figure_.y_range = {low[1], high[1]};
    std::filesystem::create_directories("out/mechanisms");
    write_figure(figure_, "out/mechanisms/" + name);
  }

 private:
  polybody::Figure figure_;
  int u_, v_;
};

}  // namespace mechanism
