// Tables of numbers from files: SmoothTable, MonotoneTable and RoadProfile. An accepted table interpolates its points
// and is finite between them. Outside it is finite up to the distance of the last two points. A road does not exceed
// its highest point.
#include <cmath>

#include <polybody/math/smooth_table.hpp>
#include <polybody/vehicle/terrain.hpp>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

struct Pair {
  double x, y;
};
bool names_table(std::string const& message) { return message.starts_with("the table"); }

/// Calls `at(x)` at the points, between them and on both sides.
template <class F>
void visit(std::vector<Pair> const& points, F&& at) {
  std::size_t const n = points.size();
  at(2.0 * points[0].x - points[1].x), at(2.0 * points[n - 1].x - points[n - 2].x);
  for (std::size_t i = 0; i < points.size(); ++i) {
    at(points[i].x);
    if (i > 0)
      for (double const share : {0.25, 0.5, 0.75}) at(points[i - 1].x + share * (points[i].x - points[i - 1].x));
  }
}

void smooth(std::vector<Pair> const& pairs, SmoothTable::Ends const& ends) {
  std::vector<SmoothTable::Point> points;
  for (Pair const& p : pairs) points.push_back({p.x, p.y});
  auto const table = accepted([&] { return SmoothTable(points, ends, "the table"); }, names_table);
  if (!table) return;
  for (Pair const& p : pairs) require((*table)(p.x).value == p.y, "a smooth table goes through its points");
  visit(pairs, [&](double t) {
    Motion const m = (*table)(t);
    require(std::isfinite(m.value) && std::isfinite(m.rate) && std::isfinite(m.acceleration),
            "a smooth table is finite at t = ", t);
    require(std::isfinite(table->integral(t)), "the integral of a smooth table is finite at t = ", t);
  });
}

void monotone(std::vector<Pair> const& pairs) {
  std::vector<MonotoneTable::Point> points;
  for (Pair const& p : pairs) points.push_back({p.x, p.y});
  auto const table = accepted([&] { return MonotoneTable(points, "the table"); }, names_table);
  if (!table) return;
  for (Pair const& p : pairs) require((*table)(p.x) == p.y, "a monotone table goes through its points");
  visit(pairs, [&](double x) {
    require(std::isfinite((*table)(x)) && std::isfinite(table->slope(x)), "a monotone table is finite at x = ", x);
    require(std::isfinite(table->integral(x)), "the integral of a monotone table is finite at x = ", x);
  });
}

void road(std::vector<Pair> const& pairs) {
  std::vector<RoadProfile::Point> points;
  for (Pair const& p : pairs) points.push_back({p.x, p.y});
  auto const table = accepted([&] { return RoadProfile(points, "the table"); }, names_table);
  if (!table) return;
  visit(pairs, [&](double x) {
    Height<double> const h = table->height(x, 0.0);
    require(std::isfinite(h.z) && std::isfinite(h.slope_x), "a road is finite at x = ", x);
    require(h.z <= table->highest(), "a road stays below its highest point at x = ", x);
  });
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  Numbers numbers(data, size);
  int const ends = numbers.byte();
  polybody::SmoothTable::Ends rates;
  if (ends & 1) rates.first_rate = numbers.next();
  if (ends & 2) rates.last_rate = numbers.next();
  std::vector<Pair> pairs;
  while (numbers.left() >= 2) {
    double const x = numbers.next();
    pairs.push_back({x, numbers.next()});
    if ((ends & 4) && pairs.size() > 1)  // widths instead of positions: these increase
      pairs.back().x = pairs[pairs.size() - 2].x + std::abs(x);
  }
  smooth(pairs, rates);
  monotone(pairs);
  road(pairs);
  return 0;
}
