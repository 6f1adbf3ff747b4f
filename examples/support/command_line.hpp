#pragma once
// The options of an example's command line, by CLI11: compiled once for all examples, as its header costs each of them
// six times Eigen/Dense.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
}

class CommandLine {
 public:
  // Where the value of an option goes; what stands there is the default.
  using Value = std::variant<double*, int*, std::ptrdiff_t*, std::string*, std::filesystem::path*>;

  explicit CommandLine(std::string const& description);
  ~CommandLine();

  void option(std::string const& name, Value value, std::string const& help);
  void positive(std::string const& name, Value value, std::string const& help);
  void not_negative(std::string const& name, Value value, std::string const& help);
  void between(std::string const& name, Value value, double least, double most, std::string const& help);
  // `alone`, where it is not empty, is the value of an option that stands without one.
  void one_of(std::string const& name, std::string* value, std::vector<std::string> const& all, std::string const& help,
              std::string const& alone = "");
  // "!--no-…" sets it to false.
  void flag(std::string const& name, bool* value, std::string const& help);

  // What main is to return at once: after --help, or for options that cannot be meant, which it says.
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};
