#pragma once
/// \file
/// Writer of tables as comma-separated values (RFC 4180). table.hpp reads them.

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
#include <polybody/io/table.hpp>
#include <polybody/io/text_files.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

/// Writer of a table: a head line, then rows of numbers in the shortest form that reads back to the same double. A
/// single quote precedes a text that begins with =, +, - or @, so that a spreadsheet does not evaluate it. The file
/// appears under its name on `close()` (see AtomicFile). If an exception interrupts the writing, `Keeps` determines
/// whether a file with the rows written so far appears. Move-only.
class Csv {
 public:
  /// Result if an exception interrupts the writing. `rows`: a file with the rows written so far, if there are any.
  /// `full_table`: no file.
  enum class Keeps { rows, full_table };

  /// Creates `file` with its parent folders and writes the heads `columns`, with their units ("t [s]").
  /// \throws InvalidInput if there is no head, or a head is empty or occurs twice
  /// \throws IoError if the file cannot be created.
  Csv(std::filesystem::path const& file, std::vector<std::string> columns, Keeps keeps = Keeps::rows)
      : columns_(std::move(columns)), file_((check_heads(file, columns_), file)), keeps_(keeps) {
    for (auto const& head : columns_) (line_ += detail::csv_text(head)) += ',';
    line_.back() = '\n';
    file_.write(line_);
  }

  /// Adds one row of `values`, a number for each column. Throws InvalidInput, and writes nothing, if the number of
  /// values differs from the number of columns or a value is not finite. Throws IoError if the row cannot be written.
  void row(std::span<double const> values) {
    line_.clear();
    write_row(values, 0);
  }

  /// Adds one row with a `text` in the first column, followed by `values`: `row("mass [kg]", numbers)`. `read_csv`
  /// reads only numbers and refuses such a table.
  void row(std::string_view text, std::span<double const> values) {
    line_ = detail::csv_text(std::string(text)) + ',';
    write_row(values, 1);
  }

  /// Overload for `values` in braces, `row({t, x, y})`.
  void row(std::initializer_list<double> values) { row(std::span<double const>(values.begin(), values.size())); }

  /// Overload for `values` as separate arguments, `row(t, x, y)`.
  template <std::convertible_to<double>... Numbers>
  void row(Numbers const&... values) {
    row({static_cast<double>(values)...});
  }

  /// Completes the file and renames it to its final name. A second call has no effect. Throws IoError if the file
  /// cannot be written.
  void close() { file_.close(); }

  std::size_t rows() const noexcept { return rows_; }  ///< Number of rows written, without the head.

 private:
  static void check_heads(std::filesystem::path const& file, std::vector<std::string> const& columns) {
    if (columns.empty())
      throw InvalidInput("table.columns",
                         {"file \"", ErrorObject{file.string()}, "\": a table needs at least one column."});
    std::set<std::string_view> seen;
    for (auto const& head : columns) {
      if (head.empty())
        throw InvalidInput("table.columns", {"file \"", ErrorObject{file.string()}, "\": the head of column ",
                                             std::size_t(&head - columns.data()) + 1, ", counted from 1, is empty."});
      if (!seen.insert(head).second)
        throw InvalidInput("table.columns",
                           {"file \"", ErrorObject{file.string()}, "\": duplicate column \"", head, "\"."});
    }
  }

  /// Appends `values` to `line_`, which contains the texts of the first `texts` columns, and writes the line.
  void write_row(std::span<double const> values, std::size_t texts) {
    auto const where = [&] { return "file \"" + file_.name() + "\", row " + std::to_string(rows_ + 1); };
    if (values.size() + texts != columns_.size())
      throw InvalidInput("table.row_size", {ErrorObject{where()}, ": the row has ", values.size() + texts,
                                            " values, but the table has ", columns_.size(), " columns."});
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]))
        throw InvalidInput("value.not_finite", {ErrorObject{where()}, ", column \"", columns_[i + texts],
                                                "\": the value is not finite (", ErrorValue{values[i]}, ")."});
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
