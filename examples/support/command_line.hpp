#pragma once
// Options of an example's command line, by CLI11. They are compiled once for all examples, because the header of CLI11
// takes six times as long to compile as Eigen/Dense.

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
  // Destination of the value of an option; its content is the default. A list has commas between its values.
  using Value = std::variant<double*, int*, std::ptrdiff_t*, std::string*, std::filesystem::path*, std::vector<double>*,
                             std::vector<std::ptrdiff_t>*, std::vector<std::string>*>;

  explicit CommandLine(std::string const& description);
  ~CommandLine();

  void option(std::string const& name, Value value, std::string const& help);
  void positive(std::string const& name, Value value, std::string const& help);
  void not_negative(std::string const& name, Value value, std::string const& help);
  void between(std::string const& name, Value value, double least, double most, std::string const& help);
  // The value, or each value of a list, is one of `all`. `alone`, if it is not empty, is the value of an option that is
  // given without a value.
  void one_of(std::string const& name, Value value, std::vector<std::string> const& all, std::string const& help,
              std::string const& alone = "");
  // A `name` "!--no-…" sets the value to false.
  void flag(std::string const& name, bool* value, std::string const& help);

  // Return value for main after --help or after invalid options, which are reported; empty if the program continues.
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};
