#include "space.hpp"

#include "../chapter2_plots.hpp"
#include "../chapter2_space.hpp"

namespace fs = std::filesystem;

namespace chapter2 {
namespace {

// One row for each mesh. The points are those of the first one.
template <class MakeBeam>
void row_for_each(char const* problem, char const* body, std::array<Index, 3> const& meshes, MakeBeam const& make,
                  std::vector<std::vector<double>>& points) {
  for (Index const n : meshes) {
    auto const beam = make(n);
    Gap<3> const a = beam.gap();
    std::printf("  space %-5s %-8s %3d elements %12.4e %12.4e %12.4e\n", problem, body, int(n), a.gap, a.strain.norm(),
                a.interpolation.norm());
    if (n == meshes.front()) add_points(points, double(n), beam.model, beam.x, beam.beam, 4);
  }
}

// Shapes in the plane of two coordinates.
Figure figure_of(std::string title, std::vector<std::vector<double>> const& lrvf,
                 std::vector<std::vector<double>> const& se3, std::size_t x, std::size_t y) {
  Figure f{.title = std::move(title), .equal_axes = true};
  char const* const axes[] = {"x [m]", "y [m]", "z [m]"};
  f.x_label = axes[x];
  f.y_label = axes[y];
  auto const add = [&](auto const& points, std::size_t column, char const* label, int colour, char const* style) {
    f.curves.push_back(
        {.x = points[column + x], .y = points[column + y], .label = label, .style = style, .colour = colour});
  };
  add(lrvf, 2, "LRVF, position mesh", 0, "lines");
  add(lrvf, 5, "LRVF, rotation mesh", 0, "dashed");
  add(se3, 2, "Se3Beam, position mesh", 7, "lines");
  add(se3, 5, "Se3Beam, rotation mesh", 6, "dashed");
  return f;
}

}  // namespace
}  // namespace chapter2

void meshes_in_space(fs::path const& folder, bool plot) {
  using namespace chapter2;
  std::printf("\nTwo meshes in space [m]:\n\n  %-32s %12s %12s %12s\n", "", "gap", "strain", "interpol.");
  std::vector<Figure> figures;
  auto const both = [&](char const* name, char const* title, std::array<Index, 3> const& meshes, auto const& lrvf,
                        auto const& se3, std::size_t y) {
    std::vector<std::vector<double>> of_lrvf, of_se3;
    row_for_each(name, "LRVF", meshes, lrvf, of_lrvf);
    row_for_each(name, "Se3Beam", meshes, se3, of_se3);
    std::vector<std::string> const heads{"elements",         "s [m]",
                                         "x, positions [m]", "y, positions [m]",
                                         "z, positions [m]", "x, rotations [m]",
                                         "y, rotations [m]", "z, rotations [m]"};
    write_table(folder / (std::string(name) + "_meshes.csv"), heads, of_lrvf);
    write_table(folder / (std::string(name) + "_se3_meshes.csv"), heads, of_se3);
    figures.push_back(figure_of(title, of_lrvf, of_se3, 0, y));
  };
  both("helix", "Moment and torque, 10 elements", {10, 20, 40}, helix<Lrvf<>>, helix<Se3Beam>, 1);
  both("bend", "45° bend under 600 N, 8 elements", {8, 16, 32}, bend<Lrvf<>>, bend<Se3Beam>, 2);
  DrawResult const drawn = write_panels(figures, 2, folder / "meshes_in_space", plot);
  std::cout << "  " << (folder / "meshes_in_space").string() << (drawn == DrawResult::png ? ".png" : ".gp") << '\n';
}
