#pragma once
/// \file
/// Writer of figures: a data file, a gnuplot script to run or edit by hand, and a PNG.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/figure.hpp>
#include <polybody/io/text_files.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

// Functions that find and run the program gnuplot, and quote text for its scripts.

/// First executable `gnuplot` in the folders of the environment variable PATH; empty if there is none.
template <class = void>  // compiled where it is used
std::optional<std::filesystem::path> find_gnuplot() {
  namespace fs = std::filesystem;
  char const* const path = std::getenv("PATH");
  for (std::string_view rest = path ? path : ""; !rest.empty();) {
    std::string_view const folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(folder.size() == rest.size() ? rest.size() : folder.size() + 1);
    if (folder.empty()) continue;
    std::error_code reason;
    fs::path const program = fs::absolute(fs::path(folder) / "gnuplot", reason);
    auto const status = fs::status(program, reason);
    auto const may_run = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    if (fs::is_regular_file(status) && (status.permissions() & may_run) != fs::perms::none) return program;
  }
  return std::nullopt;
}

namespace detail {

/// `text` in single quotes. `escape` replaces each single quote within the text.
template <class = void>
std::string single_quoted(std::string_view text, std::string_view escape) {
  std::string quoted = "'";
  for (char const c : text) c == '\'' ? quoted += escape : quoted += c;
  return quoted + '\'';
}

/// Text quoted as one word for a POSIX shell.
template <class = void>
std::string shell_word(std::string_view text) {
  return single_quoted(text, R"('\'')");
}

/// Gnuplot string expression for a text. The text is in single quotes, because gnuplot executes `...` in double quotes
/// as a command.
template <class = void>
std::string gnuplot_text(std::string_view text) {
  std::string expression = single_quoted(text, "''");
  for (std::size_t at = 0; (at = expression.find('\n', at)) != expression.npos; at += 7)
    expression.replace(at, 1, "'.\"\\n\".'");
  return expression;
}

/// Runs gnuplot, the file `program`, on `script` in the folder of the script. The gnuplot variable png contains the
/// name of a temporary file, to which the script draws. The temporary file then replaces the file `png`. Throws IoError
/// with the script's name and gnuplot's message if gnuplot fails, and IoError if the picture cannot be renamed.
template <class = void>
void run_gnuplot(std::filesystem::path const& program, std::filesystem::path const& script,
                 std::filesystem::path const& png) {
  namespace fs = std::filesystem;
  struct Temporary {
    fs::path file;
    ~Temporary() {
      std::error_code ignored;
      fs::remove(file, ignored);
    }
  };
  Temporary const drawing{temporary_next_to(png)}, words{temporary_next_to(png)};
  fs::path const folder = fs::absolute(script).parent_path();
  std::string const command = "cd " + shell_word(folder.string()) + " && " + shell_word(program.string()) + " -d -e " +
                              shell_word("png='./" + drawing.file.filename().string() + "'") + ' ' +
                              shell_word("./" + script.filename().string()) + " </dev/null >" +
                              shell_word(words.file.filename().string()) + " 2>&1";
  bool const ran = std::system(command.c_str()) == 0;
  std::error_code reason;
  if (!ran || fs::file_size(drawing.file, reason) == 0 || reason) {
    std::ifstream said(words.file);
    throw IoError("gnuplot.failed", {"gnuplot failed on \"", ErrorObject{script.string()},
                                     "\": ", std::string(std::istreambuf_iterator<char>(said), {})});
  }
  fs::rename(drawing.file, png, reason);
  if (reason)
    throw IoError("file.write",
                  {"file \"", ErrorObject{png.string()}, "\" cannot be renamed to its final name: ", reason.message()});
}

}  // namespace detail

/// Result of `write_panels` and `write_figure`. It is script_only if gnuplot is not on PATH or `draw` is false; an
/// existing PNG then remains unchanged.
enum class DrawResult { png, script_only };

namespace detail {

/// Gnuplot's names of the styles in `curve_styles`, in the same order.
inline constexpr std::array<std::string_view, 6> gnuplot_styles{
    "lines",       "points",
    "linespoints", "lines dashtype (12,6)",
    "steps",       "filledcurves closed fillstyle transparent solid 0.3"};

/// Colours that colour-blind readers can distinguish [Okabe & Ito 2008], the most visible first.
inline constexpr std::array<std::string_view, 8> palette{"#0072B2", "#D55E00", "#009E73", "#E69F00",
                                                         "#CC79A7", "#56B4E9", "#000000", "#F0E442"};

/// Point types of gnuplot that are distinct without colours. Filled types come first, because thick lines fill the
/// open ones.
inline constexpr std::array<int, 8> point_types{5, 7, 9, 13, 11, 15, 4, 6};

/// Text of the data file: a block of two columns for each curve. Two blank lines separate the blocks.
template <class = void>  // compiled where it is used
std::string data_text(std::vector<Figure> const& figures) {
  std::string text;
  for (auto const& figure : figures)
    for (auto const& curve : figure.curves) {
      std::string remark = figure.title + " | " + curve.label;
      std::ranges::replace(remark, '\n', ' ');
      text += (text.empty() ? "# " : "\n\n# ") + remark + '\n';
      for (std::size_t i = 0; i < curve.x.size(); ++i)
        text += all_digits(curve.x[i]) + ' ' + all_digits(curve.y[i]) + '\n';
    }
  return text;
}

/// Number of digits for the tick labels of an axis from `low` to `high`: six, or more if the span is less than 1e-3 of
/// the larger magnitude.
template <class = void>
std::string tick_digits(double low, double high) {
  double const share = std::max(std::abs(low), std::abs(high)) / std::abs(high - low);
  double const digits = share < 1e16 ? std::ceil(std::log10(share)) + 3 : 6;
  return std::to_string(static_cast<int>(std::clamp(digits, 6.0, 17.0)));
}

/// Gnuplot commands for one figure. The first curve is data block number `block` of the file `data`.
template <class = void>
std::string script_text(Figure const& figure, std::string const& data, std::size_t block) {
  auto const range = [](auto const& r) {
    return r ? '[' + all_digits((*r)[0]) + ':' + all_digits((*r)[1]) + ']' : std::string("[*:*]");
  };
  auto const digits = [&](auto const& r, auto points) {
    if (r) return tick_digits((*r)[0], (*r)[1]);
    double low = (figure.curves[0].*points)[0], high = low;
    for (auto const& curve : figure.curves)
      for (double const value : curve.*points) low = std::min(low, value), high = std::max(high, value);
    return tick_digits(low, high);
  };
  bool const named = std::ranges::any_of(figure.curves, [](auto& c) { return !c.label.empty(); });
  std::string text = "reset\n";
  text += "set title " + gnuplot_text(figure.title) + " noenhanced\n";
  text += "set xlabel " + gnuplot_text(figure.x_label) + " noenhanced\n";
  text += "set ylabel " + gnuplot_text(figure.y_label) + " noenhanced\n";
  text += "set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1\nset tics nomirror\nset border 3\n";
  text += figure.legend && named ? "set key below height 1 noenhanced\n" : "unset key\n";
  text += "set format x '%." + digits(figure.x_range, &Curve::x) + "h'\n";
  text += "set format y '%." + digits(figure.y_range, &Curve::y) + "h'\n";
  if (figure.log_x) text += "set logscale x\n";
  if (figure.log_y) text += "set logscale y\n";
  if (figure.equal_axes) text += "set size ratio -1\n";
  for (FigureText const& t : figure.texts)
    text += "set label " + gnuplot_text(t.text) + " at " + all_digits(t.x) + ',' + all_digits(t.y) +
            " noenhanced front offset character 0.6,0.5\n";
  text += "set xrange " + range(figure.x_range) + "\nset yrange " + range(figure.y_range) + "\nplot ";
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    Curve const& curve = figure.curves[i];
    std::size_t const colour = (curve.colour < 0 ? i : std::size_t(curve.colour)) % palette.size();
    auto const style = std::size_t(std::ranges::find(curve_styles, curve.style) - curve_styles.begin());
    text += (i ? ", \\\n     " : "") + gnuplot_text(data) + " index " + std::to_string(block + i) + " using 1:2 with " +
            std::string(gnuplot_styles[style]);
    text += " linewidth " + all_digits(curve.width) + " linecolor rgb '" + std::string(palette[colour]) + "'";
    if (curve.style.ends_with("points")) text += " pointtype " + std::to_string(point_types[colour]) + " pointsize 1.5";
    text += curve.label.empty() ? " notitle" : " title " + gnuplot_text(curve.label);
  }
  return text + '\n';
}

template <class = void>
std::filesystem::path with_ending(std::filesystem::path stem, char const* ending) {
  return stem += ending;
}

}  // namespace detail

/// Draws several figures in one PNG, row by row in `columns` columns. Each panel has the size of the largest figure.
/// Writes `stem`.dat, .gp (a script that runs in its own folder) and, if `draw` is true and gnuplot is on PATH, .png.
/// Each file appears when it is complete. Before it writes a file, throws InvalidInput for an empty name or
/// one with control characters, for no figure or column, for a picture above 30000 pixels, and for a figure that
/// cannot be drawn, with the names of the figure and the curve. Throws IoError if writing or gnuplot fails.
template <class = void>
DrawResult write_panels(std::vector<Figure> const& figures, int columns, std::filesystem::path const& stem,
                        bool draw = true) {
  std::string const name = stem.filename().string();
  if (name.empty() || std::ranges::any_of(name, [](unsigned char c) { return c < ' '; }))
    throw InvalidInput("file.name", {"figure file \"", ErrorObject{stem.string()},
                                     "\": the name is empty or has a control character."});
  if (figures.empty() || columns < 1)
    throw InvalidInput("figure.content", {"figure file \"", ErrorObject{stem.string()},
                                          "\": at least one figure and one column are needed, but there are ",
                                          figures.size(), " figures and ", columns, " columns."});
  int width = 0, height = 0;
  for (auto const& figure : figures) {
    detail::check(figure);
    width = std::max(width, figure.width_px);
    height = std::max(height, figure.height_px);
  }
  int const count = static_cast<int>(figures.size());
  int const across = std::min(columns, count), down = (count + across - 1) / across;
  if (across > 30000 / width || down > 30000 / height)
    throw InvalidInput("figure.size", {"figure file \"", ErrorObject{stem.string()},
                                       "\": the picture is wider or higher than 30000 pixels. Use fewer panels."});

  std::string const size = std::to_string(across * width) + ',' + std::to_string(down * height);
  std::string script = "# gnuplot script; run it from its own folder\n";
  script += "if (!exists(\"png\")) png = " + detail::gnuplot_text("./" + name + ".png") + '\n';
  script += "if (strstrt(GPVAL_TERMINALS, ' pngcairo ')) { set terminal pngcairo size " + size +
            " font 'sans,14' } else { set terminal png size " + size + " }\n";
  script += "set encoding utf8\nset output png\n";
  if (count > 1) script += "set multiplot layout " + std::to_string(down) + ',' + std::to_string(across) + '\n';
  std::size_t block = 0;
  for (auto const& figure : figures) {
    script += detail::script_text(figure, "./" + name + ".dat", block);
    block += figure.curves.size();
  }
  script += count > 1 ? "unset multiplot\nunset output\n" : "unset output\n";

  AtomicFile data(detail::with_ending(stem, ".dat")), commands(detail::with_ending(stem, ".gp"));
  data.write(detail::data_text(figures));
  commands.write(script);
  data.close();
  commands.close();
  auto const gnuplot = draw ? find_gnuplot() : std::nullopt;
  if (!gnuplot) return DrawResult::script_only;
  detail::run_gnuplot(*gnuplot, detail::with_ending(stem, ".gp"), detail::with_ending(stem, ".png"));
  return DrawResult::png;
}

/// Writes one figure to `stem`.dat, .gp and, if `draw` is true, .png, like `write_panels`.
template <class = void>
DrawResult write_figure(Figure const& figure, std::filesystem::path const& stem, bool draw = true) {
  return write_panels({figure}, 1, stem, draw);
}

}  // namespace polybody
