#include <polybody/io/plot.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <random>

#include "support/refusal.hpp"

namespace fs = std::filesystem;
using namespace polybody;

namespace plot_test {

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool is_png(fs::path const& file) {
  return text_of(file).starts_with("\x89PNG\r\n\x1a\n") && fs::file_size(file) > 500;
}

/// Width and height in the header of the PNG file [px].
std::array<int, 2> png_size(fs::path const& file) {
  std::string const text = text_of(file);
  auto const number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(text.at(at + i));
    return value;
  };
  return {number(16), number(20)};
}

Figure waves() {
  Figure figure{.title = "Pendulum: tip_x over time (ρ∞ = 0.8, 'stiff' \"bar\")",
                .x_label = "time [s]",
                .y_label = "position [m]"};
  Curve sine{.label = "rigid_body"}, cosine{.label = "ANCF, n = 8"};
  Curve steps{.label = "steps"}, few{.label = "measured"};
  for (int i = 0; i <= 200; ++i) {
    double const t = 0.05 * i;
    sine.x.push_back(t), sine.y.push_back(std::sin(t));
    cosine.x.push_back(t), cosine.y.push_back(std::sin(t) * std::exp(-0.1 * t));
    if (i % 20 == 0) steps.x.push_back(t), steps.y.push_back(0.5 * std::cos(t));
    if (i % 25 == 0) few.x.push_back(t), few.y.push_back(std::sin(t) + 0.03);
  }
  Curve twin = cosine, joined = few;
  cosine.style = "dashed", steps.style = "steps", few.style = "points", few.colour = 0;
  twin.label = "", twin.colour = 1, joined.style = "linespoints", joined.label = "joined, θ";
  for (double& y : twin.y) y = -y;
  for (double& y : joined.y) y -= 0.4;
  figure.curves = {sine, cosine, steps, few, twin, joined};
  return figure;
}

/// Each test has its own empty folder, with a blank and a quote in its name.
struct Plots : testing::Test {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody it's " + std::to_string(std::random_device{}()));
  fs::path const stem = folder / "tip path";
  bool const have_gnuplot = find_gnuplot().has_value();

  Plots() { fs::create_directories(folder); }
  ~Plots() override { fs::remove_all(folder); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  fs::path with(char const* ending) const { return stem.string() + ending; }
};

/// Sets PATH to `value` during its lifetime.
struct Path {
  std::string const before = std::getenv("PATH") ? std::getenv("PATH") : "";
  explicit Path(std::string const& value) { setenv("PATH", value.c_str(), 1); }
  ~Path() { setenv("PATH", before.c_str(), 1); }
};

TEST_F(Plots, WritesDataScriptAndPicture) {
  DrawResult const drawn = write_figure(waves(), stem);
  EXPECT_EQ(drawn, have_gnuplot ? DrawResult::png : DrawResult::script_only);
  EXPECT_EQ(files(), have_gnuplot ? 3u : 2u);  // no temporary file remains
  if (!have_gnuplot) GTEST_SKIP() << "gnuplot is not on PATH";
  EXPECT_TRUE(is_png(with(".png")));
  EXPECT_EQ(png_size(with(".png")), (std::array{1000, 700}));
  if (char const* keep = std::getenv("POLYBODY_KEEP_FIGURE"))
    fs::copy_file(with(".png"), keep, fs::copy_options::overwrite_existing);
}

TEST_F(Plots, ScriptRunsByHandFromItsOwnFolder) {
  ASSERT_EQ(write_figure(waves(), stem, false), DrawResult::script_only);
  EXPECT_EQ(files(), 2u);
  EXPECT_EQ(text_of(with(".gp")).find(folder.string()), std::string::npos);  // names are relative
  if (!have_gnuplot) GTEST_SKIP() << "gnuplot is not on PATH";
  fs::path const moved = folder / "moved";
  fs::create_directories(moved);
  fs::rename(with(".gp"), moved / "tip path.gp");
  fs::rename(with(".dat"), moved / "tip path.dat");
  fs::path const before = fs::current_path();
  fs::current_path(moved);
  int const status = std::system("gnuplot 'tip path.gp'");
  fs::current_path(before);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(is_png(moved / "tip path.png"));
}

TEST_F(Plots, ScriptSaysWhatTheFigureSays) {
  write_figure(waves(), stem, false);
  std::string const script = text_of(with(".gp"));
  EXPECT_TRUE(has(script, "set title 'Pendulum: tip_x over time (ρ∞ = 0.8, ''stiff'' \"bar\")' noenhanced"));
  EXPECT_TRUE(has(script, "set xlabel 'time [s]'"));
  EXPECT_TRUE(has(script, "index 1 using 1:2 with lines dashtype (12,6) linewidth 1.5 linecolor rgb '#D55E00'"));
  EXPECT_TRUE(has(script, "index 3 using 1:2 with points linewidth 1.5 linecolor rgb '#0072B2'"));
  EXPECT_TRUE(has(script, "index 4 using 1:2 with lines linewidth 1.5 linecolor rgb '#D55E00' notitle"));
  EXPECT_TRUE(has(script, "set key"));
  EXPECT_EQ(script.find("logscale"), std::string::npos);

  Figure figure{.title = "", .curves = {{.x = {1, 2}, .y = {3, 4}, .label = "a"}}};
  figure.equal_axes = true, figure.legend = false;
  figure.x_range = {0.0, 2.5}, figure.curves[0].colour = 9;
  write_figure(figure, stem, false);
  std::string const second = text_of(with(".gp"));
  EXPECT_TRUE(has(second, "set size ratio -1"));
  EXPECT_TRUE(has(second, "unset key"));
  EXPECT_TRUE(has(second, "set xrange [0:2.5]"));
  EXPECT_TRUE(has(second, "#D55E00"));  // colour 9 is colour 1 again: there are eight colours
  EXPECT_EQ(text_of(with(".dat")), "#  | a\n1 3\n2 4\n");
}

TEST_F(Plots, DataBlocksReadBackExactly) {
  Figure figure{.title = "two\nlines"};
  figure.curves = {{.x = {0.1, 1e-300}, .y = {1.0 / 3.0, -5e-324}, .label = "a\nb"}, {.x = {1}, .y = {2}, .label = ""}};
  write_figure(figure, stem, false);
  EXPECT_EQ(text_of(with(".dat")),
            "# two lines | a b\n0.1 0.3333333333333333\n1e-300 -5e-324\n\n\n# two lines | \n1 2\n");
}

TEST_F(Plots, PanelsShareOnePicture) {
  Figure log = waves();
  log.log_x = log.log_y = true;
  Figure equal = waves();
  equal.equal_axes = true;
  Figure flat{.title = "constant",
              .x_label = "t [s]",
              .y_label = "E [J]",
              .curves = {{.x = {0, 1, 2}, .y = {1, 1 + 1e-15, 1}, .label = "E"}}};
  flat.width_px = 300, flat.height_px = 200;
  DrawResult const drawn = write_panels({waves(), log, equal, flat, flat}, 3, stem);
  EXPECT_TRUE(has(text_of(with(".gp")), "set multiplot layout 2,3"));
  EXPECT_TRUE(has(text_of(with(".gp")), "index 19 "));
  EXPECT_TRUE(has(text_of(with(".gp")), "set format y '%.17h'"));  // 1 and 1 + 1e-15 differ
  if (drawn == DrawResult::script_only) GTEST_SKIP() << "gnuplot is not on PATH";
  EXPECT_TRUE(is_png(with(".png")));
  EXPECT_EQ(png_size(with(".png")), (std::array{3000, 1400}));
  if (char const* keep = std::getenv("POLYBODY_KEEP_PANELS"))
    fs::copy_file(with(".png"), keep, fs::copy_options::overwrite_existing);
}

TEST_F(Plots, EveryStyleAndOddShapeIsDrawn) {
  if (!have_gnuplot) GTEST_SKIP() << "gnuplot is not on PATH";
  for (auto const style : detail::curve_styles)
    for (bool const log : {false, true}) {
      Figure figure{.title = std::string(style)};
      figure.curves.push_back({.x = {1}, .y = {2}, .label = "one point", .style = std::string(style)});
      figure.curves.push_back({.x = {1, 2, 1}, .y = {0, 0, 0}, .label = "zero", .style = std::string(style)});
      figure.log_y = log;
      EXPECT_EQ(write_figure(figure, stem), DrawResult::png) << style;
    }
  Figure outside = waves();
  outside.x_range = {100.0, -100.0}, outside.y_range = {50.0, 60.0};
  EXPECT_EQ(write_figure(outside, stem), DrawResult::png);
}

TEST_F(Plots, TextAndNamesAreNeverCommands) {
  Figure figure = waves();
  figure.title =
      "`touch pwned1` $(touch pwned2) ';touch pwned3;' @x \\ \"\n`touch pwned4` '.system('touch "
      "pwned5').'";
  figure.x_label = figure.y_label = figure.curves[0].label = figure.title;
  fs::path const before = fs::current_path();
  fs::current_path(folder);
  for (std::string const name : {"plain", "|touch pwned6", "< touch pwned7", "$(touch pwned8)", "`touch pwned9`", "-",
                                 "it's \"x\"", "a;b & c", "50%d", "~", "*", "path.with.dots", "Ünïcode θ"}) {
    DrawResult const drawn = write_figure(figure, name);
    EXPECT_EQ(drawn, have_gnuplot ? DrawResult::png : DrawResult::script_only) << name;
    EXPECT_TRUE(fs::exists(name + ".gp") && fs::exists(name + ".dat")) << name;
    EXPECT_TRUE(!have_gnuplot || is_png(name + ".png")) << name;
  }
  fs::current_path(before);
  EXPECT_EQ(files(), 13u * (have_gnuplot ? 3u : 2u));
}

TEST_F(Plots, RefusalsNameTheFigureAndTheCurveAndWriteNothing) {
  auto const refusal = [&](auto&& spoil) {
    Figure figure = waves();
    figure.title = "Energy";
    spoil(figure);
    auto const said = message_of<InvalidInput>([&] { write_figure(figure, folder / "new" / "f"); });
    EXPECT_TRUE(has(said, "\"Energy\""));
    return said;
  };
  double const nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has(refusal([](Figure& f) { f.curves.clear(); }), "at least one curve"));
  auto const sizes = refusal([](Figure& f) { f.curves[1].y.pop_back(); });
  EXPECT_TRUE(has(sizes, "\"ANCF, n = 8\""));
  EXPECT_TRUE(has(sizes, "x has 201 numbers and y has 200"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.curves[0].x.clear(), f.curves[0].y.clear(); }), "at least one point"));
  EXPECT_TRUE(has(refusal([&](Figure& f) { f.curves[0].x[3] = nan; }), "in x is not finite"));
  EXPECT_TRUE(has(refusal([&](Figure& f) { f.curves[0].y[3] = infinity; }), "in y is not finite"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.curves[0].style = "dots"; }), "\"dots\""));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.curves[0].colour = -2; }), "colour"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.curves[0].width = 0; }), "width"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.height_px = 0; }), "pixels"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.width_px = 1 << 20; }), "pixels"));
  EXPECT_TRUE(has(refusal([&](Figure& f) { f.x_range = {0.0, nan}; }), "x_range"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.y_range = {1.0, 1.0}; }), "y_range"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.log_y = true, f.y_range = {0.0, 1.0}; }), "logarithmic"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.log_y = f.equal_axes = true; }), "equal axes"));
  EXPECT_TRUE(has(refusal([](Figure& f) { f.curves = {{.x = {1}, .y = {-1}, .label = "a"}}, f.log_y = true; }),
                  "no point is positive"));
  EXPECT_THROW(write_panels({}, 2, stem), InvalidInput);
  EXPECT_THROW(write_panels({waves()}, 0, stem), InvalidInput);
  EXPECT_THROW(write_panels(std::vector(40, waves()), 40, stem), InvalidInput);
  EXPECT_THROW(write_figure(waves(), ""), InvalidInput);
  EXPECT_THROW(write_figure(waves(), folder / ""), InvalidInput);
  EXPECT_THROW(write_figure(waves(), "two\nlines"), InvalidInput);
  EXPECT_EQ(files(), 0u);
}

TEST_F(Plots, WithoutGnuplotOnlyTheScript) {
  for (std::string const path : {"", ":", "/nowhere:relative"}) {
    Path const only(path);
    EXPECT_FALSE(find_gnuplot());
    EXPECT_EQ(write_figure(waves(), stem), DrawResult::script_only);
    EXPECT_EQ(files(), 2u);
  }
}

TEST_F(Plots, AFileThatCannotRunIsNotGnuplot) {
  fs::create_directories(folder / "a" / "gnuplot");
  fs::create_directories(folder / "b");
  std::ofstream(folder / "b" / "gnuplot") << "#!/bin/sh\n";
  Path const only((folder / "a").string() + ':' + (folder / "b").string());
  EXPECT_FALSE(find_gnuplot());
  fs::permissions(folder / "b" / "gnuplot", fs::perms::owner_all);
  EXPECT_EQ(find_gnuplot(), folder / "b" / "gnuplot");
}

TEST_F(Plots, GnuplotFailureNamesTheScriptAndKeepsTheOldPicture) {
  std::ofstream(with(".png")) << "old";
  fs::create_directories(folder / "bin");
  for (std::string const body : {"echo strange >&2; exit 3", "echo strange"}) {  // fails, or draws nothing
    std::ofstream(folder / "bin" / "gnuplot") << "#!/bin/sh\n" << body << '\n';
    fs::permissions(folder / "bin" / "gnuplot", fs::perms::owner_all);
    Path const first((folder / "bin").string() + ':' + std::getenv("PATH"));
    auto const said = message_of<IoError>([&] { write_figure(waves(), stem); });
    EXPECT_TRUE(has(said, with(".gp").string()));
    EXPECT_TRUE(has(said, "strange"));
    EXPECT_EQ(text_of(with(".png")), "old");
    EXPECT_EQ(files(), 4u);  // bin, dat, gp, png
  }
}

TEST(PlotMarks, HaveDigitsEnoughToTellThemApart) {
  EXPECT_EQ(detail::tick_digits(0.0, 2.0), "6");
  // six digits before the point, three after the first digit of the span
  EXPECT_EQ(detail::tick_digits(1e5, 1e5 + 1.0), "9");
  EXPECT_EQ(detail::tick_digits(1.0, 1.0), "6");
}

TEST_F(Plots, AnUnwritablePlaceIsAnIoError) {
  std::ofstream(folder / "plain") << 'x';
  EXPECT_THROW(write_figure(waves(), folder / "plain" / "f"), IoError);
  fs::create_directories(with(".gp"));
  EXPECT_TRUE(has(message_of<IoError>([&] { write_figure(waves(), stem); }), ".gp"));
  EXPECT_EQ(files(), 2u);  // neither a data file without a script nor a temporary file
}

}  // namespace plot_test
