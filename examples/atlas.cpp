// The atlas: a list of problems under every formulation that applies, compared at equal error. It writes one page per
// problem and a summary into docs/atlas, and reports with pictures into the folder --output.
//   atlas --list
//   atlas --problem robot_arm --output out/atlas
//   atlas --quick --check                         # coarse meshes: reports, and the check of the pages' coarse results
//   atlas --external other_code.csv               # with results of other programs
#include <iostream>

#include <polybody/io/equal_error_page.hpp>
#include <polybody/version.hpp>

#include "atlas/page.hpp"
#include "support/command_line.hpp"

using namespace atlas;
namespace fs = std::filesystem;

namespace {

struct Options {
  std::vector<std::string> problems;
  bool quick = false, check = false, list = false;
  fs::path output = "out/atlas", pages = "docs/atlas", external;
  std::string machine;
};

std::vector<Problem> all_problems() {
  return {robot_arm(),  cantilever(),        princeton_beam(), curved_cantilever(), rotating_cantilever(),
          flying_rod(), spinning_pendulum(), slider_crank(),   four_bar(),          lateral_buckling(),
          chain(),      vehicle_pins(),      vehicle_links()};
}

void print_list(std::vector<Problem> const& problems) {
  for (Problem const& problem : problems)
    std::cout << problem.name << ": " << problem.title << ". Output: " << problem.question.output << ", 0 to "
              << number(problem.question.end_time) << " s.\n";
}

Done run(Problem const& problem, Options const& o, std::vector<ExternalResult> const& external) {
  EqualErrorStudy study({.modes = {1, 2, 4}, .repeats = o.quick ? 1 : 5, .samples = problem.question.samples(o.quick)});
  Formulations formulations(study, problem.question, o.quick);
  problem.add(formulations);
  Done done{problem, formulations.run(), {.machine = o.machine}};
  done.others.runs = runs_of(external, problem, done.report, o.external);
  write_report(done.report, o.output / problem.name,
               {.title = problem.title,
                .command = "atlas --problem " + problem.name + (o.quick ? " --quick" : ""),
                .machine = o.machine,
                .version = std::string(library_version)});
  if (!done.others.runs.empty())
    write_external_page(done.others, problem, done.report, o.output / problem.name / "external.html");
  return done;
}

void print(Done const& done, double cpu, Options const& o) {
  std::cout << "==== " << done.problem.title << " (" << number(cpu, 3) << " s)\n" << done.report;
  for (auto const& row : external_table(done.others, done.report).rows)
    for (std::size_t j = 0; j < row.size(); ++j) std::cout << row[j].text << (j + 1 < row.size() ? ", " : "\n");
  std::cout << "Report: " << (o.output / done.problem.name / "report.html").string() << "\n\n" << std::flush;
}

// Runs the problems. Returns the number of differences between the pages and the results.
std::size_t run_all(std::vector<Problem> const& problems, Options const& o,
                    std::vector<ExternalResult> const& external) {
  std::vector<Done> all;
  std::vector<std::string> faults;
  auto const add = [&](std::vector<std::string> const& more) { faults.insert(faults.end(), more.begin(), more.end()); };
  for (Problem const& problem : problems) {
    std::clock_t const begin = std::clock();
    all.push_back(run(problem, o, external));
    print(all.back(), double(std::clock() - begin) / CLOCKS_PER_SEC, o);
    if (o.check)
      add(check_page(all.back(), o.pages, o.quick));
    else if (!o.quick)
      write_page(all.back(), o.pages);
  }
  if (o.check && !o.quick) add(check_summary(all, o.pages));
  if (!o.check && !o.quick) write_summary(all, o.pages);
  for (std::string const& fault : faults) std::cerr << fault << '\n';
  if (o.check) std::cout << all.size() << " pages checked, " << faults.size() << " differences\n";
  return faults.size();
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  std::vector<Problem> problems = all_problems();
  std::vector<std::string> names;
  for (Problem const& problem : problems) names.push_back(problem.name);
  CommandLine line{"The atlas: problems under every formulation that applies, compared at equal error"};
  line.one_of("--problem", &o.problems, names, "problems to run (default: all)");
  line.flag("--list", &o.list, "print the problems");
  line.flag("--quick", &o.quick, "three coarse meshes and three long steps only; writes no pages");
  line.flag("--check", &o.check, "compare the pages with the results, except times, and write no pages");
  line.option("--output", &o.output, "folder for reports");
  line.option("--pages", &o.pages, "folder of the pages");
  line.option("--external", &o.external, "results of other programs (docs/atlas/external.md)");
  line.option("--machine", &o.machine, "name of this machine; results of other programs on it are ranked");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    std::vector<ExternalResult> external;
    if (!o.external.empty()) external = read_external(o.external, names);
    if (!o.problems.empty())
      std::erase_if(problems, [&](Problem const& problem) {
        return std::find(o.problems.begin(), o.problems.end(), problem.name) == o.problems.end();
      });
    if (o.list) {
      print_list(problems);
      return 0;
    }
    return run_all(problems, o, external) == 0 ? 0 : 1;
  } catch (Error const& e) {
    std::cerr << "atlas: " << e.what() << '\n';
    return 1;
  }
}
