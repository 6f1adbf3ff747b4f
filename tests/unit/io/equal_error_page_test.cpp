// The page and the files of a comparison at equal error. Chromium opens the page (equal_error_page_browser.mjs).
#include <polybody/io/equal_error_page.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <source_location>
#include <sstream>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/cholesky_coordinates.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/bodies/shared/with_sliders.hpp>

#include "support/refusal.hpp"

namespace equal_error_page_test {

namespace fs = std::filesystem;
using namespace polybody;

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A formulation with four meshes and three steps. The error is c n^−2 + 0.01 h, the CPU time `cost` n/h [s].
StudiedFormulation studied(std::string name, std::string_view family, std::string model, double c, double cost) {
  StudiedFormulation f;
  f.name = std::move(name);
  f.model = std::move(model);
  f.integrator = "GeneralisedAlpha";
  f.policy = "Constraint";
  f.family = family;
  f.mesh_name = "elements";
  f.step_name = "step [s]";
  for (Index const mesh : {5, 10, 20, 40})
    for (double const step : {1e-2, 5e-3, 2.5e-3}) {
      StudyRun run{.mesh = mesh, .step = step, .cpu = cost * double(mesh) / step, .unknowns = 3 * mesh, .steps = 400};
      run.iterations = 2 * run.steps;
      run.factorisations = 10 + long(mesh);
      run.error = c / double(mesh * mesh) + 0.01 * step;
      f.runs.push_back(std::move(run));
    }
  f.limit_error = 1e-5;
  f.mesh_order = 2.0;
  f.step_order = 1.0;
  f.spread = 1e-13;
  return f;
}

/// Three formulations of two physical models, whose difference is not resolved. The second one does not reach the
/// smallest error, and one of its runs fails. The third one has a name with letters of HTML.
EqualErrorReport report() {
  EqualErrorReport r;
  r.output = "height & width [m]";
  r.span = 2.0;
  for (int k = 0; k <= 100; ++k) r.times.push_back(0.1 * k);
  r.formulations = {studied("LRVF", families::lrvf, "beam with shear", 0.8, 1e-6),
                    studied("cable", families::cable_green, "cable, \"Green\"", 4.0, 2e-6),
                    studied("<b>own</b> & 'more'", families::rigid, "beam with shear", 0.4, 4e-6)};
  for (std::size_t i = 0; i < 3; ++i) {
    StudiedFormulation& f = r.formulations[i];
    for (double const t : r.times) f.limit.push_back(std::sin(t) + (i == 1 ? 1e-5 * t : 0.0));
    for (StudyRun& run : f.runs) run.y = f.limit;
    for (double const t : r.times) f.runs.back().energy.push_back(5.0 + 0.1 * double(i) + std::cos(t));
  }
  StudyRun& failed = r.formulations[1].runs[0];
  failed.y.clear();
  failed.error = std::numeric_limits<double>::quiet_NaN();
  failed.failure = "a step <did> not converge.";
  r.formulations[1].remarks = {"the output does not converge & more."};
  r.references = {{"beam with shear", 0, 1e-5}, {"cable, \"Green\"", 1, 2e-4}};
  r.differences = {{0, 1, 1e-4, 2.1e-4}};
  r.rankings = {{.wanted = 1e-2, .ranked = {{0, 3}, {2, 0}, {1, 6}}, .missing = {}},
                {.wanted = 1e-3, .ranked = {{0, 9}, {2, 6}}, .missing = {{1, "no run reaches <this> error"}}}};
  for (Ranking const& ranking : r.rankings)
    for (CheapestRun const& at : ranking.ranked) {
      StudyRun& run = r.formulations[at.formulation].runs[at.run];
      run.timings = 5;
      run.least_cpu = 0.9 * run.cpu;
      run.most_cpu = 1.3 * run.cpu;
    }
  r.formulations[0].runs[0].on_front = r.formulations[2].runs[11].on_front = true;
  return r;
}

/// Each test has its own folder, which does not exist yet, with letters that an address must encode.
struct EqualErrorPage : testing::Test {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody page & #" + std::to_string(std::random_device{}()));
  ~EqualErrorPage() override { fs::remove_all(folder); }

  std::string page(EqualErrorReport const& r, PageOptions const& options = {}) const {
    write_page(r, folder / "page.html", options);
    return text_of(folder / "page.html");
  }
  /// Number of occurrences of `part` in `text`.
  static int count(std::string const& text, std::string const& part) {
    int n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++n;
    return n;
  }
};

TEST_F(EqualErrorPage, ContainsTablesChartsAndRemarks) {
  std::string const text =
      page(report(), {.command = "arm --error 1e-3", .machine = "two cores", .version = "0.1.2", .date = "2020-01-02"});
  EXPECT_TRUE(has(text, "The output is <b>height &amp; width [m]</b> from 0 s to 10 s"));
  EXPECT_TRUE(has(text, "<b>2.000\u00A0m</b>"));
  EXPECT_TRUE(has(text, "Error of at most 0.1\u00A0% of the span, 0.00200\u00A0m"));
  EXPECT_TRUE(has(text, "5\u00A0elements"));
  EXPECT_TRUE(
      has(text, "<b>LRVF</b> needs 0.00100\u00A0s with 10\u00A0elements, h\u00A0=\u00A00.01\u00A0s; <b>&lt;b&gt;"));
  EXPECT_TRUE(has(text, "needs 2.00 times as long.</p>"));
  for (char const* id : {"work", "error-over-elements", "error-over-step", "output", "differences", "energy"})
    EXPECT_EQ(count(text, "<figure class=\"chart\" id=\"" + std::string(id) + "\">"), 1) << id;
  EXPECT_TRUE(has(text, ">not resolved</td>"));
  EXPECT_TRUE(has(text, "not resolved, error bound 0.000210\u00A0m"));
  EXPECT_TRUE(has(text, "order 2.0, h\u00A0=\u00A00.0025\u00A0s, GeneralisedAlpha"));
  EXPECT_TRUE(has(text, "error 0.405\u00A0% of the span (0.00810\u00A0m)"));
  EXPECT_TRUE(has(text, "1 of 12 runs failed."));
  for (char const* part : {"arm --error 1e-3", "two cores", "2020-01-02", "polybody 0.1.2"})
    EXPECT_TRUE(has(text.substr(text.find("<footer>")), part));
#if defined(__clang__)
  EXPECT_TRUE(has(text, "<dd>clang " + detail::html_escaped(__clang_version__)));
#else
  EXPECT_TRUE(has(text, "<dd>g++ " + detail::html_escaped(__VERSION__)));
#endif
  EXPECT_EQ(count(text, "<table>"), count(text, "</table>"));
  EXPECT_EQ(count(text, "<table>"), 2 + 1 + 1 + 2 + 1);  // rankings, front, formulations, models, runs
  EXPECT_EQ(count(text, " aria-sort=\"ascending\""), 3);
  EXPECT_FALSE(has(text, "nan\"") || has(text, "inf\""));
}

TEST_F(EqualErrorPage, EscapesTextsAndNeedsNoNetwork) {
  EqualErrorReport r = report();
  r.output = "a <script>alert(1)</script> [m]";
  std::string const text = page(r, {.title = "</title><i>\"x\"", .command = "a < b && 'c'", .machine = "<m>"});
  EXPECT_EQ(count(text, "<script"), 1);
  EXPECT_FALSE(has(text, "<b>own") || has(text, "<did>") || has(text, "<this>") || has(text, "<i>") ||
               has(text, "<m>"));
  EXPECT_TRUE(has(text, "&lt;b&gt;own&lt;/b&gt; &amp; &#39;more&#39;"));
  EXPECT_TRUE(has(text, "<title>&lt;/title&gt;&lt;i&gt;&quot;x&quot;</title>"));
  EXPECT_TRUE(has(text, "a &lt; b &amp;&amp; &#39;c&#39;"));
  EXPECT_TRUE(has(text, "a step &lt;did&gt; not converge."));
  EXPECT_FALSE(has(text, "http:") || has(text, "https:") || has(text, "@import") || has(text, "<link"));
  EXPECT_TRUE(has(text, " UTC</dd>"));  // the default date
}

TEST_F(EqualErrorPage, LinksTheFilmByARelativeAddress) {
  fs::create_directories(folder / "films");
  std::ofstream(folder / "films" / "arm & 1.html") << "<p>film";
  std::string const text = page(report(), {.film = folder / "films" / "arm & 1.html"});
  EXPECT_TRUE(has(text, "<iframe src=\"films/arm%20%26%201.html\""));
  EXPECT_TRUE(has(text, "<a href=\"films/arm%20%26%201.html\">"));
  EXPECT_TRUE(has(text, "<a href=\"#film\">"));
  EXPECT_FALSE(has(page(report()), "<iframe"));
  EXPECT_TRUE(has(message_of<IoError>([&] { page(report(), {.film = folder / "none.html"}); }), "does not exist"));
}

TEST_F(EqualErrorPage, ReportHasTablesThatReadBack) {
  EqualErrorReport const r = report();
  std::vector<fs::path> const files = write_report(r, folder / "deep", {.command = "arm", .date = "2020-01-02"});
  EXPECT_EQ(files, (std::vector<fs::path>{folder / "deep" / "report.html", folder / "deep" / "runs.csv",
                                          folder / "deep" / "histories.csv", folder / "deep" / "report.md"}));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "deep"), fs::directory_iterator()), 4);
  EXPECT_TRUE(has(text_of(files[0]), "<a href=\"histories.csv\">histories.csv</a>"));
  std::string const runs = text_of(files[1]);
  EXPECT_EQ(count(runs, "\n"), 1 + 36 - 1);
  EXPECT_TRUE(
      has(runs, "\nLRVF,beam with shear,LRVF in the plane,Constraint,GeneralisedAlpha,5,elements,0.01,step [s],"));
  EXPECT_TRUE(has(runs, "\ncable,\"cable, \"\"Green\"\"\",\"ANCF cable, Green strain\","));
  EXPECT_FALSE(has(runs, "nan"));
  Table const histories = read_csv(files[2]);
  EXPECT_EQ(histories.column("t [s]"), r.times);
  EXPECT_EQ(histories.column("reference of cable, \"Green\" [m]"), r.formulations[1].limit);
  std::ostringstream printed;
  printed << r;
  EXPECT_TRUE(has(text_of(files[3]), "# Comparison at equal error\n\n```text\n" + printed.str() + "```\n"));
  EXPECT_TRUE(has(text_of(files[3]), "Command: arm\n"));
}

TEST_F(EqualErrorPage, DrawsReportsWithoutResults) {
  EqualErrorReport r = report();
  for (StudiedFormulation& f : r.formulations) {
    f.limit.clear();
    f.mesh_name.clear();
    for (StudyRun& run : f.runs) {
      run.y.clear();
      run.energy.clear();
      run.error = std::numeric_limits<double>::quiet_NaN();
      run.failure = "it failed.";
    }
  }
  r.references.clear();
  r.differences.clear();
  r.rankings.clear();
  r.times.clear();
  r.span = 0.0;
  std::string const text = page(r);
  EXPECT_TRUE(has(text, "No formulation has a converged result."));
  EXPECT_TRUE(has(text, "12 of 12 runs failed."));
  EXPECT_TRUE(has(text, "No run has a known error."));
  EXPECT_FALSE(has(text, "nan\"") || has(text, "inf\"") || has(text, "<figure"));
  EXPECT_EQ(write_report(r, folder / "files").size(), 4u);
}

TEST_F(EqualErrorPage, RefusesOtherReportsAndFoldersThatCannotBeWritten) {
  EXPECT_TRUE(has(refusal([&] { page({.output = "x [m]"}); }), "report \"x [m]\": there are no formulations"));
  EqualErrorReport r = report();
  r.formulations[1].limit.pop_back();
  EXPECT_TRUE(has(refusal([&] { page(r); }), "report \"cable\": a history has another length"));
  r = report();
  r.rankings[0].ranked[0].run = 12;
  EXPECT_TRUE(has(refusal([&] { page(r); }), "an index is out of range"));
  r = report();
  r.formulations[0].runs.clear();
  EXPECT_TRUE(has(refusal([&] { write_report(r, folder); }), "report \"LRVF\": the formulation has no runs"));
  r = report();
  r.references[0].formulation = 7;
  EXPECT_TRUE(has(refusal([&] { write_report(r, folder); }), "report \"beam with shear\": the reference"));
  EXPECT_FALSE(fs::exists(folder));
  fs::create_directories(folder);
  std::ofstream(folder / "file") << "no folder";
  EXPECT_TRUE(
      has(message_of<IoError>([&] { write_report(report(), folder / "file"); }), "its folder cannot be created"));
  EXPECT_EQ(text_of(folder / "file"), "no folder");
}

// The families of all bodies have different styles, and gnuplot figures have the same colour and marker.
TEST(FormulationStyles, AreFixedAndDistinct) {
  static_assert(formulation_family<planar::Rigid> == families::rigid);
  static_assert(formulation_family<Rigid<>> == families::rigid);
  static_assert(formulation_family<Rigid<EulerParameters>> == families::rigid);
  static_assert(formulation_family<planar::Lrvf> == families::lrvf);
  static_assert(formulation_family<planar::FullLrvf> == families::lrvf);
  static_assert(formulation_family<Lrvf<>> == families::lrvf_in_space);
  static_assert(formulation_family<Se3Beam> == families::se3_beam_in_space);
  static_assert(formulation_family<planar::Se3Beam> == families::se3_beam);
  static_assert(formulation_family<planar::AncfCable<>> == families::cable_green);
  static_assert(formulation_family<AncfCable<EngineeringStrain>> == families::cable_engineering);
  static_assert(formulation_family<planar::AncfCable<EngineeringStrain>> == families::cable_engineering);
  static_assert(formulation_family<WithSliders<AncfCable<>>> == families::cable_green);
  static_assert(formulation_family<CholeskyCoordinates<AncfCable<>>> == families::cable_green);
  static_assert(formulation_family<AncfBeam<>> == families::beam_elastic_line);
  static_assert(formulation_family<AncfBeam<Continuum<>>> == families::beam_continuum);
  static_assert(formulation_family<planar::Ffr> == families::ffr_nodal);
  static_assert(formulation_family<Ffr> == families::ffr_nodal);
  for (FormulationStyle const& a : formulation_styles) {
    EXPECT_EQ(formulation_style(a.family).colour, a.colour);
    for (FormulationStyle const& b : formulation_styles)
      if (&a != &b) {
        EXPECT_NE(a.family, b.family);
        EXPECT_TRUE(a.colour != b.colour || (a.marker != b.marker && a.dash != b.dash)) << a.family;
      }
  }
  EXPECT_EQ(formulation_style(families::lrvf).rgb(), detail::palette[0]);
  EXPECT_EQ(formulation_style(families::lrvf).marker, detail::point_types[0]);
  EXPECT_TRUE(formulation_style(families::lrvf_in_space).open());
  EXPECT_EQ(formulation_style("no family").family, families::other);
  EXPECT_EQ(formulation_colour(families::lrvf), 0);
  EXPECT_EQ(formulation_colour("Bushing"), 2);
  EXPECT_EQ(formulation_colour("no family"), -1);
  EXPECT_NE(formulation_style(families::lrvf, "Penalty").dash, formulation_style(families::lrvf).dash);
}

TEST(HtmlText, NumbersHaveThreeDigits) {
  EXPECT_EQ(detail::readable(0.0041), "0.00410");
  EXPECT_EQ(detail::readable(0.00099999), "0.00100");
  EXPECT_EQ(detail::readable(350.4), "350");
  EXPECT_EQ(detail::readable(-123456.0), "−123456");
  EXPECT_EQ(detail::readable(1.2e-7), "1.20\u00A0×\u00A010⁻⁷");
  EXPECT_EQ(detail::readable(std::nan("")), "–");
  EXPECT_EQ(detail::short_text(0.0025), "0.0025");
  EXPECT_EQ(detail::short_text(20.0), "20");
  EXPECT_EQ(detail::short_text(1e-6), "10⁻⁶");
  EXPECT_EQ(detail::short_text(2.5e-5), "2.5\u00A0×\u00A010⁻⁵");
  EXPECT_EQ(detail::fixed_text(-0.001, 2), "0.00");
}

TEST(ChartAxis, HasReadableTicks) {
  auto const labels = [](detail::ChartAxis const& axis) {
    std::string all;
    for (detail::ChartTick const& tick : axis.ticks())
      if (!tick.label.empty()) all += (all.empty() ? "" : " ") + tick.label;
    return all;
  };
  EXPECT_EQ(labels({{0.0, 6.75}, false, {0, 600}}), "0 2 4 6");
  EXPECT_EQ(labels({{-0.3, 0.4}, false, {0, 600}}), "−0.2 0.0 0.2 0.4");
  EXPECT_EQ(labels({{1e-5, 1e-1}, true, {0, 600}}), "10⁻⁵ 10⁻⁴ 10⁻³ 10⁻² 10⁻¹");
  EXPECT_EQ(labels({{0.01, 0.2}, true, {0, 600}}), "0.01 0.02 0.05 0.1 0.2");
  EXPECT_EQ(labels({{1e-8, 1e-6, 1e-4}, true, {0, 600}, 0.06, {1e-8, 1e-4, 1e-6}}), "10⁻⁸ 10⁻⁶ 10⁻⁴");
  EXPECT_EQ(labels({{5.0, 80.0}, true, {0, 600}, 0.06, {5, 10, 20, 40, 80}}), "5 10 20 40 80");
  detail::ChartAxis const far({5000.0, 5000.01}, false, {0, 600});
  EXPECT_EQ(far.offset(), "5000");
  detail::ChartAxis const large({0.0, 3.2e5}, false, {0, 600});
  EXPECT_EQ(large.factor(), "10³");
  EXPECT_EQ(labels(large), "0 100 200 300");
  EXPECT_GT(labels({{2.0, 2.0}, true, {0, 600}}).size(), 2u);  // constants have a range
  EXPECT_GT(labels({{0.0318, 0.03182}, true, {0, 600}}).size(), 8u);
  EXPECT_EQ(detail::ChartAxis({1.0, 100.0}, true, {0, 600}, 0.0).at(10.0), 300.0);
}

TEST_F(EqualErrorPage, WorksInABrowser) {
  page(report(), {.title = "A page"});
  fs::path const script = fs::path(std::source_location::current().file_name()).parent_path();
  char const* const pictures = std::getenv("POLYBODY_PICTURES");  // a folder for the pictures
  std::string const command = "node '" + (script / "equal_error_page_browser.mjs").string() + "' '" +
                              (folder / "page.html").string() + "'" +
                              (pictures ? " --pictures '" + std::string(pictures) + "'" : "") + " > '" +
                              (folder / "found.txt").string() + "' 2>&1";
  int const status = std::system(command.c_str());
  int const code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 77 || code == 127) GTEST_SKIP() << "node or chromium is missing (Debian: nodejs chromium)";
  EXPECT_EQ(code, 0) << text_of(folder / "found.txt");
}

}  // namespace equal_error_page_test
