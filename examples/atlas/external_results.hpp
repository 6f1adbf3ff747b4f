#pragma once
// Results of other programs for problems of the atlas, from a file of comma-separated values (docs/atlas/external.md).
#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include <polybody/io/table.hpp>
#include <polybody/math/types.hpp>

namespace atlas {

// One result. It has either an error or a history.
struct ExternalResult {
  polybody::Required<std::string> name, version;  // of the program
  polybody::Required<std::string> problem;        // name of a problem of the atlas
  polybody::Required<std::string> setting;        // such as "20 elements, h = 1e-3 s"
  std::string model = {};                         // physical model of the reference for the history
  std::optional<double> error = {};               // relative to the span of the output
  std::string history = {};                       // file with times [s] and values of the output
  std::optional<double> time = {};                // processor time [s]
  std::string machine = {};                       // on which the time was measured
  std::size_t line = 0;                           // of the file

  std::string title() const { return name.value + ' ' + version.value; }
};

inline std::vector<std::string> const external_columns{"name",  "version", "problem", "setting", "model",
                                                       "error", "history", "time",    "machine"};

namespace external {

// A record of the file, by the names of its columns.
struct Record {
  polybody::detail::CsvReader const& reader;
  std::vector<std::string> const& heads;
  std::vector<std::string> fields;
  std::size_t line;

  std::string optional(std::string const& column) const {
    std::string const& text = fields[std::size_t(std::find(heads.begin(), heads.end(), column) - heads.begin())];
    if (text.find_first_of("|\r\n") != text.npos)
      reader.fail(line, "column \"" + column + "\": the text contains \"|\" or a line break");
    return text;
  }
  std::string required(std::string const& column) const {
    std::string const text = optional(column);
    if (text.empty()) reader.fail(line, "column \"" + column + "\": a value is required");
    return text;
  }
  // A number that is at least zero; positive if `positive`.
  std::optional<double> number(std::string const& column, bool positive) const {
    std::string const text = optional(column);
    if (text.empty()) return std::nullopt;
    double value = 0.0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool const read = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
    if (!read || value < 0.0 || (positive && value == 0.0))
      reader.fail(line, "column \"" + column + "\": \"" + text + "\" is not a " +
                            (positive ? "positive finite number" : "finite number of at least 0"));
    return value;
  }
};

inline ExternalResult result_of(Record const& of, std::vector<std::string> const& problems) {
  ExternalResult out{.name = of.required("name"),
                     .version = of.required("version"),
                     .problem = of.required("problem"),
                     .setting = of.required("setting"),
                     .model = of.optional("model"),
                     .error = of.number("error", false),
                     .history = of.optional("history"),
                     .time = of.number("time", true),
                     .machine = of.optional("machine"),
                     .line = of.line};
  if (std::find(problems.begin(), problems.end(), out.problem.value) == problems.end())
    of.reader.fail(of.line,
                   "the atlas has no problem \"" + out.problem.value + "\"; `atlas --list` prints the problems");
  if (out.error.has_value() == !out.history.empty())
    of.reader.fail(of.line, "exactly one of the columns \"error\" and \"history\" needs a value");
  if (!out.history.empty() && out.model.empty())
    of.reader.fail(of.line, "a history needs the physical model of its reference in the column \"model\"");
  if (out.time && out.machine.empty())
    of.reader.fail(of.line, "a time needs the machine on which it was measured in the column \"machine\"");
  return out;
}

inline void check_heads(polybody::detail::CsvReader const& reader, std::vector<std::string> const& heads,
                        std::size_t line) {
  for (std::string const& column : external_columns)
    if (std::count(heads.begin(), heads.end(), column) != 1)
      reader.fail(line, "the head line needs the column \"" + column + "\" once");
  if (heads.size() != external_columns.size())
    reader.fail(line, "the head line has " + std::to_string(heads.size()) + " columns, but " +
                          std::to_string(external_columns.size()) + " are known");
}

}  // namespace external

// Reads the results in `file`. `problems` are the names that the column "problem" permits. Throws IoError with the file
// and, if possible, the line and the column.
inline std::vector<ExternalResult> read_external(std::filesystem::path const& file,
                                                 std::vector<std::string> const& problems) {
  std::string const name = file.string();
  std::optional<std::string> const text = polybody::detail::content_of(file);
  if (!text) throw polybody::IoError("file.open", {"file \"", polybody::ErrorObject{name}, "\" cannot be read."});
  polybody::detail::CsvReader reader{*text, name};
  if (reader.text.starts_with("\xEF\xBB\xBF")) reader.text.remove_prefix(3);
  std::size_t line = 1;
  std::vector<std::string> const heads = reader.record(line);
  external::check_heads(reader, heads, line);
  std::vector<ExternalResult> all;
  for (auto fields = reader.record(line); !fields.empty(); fields = reader.record(line)) {
    if (fields.size() != heads.size())
      reader.fail(line, "the line has " + std::to_string(fields.size()) + " fields, but the head line has " +
                            std::to_string(heads.size()));
    all.push_back(external::result_of({reader, heads, std::move(fields), line}, problems));
  }
  return all;
}

}  // namespace atlas
