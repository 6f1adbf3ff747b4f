#pragma once
/// \file
/// Tables of the page of a comparison at equal error. A click on the head of a column sorts its table.

#include <polybody/io/equal_error_charts.hpp>
#include <polybody/io/text_files.hpp>

namespace polybody::detail {

/// Cell of a table in a page.
struct PageCell {
  std::string html;                   ///< content as HTML
  std::optional<double> number = {};  ///< value for sorting, NaN if unknown; empty: sorted as text
  std::string kind = {};              ///< class of the cell; empty: none
};

/// Table in a page, in its own box that scrolls.
struct PageTable {
  std::string label;                             ///< name of the table for screen readers, as text
  std::vector<std::string> heads;                ///< heads of the columns, as text in one or two lines
  std::vector<std::vector<PageCell>> rows = {};  ///< rows of cells; the first cell of a row is its head
  std::size_t sorted = std::string::npos;        ///< column by which the rows are sorted, ascending; npos: none

  /// HTML element of the table. A column with numbers is aligned to the right.
  std::string html() const {
    std::string out = "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"" + html_escaped(label) +
                      "\"><table><thead><tr>";
    for (std::size_t j = 0; j < heads.size(); ++j)
      out += std::string("<th scope=\"col\"") + (is_number(j) ? " class=\"n\"" : "") +
             (j == sorted ? " aria-sort=\"ascending\"" : "") + "><button type=\"button\">" + in_lines(heads[j]) +
             "</button></th>";
    out += "</tr></thead><tbody>\n";
    for (auto const& row : rows) {
      out += "<tr>";
      for (std::size_t j = 0; j < row.size(); ++j) out += cell(row[j], j == 0);
      out += "</tr>\n";
    }
    return out + "</tbody></table></div>\n";
  }

 private:
  bool is_number(std::size_t j) const { return !rows.empty() && rows.front()[j].number.has_value(); }
  static std::string in_lines(std::string const& head) {
    std::string out = html_escaped(head);
    if (std::size_t const at = out.find('\n'); at != out.npos) out.replace(at, 1, "<br>");
    return out;
  }
  static std::string cell(PageCell const& c, bool head) {
    std::string const kind = (c.number ? "n " : "") + c.kind;
    std::string const name = head ? "th" : "td";
    return "<" + name + (head ? " scope=\"row\"" : "") + (kind.empty() ? "" : " class=\"" + kind + '"') +
           (c.number ? " data-v=\"" + (std::isfinite(*c.number) ? all_digits(*c.number) : std::string()) + '"' : "") +
           ">" + c.html + "</" + name + ">";
  }
};

/// Cell with a number of `digits` significant digits.
inline PageCell number_cell(double x, int digits = 3) { return {readable(x, digits), x}; }
/// Cell with a count.
inline PageCell count_cell(long n) { return {std::to_string(n), double(n)}; }
/// Cell with a text, which is escaped.
inline PageCell text_cell(std::string const& text) { return {html_escaped(text)}; }

/// Tables of a report.
class EqualErrorTables {
 public:
  /// Tables of the report `r` with the styles of `charts`. Both must outlive this object.
  EqualErrorTables(EqualErrorReport const& r, EqualErrorCharts const& charts) : r_(r), charts_(charts) {}

  /// Cheapest runs for a wanted error, by ascending CPU time.
  PageTable ranking(Ranking const& ranking) const {
    PageTable table{"Ranking for the error " + percent_text(ranking.wanted),
                    {"formulation", "mesh", "step", "integrator", "CPU time\n[s]", "least\n[s]", "most\n[s]", "ratio",
                     "error" + unit_line(), "unknowns", "Newton\niterations", "factorisations"}};
    table.sorted = 4;
    double cheapest = 0.0, dearest = 0.0;
    for (CheapestRun const& at : ranking.ranked) {
      double const cpu = run_of(at).cpu;
      if (cheapest == 0.0) cheapest = cpu;
      dearest = std::max(dearest, cpu);
    }
    for (CheapestRun const& at : ranking.ranked) {
      StudyRun const& run = run_of(at);
      std::vector<PageCell> row = setting_cells(at.formulation, run);
      double const ratio = run.cpu / std::max(cheapest, 1e-9);
      row.insert(row.end(),
                 {number_cell(run.cpu), timing_cell(run, run.least_cpu), timing_cell(run, run.most_cpu),
                  ratio_cell(ratio, run.cpu / std::max(dearest, 1e-9)), number_cell(run.error),
                  count_cell(long(run.unknowns)), count_cell(run.iterations), count_cell(run.factorisations)});
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  /// Runs of the Pareto front of all formulations, by ascending error.
  PageTable front() const {
    PageTable table{"Best runs of all formulations",
                    {"formulation", "mesh", "step", "error\n[% of span]", "CPU time\n[s]"}};
    table.sorted = 3;
    for (std::size_t i = 0; i < r_.formulations.size(); ++i)
      for (StudyRun const& run : r_.formulations[i].runs) {
        if (!run.on_front) continue;
        std::vector<PageCell> row = setting_cells(i, run);
        row.back() = number_cell(100.0 * run.error / r_.span);  // replaces the integrator
        row.push_back(number_cell(run.cpu));
        table.rows.push_back(std::move(row));
      }
    std::sort(table.rows.begin(), table.rows.end(),
              [](auto const& a, auto const& b) { return a[3].number.value_or(0.0) < b[3].number.value_or(0.0); });
    return table;
  }

  /// Formulations with their physical models, observed orders and error bounds.
  PageTable formulations() const {
    PageTable table{"Formulations",
                    {"formulation", "physical model", "body", "policy", "integrator", "order\nmesh", "order\nstep",
                     "error bound" + unit_line(), "round-off" + unit_line()}};
    for (std::size_t i = 0; i < r_.formulations.size(); ++i) {
      StudiedFormulation const& f = r_.formulations[i];
      table.rows.push_back({name_cell(i), text_cell(f.model), text_cell(f.family), text_cell(f.policy),
                            text_cell(f.integrator), number_cell(f.mesh_order, 2), number_cell(f.step_order, 2),
                            number_cell(f.limit_error), number_cell(f.spread, 2)});
    }
    return table;
  }

  /// References of the physical models with their error bounds.
  PageTable references() const {
    PageTable table{"References of the physical models",
                    {"physical model", "formulation", "error bound" + unit_line()}};
    for (ModelReference const& reference : r_.references)
      table.rows.push_back(
          {text_cell(reference.model), name_cell(reference.formulation), number_cell(reference.error)});
    return table;
  }

  /// Largest differences of the references with their error bounds.
  PageTable differences() const {
    PageTable table{"Differences of the physical models",
                    {"first", "second", "largest\ndifference" + unit_line(' '), "error bound" + unit_line()}};
    for (ModelDifference const& d : r_.differences)
      table.rows.push_back({text_cell(r_.references[d.a].model), text_cell(r_.references[d.b].model),
                            d.resolved() ? number_cell(d.difference)
                                         : PageCell{"not resolved", std::numeric_limits<double>::quiet_NaN(), "weak"},
                            number_cell(d.error)});
    return table;
  }

  /// All runs.
  PageTable runs() const {
    PageTable table{"All runs",
                    {"formulation", "mesh", "step", "integrator", "error" + unit_line(), "error\n[% of span]",
                     "CPU time\n[s]", "unknowns", "steps", "Newton\niterations", "factorisations"}};
    for (std::size_t i = 0; i < r_.formulations.size(); ++i)
      for (StudyRun const& run : r_.formulations[i].runs) {
        std::vector<PageCell> row = setting_cells(i, run);
        bool const failed = !run.failure.empty();
        double const nan = std::numeric_limits<double>::quiet_NaN();
        row.push_back(failed ? PageCell{"failed", nan, "weak"} : number_cell(run.error));
        row.push_back(number_cell(failed ? nan : 100.0 * run.error / r_.span));
        row.push_back(number_cell(failed ? nan : run.cpu));
        for (long const n : {long(run.unknowns), run.steps, run.iterations, run.factorisations})
          row.push_back(failed ? number_cell(nan) : count_cell(n));
        table.rows.push_back(std::move(row));
      }
    return table;
  }

 private:
  StudyRun const& run_of(CheapestRun const& at) const { return r_.formulations[at.formulation].runs[at.run]; }
  /// Unit of the output after the letter `before`; empty if the output has no unit.
  std::string unit_line(char before = '\n') const { return r_.unit().empty() ? std::string() : before + r_.unit(); }

  PageCell name_cell(std::size_t i) const {
    return {"<span class=\"formulation\">" + ChartDrawing::swatch(charts_.style(i), i) + "<span>" +
            html_escaped(r_.formulations[i].name) + "</span></span>"};
  }
  std::vector<PageCell> setting_cells(std::size_t i, StudyRun const& run) const {
    StudiedFormulation const& f = r_.formulations[i];
    return {name_cell(i),
            {f.mesh_name.empty() ? "–" : mesh_text(f, run), double(run.mesh)},
            {f.step_name == "tolerance" ? step_text(f, run) : short_text(run.step) + "\u00A0s", run.step},
            text_cell(f.integrator)};
  }
  static PageCell timing_cell(StudyRun const& run, double cpu) {
    return number_cell(run.timings > 0 ? cpu : std::numeric_limits<double>::quiet_NaN());
  }
  /// Cell with a bar of the length `share` of its width.
  static PageCell ratio_cell(double ratio, double share) {
    return {
        "<span class=\"bar\" style=\"--share:" + fixed_text(100.0 * share, 1) + "%\">" + readable(ratio) + "</span>",
        ratio};
  }

  EqualErrorReport const& r_;
  EqualErrorCharts const& charts_;
};

}  // namespace polybody::detail
