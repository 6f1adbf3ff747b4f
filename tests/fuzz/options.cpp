// Options of the examples: one option of each kind and type. The input contains one argument per line. Accepted
// values are finite and within their bounds. Other values cause a message on a stream and an exit code.
// with: examples/support/command_line.cpp
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <sstream>

#include "fuzz/target.hpp"
#include "support/command_line.hpp"

namespace polybody::fuzz {

struct Options {
  double end_time = 1.0, step = 1e-3, ramp = 0.0, rho = 0.5, moment = 1.0;
  std::ptrdiff_t elements = 8, modes = 16;
  int cut = 0;
  std::string body = "lrvf", figure, files = "files";
  std::filesystem::path out = "out";
  bool compare = false, watched = true;
};

std::optional<int> parse(Options& o, std::vector<std::string>& arguments) {
  CommandLine line{"A program."};
  line.one_of("--body", &o.body, {"lrvf", "ancf", "ancf-engineering"}, "body");
  line.positive("--elements", &o.elements, "elements");
  line.not_negative("--modes", &o.modes, "modes");
  line.positive("--step", &o.step, "time step [s]");
  line.positive("--until", &o.end_time, "end of the run [s]");
  line.not_negative("--ramp", &o.ramp, "end of the ramp [s]");
  line.between("--rho", &o.rho, 0.0, 1.0, "spectral radius");
  line.between("--cut", &o.cut, 0, 63, "pin");
  line.option("--moment", &o.moment, "moment [N m]");
  line.option("--figure", &o.figure, "figure");
  line.option("--files", &o.files, "files");
  line.option("--out", &o.out, "folder");
  line.flag("--compare", &o.compare, "all");
  line.flag("!--unwatched", &o.watched, "unwatched");
  std::vector<char*> argv;
  for (std::string& word : arguments) argv.push_back(word.data());
  argv.push_back(nullptr);
  return line.parse(int(arguments.size()), argv.data());
}

void check(Options const& o) {
  std::vector<std::string> const bodies{"lrvf", "ancf", "ancf-engineering"};
  require(std::find(bodies.begin(), bodies.end(), o.body) != bodies.end(), "--body is one of its names");
  require(o.elements > 0 && o.modes >= 0, "counts keep to their bounds");
  require(o.step > 0.0 && std::isfinite(o.step), "--step is positive and finite");
  require(o.end_time > 0.0 && std::isfinite(o.end_time), "--until is positive and finite");
  require(o.ramp >= 0.0 && std::isfinite(o.ramp), "--ramp is not negative and finite");
  require(o.rho >= 0.0 && o.rho <= 1.0, "--rho is between 0 and 1");
  require(o.cut >= 0 && o.cut <= 63, "--cut is between 0 and 63");
  require(std::isfinite(o.moment), "--moment is finite");
}

/// Captures the output of the parser, which otherwise goes to the streams of the program.
struct Streams {
  std::ostringstream out, err;
  std::streambuf *const cout = std::cout.rdbuf(out.rdbuf()), *const cerr = std::cerr.rdbuf(err.rdbuf());
  ~Streams() { std::cout.rdbuf(cout), std::cerr.rdbuf(cerr); }
};

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::vector<std::string> arguments{"program"};
  std::istringstream lines{std::string(text_of(data, size))};
  for (std::string line; std::getline(lines, line);) arguments.push_back(line);
  Options options;
  Streams streams;
  auto const code = parse(options, arguments);
  if (!code) check(options);
  if (code && *code == 0) require(!streams.out.str().empty(), "help is printed");
  if (code && *code != 0) require(!streams.err.str().empty(), "what cannot be meant is told");
  return 0;
}
