// Height fields. An accepted field interpolates its points, is finite within its cells and outside, and does not
// exceed `highest()`.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/vehicle/terrain.hpp>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

void check(HeightField const& field, HeightField::Grid const& grid) {
  MatX const& z = grid.heights;
  double const size = largest_size(z.reshaped());
  // In addition to round-off, each product of denormal numbers has an error of the least denormal number. There are
  // four products, and sums of four times up to dy.
  double const least = std::numeric_limits<double>::denorm_min();
  double const rounding = 1e-9 * size + 32.0 * least * std::max<double>({1.0, grid.dx, grid.dy});
  auto const at = [&](double i, double j) { return field.height(grid.x0 + i * grid.dx, grid.y0 + j * grid.dy); };
  for (double i = -2.0; i <= double(z.rows()) + 1.0; i += 0.5)
    for (double j = -2.0; j <= double(z.cols()) + 1.0; j += 0.5) {
      Height<double> const h = at(i, j);
      require(std::isfinite(h.z) && std::isfinite(h.slope_x) && std::isfinite(h.slope_y), "heights are finite at ", i,
              ", ", j);
      require(h.z <= field.highest() + rounding, "heights stay below the highest at ", i, ", ", j);
    }
  // If positions have few digits compared with the spacing, the cell search is not exact.
  if (std::abs(grid.x0) > 1e3 * grid.dx || std::abs(grid.y0) > 1e3 * grid.dy) return;
  for (Index i = 0; i < z.rows(); ++i)
    for (Index j = 0; j < z.cols(); ++j)
      require(std::abs(at(double(i), double(j)).z - z(i, j)) <= rounding, "a field goes through its points");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody;
  using namespace polybody::fuzz;
  Numbers numbers(data, size);
  Index const rows = numbers.byte() % 6, columns = numbers.byte() % 6;
  double place[4];
  for (double& x : place) x = numbers.next();
  HeightField::Grid grid{place[0], place[1], place[2], place[3], MatX(rows, columns)};
  for (double& z : grid.heights.reshaped()) z = numbers.next();
  auto const field = accepted([&] { return HeightField(grid, "the field"); },
                              [](std::string const& message) { return message.starts_with("the field"); });
  if (field) check(*field, grid);
  return 0;
}
