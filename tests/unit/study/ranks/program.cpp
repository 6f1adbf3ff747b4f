// A study over MPI ranks, which run.py starts, kills and compares:
//   study_ranks FOLDER [--threads N] [--pause MS] [--alone] [--limit S] [--fail KIND]
// Writes FOLDER/a.csv. In addition to the record it writes a line "point rank" to FOLDER/calls for each call of the
// point's function.
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>

#include <polybody/study/mpi.hpp>
#include <polybody/study/report.hpp>
#include <polybody/study/sampling.hpp>

using namespace polybody;

namespace {

struct Options {
  std::string folder, fail;
  int threads = 1, pause = 0;
  bool alone = false;  // without MPI
  double limit = 0.0;  // time limit per point [s]
};

/// Numbers with many digits; one point of seven fails.
std::array<double, 2> values_at(Options const& o, int rank, Point const& p) {
  std::string const call =
      std::to_string(p.index()) + ' ' + std::to_string(rank) + ' ' + std::to_string(::getpid()) + '\n';
  std::FILE* const calls = std::fopen((o.folder + "/calls").c_str(), "a");
  if (!calls) throw std::runtime_error("calls cannot be written");
  std::fwrite(call.data(), 1, call.size(), calls);  // written in one piece
  std::fclose(calls);
  if (o.pause > 0) std::this_thread::sleep_for(std::chrono::milliseconds(o.pause));
  if (p.index() == 20 && o.fail == "misuse") p["no such column"];
  if ((p.index() == 5 || p.index() == 40) && o.fail == "hangs") ::pause();
  if (rank > 0 && o.fail == "worker") throw std::runtime_error("a worker's own error");
  if (rank == 0 && o.fail == "first") throw std::runtime_error("the first rank's own error");
  if (p.index() % 7 == 3) throw Diverged{"x ", p["x"], "\nis off"};
  return {std::sin(p["x"]) * std::exp(p["y"]), double(rank)};
}

int run(Options const& o, MpiRanks const* ranks) {
  int const rank = ranks ? ranks->rank() : 0;
  try {
    bool const differs = o.fail == "differs" && rank > 0;
    Study const study({o.folder + "/a.study", differs ? "something else" : "a product"},
                      grid(latin_hypercube(20, 5, {normal("x", "m", 1.0, 0.5), uniform("y", "", 0.0, 1.0)}),
                           formulations("body", {"rigid", "flexible", "none"})),
                      outputs("product [m]", measured("rank")));
    auto const f = [&](Point const& p) { return values_at(o, rank, p); };
    StudyOptions const options{.threads = o.threads, .time_limit = o.limit};
    StudyResults const found = ranks ? run_over_ranks(*ranks, study, f, options) : study.run(f, options);
    if (!found.complete()) throw Error{"rank ", rank, " has not all points"};
    write_table(found, o.folder + (rank == 0 ? "/a.csv" : "/a" + std::to_string(rank) + ".csv"));
  } catch (std::exception const& error) {
    std::fprintf(stderr, "rank %d: %s\n", rank, error.what());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    auto const is = [&](char const* name) { return std::strcmp(argv[i], name) == 0 && i + 1 < argc; };
    if (is("--threads"))
      o.threads = std::atoi(argv[++i]);
    else if (is("--pause"))
      o.pause = std::atoi(argv[++i]);
    else if (is("--limit"))
      o.limit = std::atof(argv[++i]);
    else if (is("--fail"))
      o.fail = argv[++i];
    else if (std::strcmp(argv[i], "--alone") == 0)
      o.alone = true;
    else
      o.folder = argv[i];
  }
  if (o.alone) return run(o, nullptr);
  MpiRanks const ranks(argc, argv);
  return run(o, &ranks);
}
