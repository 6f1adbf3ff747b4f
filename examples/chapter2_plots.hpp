#pragma once
// Pictures and tables that the two programs of Chapter 2 share.
#include "chapter2.hpp"

#include <filesystem>
#include <iostream>

namespace chapter2 {

// Centre line of a body, as `samples` straight pieces in the plane.
template <class M, class B>
Curve shape_of(M const& model, State const& x, BodyHandle<B> const& handle, double bar_length, int samples = 60) {
  Curve c;
  for (int i = 0; i <= samples; ++i) {
    Vec3 const r = position(model, x, handle.at(bar_length * i / samples));
    c.x.push_back(r[0]);
    c.y.push_back(r[1]);
  }
  return c;
}

// Beam with a position mesh and a rotation mesh.
template <class B>
concept HasTwoMeshes = requires(B const& beam, std::span<double const> q) { mesh_diagnostics(beam, q); };

// Rotation mesh: the curve that the rotation field of a beam implies.
template <class M, HasTwoMeshes B>
Curve implied_shape_of(M const& model, State const& x, BodyHandle<B> const& handle) {
  Curve c;
  for (Vec2 const& r : implied_curve(handle.body(), coordinates_of(model, x, handle), 6)) {
    c.x.push_back(r[0]);
    c.y.push_back(r[1]);
  }
  return c;
}

// Adds both meshes of a beam as two curves, or the centre line of another body as one curve, with its nodes and the
// time at the tip. Only the first snapshot has labels.
template <class M, class B>
void add_snapshot(Figure& figure, M const& model, State const& x, BodyHandle<B> const& handle, double bar_length) {
  bool const first = figure.curves.empty();
  Curve position = shape_of(model, x, handle, bar_length);
  position.colour = 0;
  if constexpr (HasTwoMeshes<B>) {
    position.label = first ? "position mesh" : "";
    Curve rotation = implied_shape_of(model, x, handle);
    rotation.colour = 1;
    rotation.style = "dashed";
    rotation.label = first ? "rotation mesh" : "";
    figure.curves.push_back(position);
    figure.curves.push_back(rotation);
  } else {
    position.label = first ? "centre line" : "";
    figure.curves.push_back(position);
  }
  Curve nodes = shape_of(model, x, handle, bar_length, int(handle.body().elements()));
  nodes.label = first ? "nodes" : "";
  nodes.style = "points";
  nodes.colour = 0;
  figure.curves.push_back(nodes);
  figure.texts.push_back({nodes.x.back(), nodes.y.back(), number(x.t, 3) + " s"});
}

// Adds points of both meshes to the columns of a table: a number of the state, the arc length s, and the points at s on
// the position mesh and on the rotation mesh, `samples` in each element.
template <class M, HasTwoMeshes B>
void add_points(std::vector<std::vector<double>>& columns, double state, M const& model, State const& x,
                BodyHandle<B> const& handle, int samples = 2) {
  auto const implied = implied_curve(handle.body(), coordinates_of(model, x, handle), samples);
  Index const dim = implied[0].size();
  columns.resize(std::size_t(2 + 2 * dim));
  double const part = handle.body().length() / double(implied.size() - 1);
  for (std::size_t i = 0; i < implied.size(); ++i) {
    Vec3 const r = position(model, x, handle.at(part * double(i)));
    columns[0].push_back(state);
    columns[1].push_back(part * double(i));
    for (Index k = 0; k < dim; ++k) {
      columns[std::size_t(2 + k)].push_back(r[k]);
      columns[std::size_t(2 + dim + k)].push_back(implied[i][k]);
    }
  }
}

// Sets the ranges and the size of a figure of shapes, so that flat shapes remain readable on equal axes.
inline void fit(Figure& figure) {
  double lo[2] = {0.0, 0.0}, hi[2] = {0.0, 0.0};
  for (Curve const& c : figure.curves)
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      lo[0] = std::min(lo[0], c.x[i]);
      hi[0] = std::max(hi[0], c.x[i]);
      lo[1] = std::min(lo[1], c.y[i]);
      hi[1] = std::max(hi[1], c.y[i]);
    }
  double const margin = 0.5, wide = hi[0] - lo[0] + 2.0 * margin;
  double const missing = std::max(0.0, 0.35 * wide - (hi[1] - lo[1] + 2.0 * margin));
  figure.x_range = {lo[0] - margin, hi[0] + margin};
  figure.y_range = {lo[1] - margin - 0.5 * missing, hi[1] + margin + 0.5 * missing};
  double const tall = (*figure.y_range)[1] - (*figure.y_range)[0];
  figure.width_px = 1000;
  figure.height_px = int(std::min(1200.0, 200.0 + 850.0 * tall / wide));
}

// Writes histories of a run to one CSV file, with one column for each history and one row for each time.
inline void write_table(std::filesystem::path const& file, std::vector<std::string> const& heads,
                        std::vector<std::vector<double>> const& columns) {
  Csv csv(file, heads);
  std::vector<double> row(heads.size());
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    for (std::size_t j = 0; j < heads.size(); ++j) row[j] = columns[j][i];
    csv.row(std::span<double const>(row));
  }
  csv.close();
}

// Stiffnesses of a section as text, for the title of a figure.
inline std::string stiffness_text(Stiffness const& s) {
  return "EA = " + number(s.EA, 3) + " N, GA = " + number(s.GA, 3) + " N, EI = " + number(s.EI, 3) + " N m²";
}

inline void draw(Figure const& figure, std::filesystem::path const& stem, bool plot) {
  DrawResult const drawn = write_figure(figure, stem, plot);
  std::cout << "  " << stem.string() << (drawn == DrawResult::png ? ".png" : ".gp") << '\n';
}

// Prints the table of a comparison, and writes the files of its report to `folder`.
inline void report(Comparison const& c, std::filesystem::path const& folder, bool plot) {
  std::cout << c << '\n';
  for (std::filesystem::path const& file : write_report(c, folder, plot)) std::cout << "  " << file.string() << '\n';
}

}  // namespace chapter2
