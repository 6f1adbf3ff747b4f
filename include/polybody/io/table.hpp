#pragma once
/// \file
/// Table of numbers in memory, and its reader for comma-separated values (RFC 4180).

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <polybody/io/text_files.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

/// Table of numbers: `rows[i][j]` is the number in row i and column `columns[j]`.
struct Table {
  std::vector<std::string> columns;       ///< (m) heads of the columns, with units
  std::vector<std::vector<double>> rows;  ///< (n) rows of m numbers

  /// Returns the n numbers of the column `name`. Throws InvalidInput with a list of the heads unless exactly one
  /// column has this name.
  std::vector<double> column(std::string_view name) const {
    std::string heads;
    std::size_t found = 0, place = 0;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      heads += (j ? ", \"" : "\"") + columns[j] + "\"";
      if (columns[j] == name) ++found, place = j;
    }
    if (found != 1)
      throw InvalidInput(found ? "table.columns" : "table.no_column",
                         {(found ? "duplicate column \"" : "no column \""), ErrorObject{name}, "\"; the table has ",
                          (heads.empty() ? "none" : heads), "."});
    std::vector<double> values;
    for (auto const& row : rows) values.push_back(row.at(place));
    return values;
  }
};

namespace detail {

/// Index of the first character that is not a single quote, if this character is =, +, - or @; otherwise npos.
/// Spreadsheets evaluate a text that begins with one of these four characters as a formula.
inline std::size_t formula_in(std::string_view text) {
  std::size_t const first = text.find_first_not_of('\'');
  bool const is_formula = first != text.npos && std::string_view("=+-@").find(text[first]) != std::string_view::npos;
  return is_formula ? first : text.npos;
}

/// Field of comma-separated values (RFC 4180) for a text that is not a number. A single quote precedes a text that
/// begins with =, +, - or @, because spreadsheets evaluate such texts as formulas.
inline std::string csv_text(std::string const& text) {
  std::string const full = formula_in(text) == text.npos ? text : '\'' + text;
  bool const edge = full.starts_with(' ') || full.ends_with(' ') || full.starts_with("\xEF\xBB\xBF");
  if (!edge && full.find_first_of(",\"\r\n\t") == full.npos) return full;
  std::string quoted = "\"";
  for (char const c : full) quoted.append(c == '"' ? 2u : 1u, c);
  return quoted + '"';
}
/// Text from which `csv_text` has made the `field`.
inline std::string text_of_csv(std::string const& field) {
  std::size_t const place = formula_in(field);
  return place == 0 || place == field.npos ? field : field.substr(1);
}

/// Reader that splits RFC 4180 text into records of fields and counts lines from 1.
struct CsvReader {
  std::string_view text;
  std::string name;  ///< name of the file, for messages
  std::size_t line = 1;

  [[noreturn, gnu::cold]] void fail(std::size_t at, std::string const& what) const {
    throw IoError("file.content", {"file \"", ErrorObject{name}, "\", line ", at, ": ", what});
  }

  /// Returns the next record, which is empty at the end of the text. `at` becomes the line in which the record
  /// begins. Blank lines are skipped, and blanks around a field outside of its quotes.
  std::vector<std::string> record(std::size_t& at) {
    while (!text.empty() && (text.front() == '\n' || text.front() == '\r')) step();
    at = line;
    std::vector<std::string> fields;
    while (!text.empty()) {
      fields.push_back(field());
      if (text.empty()) break;
      bool const more = text.front() == ',';
      bool const pair = step() == '\r' && text.starts_with('\n');
      if (pair) step();
      if (!more) break;
      if (text.empty()) fields.emplace_back();
    }
    return fields;
  }

 private:
  static constexpr std::string_view blanks = " \t";

  char step() {
    char const c = text.front();
    text.remove_prefix(1);
    line += c == '\n' || (c == '\r' && !text.starts_with('\n'));
    return c;
  }

  std::string field() {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) step();
    if (!text.starts_with('"')) {
      std::string_view plain = text.substr(0, text.find_first_of(",\r\n"));
      text.remove_prefix(plain.size());
      auto const last = plain.find_last_not_of(blanks);
      return std::string(plain.substr(0, last == plain.npos ? 0 : last + 1));
    }
    std::size_t const opened = line;
    std::string value;
    for (step(); !text.empty();) {
      char const c = step();
      if (c != '"')
        value += c;
      else if (text.starts_with('"'))
        value += step();
      else {
        while (!text.empty() && blanks.find(text.front()) != blanks.npos) step();
        if (text.find_first_of(",\r\n") != 0 && !text.empty()) fail(line, "text follows a closing quote");
        return value;
      }
    }
    fail(opened, "a quote is never closed");
  }
};

}  // namespace detail

/// Reads a table from `file`, written by `Csv` or another program. Accepts lines that end with LF, CR LF or CR, quoted
/// fields, a byte-order mark, a leading '+' and blank lines. Removes a single quote before =, +, - or @ at the
/// beginning of a head. Throws IoError with the file and, if possible, the line. The reasons are a file that cannot be
/// read or is empty, faulty quotes, rows of different lengths, and fields that are not finite numbers.
inline Table read_csv(std::filesystem::path const& file) {
  std::string const name = file.string();
  errno = 0;
  std::optional<std::string> const text = detail::content_of(file);
  if (!text)
    throw IoError("file.open", {"file \"", ErrorObject{name}, "\" cannot be read",
                                (errno ? ": " + std::generic_category().message(errno) : "")});
  detail::CsvReader reader{*text, name};
  if (reader.text.starts_with("\xEF\xBB\xBF")) reader.text.remove_prefix(3);
  std::size_t line = 1;
  Table table{reader.record(line), {}};
  for (std::string& head : table.columns) head = detail::text_of_csv(head);
  if (table.columns.empty())
    throw IoError("file.content", {"file \"", ErrorObject{name}, "\" is empty, but needs a head line."});
  for (auto fields = reader.record(line); !fields.empty(); fields = reader.record(line)) {
    if (fields.size() != table.columns.size())
      reader.fail(line, "the line has " + std::to_string(fields.size()) + " fields, but the table has " +
                            std::to_string(table.columns.size()) + " columns");
    auto& row = table.rows.emplace_back();
    for (std::size_t j = 0; j < fields.size(); ++j) {
      std::string_view digits = fields[j];
      if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
      double value = 0.0;
      auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
        reader.fail(line, "column \"" + table.columns[j] + "\": \"" + fields[j] +
                              "\" is not a finite number in the range of a double");
      row.push_back(value);
    }
  }
  return table;
}

}  // namespace polybody
