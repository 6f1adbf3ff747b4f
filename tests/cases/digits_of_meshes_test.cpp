// Digits of the tip of cantilevers in space with 1 to 32 elements, and the order of convergence, by Lrvf, Se3Beam and
// AncfBeam (S1, S4 to S8). The table of docs/formulations.md contains these numbers.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "support/spatial_rods.hpp"

using namespace polybody;

namespace digits_of_meshes_test {

using namespace spatial_rods;

constexpr Index meshes[] = {1, 2, 4, 8, 16, 32};

/// Digits −log10 of the error with each mesh, and the order from the two finest meshes, as cells of the table.
std::vector<std::string> cells_of(std::vector<double> const& errors) {
  std::vector<std::string> cells;
  for (double const e : errors) {
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", -std::log10(e));
    cells.push_back(e < 1e-9 ? "exact" : text);
  }
  char order[16];
  std::snprintf(order, sizeof order, "%.2f", std::log2(errors[4] / errors[5]));
  cells.push_back(errors[5] < 1e-9 ? "–" : order);
  return cells;
}

/// Problem with its tip displacement and the displacement of the exact rod.
template <class B>
struct Problem {
  char const* name;
  std::function<Vec3(Index)> tip;
  Vec3 exact;
};
template <class B>
std::vector<Problem<B>> problems() {
  auto const tip = [](Bar bar, TipLoad const& load, ReferenceCurve const& curve = {}) {
    if (bar.constants->rotary_inertia == 0.0) bar.constants->rotary_inertia = 0.01;  // AncfBeam needs it; no effect
    return [=](Index n) {
      B const body = curve ? B::from(bar, n, curve) : B::from(bar, n);
      return SpatialCantilever<B>(body, load, {.load_steps = n < 4 ? 20 : 4}).tip_displacement();
    };
  };
  double const beta = pi / 3;
  Bar const thick{.length = 2.0,
                  .section = Rectangle{.height = 0.5, .width = 0.1},
                  .material = Material{.density = 7850, .young = 2.07e11, .poisson = 0.3}};
  Bar const of_constants{.length = 2.0, .constants = constants(thick)};
  Bar const arc = spatial_cantilevers::bend_bar(5e6, polar);
  Vec3 const end = spatial_cantilevers::bend_curve(arc.length).origin;
  return {
      {"S1, 1 rad", tip(rolled_bar(), {.moment = {0, 0, 1}}), Vec3(std::sin(1.0) - 1, 1 - std::cos(1.0), 0)},
      {"S4, 62.5 MN", tip(of_constants, {.force = {0, 6.25e7, 0}}), Vec3(-0.1509711442396, 0.7105685978542, 0)},
      {"S5, dead moments", tip(end_moments_bar(), {.moment = {0.5e6, 2e6, 0}}), dead_moments},
      {"S6, 13.345 N at 60°",
       tip(spatial_cantilevers::princeton(), {.force = 13.345 * Vec3(0, -std::cos(beta), std::sin(beta))}),
       princeton[18].tip},
      {"S7, 600 N", tip(arc, {.force = {0, 0, 600}}, spatial_cantilevers::bend_curve), bends[2].tip - end},
      {"S7, 3000 N", tip(arc, {.force = {0, 0, 3000}}, spatial_cantilevers::bend_curve), bends[3].tip - end},
      {"S8, force along y", [](Index n) { return twisted_tip<B>(n, {0, 1, 0}, 0.01); }, twisted_by_y},
  };
}

/// Rows of one body: cells after the names of problem and body.
template <class B>
std::vector<std::vector<std::string>> rows(std::string const& body) {
  std::vector<std::vector<std::string>> out;
  for (Problem<B> const& p : problems<B>()) {
    std::vector<double> errors;
    for (Index const n : meshes) errors.push_back((p.tip(n) - p.exact).norm() / p.exact.norm());
    EXPECT_TRUE(errors[5] < 1e-9 || std::log2(errors[4] / errors[5]) > 1.95) << p.name << ", " << body;
    out.push_back({p.name, "`" + body + "`"});
    for (std::string const& cell : cells_of(errors)) out.back().push_back(cell);
  }
  return out;
}

std::string line_of(std::vector<std::string> const& cells) {
  std::string line = "|";
  for (std::string const& cell : cells) line += " " + cell + " |";
  return line;
}
/// Cells of the lines of the page, without the spaces around them.
std::vector<std::vector<std::string>> table_of(std::filesystem::path const& page) {
  std::vector<std::vector<std::string>> table;
  std::ifstream in(page);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| S")) continue;
    std::vector<std::string> cells;
    for (std::size_t from = 2, to; (to = line.find(" |", from)) != line.npos; from = to + 3)
      cells.push_back(line.substr(from, to - from));
    table.push_back(cells);
  }
  return table;
}
/// Two cells with the same text, or numbers that differ by one in the last digit.
bool agree(std::string const& a, std::string const& b) {
  bool const number = std::isdigit(a[0]) && std::isdigit(b[0]) && a.find('.') == b.find('.') && a.size() == b.size();
  double const last = a.size() - a.find('.') == 2 ? 0.1 : 0.01;
  return a == b || (number && std::abs(std::stod(a) - std::stod(b)) < 1.01 * last);
}

TEST(DigitsOfMeshes, AreThoseOfThePage) {
  auto const lrvf = rows<Lrvf<>>("Lrvf"), helices = rows<Se3Beam>("Se3Beam"), ancf = rows<AncfBeam<>>("AncfBeam");
  auto const page = table_of(std::filesystem::path(__FILE__).parent_path() / "../../docs/formulations.md");
  std::string made;
  bool same = page.size() == 3 * lrvf.size();
  for (std::size_t i = 0; i < lrvf.size(); ++i)
    for (auto const& row : {lrvf[i], helices[i], ancf[i]}) {
      made += line_of(row) + "\n";
      std::size_t const k = std::size_t(std::count(made.begin(), made.end(), '\n')) - 1;
      same = same && k < page.size() && page[k].size() == row.size() &&
             std::equal(row.begin(), row.end(), page[k].begin(), agree);
    }
  EXPECT_TRUE(same) << "docs/formulations.md needs these rows:\n" << made;
}

}  // namespace digits_of_meshes_test
