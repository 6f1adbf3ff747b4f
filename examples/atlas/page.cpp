#include "page.hpp"

#include <algorithm>
#include <cmath>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/text_files.hpp>

namespace atlas {

namespace fs = std::filesystem;

namespace {

// Text of a list of numbers: "5, 10, 20".
template <class T, class Text>
std::string listed(std::vector<T> const& values, Text const& text) {
  std::string out;
  for (T const& x : values) out += (out.empty() ? "" : ", ") + text(x);
  return out;
}

std::string meshes_of(StudiedFormulation const& f) {
  if (f.mesh_name.empty()) return "–";
  std::vector<Index> meshes;
  for (StudyRun const& run : f.runs)
    if (meshes.empty() || meshes.back() != run.mesh) meshes.push_back(run.mesh);
  return listed(meshes, [](Index n) { return std::to_string(n); }) + ' ' + f.mesh_name;
}

std::string steps_of(StudiedFormulation const& f) {
  std::vector<double> steps;
  for (StudyRun const& run : f.runs)
    if (run.mesh == f.runs.front().mesh) steps.push_back(run.step);
  return (f.step_name == "tolerance" ? "tolerances " : "") + listed(steps, [](double h) { return number(h, 4); });
}

Table settings_table(EqualErrorReport const& r) {
  Table t{"Formulations",
          "Physical model, meshes and steps of each formulation; observed orders; error bar of the extrapolated limit.",
          {"formulation", "physical model", "policy", "meshes", "steps [s]", "order in mesh", "order in step",
           "error bar " + r.unit()},
          1};
  bool several = false;
  for (StudiedFormulation const& f : r.formulations) {
    several = several || f.integrator != r.formulations.front().integrator;
    t.rows.push_back({Cell::of(f.name), Cell::of(f.model), Cell::of(f.policy), Cell::of(meshes_of(f)),
                      Cell::of(steps_of(f)), Cell::number(f.mesh_order, 2, 0.15), Cell::number(f.step_order, 2, 0.15),
                      Cell::number(f.limit_error, 2, 0.2 * f.limit_error)});
  }
  if (!several) {
    t.note += "\nThe integrator is " + r.formulations.front().integrator + ".";
    return t;
  }
  t.heads.insert(t.heads.begin() + 3, "integrator");
  for (std::size_t i = 0; i < t.rows.size(); ++i)
    t.rows[i].insert(t.rows[i].begin() + 3, Cell::of(r.formulations[i].integrator));
  return t;
}

std::string error_name(double wanted) { return number(wanted, 2); }

// Least processor time of these runs [s]. Rigid bodies count only if they have the physical model of the problem.
double fastest_of(Problem const& problem, EqualErrorReport const& r, std::vector<CheapestRun> const& runs) {
  double least = std::numeric_limits<double>::infinity();
  for (CheapestRun const& c : runs)
    if (StudiedFormulation const& f = r.formulations[c.formulation];
        f.family != families::rigid || f.model == problem.model)
      least = std::min(least, std::max(f.runs[c.run].cpu, 1e-9));
  return least;
}

Table cheapest_table(Problem const& problem, EqualErrorReport const& r) {
  Table t{"Cheapest settings",
          "Cheapest run of each formulation whose discretisation error is at most the wanted error, relative to the "
          "span " +
              number(r.span, 4) + ' ' + r.unit() +
              " of the output.\nTimes are medians of repeated runs.\nThe ratio is relative to the fastest "
              "run, without rigid bodies of another physical model than \"" +
              problem.model + "\".",
          {"error", "formulation", "mesh, step", "error found " + r.unit(), "unknowns", "Newton iterations",
           "factorisations", "time [s]", "ratio"},
          2};
  for (Ranking const& ranking : r.rankings)
    for (CheapestRun const& c : ranking.ranked) {
      StudiedFormulation const& f = r.formulations[c.formulation];
      StudyRun const& run = f.runs[c.run];
      double const ratio = run.cpu / fastest_of(problem, r, ranking.ranked);
      t.rows.push_back({Cell::of(error_name(ranking.wanted)), Cell::of(f.name),
                        Cell::time(polybody::detail::setting_of(f, run)), Cell::time(number(run.error, 2)),
                        Cell::time(std::to_string(run.unknowns)), Cell::time(std::to_string(run.iterations)),
                        Cell::time(std::to_string(run.factorisations)), Cell::time(number(run.cpu, 2)),
                        Cell::time(number(ratio, 2))});
    }
  return t;
}

// Compares the settings of the page with the runs of these settings: the cheapest setting depends on times.
std::vector<std::string> check_cheapest(Problem const& problem, EqualErrorReport const& r, std::string_view page) {
  Table const fresh = cheapest_table(problem, r);
  std::vector<std::string> faults = differences(fresh, page);
  for (TextRow const& row : rows_of(page, fresh.title)) {
    if (row.size() != fresh.heads.size()) continue;  // a fault of `differences`
    std::string const name = fresh.title + ", " + row[0] + ", " + row[1] + ": ";
    StudyRun const* found = nullptr;
    for (StudiedFormulation const& f : r.formulations)
      for (StudyRun const& run : f.runs)
        if (f.name == row[1] && polybody::detail::setting_of(f, run) == row[2]) found = &run;
    double const shown = number_in(row[3]);
    if (found == nullptr)
      faults.push_back(name + "the study has no run with " + row[2] + ".");
    else if (!(std::abs(found->error - shown) <= 0.06 * shown + 1e-9 * r.span))
      faults.push_back(name + "the page has the error " + row[3] + ", the run " + number(found->error, 3) + ".");
    else if (std::to_string(found->unknowns) != row[4])
      faults.push_back(name + "the page has " + row[4] + " unknowns, the run " + std::to_string(found->unknowns) + ".");
    else if (double const n = number_in(row[5]); std::abs(double(found->iterations) - n) > 0.02 * n)
      faults.push_back(name + "the page has " + row[5] + " iterations, the run " + std::to_string(found->iterations) +
                       ".");
  }
  return faults;
}

Table unranked_table(EqualErrorReport const& r) {
  Table t{"Without a rank",
          "Formulations that do not reach a wanted error, and the reason.",
          {"error", "formulation", "reason"},
          2};
  for (Ranking const& ranking : r.rankings)
    for (UnrankedFormulation const& u : ranking.missing)
      t.rows.push_back(
          {Cell::of(error_name(ranking.wanted)), Cell::of(r.formulations[u.formulation].name), Cell::of(u.reason)});
  return t;
}

Table difference_table(EqualErrorReport const& r) {
  Table t{"Differences between physical models",
          "Largest difference over time between the converged results, with its error bar.\nA difference below its "
          "error bar is not resolved.\nModels with an error bar above half of the span are omitted.",
          {"first", "second", "difference " + r.unit(), "error bar " + r.unit()},
          2};
  for (ModelDifference const& d : r.differences) {
    if (d.error > 0.5 * r.span) continue;
    Cell const difference =
        d.resolved() ? Cell::number(d.difference, 3, d.error + 5e-3 * d.difference) : Cell::of("not resolved");
    t.rows.push_back({Cell::of(r.references[d.a].model), Cell::of(r.references[d.b].model), difference,
                      Cell::number(d.error, 2, 0.2 * d.error)});
  }
  return t;
}

// The effect of round-off differs between compilers, so the check compares its order of magnitude.
Table round_off_table(Problem const& problem, EqualErrorReport const& r) {
  Table t{"Effect of round-off",
          "Largest change of the output if each initial coordinate changes by one unit in the last place, with the "
          "finest mesh and the shortest step.\nSmaller errors and differences cannot be ranked.",
          {"formulation", "change " + r.unit(), "relative to the span"},
          1};
  for (StudiedFormulation const& f : r.formulations)
    if (problem.has_contacts && !f.finest().y.empty())
      t.rows.push_back({Cell::of(f.name), Cell::number(f.spread, 1, 9.0 * f.spread + 1e-9 * r.span),
                        Cell::number(f.spread / r.span, 1, 9.0 * f.spread / r.span + 1e-9)});
  return t;
}

Table known_table(Problem const& problem, EqualErrorReport const& r) {
  Table t{"Known answers",
          "Converged result at the end of the run, compared with an independent source.",
          {"physical model", "source", "known " + r.unit(), "found " + r.unit(), "error bar " + r.unit()},
          2};
  for (KnownAnswer const& known : problem.known)
    for (std::size_t k = 0; k < r.references.size(); ++k)
      if (r.references[k].model == known.model)
        t.rows.push_back({Cell::of(known.model), Cell::of(known.source), Cell::of(number(known.value, 6)),
                          Cell::number(r.reference(k).back(), 6, r.references[k].error + 1e-6 * r.span),
                          Cell::number(r.references[k].error, 2, 0.2 * r.references[k].error)});
  return t;
}

Table remark_table(Problem const& problem, EqualErrorReport const& r) {
  Table t{
      "Remarks", "Formulations that do not apply, runs that failed, and other findings.", {"formulation", "remark"}, 2};
  t.masked_keys = true;
  for (Excluded const& e : problem.excluded) t.rows.push_back({Cell::of(e.formulation), Cell::of(e.reason)});
  for (StudiedFormulation const& f : r.formulations)
    for (std::string const& remark : f.remarks) t.rows.push_back({Cell::of(f.name), Cell::of(remark)});
  return t;
}

std::string page_name(fs::path const& folder, std::string const& name) { return (folder / (name + ".md")).string(); }

std::string content_of(std::string const& file) {
  auto const text = polybody::detail::content_of(file);
  if (!text) throw IoError("file.open", {"file \"", ErrorObject{file}, "\" cannot be read."});
  return *text;
}

void write_part(std::string const& file, std::string const& head, std::string const& made) {
  auto const text = polybody::detail::content_of(file);
  std::string const empty = head + std::string(begin_marker) + '\n' + std::string(end_marker) + '\n';
  AtomicFile out(file);
  out.write(with_part(text ? *text : empty, made));
  out.close();
}

std::string const summary = "summary", summary_title = "Fastest formulations";

// Runs of a ranking whose physical model differs from that of the problem by at most the wanted error. A difference
// that is not resolved counts if its error bar is at most the wanted error.
std::vector<CheapestRun> admissible(Done const& done, Ranking const& ranking) {
  EqualErrorReport const& r = done.report;
  std::vector<CheapestRun> out;
  for (CheapestRun const& c : ranking.ranked) {
    std::string const& model = r.formulations[c.formulation].model;
    bool holds = model == done.problem.model;
    for (ModelDifference const& d : r.differences) {
      std::string const &a = r.references[d.a].model, &b = r.references[d.b].model;
      if ((a != model || b != done.problem.model) && (b != model || a != done.problem.model)) continue;
      holds = std::max(d.resolved() ? d.difference : 0.0, d.error) <= ranking.wanted * r.span;
    }
    if (holds) out.push_back(c);
  }
  return out;
}

std::string link_of(Problem const& problem) { return '[' + problem.title + "](" + problem.name + ".md)"; }

Table summary_table(std::vector<Done> const& all) {
  Table t{
      summary_title,
      "The three fastest formulations of each problem at each error, relative to the span of the output, with their "
      "processor time relative to the fastest one.\nA formulation counts if its discretisation error and the "
      "difference of its physical model from the model in the second column are both at most the error.",
      {"problem", "physical model", "0.1", "0.01", "0.001", "0.0001"},
      1};
  for (Done const& done : all) {
    EqualErrorReport const& r = done.report;
    t.rows.push_back({Cell::of(link_of(done.problem)), Cell::of(done.problem.model)});
    for (std::size_t k = 2; k < t.heads.size(); ++k) {
      std::string text;
      for (Ranking const& ranking : r.rankings) {
        if (error_name(ranking.wanted) != t.heads[k]) continue;
        std::vector<CheapestRun> runs = admissible(done, ranking);
        double const least = fastest_of(done.problem, r, runs);
        runs.resize(std::min<std::size_t>(runs.size(), 3));
        for (CheapestRun const& c : runs) {
          StudiedFormulation const& f = r.formulations[c.formulation];
          text += (text.empty() ? "" : "; ") + f.name + ' ' + number(f.runs[c.run].cpu / least, 2);
        }
      }
      t.rows.back().push_back(Cell::time(text.empty() ? "none" : text));
    }
  }
  return t;
}

// Names of the formulations in a cell of the summary: "NAME RATIO; NAME RATIO".
std::vector<std::string> names_in(std::string const& cell) {
  std::vector<std::string> names;
  if (cell == "none") return names;
  for (std::size_t at = 0; at < cell.size();) {
    std::size_t const end = std::min(cell.find("; ", at), cell.size());
    std::string const part = cell.substr(at, end - at);
    names.push_back(part.substr(0, part.rfind(' ')));
    at = end + 2;
  }
  return names;
}

// Differences between a row of the summary and the results of its problem.
std::vector<std::string> check_row(TextRow const& row, Done const& done, Table const& table) {
  std::vector<std::string> faults;
  for (Ranking const& ranking : done.report.rankings)
    for (std::size_t k = 2; k < row.size() && k < table.heads.size(); ++k) {
      if (table.heads[k] != error_name(ranking.wanted)) continue;
      std::vector<std::string> names;
      for (CheapestRun const& c : admissible(done, ranking))
        names.push_back(done.report.formulations[c.formulation].name);
      std::vector<std::string> const shown = names_in(row[k]);
      for (std::string const& name : shown)
        if (std::find(names.begin(), names.end(), name) == names.end())
          faults.push_back(done.problem.title + ": \"" + name + "\" does not reach the error " + table.heads[k] + ".");
      if (shown.size() != std::min<std::size_t>(names.size(), 3))
        faults.push_back(done.problem.title + ": the summary has another number of formulations at the error " +
                         table.heads[k] + ".");
    }
  return faults;
}

}  // namespace

Table coarse_table(Done const& done) {
  EqualErrorReport const& r = done.report;
  Question const& q = done.problem.question;
  std::string const end = q.quick_end > 0.0 ? "at " + number(q.quick_end) + " s " : "at the end ",
                    until = q.quick_end > 0.0 ? "largest magnitude until then " : "largest magnitude ";
  Table t{"Coarsest settings",
          "Results with the coarsest mesh and the longest step, which `atlas --quick --check` computes again.",
          {"formulation", "mesh, step", end + r.unit(), until + r.unit(), "unknowns"},
          2};
  for (StudiedFormulation const& f : r.formulations) {
    StudyRun run = f.runs.front();
    if (!run.y.empty()) run.y.resize(std::size_t(q.samples(true)) + 1);
    double largest = 0.0;
    for (double const y : run.y) largest = std::max(largest, std::abs(y));
    double const tolerance = 1e-4 * largest + 1e-9;
    std::vector<Cell> row{Cell::of(f.name), Cell::of(polybody::detail::setting_of(f, run))};
    if (run.y.empty()) row.insert(row.end(), {Cell::of("fails"), Cell::of("fails"), Cell::of("–")});
    if (!run.y.empty())
      row.insert(row.end(), {Cell::number(run.y.back(), 6, tolerance), Cell::number(largest, 6, tolerance),
                             Cell::of(std::to_string(run.unknowns))});
    t.rows.push_back(std::move(row));
  }
  return t;
}

std::vector<Table> tables_of(Done const& done) {
  EqualErrorReport const& r = done.report;
  return {settings_table(r),
          cheapest_table(done.problem, r),
          unranked_table(r),
          difference_table(r),
          round_off_table(done.problem, r),
          known_table(done.problem, r),
          remark_table(done.problem, r),
          coarse_table(done),
          external_table(done.others, r)};
}

void write_page(Done const& done, fs::path const& folder) {
  std::string made;
  for (Table const& table : tables_of(done))
    if (!table.rows.empty()) made += markdown(table);
  Problem const& problem = done.problem;
  write_part(page_name(folder, problem.name), "# " + problem.title + "\n\n" + problem.text + "\n\n", made);
}

std::vector<std::string> check_page(Done const& done, fs::path const& folder, bool quick) {
  std::string const file = page_name(folder, done.problem.name), text = content_of(file);
  std::vector<std::string> faults;
  auto const add = [&](std::vector<std::string> const& more) { faults.insert(faults.end(), more.begin(), more.end()); };
  try {
    std::string_view const page = part_of(text);
    if (quick) add(differences(coarse_table(done), page));
    for (Table const& table : tables_of(done)) {
      if (quick) break;
      bool const shown = page.find("## " + table.title + '\n') != page.npos;
      if (table.title == "Cheapest settings")
        add(check_cheapest(done.problem, done.report, page));
      else if (!table.rows.empty() || (shown && table.title != "Other programs"))
        add(differences(table, page));
    }
  } catch (InvalidInput const& fault) {
    faults.push_back(fault.what());
  }
  for (std::string& fault : faults) fault = file + ": " + fault;
  return faults;
}

void write_summary(std::vector<Done> const& all, fs::path const& folder) {
  std::string const file = page_name(folder, summary);
  Table const fresh = summary_table(all);
  Table table = fresh;
  if (auto const text = polybody::detail::content_of(file)) {
    table.rows.clear();
    std::vector<TextRow> const old = rows_of(part_of(*text), summary_title);
    auto const row_of = [&](std::string const& name) {
      return std::find_if(fresh.rows.begin(), fresh.rows.end(), [&](auto const& row) { return row[0].text == name; });
    };
    for (TextRow const& row : old) {  // rows of problems that did not run stay
      std::vector<Cell> cells;
      for (std::string const& cell : row) cells.push_back(Cell::of(cell));
      auto const mine = row_of(row.front());
      table.rows.push_back(mine != fresh.rows.end() ? *mine : cells);
    }
    for (auto const& row : fresh.rows)
      if (std::none_of(old.begin(), old.end(), [&](TextRow const& one) { return one.front() == row[0].text; }))
        table.rows.push_back(row);
  }
  write_part(file, "# Which formulation when\n\n", markdown(table));
}

std::vector<std::string> check_summary(std::vector<Done> const& all, fs::path const& folder) {
  std::string const file = page_name(folder, summary), text = content_of(file);
  std::vector<std::string> faults;
  Table const table = summary_table(all);
  std::vector<TextRow> const rows = rows_of(part_of(text), summary_title);
  for (Done const& done : all) {
    auto const row = std::find_if(rows.begin(), rows.end(),
                                  [&](TextRow const& one) { return one.front() == link_of(done.problem); });
    if (row == rows.end())
      faults.push_back("there is no row \"" + done.problem.title + "\".");
    else
      for (std::string& fault : check_row(*row, done, table)) faults.push_back(std::move(fault));
  }
  for (std::string& fault : faults) fault = file + ": " + fault;
  return faults;
}

}  // namespace atlas
