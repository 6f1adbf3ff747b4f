#pragma once
/// \file
/// Sections of the page of a comparison at equal error.

#include <chrono>
#include <filesystem>

#include <polybody/io/equal_error_page_text.hpp>
#include <polybody/io/equal_error_tables.hpp>

namespace polybody {

/// Texts of the page of a comparison, and files that the page refers to.
struct PageOptions {
  std::string title = "Comparison at equal error";  ///< heading and title of the page
  std::string command = {};                         ///< command that made the report; empty: not printed
  std::string machine = {};                         ///< name of the machine; empty: not printed
  std::string version = {};                         ///< `library_version`; empty: not printed
  std::string date = {};                            ///< date of the report; empty: the current date and time in UTC
  std::filesystem::path film = {};                  ///< page that `Film::write` made; empty: no film
  std::vector<std::filesystem::path> files = {};    ///< further files of the report, linked at the foot of the page
};

namespace detail {

/// Checks that a report can be drawn.
/// \throws InvalidInput if there are no formulations, if a formulation has no runs, if a history has another length
/// than the times, if a reference has no limit, or if an index is out of range.
template <class = void>  // compiled where it is used
void check(EqualErrorReport const& r) {
  auto const need = [](bool good, std::string_view object, std::string_view fault) {
    if (!good) throw InvalidInput("equal_error.report", {"report \"", ErrorObject{object}, "\": ", fault});
  };
  need(!r.formulations.empty(), r.output, "there are no formulations. Use the result of `EqualErrorStudy::run`.");
  auto const fits = [&](std::vector<double> const& y) { return y.empty() || y.size() == r.times.size(); };
  for (StudiedFormulation const& f : r.formulations) {
    need(!f.runs.empty(), f.name, "the formulation has no runs. Use the result of `EqualErrorStudy::run`.");
    bool good = fits(f.limit);
    for (StudyRun const& run : f.runs) good = good && fits(run.y) && fits(run.energy);
    need(good, f.name, "a history has another length than the times. Sample all histories at `times`.");
  }
  std::string_view const range = "an index is out of range. Use the result of `EqualErrorStudy::run`.";
  for (ModelReference const& reference : r.references)
    need(reference.formulation < r.formulations.size() && !r.formulations[reference.formulation].limit.empty(),
         reference.model, "the reference needs a formulation with a limit. Use the result of `EqualErrorStudy::run`.");
  for (ModelDifference const& d : r.differences)
    need(d.a < r.references.size() && d.b < r.references.size(), r.output, range);
  for (Ranking const& ranking : r.rankings) {
    for (CheapestRun const& at : ranking.ranked)
      need(at.formulation < r.formulations.size() && at.run < r.formulations[at.formulation].runs.size(), r.output,
           range);
    for (UnrankedFormulation const& other : ranking.missing)
      need(other.formulation < r.formulations.size(), r.output, range);
  }
}

/// Name and version of the compiler, and the options that change CPU times.
template <class = void>
std::string compiler_text() {
#if defined(__clang__)
  std::string text = std::string("clang ") + __clang_version__;
#elif defined(__GNUC__)
  std::string text = std::string("g++ ") + __VERSION__;
#else
  std::string text = "unknown";
#endif
#if defined(__GNUC__) && !defined(__OPTIMIZE__)
  text += ", without optimisation";
#endif
#if !defined(NDEBUG)
  text += ", with assertions";
#endif
  return text;
}

/// Current date and time in UTC, such as "2026-11-28 23:05 UTC".
template <class = void>
std::string utc_now() {
  using namespace std::chrono;
  auto const now = floor<minutes>(system_clock::now());
  auto const day = floor<days>(now);
  year_month_day const date{day};
  auto const two = [](auto n) { return (n < 10 ? "0" : "") + std::to_string(n); };
  auto const minute = (now - day).count();
  return std::to_string(int(date.year())) + '-' + two(unsigned(date.month())) + '-' + two(unsigned(date.day())) + ' ' +
         two(minute / 60) + ':' + two(minute % 60) + " UTC";
}

/// Page of a report.
class EqualErrorPage {
 public:
  /// Page of the report `r` for the file `file`. The report must outlive this object.
  EqualErrorPage(EqualErrorReport const& r, PageOptions options, std::filesystem::path file)
      : r_(r), options_(std::move(options)), file_(std::move(file)), charts_(r), tables_(r, charts_) {}

  /// Text of the HTML file.
  std::string html() const {
    std::string const title = html_escaped(options_.title);
    std::string const sections = rankings() + curves() + models() + histories() + film() + remarks() + all_runs();
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           title + "</title>\n<style>" + std::string(page_style) + colours() + "</style>\n</head>\n<body>\n" +
           head(title, sections) + "<main>\n" + sections + "</main>\n" + foot() + "<script>" +
           std::string(page_script) + "</script>\n</body>\n</html>\n";
  }

 private:
  /// Class f<i> with the colour of formulation i. Black becomes white on a dark page.
  std::string colours() const {
    std::string out, dark;
    for (std::size_t i = 0; i < r_.formulations.size(); ++i) {
      std::string const rule = ".f" + std::to_string(i) + " { color: ";
      std::string_view const rgb = charts_.style(i).rgb();
      out += rule + std::string(rgb) + "; }\n";
      if (rgb == "#000000") dark += rule + "#f4f6f9; }\n";
    }
    return out + (dark.empty() ? "" : "@media (prefers-color-scheme: dark) {\n" + dark + "}\n");
  }

  /// Head of the page with links to its `sections`.
  std::string head(std::string const& title, std::string const& sections) const {
    std::string out = "<header>\n<p class=\"kind\">polybody · formulations compared at equal error</p>\n<h1>" + title +
                      "</h1>\n<p class=\"lead\">The output is <b>" + html_escaped(r_.output) + "</b>";
    if (!r_.times.empty())
      out += " from " + short_text(r_.times.front()) + " s to " + short_text(r_.times.back()) + " s";
    out += ", and its span, the largest minus the smallest value, is <b>" + readable(r_.span, 4) +
           html_escaped(unit_after_number(r_)) + "</b>.</p>\n<nav aria-label=\"Sections\">";
    static constexpr std::array<std::array<std::string_view, 2>, 7> links{{{"ranking", "Ranking"},
                                                                           {"curves", "Work and precision"},
                                                                           {"models", "Physical models"},
                                                                           {"histories", "Histories"},
                                                                           {"film", "Film"},
                                                                           {"remarks", "Remarks"},
                                                                           {"runs", "All runs"}}};
    for (auto const& [id, name] : links)
      if (std::string const target(id); sections.find("<section id=\"" + target + '"') != sections.npos)
        out += "<a href=\"#" + target + "\">" + std::string(name) + "</a>";
    return out + "</nav>\n</header>\n";
  }

  static std::string section(std::string const& id, std::string const& title, std::string const& content) {
    return "<section id=\"" + id + "\" aria-labelledby=\"" + id + "-head\">\n<h2 id=\"" + id + "-head\">" + title +
           "</h2>\n" + content + "</section>\n";
  }
  static std::string card(std::string const& title, std::string const& content) {
    return "<div class=\"card\"><h3>" + title + "</h3>" + content + "</div>\n";
  }
  static std::string drawn(Chart const& chart) { return ChartDrawing(chart).html(); }
  /// Grid with two columns.
  static std::string grid(std::string const& content) { return "<div class=\"grid\">\n" + content + "</div>\n"; }
  /// Charts in rows of two.
  static std::string drawn(std::vector<Chart> const& charts) {
    std::string out;
    for (std::size_t k = 0; k < charts.size(); k += 2)
      out += grid(drawn(charts[k]) + (k + 1 < charts.size() ? drawn(charts[k + 1]) : std::string()));
    return out;
  }

  std::string rankings() const {
    std::string out =
        "<p>Each table contains the cheapest run of each formulation with at most the error in its heading. The error "
        "is "
        "the largest difference from the reference of the formulation’s own physical model. The ratio "
        "compares the CPU time with that of the first formulation.</p>\n";
    for (Ranking const& ranking : r_.rankings) {
      std::string content;
      if (!ranking.ranked.empty()) content += summary(ranking) + tables_.ranking(ranking).html();
      if (!ranking.missing.empty()) content += "<ul class=\"missing\" aria-label=\"Not ranked\">";
      for (UnrankedFormulation const& other : ranking.missing)
        content += "<li>" + ChartDrawing::swatch(charts_.style(other.formulation), other.formulation) + "<b>" +
                   html_escaped(r_.formulations[other.formulation].name) +
                   "</b> is not ranked: " + html_escaped(other.reason) + ".</li>";
      if (!ranking.missing.empty()) content += "</ul>";
      out += card("Error of at most " + percent_text(ranking.wanted) + " of the span, " +
                      readable(ranking.wanted * r_.span) + html_escaped(unit_after_number(r_)),
                  content);
    }
    return section("ranking", "Cheapest run of each formulation", out);
  }

  /// Result of a ranking in words.
  std::string summary(Ranking const& ranking) const {
    auto const name = [&](CheapestRun const& at) {
      return "<b>" + html_escaped(r_.formulations[at.formulation].name) + "</b>";
    };
    auto const run = [&](CheapestRun const& at) -> StudyRun const& {
      return r_.formulations[at.formulation].runs[at.run];
    };
    CheapestRun const& first = ranking.ranked[0];
    std::string out = "<p>" + name(first) + " needs " + readable(run(first).cpu) + "\u00A0s with " +
                      html_escaped(setting_text(r_.formulations[first.formulation], run(first)));
    if (ranking.ranked.size() == 1) return out + ".</p>";
    CheapestRun const& second = ranking.ranked[1];
    double const ratio = run(second).cpu / std::max(run(first).cpu, 1e-9);
    out += "; " + name(second) + " needs " + readable(ratio) + " times as long.";
    bool const timed = run(first).timings > 1 && run(second).timings > 1;
    return out +
           (timed && run(first).most_cpu >= run(second).least_cpu ? " Their measured times overlap.</p>" : "</p>");
  }

  std::string curves() const {
    std::string content =
        "<p>CPU times are medians of repeated runs. A run that is in no ranking is not repeated. "
        "The names below a chart hide and show its curves.</p>\n";
    if (Chart const work = charts_.work(); work.curves.empty())
      content = "<p>No run has a known error. See the remarks.</p>\n";
    else
      content +=
          grid(drawn(work) + "<div class=\"stack tall\">" +
               card("Best runs of all formulations",
                    "<p>No other run has both a smaller error and a smaller CPU time.</p>" + tables_.front().html()) +
               "</div>\n");
    std::vector<Chart> convergence = charts_.convergence_over_mesh();
    for (Chart& chart : charts_.convergence_over_step()) convergence.push_back(std::move(chart));
    content += drawn(convergence) +
               card("Formulations",
                    "<p>The orders are observed from the three finest meshes and the three shortest "
                    "steps. The column “round-off” contains the change of the output after a perturbation "
                    "of the initial coordinates by one unit in the last place.</p>" +
                        tables_.formulations().html());
    return section("curves", "Work and precision", content);
  }

  std::string models() const {
    if (r_.references.empty())
      return section("models", "Physical models", "<p>No formulation has a converged result. See the remarks.</p>\n");
    std::string content =
        "<p>Formulations with different physical models converge to different results. These "
        "differences are separate from the discretisation errors.</p>\n";
    std::vector<Chart> const charts = charts_.differences();
    std::string tables;
    if (!r_.differences.empty())
      tables += card("Differences",
                     "<p>A difference below its error bound is not resolved.</p>" + tables_.differences().html());
    tables += card("References",
                   "<p>Each physical model has the extrapolated result of one formulation as its "
                   "reference.</p>" +
                       tables_.references().html());
    content += charts.size() == 1 ? grid(drawn(charts[0]) + "<div class=\"stack\">\n" + tables + "</div>\n")
                                  : drawn(charts) + grid(tables);
    return section("models", "Physical models", content);
  }

  std::string histories() const {
    std::vector<Chart> charts;
    for (Chart& chart : std::array{charts_.output(), charts_.energy()})
      if (!chart.curves.empty()) charts.push_back(std::move(chart));
    return charts.empty() ? std::string() : section("histories", "Histories", drawn(charts));
  }

  std::string film() const {
    if (options_.film.empty()) return {};
    std::string const address = html_escaped(relative_address(options_.film, file_));
    return section(
        "film", "Film",
        "<div class=\"card\"><iframe src=\"" + address +
            "\" title=\"Film of the compared runs\" loading=\"lazy\" allow=\"fullscreen\"></iframe><a href=\"" +
            address + "\">Open the film on its own page</a></div>\n");
  }

  std::string remarks() const {
    std::string items;
    for (std::size_t i = 0; i < r_.formulations.size(); ++i) {
      StudiedFormulation const& f = r_.formulations[i];
      std::string const name = ChartDrawing::swatch(charts_.style(i), i) + "<b>" + html_escaped(f.name) + "</b>";
      for (std::string const& remark : f.remarks) items += "<li>" + name + ": " + html_escaped(remark) + "</li>\n";
      std::string failures;
      std::size_t count = 0;
      for (StudyRun const& run : f.runs) {
        if (run.failure.empty()) continue;
        ++count;
        failures += "<li>" + html_escaped(setting_text(f, run)) + ": " + html_escaped(run.failure) + "</li>";
      }
      if (count > 0)
        items += "<li>" + name + ": " + std::to_string(count) + " of " + std::to_string(f.runs.size()) +
                 " runs failed.<details" + (count < 4 ? " open" : "") + "><summary>Messages</summary><ul>" + failures +
                 "</ul></details></li>\n";
    }
    if (items.empty()) return {};
    return section("remarks", "Remarks", "<div class=\"card\"><ul class=\"remarks\">" + items + "</ul></div>\n");
  }

  std::string all_runs() const {
    std::size_t count = 0;
    for (StudiedFormulation const& f : r_.formulations) count += f.runs.size();
    return section("runs", "All runs",
                   "<details class=\"card tall\"><summary>Table of " + std::to_string(count) + " runs</summary>" +
                       tables_.runs().html() + "</details>\n");
  }

  std::string foot() const {
    std::string out = "<footer><dl>";
    auto const row = [&](std::string const& name, std::string const& content) {
      if (!content.empty()) out += "<dt>" + name + "</dt><dd>" + content + "</dd>";
    };
    row("Command", options_.command.empty() ? "" : "<code>" + html_escaped(options_.command) + "</code>");
    row("Compiler", html_escaped(compiler_text()));
    row("Machine", html_escaped(options_.machine));
    row("Date", html_escaped(options_.date));
    row("Library", options_.version.empty() ? "" : "polybody " + html_escaped(options_.version));
    std::string links;
    for (std::filesystem::path const& file : options_.files)
      links += (links.empty() ? "<a href=\"" : ", <a href=\"") + html_escaped(relative_address(file, file_)) + "\">" +
               html_escaped(file.filename().string()) + "</a>";
    row("Files", links);
    return out + "</dl></footer>\n";
  }

  EqualErrorReport const& r_;
  PageOptions options_;
  std::filesystem::path file_;
  EqualErrorCharts charts_;
  EqualErrorTables tables_;
};

}  // namespace detail

}  // namespace polybody
