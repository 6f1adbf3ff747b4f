#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

namespace {
// NaN is neither below nor above a bound, so CLI11's ranges let it pass.
std::string finite(std::string const& text) {
  double x = 0.0;
  bool const number = CLI::detail::lexical_cast(text, x);
  return number && !std::isfinite(x) ? "'" + text + "' is not a finite number" : "";
}

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;

CLI::Option* add(CLI::App& app, std::string const& name, CommandLine::Value value, std::string const& help) {
  auto const to_option = [&](auto* to) {
    using T = std::remove_pointer_t<decltype(to)>;
    CLI::Option* const option = app.add_option(name, *to, help);
    bool has_default = true;
    if constexpr (is_list<T>) option->delimiter(',');
    if constexpr (is_list<T> || std::is_same_v<T, std::string>) has_default = !to->empty();
    return has_default ? option->capture_default_str() : option;
  };
  CLI::Option* const option = std::visit(to_option, value);
  if (std::holds_alternative<double*>(value) || std::holds_alternative<std::vector<double>*>(value))
    option->check(CLI::Validator(finite, "", "finite"));
  return option;
}
}  // namespace

CommandLine::CommandLine(std::string const& description) : app_(std::make_unique<CLI::App>(description)) {}
CommandLine::~CommandLine() = default;

void CommandLine::option(std::string const& name, Value value, std::string const& help) {
  add(*app_, name, value, help);
}
void CommandLine::positive(std::string const& name, Value value, std::string const& help) {
  add(*app_, name, value, help)->check(CLI::PositiveNumber);
}
void CommandLine::not_negative(std::string const& name, Value value, std::string const& help) {
  add(*app_, name, value, help)->check(CLI::NonNegativeNumber);
}
void CommandLine::between(std::string const& name, Value value, double least, double most, std::string const& help) {
  add(*app_, name, value, help)->check(CLI::Range(least, most));
}
void CommandLine::one_of(std::string const& name, Value value, std::vector<std::string> const& all,
                         std::string const& help, std::string const& alone) {
  CLI::Option* const option = add(*app_, name, value, help)->check(CLI::IsMember(all));
  if (!alone.empty()) option->expected(0, 1)->default_str(alone);
}
void CommandLine::flag(std::string const& name, bool* value, std::string const& help) {
  // A flag has no value. CLI11 would convert a value of "!--no-…" by std::stoll and not catch std::out_of_range.
  app_->add_flag(name, *value, help)->disable_flag_override();
}

std::optional<int> CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return app_->exit(error);
  }
  return std::nullopt;
}
