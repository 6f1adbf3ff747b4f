#pragma once
/// \file
/// Tables of numbers as comma-separated values (RFC 4180); reading them back: table.hpp.

#include <cmath>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/digits.hpp>
#include <polybody/io/table.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

/// Writes a table, one head line and then rows of numbers in the shortest form that reads back to
/// the same double. A text that begins with =, +, - or @ gets a single quote before it, so that a spreadsheet does not
/// evaluate it. The file appears under its name on `close()` (see AtomicFile), and where an
/// exception ends the loop that writes it: with the rows so far, if there are any. Move-only.
class Csv {
 public:
  /// What an exception leaves: rows of a run are of use without those to come, half a table is not.
  enum class Keeps { rows, whole_table };

  /// `columns`: the heads, with their units ("t [s]"); not empty and all different, else
  /// InvalidInput. Creates the parent folders; throws IoError if the file cannot be made.
  Csv(std::filesystem::path const& file, std::vector<std::string> columns, Keeps keeps = Keeps::rows)
      : columns_(std::move(columns)), file_((check_heads(file, columns_), file)), keeps_(keeps) {
    for (auto const& head : columns_) (line_ += detail::csv_text(head)) += ',';
    line_.back() = '\n';
    file_.write(line_);
  }

  /// Adds one row, `values`, a number for each column. Throws InvalidInput, and writes nothing, if the count differs or
  /// a number is not finite; IoError if the system refuses the bytes.
  void row(std::span<double const> values) {
    line_.clear();
    write_row(values, 0);
  }

  /// The same with a text before the `values`, in the first column: `row("mass [kg]", numbers)`. `read_csv` reads
  /// numbers only and refuses such a table.
  void row(std::string_view text, std::span<double const> values) {
    line_ = detail::csv_text(std::string(text)) + ',';
    write_row(values, 1);
  }

  /// The same for `values` in braces, `row({t, x, y})`.
  void row(std::initializer_list<double> values) { row(std::span<double const>(values.begin(), values.size())); }

  /// The same for `values` one by one, `row(t, x, y)`.
  template <std::convertible_to<double>... Numbers>
  void row(Numbers const&... values) {
    row({static_cast<double>(values)...});
  }

  /// Completes the file and puts it in place; a second call does nothing. Throws IoError.
  void close() { file_.close(); }

  std::size_t rows() const noexcept { return rows_; }  ///< Rows written so far, without the head.

 private:
  static void check_heads(std::filesystem::path const& file, std::vector<std::string> const& columns) {
    if (columns.empty()) throw InvalidInput{"file '", file.string(), "': a table needs at least one column"};
    std::set<std::string_view> seen;
    for (auto const& head : columns) {
      if (head.empty()) throw InvalidInput{"file '", file.string(), "': a column head is empty"};
      if (!seen.insert(head).second)
        throw InvalidInput{"file '", file.string(), "': two columns are called '", head, "'"};
    }
  }

  /// Completes `line_`, which holds the texts of the first `texts` columns.
  void write_row(std::span<double const> values, std::size_t texts) {
    auto const where = [&] { return "file '" + file_.name() + "', row " + std::to_string(rows_ + 1); };
    if (values.size() + texts != columns_.size())
      throw InvalidInput{where(), ": ", values.size() + texts, " values for ", columns_.size(), " columns"};
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]))
        throw InvalidInput{where(), ", column '", columns_[i + texts], "': the value is not finite (", values[i], ")"};
      detail::append_digits(line_, values[i]);
      line_ += ',';
    }
    line_.back() = '\n';
    file_.write(line_);
    if (rows_++ == 0 && keeps_ == Keeps::rows) file_.keep_on_exception();
  }

  std::vector<std::string> columns_;
  AtomicFile file_;
  Keeps keeps_;
  std::string line_;
  std::size_t rows_ = 0;
};

}  // namespace polybody
