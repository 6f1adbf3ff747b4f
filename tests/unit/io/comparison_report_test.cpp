#include <polybody/io/comparison_report.hpp>

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "support/refusal.hpp"

namespace fs = std::filesystem;
using namespace polybody;

namespace comparison_report_test {

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Two runs in the form of results of `compare`. The first is x = cos t in steps of 0.1 s with constraint equations.
/// The second has steps of 0.25 s, a small error and no constraint equations.
Comparison oscillators() {
  Comparison c;
  for (int i = 0; i < 2; ++i) {
    ComparedRun run;
    run.name = i == 0 ? "ideal, \"1\"" : "stiff/ρ";
    run.problem_size = {
        .coordinates = 3 - i, .constraints = 2 - i, .velocities = 3, .rows = 2, .degrees_of_freedom = 1};
    run.run.steps = i == 0 ? 100 : 40;
    run.run.iterations = 300;
    run.cpu = 0.125 * (i + 1);
    run.output_names = {"x [m]", "v [m/s]"};
    run.outputs.resize(2);
    for (long k = 0; k <= run.run.steps; ++k) {
      double const t = 10.0 * double(k) / double(run.run.steps), x = std::cos(t) + 1e-3 * i * t, v = -std::sin(t);
      run.times.push_back(t);
      run.violations.push_back(i == 0 ? Violation{1e-14 * (1.0 + v * v), 1e-6 * v * v, 1e-3 * x * x} : Violation{});
      run.energies.push_back({.kinetic = 0.5 * v * v, .gravity = 0.25 * x * x, .forces = 0.25 * x * x});
      run.joint_forces.push_back(std::abs(x));
      run.outputs[0].push_back(x);
      run.outputs[1].push_back(v);
    }
    run.violation = {2e-14, 1e-6, 1e-3};
    run.energy_end = 1.0 / 3.0;
    run.peak_joint_force = 1.0;
    run.difference = {0.01 * i, 0.0};
    c.runs.push_back(run);
  }
  return c;
}

WorkPrecision work() {
  WorkPrecision w{{{"ideal", "x [m]"}, {"stiff", "x [m]"}}};
  for (double const h : {0.5, 0.125, 0.03125}) {
    w.curves[0].points.push_back({.setting = h, .steps = std::lround(1.0 / h), .cpu = 0.0625 / h, .error = h * h});
    w.curves[1].points.push_back(
        {.setting = h, .steps = std::lround(1.0 / h), .cpu = 0.125 / h, .error = h * h * h * h});
  }
  w.curves[1].points[0].failure = "Newton's method stalled";
  return w;
}

/// Each test has its own folder, which does not exist yet, with a blank in its name.
struct ComparisonReport : testing::Test {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody report " + std::to_string(std::random_device{}()));
  ~ComparisonReport() override { fs::remove_all(folder); }

  /// Lines of a table, split into fields.
  std::vector<std::vector<std::string>> fields_of(fs::path const& file) const {
    std::string const text = text_of(file);
    detail::CsvReader reader{text, file.string()};
    std::vector<std::vector<std::string>> lines;
    std::size_t at = 0;
    for (auto fields = reader.record(at); !fields.empty(); fields = reader.record(at)) lines.push_back(fields);
    return lines;
  }
};

TEST_F(ComparisonReport, TableHoldsWhatIsPrintedInFullPrecision) {
  Comparison const c = oscillators();
  write_csv(c, folder / "table.csv");
  auto const lines = fields_of(folder / "table.csv");
  EXPECT_EQ(lines.at(0), (std::vector<std::string>{"quantity", c.runs[0].name, c.runs[1].name}));
  std::ostringstream text;
  text << c;
  std::istringstream printed(text.str());
  std::string line;
  std::getline(printed, line);  // the heads
  EXPECT_TRUE(has(line, c.runs[1].name));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    ASSERT_EQ(lines[i].size(), 3u);
    ASSERT_TRUE(std::getline(printed, line));
    std::string const& name = lines[i][0];
    EXPECT_TRUE(line.starts_with(name + ' ')) << line;
    std::istringstream numbers(line.substr(name.size()));
    for (std::size_t j = 0; j < 2; ++j) {
      double shown = std::nan("");
      numbers >> shown;
      double const kept = std::stod(lines[i][j + 1]);
      EXPECT_EQ(kept, quantities(c.runs[j], c.runs[0])[i - 1].value) << name;
      EXPECT_NEAR(shown, kept, 5e-4 * std::abs(kept)) << name;
    }
  }
  EXPECT_FALSE(std::getline(printed, line));
  auto const value = [&](char const* name, std::size_t run) {
    for (auto const& fields : lines)
      if (fields[0] == name) return std::stod(fields[run]);
    return std::nan("");
  };
  EXPECT_EQ(value("coordinates", 2), 2.0);
  EXPECT_EQ(value("Newton iterations per step", 2), 7.5);
  EXPECT_EQ(value("CPU ratio to the first", 2), 2.0);
  EXPECT_EQ(value("energy at the end - at the start [J]", 1), 1.0 / 3.0);
  EXPECT_EQ(value("end: x [m]", 1), std::cos(10.0));
  EXPECT_EQ(value("largest difference from the first: x [m]", 2), 0.01);
}

TEST_F(ComparisonReport, HistoriesReadBackOneFileARun) {
  Comparison const c = oscillators();
  auto const files = write_histories(c, folder);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], folder / "history_1_ideal_1.csv");
  EXPECT_EQ(files[1], folder / "history_2_stiff_ρ.csv");
  for (std::size_t i = 0; i < 2; ++i) {
    Table const table = read_csv(files[i]);
    ComparedRun const& run = c.runs[i];
    EXPECT_EQ(table.columns.size(), 13u);
    EXPECT_EQ(table.column("t [s]"), run.times);
    EXPECT_EQ(table.column("v [m/s]"), run.outputs[1]);
    EXPECT_EQ(table.column("peak joint force [N]"), run.joint_forces);
    for (std::size_t k = 0; k < run.times.size(); ++k) {
      EXPECT_EQ(table.column("velocity violation")[k], run.violations[k].velocity);
      EXPECT_EQ(table.column("total energy [J]")[k], run.energies[k].total());
      EXPECT_EQ(table.column("energy of forces [J]")[k], run.energies[k].forces);
    }
  }
}

TEST_F(ComparisonReport, AnOutputStandsInPlaceOfTheHistoryOfItsName) {
  Comparison c = oscillators();
  for (ComparedRun& run : c.runs) run.output_names[0] = "total energy [J]";
  Table const table = read_csv(write_histories(c, folder)[0]);
  EXPECT_EQ(table.columns.size(), 12u);
  EXPECT_EQ(table.column("total energy [J]"), c.runs[0].outputs[0]);
}

TEST_F(ComparisonReport, WritesAllOfIt) {
  Comparison const c = oscillators();
  auto const files = write_report(c, folder / "deep");
  bool const pictures = find_gnuplot().has_value();
  EXPECT_EQ(files.size(), 3u + 5u * (pictures ? 3u : 2u));
  for (fs::path const& file : files) {
    std::string const text = text_of(file);
    EXPECT_GT(text.size(), 50u) << file;
    if (file.extension() == ".png") {
      EXPECT_TRUE(text.starts_with("\x89PNG\r\n\x1a\n") && text.ends_with("IEND\xAE\x42\x60\x82")) << file;
    }
  }
  // no temporary file remains
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "deep"), fs::directory_iterator()),
            std::ptrdiff_t(files.size()));
  EXPECT_EQ(write_report(c, folder / "drafts", false).size(), 3u + 5u * 2u);
}

TEST_F(ComparisonReport, FiguresShowEveryRunThatHasSomethingToShow) {
  Comparison c = oscillators();
  write_figures(c, folder, false);
  std::string const violations = text_of(folder / "violations.gp"), force = text_of(folder / "joint_force.gp"),
                    outputs = text_of(folder / "outputs.gp"), energies = text_of(folder / "energies.dat");
  EXPECT_TRUE(has(violations, "set logscale y"));
  EXPECT_TRUE(has(violations, "'Violation of accelerations'"));
  EXPECT_TRUE(has(violations, "'ideal, \"1\"'"));
  EXPECT_FALSE(has(violations, "'stiff/ρ'"));  // without constraint equations
  EXPECT_TRUE(has(force, "'force [N]'") && has(force, "'t [s]'") && has(force, "'stiff/ρ'"));
  EXPECT_TRUE(has(outputs, "'x [m]'") && has(outputs, "'v [m/s]'"));
  EXPECT_TRUE(has(energies, "Total energy, change since the start | stiff/ρ\n0 0\n"));
  for (ComparedRun& run : c.runs) run.violations.assign(run.times.size(), Violation{});
  EXPECT_EQ(write_figures(c, folder / "free", false).size(), 4u * 2u);
  EXPECT_FALSE(fs::exists(folder / "free" / "violations.gp"));
}

TEST_F(ComparisonReport, ViolationsAreCutAtRoundOff) {
  Comparison c = oscillators();
  std::vector<Figure> figures;
  c.runs[0].violations[5].position = 1e-21;
  detail::add_violations(c, "Violation", "[m]", &Violation::position, figures);
  EXPECT_EQ(*std::ranges::min_element(figures.back().curves[0].y), 1e-16);
  for (Violation& violation : c.runs[0].violations) violation.position = 1e-18;
  c.runs[0].violations[5].position = 1e-30;
  detail::add_violations(c, "Violation", "[m]", &Violation::position, figures);
  EXPECT_NEAR(*std::ranges::min_element(figures.back().curves[0].y), 1e-24, 1e-30);
}

/// Blocks of a data file by their comments, as times and values.
std::map<std::string, std::vector<std::array<double, 2>>> blocks_of(fs::path const& file) {
  std::map<std::string, std::vector<std::array<double, 2>>> blocks;
  std::istringstream lines(text_of(file));
  std::string remark;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# "))
      remark = line.substr(2);
    else if (double x = 0.0, y = 0.0; std::istringstream(line) >> x >> y)
      blocks[remark].push_back({x, y});
  }
  return blocks;
}

TEST_F(ComparisonReport, DifferencesFromTheFirstRunStandBesideTheCurves) {
  Comparison const c = oscillators();
  write_figures(c, folder, false);
  auto const blocks = blocks_of(folder / "outputs.dat");
  EXPECT_EQ(blocks.size(), 6u);
  // x differs by 1e-3 t, apart from the error of cubics through steps of 0.1 s of cos t: 0.1⁴ 9/384
  auto const& off = blocks.at("x [m], difference from \"ideal, \"1\"\" | stiff/ρ");
  ASSERT_EQ(off.size(), 41u);
  for (auto const& [t, difference] : off) EXPECT_NEAR(difference, 1e-3 * t, 3e-6) << t;
  EXPECT_FALSE(blocks.contains("x [m], difference from \"ideal, \"1\"\" | ideal, \"1\""));
}

TEST_F(ComparisonReport, OutputsThatDifferMostComeFirstSixPanelsAPage) {
  Comparison c = oscillators();
  // relative to their spans of about 2 the outputs differ by 0, 0.005, 0.5. A constant output counts most if no other
  // output has its unit and its difference is not zero; it counts least if its difference is zero.
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    ComparedRun& run = c.runs[i];
    run.output_names = {"same [m]", "near [m]", "far [m]", "flat [rad]", "still [m]"};
    std::vector<double> const wave = run.outputs[0], zero(wave.size(), 0.0);
    run.outputs = {wave, wave, wave, zero, zero};
    run.difference = {0.0, 0.01 * double(i), 1.0 * double(i), 1e-9 * double(i), 0.0};
  }
  auto const files = write_figures(c, folder, false);
  auto const is_there = [&](char const* name) { return std::ranges::find(files, folder / name) != files.end(); };
  EXPECT_TRUE(is_there("outputs.gp") && is_there("outputs_2.dat") && is_there("cost.gp"));
  EXPECT_FALSE(is_there("outputs_3.gp"));
  std::string const first = text_of(folder / "outputs.gp"), second = text_of(folder / "outputs_2.gp");
  EXPECT_TRUE(has(first, "multiplot layout 3,2") && has(second, "multiplot layout 2,2"));
  EXPECT_LT(first.find("'flat [rad]'"), first.find("'far [m]'"));
  EXPECT_LT(first.find("'far [m]'"), first.find("'near [m]'"));
  EXPECT_LT(second.find("'same [m]'"), second.find("'still [m]'"));
  EXPECT_NE(second.find("'still [m]'"), std::string::npos);
}

// An output that is only round-off in the first run is not scaled by its own span if other outputs have its unit.
TEST_F(ComparisonReport, DifferencesCountByLengthsThatMatter) {
  Comparison c = oscillators();
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    ComparedRun& run = c.runs[i];
    run.output_names = {"gap [m]", "way [m]", "turn [rad]"};
    std::vector<double> const wave = run.outputs[0];
    std::vector<double> gap = wave;
    for (double& g : gap) g *= i == 0 ? 1e-12 : 1e-5;
    run.outputs = {gap, wave, gap};
    run.difference = {1e-5 * double(i), 0.02 * double(i), 1e-5 * double(i)};
  }
  // the scale is a hundredth of the largest length
  EXPECT_NEAR(detail::relative_difference(c, c.runs[1], 0), 1e-5 / (1e-2 * 2.0), 1e-6);
  EXPECT_NEAR(detail::relative_difference(c, c.runs[1], 1), 0.02 / 2.0, 1e-4);
  // relative to its own span
  EXPECT_NEAR(detail::relative_difference(c, c.runs[1], 2), 1e-5 / 2e-12, 1e-2 * 1e-5 / 2e-12);
  EXPECT_EQ(detail::outputs_by_difference(c), (std::vector<std::size_t>{2, 1, 0}));
}

TEST_F(ComparisonReport, RunsHaveTheColoursOfTheirFormulations) {
  Comparison c = oscillators();
  EXPECT_EQ(formulation_colours(c), (std::vector{0, 1}));  // families and policies are unknown
  c.runs[0].family = families::cable_green;
  c.runs[1].family = families::rigid;
  std::vector<int> const families_differ{formulation_colour(families::cable_green),
                                         formulation_colour(families::rigid)};
  EXPECT_EQ(formulation_colours(c), families_differ);
  for (Figure const& figure : detail::output_figures(c))
    for (Curve const& curve : figure.curves)
      EXPECT_EQ(curve.colour, families_differ[curve.label == c.runs[1].name]) << figure.title;
  for (ComparedRun& run : c.runs) run.family = families::rigid;
  c.runs[0].policy = "Bushing";
  c.runs[1].policy = "JointCoordinates";
  EXPECT_EQ(formulation_colours(c),
            (std::vector{formulation_colour("Bushing"), formulation_colour("JointCoordinates")}));
  c.runs[0].policy = "JointCoordinates";
  EXPECT_EQ(formulation_colours(c), (std::vector{0, 1}));
}

TEST_F(ComparisonReport, LargeDifferencesDoNotHideSmallOnes) {
  Comparison c = oscillators();
  for (double const size : {1e-3, -5e-3, 2e-5}) {
    ComparedRun& run = c.runs.emplace_back(c.runs[0]);
    run.name = "off by " + number(size);
    for (double& x : run.outputs[0]) x += size;
  }
  c.runs.erase(c.runs.begin() + 1);
  auto const labels = [](Figure const& figure) {
    std::vector<std::string> all;
    for (Curve const& curve : figure.curves) all.push_back(curve.label);
    return all;
  };
  Figure const far = detail::difference_figure(c, 0);
  EXPECT_EQ(labels(far), (std::vector<std::string>{"off by -0.005", "off by 0.001", "off by 2e-05"}));
  EXPECT_EQ(far.curves[0].colour, 2);  // the colour of this run in every figure
  EXPECT_TRUE(far.log_y);              // a ratio of 250
  EXPECT_EQ(far.y_label, "magnitude of the difference [m]");
  EXPECT_NEAR(far.curves[0].y[7], 5e-3, 1e-12);
  EXPECT_NEAR(far.curves[2].y[7], 2e-5, 1e-12);
  c.runs.pop_back();
  Figure const near = detail::difference_figure(c, 0);
  EXPECT_FALSE(near.log_y);
  EXPECT_EQ(near.y_label, "difference [m]");
  EXPECT_NEAR(near.curves[0].y[7], -5e-3, 1e-12);
}

TEST_F(ComparisonReport, CostShowsDifferenceOverTimeOfComputing) {
  Comparison c = oscillators();
  write_figures(c, folder, false);
  auto const blocks = blocks_of(folder / "cost.dat");
  ASSERT_EQ(blocks.size(), 2u);
  std::string const title = "Largest difference from \"ideal, \"1\"\", and CPU time | ";
  auto const& point = blocks.at(title + "stiff/ρ");
  ASSERT_EQ(point.size(), 1u);
  EXPECT_EQ(point[0][0], 0.25);                // s
  EXPECT_NEAR(point[0][1], 0.01 / 2.0, 1e-5);  // cos t spans 2 except for its time steps
  // the first run is a line across the points, at its own time
  auto const& first = blocks.at(title + "ideal, \"1\"");
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0][0], 0.125);
  EXPECT_EQ(first[1][0], 0.125);
  EXPECT_LT(first[0][1], point[0][1]);
  EXPECT_GT(first[1][1], point[0][1]);
  // times of one magnitude begin at zero; other times have a logarithmic axis
  EXPECT_TRUE(has(text_of(folder / "cost.gp"), "set xrange [0:0.275"));
  EXPECT_FALSE(has(text_of(folder / "cost.gp"), "set logscale x"));
  c.runs[1].cpu = 2.5;
  write_figures(c, folder / "dear", false);
  EXPECT_TRUE(has(text_of(folder / "dear" / "cost.gp"), "set logscale x"));
  c.runs[1].difference = {0.0, 0.0};
  write_figures(c, folder / "same", false);
  EXPECT_FALSE(fs::exists(folder / "same" / "cost.gp"));
  c.runs.pop_back();
  write_figures(c, folder / "one", false);
  EXPECT_FALSE(fs::exists(folder / "one" / "cost.gp"));
  EXPECT_EQ(blocks_of(folder / "one" / "outputs.dat").size(), 2u);
}

TEST_F(ComparisonReport, WorkAndPrecisionAsFiles) {
  auto const files = write_report(work(), folder, false);
  EXPECT_EQ(files, (std::vector<fs::path>{folder / "work_precision.csv", folder / "work_precision.dat",
                                          folder / "work_precision.gp"}));
  EXPECT_TRUE(has(text_of(folder / "work_precision.gp"), "set logscale x"));
  EXPECT_TRUE(has(refusal([&] { write_report(WorkPrecision{}, folder / "none"); }), "there are no curves"));
  EXPECT_FALSE(fs::exists(folder / "none"));
}

TEST_F(ComparisonReport, RefusesWhatIsNoComparison) {
  EXPECT_TRUE(has(refusal([&] { write_report(Comparison{}, folder); }), "write_report: the comparison has no runs"));
  EXPECT_TRUE(has(refusal([&] { write_csv(Comparison{}, folder / "table.csv"); }), "no runs"));
  EXPECT_TRUE(has(refusal([&] { write_histories({}, folder); }), "no runs"));
  EXPECT_TRUE(has(refusal([&] { write_figures({}, folder); }), "no runs"));
  Comparison c = oscillators();
  c.runs[1].energies.pop_back();
  EXPECT_TRUE(has(refusal([&] { write_report(c, folder); }), "the run \"stiff/ρ\" has no times"));
  c = oscillators();
  c.runs[1].output_names[0] = "y [m]";
  EXPECT_TRUE(has(refusal([&] { write_report(c, folder); }), "the run \"stiff/ρ\""));
  EXPECT_FALSE(fs::exists(folder));
  c = oscillators();
  c.runs[1].peak_joint_force = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has(refusal([&] { write_report(c, folder); }), "column \"stiff/ρ\": the value is not finite"));
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(ComparisonReport, WorkAndPrecisionLeaveFailedRunsOut) {
  Figure const figure = work_precision_figure(work());
  EXPECT_TRUE(figure.log_x && figure.log_y);
  EXPECT_EQ(figure.y_label, "error of x [m]");
  ASSERT_EQ(figure.curves.size(), 2u);
  EXPECT_EQ(figure.curves[1].label, "stiff");
  EXPECT_EQ(figure.curves[1].x, (std::vector<double>{1.0, 4.0}));
  EXPECT_EQ(figure.curves[0].y.size(), 3u);
  write_csv(work(), folder / "work.csv");
  auto const lines = fields_of(folder / "work.csv");
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[4], (std::vector<std::string>{"stiff", "0.125", "8", "1", "0.000244140625"}));
}

TEST_F(ComparisonReport, RefusesCurvesOfDifferentOutputsInOneFigure) {
  EXPECT_TRUE(has(refusal([] { work_precision_figure({}); }), "there are no curves"));
  WorkPrecision w = work();
  w.curves[1].output = "v [m/s]";
  EXPECT_TRUE(has(refusal([&] { work_precision_figure(w); }),
                  "the curve \"stiff\" shows the output \"v [m/s]\", not \"x [m]\""));
}

}  // namespace comparison_report_test
