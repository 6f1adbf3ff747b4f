#pragma once
/// \file
/// Page, tables and text of a comparison at equal error, written to files. The page is one HTML file that needs no
/// network.

#include <sstream>

#include <polybody/io/csv.hpp>
#include <polybody/io/equal_error_sections.hpp>

namespace polybody {

namespace detail {

/// Rows of comma-separated values for all complete runs. A number that is not known is an empty field.
template <class = void>  // compiled where it is used
std::string runs_table(EqualErrorReport const& r) {
  std::string const unit = r.unit().empty() ? "" : ' ' + r.unit();
  std::string out =
      "formulation,physical model,body,policy,integrator,mesh,kind of mesh,step,kind of step,"
      "CPU time [s],least CPU time [s],largest CPU time [s],timed runs," +
      csv_text("error" + unit) +
      ",error / span [1],unknowns,steps,Newton iterations,factorisations,on the Pareto front\n";
  for (StudiedFormulation const& f : r.formulations)
    for (StudyRun const& run : f.runs) {
      if (!run.failure.empty()) continue;
      auto const text = [&](std::string const& content) { out += csv_text(content) + ','; };
      auto const value = [&](double x, bool known = true) {
        if (known && std::isfinite(x)) append_digits(out, x);
        out += ',';
      };
      for (std::string const& word : {f.name, f.model, f.family, f.policy, f.integrator}) text(word);
      value(double(run.mesh), !f.mesh_name.empty());
      text(f.mesh_name);
      value(run.step);
      text(f.step_name);
      value(run.cpu);
      value(run.least_cpu, run.timings > 0);
      value(run.most_cpu, run.timings > 0);
      value(run.timings);
      value(run.error);
      value(run.error / r.span);
      for (long const n : {long(run.unknowns), run.steps, run.iterations, run.factorisations}) value(double(n));
      out += run.on_front ? "1\n" : "0\n";
    }
  return out;
}

/// Text of a report as a Markdown page with a code block.
template <class = void>
std::string report_text(EqualErrorReport const& r, PageOptions const& options) {
  std::ostringstream text;
  text << r;
  std::size_t most = 2, ticks = 0;
  for (char const c : text.str()) {
    ticks = c == '`' ? ticks + 1 : 0;
    most = std::max(most, ticks);
  }
  std::string const fence(most + 1, '`');
  std::string title = options.title;
  std::replace(title.begin(), title.end(), '\n', ' ');
  std::string out = "# " + title + "\n\n" + fence + "text\n" + text.str() + fence + "\n\n";
  if (!options.command.empty()) out += "Command: " + options.command + "\n\n";
  out += "Compiler: " + compiler_text() + "\n\n";
  if (!options.machine.empty()) out += "Machine: " + options.machine + "\n\n";
  return out + "Date: " + options.date + "\n";
}

}  // namespace detail

/// Writes a report as one HTML file that needs no network: rankings, work-precision curves, convergence, differences of
/// the physical models, and histories. The page shows the film `options.film`, which remains a separate file. The page
/// appears when it is complete.
/// \throws InvalidInput for a report that `EqualErrorStudy::run` cannot have returned.
/// \throws IoError if the film does not exist, or if the file cannot be written.
template <class = void>
void write_page(EqualErrorReport const& r, std::filesystem::path const& file, PageOptions const& options = {}) {
  detail::check(r);
  std::error_code ignored;
  if (!options.film.empty() && !std::filesystem::exists(options.film, ignored))
    throw IoError("equal_error.film", {"file \"", ErrorObject{file.string()}, "\": the film \"", options.film.string(),
                                       "\" does not exist. Call `Film::write` before."});
  PageOptions dated = options;
  if (dated.date.empty()) dated.date = detail::utc_now();
  std::string const text = detail::EqualErrorPage(r, std::move(dated), file).html();
  AtomicFile out(file);
  out.write(text);
  out.close();
}

/// Writes the complete runs of a report to `file`, one row per run, as comma-separated values.
/// \throws InvalidInput for a report that `EqualErrorStudy::run` cannot have returned; IoError if the file cannot be
/// written.
template <class = void>
void write_csv(EqualErrorReport const& r, std::filesystem::path const& file) {
  detail::check(r);
  AtomicFile out(file);
  out.write(detail::runs_table(r));
  out.close();
}

/// Writes the references of the physical models to `file`, one column per model: "t [s]", "reference of <model>
/// [unit]", ….
/// \throws InvalidInput for a report that `EqualErrorStudy::run` cannot have returned; IoError if the file cannot be
/// written.
template <class = void>
void write_histories(EqualErrorReport const& r, std::filesystem::path const& file) {
  detail::check(r);
  std::vector<std::string> heads{"t [s]"};
  for (ModelReference const& reference : r.references)
    heads.push_back("reference of " + reference.model + (r.unit().empty() ? "" : ' ' + r.unit()));
  Csv csv(file, std::move(heads), Csv::Keeps::full_table);
  std::vector<double> row(r.references.size() + 1);
  for (std::size_t k = 0; k < r.times.size(); ++k) {
    row[0] = r.times[k];
    for (std::size_t i = 0; i < r.references.size(); ++i) row[i + 1] = r.reference(i)[k];
    csv.row(row);
  }
  csv.close();
}

/// Writes a report to `folder`:
///   report.html    page of `write_page`
///   runs.csv       all complete runs
///   histories.csv  times, and references of the physical models
///   report.md      text of operator<<, command, compiler, machine and date
/// Returns the files.
/// \throws InvalidInput for a report that `EqualErrorStudy::run` cannot have returned.
/// \throws IoError if the film does not exist, or if a file cannot be written.
template <class = void>
std::vector<std::filesystem::path> write_report(EqualErrorReport const& r, std::filesystem::path const& folder,
                                                PageOptions options = {}) {
  if (options.date.empty()) options.date = detail::utc_now();
  std::vector<std::filesystem::path> const files{folder / "report.html", folder / "runs.csv", folder / "histories.csv",
                                                 folder / "report.md"};
  options.files.insert(options.files.end(), files.begin() + 1, files.end());
  write_page(r, files[0], options);
  write_csv(r, files[1]);
  write_histories(r, files[2]);
  AtomicFile text(files[3]);
  text.write(detail::report_text(r, options));
  text.close();
  return files;
}

}  // namespace polybody
