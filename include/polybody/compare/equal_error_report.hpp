#pragma once
/// \file
/// Results of a comparison at equal error: runs of each formulation over mesh and step, references of the physical
/// models, and the cheapest setting for each wanted error.
/// Theory: Eq. 11.33.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// One run of a formulation with one mesh and one step.
struct StudyRun {
  Index mesh = 0;                   ///< number of elements, or of modes; 0 for a body without mesh
  double step = 0.0;                ///< step [s], or relative tolerance of an integrator with step size control
  double cpu = 0.0;                 ///< CPU time of the steps [s]; median of the timed runs if there are any
  double least_cpu = 0.0;           ///< least CPU time of the timed runs [s]
  double most_cpu = 0.0;            ///< largest CPU time of the timed runs [s]
  int timings = 0;                  ///< number of timed runs
  Index unknowns = 0;               ///< velocities and multipliers of the integrator
  long steps = 0;                   ///< number of steps
  long iterations = 0;              ///< number of Newton iterations
  long factorisations = 0;          ///< number of factorisations
  std::vector<double> y = {};       ///< output at `times` of the report [unit of the output]; empty for a failed run
  std::vector<double> energy = {};  ///< total energy at `times` [J]; only for the finest mesh and the shortest step
  /// Change of y by interpolation through every second state [unit of the output]; 0 except for the finest mesh and
  /// the shortest step.
  double interpolation_error = 0.0;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< discretisation error [unit of the output]
  bool on_front = false;     ///< true for a run on the Pareto front of error and CPU time of the study
  std::string failure = {};  ///< message of a failed run
};

/// Runs and converged result of one formulation.
struct StudiedFormulation {
  std::string name;            ///< name of the formulation
  std::string model;           ///< physical model that the formulation discretises
  std::string integrator;      ///< name of the integrator
  std::string policy;          ///< name of the policy
  std::string family;          ///< family of the body, see bodies/shared/family.hpp
  std::string mesh_name;       ///< "elements", "modes", or empty for a body without mesh
  std::string step_name;       ///< "step [s]" or "tolerance"
  std::vector<StudyRun> runs;  ///< all combinations: for each mesh, from coarse to fine, all steps from long to short
  std::vector<double> limit;   ///< output for h → 0 and n → ∞ at `times` [unit of the output]; empty if unknown
  double limit_error = std::numeric_limits<double>::quiet_NaN();  ///< error bound of `limit` [unit of the output]
  double mesh_order = std::numeric_limits<double>::quiet_NaN();   ///< observed order of the three finest meshes [1]
  double step_order = std::numeric_limits<double>::quiet_NaN();   ///< observed order of the three shortest steps [1]
  /// Largest change of the output after a perturbation of the initial coordinates by one unit in the last place, with
  /// the finest mesh and the shortest step [unit of the output].
  double spread = 0.0;
  std::vector<std::string> remarks = {};  ///< reasons for missing results, and other findings

  /// Run with the finest mesh and the shortest step.
  StudyRun const& finest() const { return runs.back(); }
};

/// Converged result of one physical model.
struct ModelReference {
  std::string model;          ///< name of the physical model
  std::size_t formulation{};  ///< index of the formulation whose limit has the smallest error bound
  double error = 0.0;         ///< error bound of the reference [unit of the output]
};

/// Largest difference over time between the references of two physical models.
struct ModelDifference {
  std::size_t a{}, b{};     ///< indices of the references
  double difference = 0.0;  ///< largest difference [unit of the output]
  double error = 0.0;       ///< sum of the error bounds and spreads of both references [unit of the output]
  /// True if the difference exceeds its error bound.
  bool resolved() const { return difference > error; }
};

/// Cheapest run of one formulation whose error is at most the wanted error.
struct CheapestRun {
  std::size_t formulation{};  ///< index of the formulation
  std::size_t run{};          ///< index of its run
  /** True for the same run. */ bool operator==(CheapestRun const&) const = default;
};
/// Formulation without a rank.
struct UnrankedFormulation {
  std::size_t formulation{};  ///< index of the formulation
  std::string reason;         ///< reason, without a full stop
};
/// Formulations that reach a wanted error, by ascending CPU time.
struct Ranking {
  double wanted = 0.0;                            ///< wanted error, relative to the span of the output
  std::vector<CheapestRun> ranked = {};           ///< cheapest run of each formulation, cheapest first
  std::vector<UnrankedFormulation> missing = {};  ///< the other formulations
};

/// Result of `EqualErrorStudy::run`.
struct EqualErrorReport {
  std::string output;         ///< name of the output with unit
  std::vector<double> times;  ///< (n) times of the samples [s]
  /// Span: largest minus smallest value of the output of a formulation, maximum over formulations [unit of the output].
  double span = 0.0;
  std::vector<StudiedFormulation> formulations;  ///< in the order of `add`
  std::vector<ModelReference> references;        ///< one for each physical model with a converged formulation
  std::vector<ModelDifference> differences;      ///< one for each pair of references
  std::vector<Ranking> rankings;                 ///< one for each wanted error

  /// Reference of physical model k at `times`.
  std::vector<double> const& reference(std::size_t k) const { return formulations[references[k].formulation].limit; }
  /// Unit of the output with its brackets, such as "[m]"; empty if its name has no unit.
  std::string unit() const {
    std::size_t const at = output.rfind(" [");
    return at == std::string::npos ? std::string() : output.substr(at + 1);
  }
  /// Text of x with its unit, such as "0.3 m". \param x value [unit of the output] \param digits significant digits
  std::string with_unit(double x, int digits = 3) const {
    std::string const brackets = unit();
    return number(x, digits) + (brackets.size() > 2 ? ' ' + brackets.substr(1, brackets.size() - 2) : std::string());
  }
};

/// Largest difference of two histories with the same times. \param a first history \param b second history
inline double largest_difference(std::vector<double> const& a, std::vector<double> const& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

namespace detail {

/// Mesh and step of a run as text, such as "20 elements, h = 0.0025 s".
template <class = void>
std::string setting_of(StudiedFormulation const& f, StudyRun const& run) {
  std::string const mesh = f.mesh_name.empty() ? "" : std::to_string(run.mesh) + ' ' + f.mesh_name + ", ";
  return mesh + (f.step_name == "tolerance" ? "tolerance " : "h = ") + number(run.step, 4) +
         (f.step_name == "tolerance" ? "" : " s");
}
/// Observed order between two errors with the sizes fine < coarse of mesh width or step; NaN if an error is zero.
inline double order_between(double coarse_error, double fine_error, double coarse, double fine) {
  return coarse_error > 0.0 && fine_error > 0.0 ? std::log(coarse_error / fine_error) / std::log(coarse / fine)
                                                : std::numeric_limits<double>::quiet_NaN();
}
/// Text of x in a cell, "-" if x is not finite.
inline std::string cell(double x, int digits = 3) { return std::isfinite(x) ? number(x, digits) : "-"; }

/// Unit of the output after a space, such as " [m]"; empty if the output has no unit.
template <class = void>
std::string unit_in_head(EqualErrorReport const& r) {
  return r.unit().empty() ? std::string() : ' ' + r.unit();
}

/// Prints rows of cells in aligned columns: the first one to the left, the others to the right.
template <class = void>
void print_rows(std::ostream& out, std::vector<std::vector<std::string>> const& rows) {
  std::vector<std::size_t> wide;
  auto const width = [](std::string const& text) {  // number of characters in UTF-8
    return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  };
  for (auto const& row : rows)
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (wide.size() <= j) wide.push_back(0);
      wide[j] = std::max(wide[j], width(row[j]));
    }
  for (auto const& row : rows) {
    std::string line = "  ";
    for (std::size_t j = 0; j < row.size(); ++j) {
      std::string const space(wide[j] - width(row[j]), ' ');
      line += j == 0 ? row[j] + space : "  " + space + row[j];
    }
    out << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }
}

template <class = void>
void print_rankings(std::ostream& out, EqualErrorReport const& r) {
  for (Ranking const& ranking : r.rankings) {
    out << "\nError of at most " << number(ranking.wanted, 3) << " of the span, "
        << r.with_unit(ranking.wanted * r.span) << ":\n";
    std::vector<std::vector<std::string>> rows{{"formulation", "mesh, step", "CPU [s]", "least", "most", "ratio",
                                                "error", "unknowns", "iterations", "factorisations"}};
    for (CheapestRun const& at : ranking.ranked) {
      StudiedFormulation const& f = r.formulations[at.formulation];
      StudyRun const& run = f.runs[at.run];
      CheapestRun const& best = ranking.ranked.front();
      rows.push_back({f.name, setting_of(f, run), cell(run.cpu), cell(run.least_cpu), cell(run.most_cpu),
                      cell(run.cpu / std::max(r.formulations[best.formulation].runs[best.run].cpu, 1e-9)),
                      cell(run.error), std::to_string(run.unknowns), std::to_string(run.iterations),
                      std::to_string(run.factorisations)});
    }
    if (rows.size() > 1) print_rows(out, rows);
    for (UnrankedFormulation const& other : ranking.missing)
      out << "  " << r.formulations[other.formulation].name << ": " << other.reason << '\n';
  }
}

template <class = void>
void print_meshes(std::ostream& out, EqualErrorReport const& r) {
  out << "\nDiscretisation error with the shortest step, compared with the reference of the same physical model"
      << unit_in_head(r) << ":\n";
  std::vector<std::vector<std::string>> rows{{"formulation", "mesh", "error", "order"}};
  for (StudiedFormulation const& f : r.formulations) {
    if (f.mesh_name.empty()) continue;
    StudyRun const* coarser = nullptr;
    for (StudyRun const& run : f.runs) {
      if (run.step != f.runs.back().step) continue;
      double const order =
          coarser ? order_between(coarser->error, run.error, 1.0 / double(coarser->mesh), 1.0 / double(run.mesh))
                  : std::numeric_limits<double>::quiet_NaN();
      rows.push_back({f.name, std::to_string(run.mesh) + ' ' + f.mesh_name, cell(run.error), cell(order, 2)});
      coarser = &run;
    }
  }
  print_rows(out, rows);
}

}  // namespace detail

/// Prints the ranking for each wanted error, the discretisation errors by mesh, and the differences between the
/// physical models. A difference below its error bound is printed as "not resolved".
template <class = void>  // compiled where it is used
std::ostream& operator<<(std::ostream& out, EqualErrorReport const& r) {
  out << "Comparison at equal error.";
  if (!r.output.empty()) out << " Output: " << r.output << ", span " << r.with_unit(r.span, 4) << '.';
  out << '\n';
  if (r.rankings.empty()) out << "\nNo run with the finest mesh and the shortest step is complete.\n";
  detail::print_rankings(out, r);
  detail::print_meshes(out, r);
  out << "\nReferences of the physical models" << detail::unit_in_head(r) << ":\n";
  std::vector<std::vector<std::string>> rows{{"physical model", "formulation", "error bound"}};
  for (ModelReference const& reference : r.references)
    rows.push_back({reference.model, r.formulations[reference.formulation].name, detail::cell(reference.error)});
  detail::print_rows(out, rows);
  if (!r.differences.empty()) out << "\nDifferences between the physical models" << detail::unit_in_head(r) << ":\n";
  rows = {{"first", "second", "difference", "error bound"}};
  for (ModelDifference const& d : r.differences)
    rows.push_back({r.references[d.a].model, r.references[d.b].model,
                    d.resolved() ? detail::cell(d.difference) : "not resolved", detail::cell(d.error)});
  if (rows.size() > 1) detail::print_rows(out, rows);
  for (StudiedFormulation const& f : r.formulations)
    for (std::string const& remark : f.remarks) out << f.name << ": " << remark << '\n';
  return out;
}

}  // namespace polybody
