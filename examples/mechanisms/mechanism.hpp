#pragma once
// Common parts of the small mechanisms: the check of a known number, and a picture of the moving parts.
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
    figure_ = {.title = std::move(title), .x_label = names[u], .y_label = names[v], .equal_axes = true, .legend = false};
    figure_.width_px = 700;
    figure_.height_px = 500;
  }
  // Adds a line through points at the time t [s]. A positive t is written at its last point.
  void line(std::vector<polybody::Vec3> const& points, int colour, double t = -1.0) {
    polybody::Curve c{.style = points.size() > 1 ? "lines" : "points", .colour = colour};
    for (polybody::Vec3 const& p : points) c.x.push_back(p[u_]), c.y.push_back(p[v_]);
    if (t >= 0.0) figure_.texts.push_back({c.x.back(), c.y.back(), polybody::number(t, 3) + " s"});
    figure_.curves.push_back(std::move(c));
  }
  // Writes out/mechanisms/NAME.png, with its data and script.
  void write(std::string const& name) const {
    std::filesystem::create_directories("out/mechanisms");
    write_figure(figure_, "out/mechanisms/" + name);
  }

 private:
  polybody::Figure figure_;
  int u_, v_;
};

}  // namespace mechanism
