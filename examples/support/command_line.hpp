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
  // Destination of the value of an option; its content is the default.
  using Value = std::variant<double*, int*, std::ptrdiff_t*, std::string*, std::filesystem::path*>;

  explicit CommandLine(std::string const& description);
  ~CommandLine();

  void option(std::string const& name, Value value, std::string const& help);
  void positive(std::string const& name, Value value, std::string const& help);
  void not_negative(std::string const& name, Value value, std::string const& help);
  void between(std::string const& name, Value value, double least, double most, std::string const& help);
  // `alone`, if it is not empty, is the value of an option that is given without a value.
  void one_of(std::string const& name, std::string* value, std::vector<std::string> const& all, std::string const& help,
              std::string const& alone = "");
  // "!--no-…" sets it to false.
  void flag(std::string const& name, bool* value, std::string const& help);

  // Return value for main after --help or after invalid options, which are reported; empty if the program continues.
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};
