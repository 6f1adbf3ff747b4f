#pragma once
/// \file
/// Pictures and films of vibration and buckling modes.

#include <numbers>

#include <polybody/io/film_scene.hpp>
#include <polybody/io/plot.hpp>
#include <polybody/io/visual.hpp>

namespace polybody {

/// Options of mode pictures: size of the displacements, view and text.
struct ModePictureOptions {
  double size = 0.1;                     ///< largest displacement, relative to the diagonal of the box around the model
  Vec3 look_from = Vec3(-2, -3, 1.5);    ///< (3) direction from the model to the camera, world axes
  Vec3 up = Vec3::UnitZ();               ///< (3) upward direction in the picture, world axes
  int columns = 2;                       ///< number of panels in a row
  bool draw = true;                      ///< true: draws the PNG with gnuplot; false: writes only data and script
  std::vector<std::string> titles = {};  ///< title of each mode; empty: "mode 1", "mode 2" …
};

namespace detail {

/// \throws InvalidInput unless the size is positive and the view directions are finite and not parallel.
template <class = void>
void require_picture(ModePictureOptions const& options) {
  require_positive(options.size, "mode pictures: the size of the displacements");
  double const across = options.look_from.cross(options.up).norm();
  if (!(across > 1e-6 * options.look_from.norm() * options.up.norm()))
    throw InvalidInput("film.camera",
                       {ErrorObject{"mode pictures"}, ": look_from and up must be finite and not parallel, but are (",
                        options.look_from[0], ", ", options.look_from[1], ", ", options.look_from[2], ") and (",
                        options.up[0], ", ", options.up[1], ", ", options.up[2], ")."});
}

/// Parts of a model in state x and their displacements in one mode.
class ModeShape {
 public:
  /// Scales the mode `shape` (nv) such that its largest displacement is `size` times the diagonal of the model. The
  /// displacements, linear in the mode, are the velocities of the points at v = `shape`.
  ModeShape(Visual& visual, State const& x, MatX::ConstColXpr const& shape, double size) {
    if (shape.size() != x.v.size())
      throw InvalidInput("mode.size", {ErrorObject{"mode pictures"}, ": a mode has ", ErrorValue{shape.size()},
                                       " entries, but the state has ", x.v.size(),
                                       " velocities. Give the state for which the modes were computed."});
    State y = x;
    y.v = shape;
    parts_ = visual.at(y);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    double largest = 0.0;
    for (VisualPart const& part : parts_)
      for (std::size_t i = 0; i < part.surface.points.size(); ++i) {
        low = low.cwiseMin(part.surface.points[i]);
        high = high.cwiseMax(part.surface.points[i]);
        largest = std::max(largest, part.velocities[i].norm());
      }
    if (parts_.empty())
      throw InvalidInput("visual.empty",
                         {ErrorObject{"mode pictures"}, ": the Visual has no shape. Add shapes by sweep or attach."});
    scale_ = largest > 0.0 ? size * (high - low).norm() / largest : 0.0;
  }
  std::vector<VisualPart> const& parts() const { return parts_; }
  /// Position of point i of a part, displaced by the fraction `phase` of the largest displacement.
  Vec3 point(VisualPart const& part, std::size_t i, double phase) const {
    return part.surface.points[i] + phase * scale_ * part.velocities[i];
  }
  /// Parts displaced by the fraction `phase` of the largest displacement, as deformable parts of a film.
  std::vector<VisualPart> displaced(double phase) const {
    std::vector<VisualPart> out = parts_;
    for (std::size_t k = 0; k < out.size(); ++k) {
      for (std::size_t i = 0; i < out[k].surface.points.size(); ++i)
        out[k].surface.points[i] = point(parts_[k], i, phase);
      out[k].carried.clear();
      out[k].axial_stress.clear();
    }
    return out;
  }

 private:
  std::vector<VisualPart> parts_;
  double scale_ = 0.0;
};

/// Walks along all edges of a surface, one walk without jumps for each connected part. A walk is a depth-first search
/// that returns along each edge.
/// \return for each walk, the indices of its points in their order
template <class = void>
std::vector<std::vector<int>> edge_walks(Surface const& surface) {
  std::vector<std::vector<int>> next(surface.points.size()), walks;
  int begin = 0;
  for (int const end : surface.ends) {
    for (int k = begin; k < end; ++k) {
      int const a = surface.corners[std::size_t(k)], b = surface.corners[std::size_t(k + 1 == end ? begin : k + 1)];
      if (a < b) next[std::size_t(a)].push_back(b);
      if (b < a) next[std::size_t(b)].push_back(a);
    }
    begin = end;
  }
  for (auto& list : next) {  // each edge is stored once at each of its two ends
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  std::vector<std::vector<int>> const lower = next;
  for (std::size_t a = 0; a < lower.size(); ++a)
    for (int const b : lower[a]) next[std::size_t(b)].push_back(int(a));
  std::vector<char> seen(next.size(), 0);
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (seen[start] || next[start].empty()) continue;
    std::vector<int> walk{int(start)}, path{int(start)};
    seen[start] = 1;
    std::vector<std::size_t> at(next.size(), 0);
    while (!path.empty()) {
      int const here = path.back();
      if (at[std::size_t(here)] == next[std::size_t(here)].size()) {
        path.pop_back();
        if (!path.empty()) walk.push_back(path.back());
        continue;
      }
      int const there = next[std::size_t(here)][at[std::size_t(here)]++];
      walk.push_back(there);
      if (seen[std::size_t(there)]) {
        walk.push_back(here);
      } else {
        seen[std::size_t(there)] = 1;
        path.push_back(there);
      }
    }
    walks.push_back(std::move(walk));
  }
  return walks;
}

/// Title of mode k.
inline std::string mode_title(ModePictureOptions const& options, std::size_t k) {
  return k < options.titles.size() ? options.titles[k] : "mode " + std::to_string(k + 1);
}

/// Sets the axis ranges of a figure with equal axes to the aspect ratio 1.5 of its panel, so that the axis labels have
/// space.
template <class = void>
void fill_panel(Figure& figure) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Curve const& curve : figure.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      low = low.cwiseMin(Vec2(curve.x[i], curve.y[i]));
      high = high.cwiseMax(Vec2(curve.x[i], curve.y[i]));
    }
  Vec2 const middle = 0.5 * (low + high);
  double const aspect = 1.5, height = 1.1 * std::max(high[1] - low[1], (high[0] - low[0]) / aspect);
  if (!(height > 0.0)) return;
  figure.x_range = {middle[0] - 0.5 * aspect * height, middle[0] + 0.5 * aspect * height};
  figure.y_range = {middle[1] - 0.5 * height, middle[1] + 0.5 * height};
}

/// Panel of one mode: edges of the undeformed model in thin lines, and edges of the model displaced by the mode.
template <class = void>
Figure mode_figure(ModeShape const& mode, ModePictureOptions const& options, std::string title) {
  Vec3 const back = options.look_from.normalized(), right = options.up.cross(back).normalized(), up = back.cross(right);
  Figure figure{.title = std::move(title), .x_label = "m", .y_label = "m", .equal_axes = true, .legend = false};
  for (double const phase : {0.0, 1.0})
    for (VisualPart const& part : mode.parts())
      for (std::vector<int> const& walk : edge_walks<>(part.surface)) {
        Curve curve{.colour = phase == 0.0 ? 6 : 0, .width = phase == 0.0 ? 0.4 : 1.0};
        for (int const i : walk) {
          Vec3 const p = mode.point(part, std::size_t(i), phase);
          curve.x.push_back(right.dot(p));
          curve.y.push_back(up.dot(p));
        }
        figure.curves.push_back(std::move(curve));
      }
  fill_panel<>(figure);
  return figure;
}

}  // namespace detail

/// Titles such as "mode 1, 5.37 Hz" for the angular frequencies ω [rad/s] of `Modes::frequency`. The title for a
/// negative ω, which means an unstable motion, is "mode 1, unstable".
template <class = void>
std::vector<std::string> mode_titles(VecX const& frequency) {
  std::vector<std::string> titles;
  for (Index i = 0; i < frequency.size(); ++i) {
    char hertz[40];
    std::snprintf(hertz, sizeof hertz, "%.4g", std::abs(frequency[i]) / (2.0 * std::numbers::pi));
    titles.push_back("mode " + std::to_string(i + 1) + (frequency[i] < 0.0 ? ", unstable" : ", ") +
                     (frequency[i] < 0.0 ? std::string() : std::string(hertz) + " Hz"));
  }
  return titles;
}

/// Draws modes in one picture, with one panel for each column of `shapes`. A panel shows the edges of the model in
/// state x in thin lines, and the edges displaced by the mode:
///   Modes const found = modes(model, x, 4);
///   write_modes(visual, x, found.shape, "out/modes", {.titles = mode_titles(found.frequency)});
/// Displacements are linear, so large rotations look stretched. Writes `stem`.dat, .gp and, if gnuplot is on PATH, .png
/// (see `write_panels`). `shapes` (nv×k) are the shapes of `modes` or `buckling_modes`, or the real parts of damped
/// modes.
/// \throws InvalidInput for shapes without columns or of another model, for a size that is not positive, for parallel
/// view directions, and for a visual without shapes; IoError if a file cannot be written or gnuplot fails.
template <class = void>
DrawResult write_modes(Visual& visual, State const& x, MatX const& shapes, std::filesystem::path const& stem,
                       ModePictureOptions const& options = {}) {
  detail::require_picture<>(options);
  if (shapes.cols() == 0)
    throw InvalidInput("mode.number", {ErrorObject{"mode pictures"},
                                       ": the matrix of shapes has no columns. Compute at least one mode."});
  std::vector<Figure> panels;
  for (Index k = 0; k < shapes.cols(); ++k)
    panels.push_back(detail::mode_figure<>(detail::ModeShape(visual, x, shapes.col(k), options.size), options,
                                           detail::mode_title(options, std::size_t(k))));
  return write_panels(panels, options.columns, stem, options.draw);
}

/// Records one period of a mode, column `mode` of `shapes`, as frames of a film:
///   record_mode(film.scene("mode 1"), visual, x, found.shape, 0);
/// The period is 2 s for every frequency. The displacements at time t [s] are those of `write_modes` with this `size`,
/// times sin(πt).
/// \throws InvalidInput like `write_modes`, and for a column that does not exist.
template <class = void>
void record_mode(FilmScene& scene, Visual& visual, State const& x, MatX const& shapes, Index mode, double size = 0.1) {
  detail::require_picture<>({.size = size});
  if (mode < 0 || mode >= shapes.cols())
    throw InvalidInput("mode.number", {ErrorObject{"record_mode"}, ": mode ", ErrorValue{mode},
                                       " does not exist; the shapes have ", shapes.cols(), " modes, counted from 0."});
  detail::ModeShape const displaced(visual, x, shapes.col(mode), size);
  for (int k = 0; k <= 60; ++k)
    if (double const t = k / 30.0; scene.due(t)) scene.record(t, displaced.displaced(std::sin(std::numbers::pi * t)));
}

}  // namespace polybody
