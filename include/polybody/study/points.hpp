#pragma once
/// \file
/// Points of a study: a table of parameters with names and units, one row for each point.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polybody/math/errors.hpp>

namespace polybody {

/// Error of a program that uses a study wrongly. For example, the function of a point reads a column that does not
/// exist, or returns the wrong number of outputs. The error ends the study and is not recorded as a failure of the
/// point.
class StudyUsageError : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

/// Parameter of a study: a column of its table.
struct Column {
  std::string name{};                  ///< name of the parameter: point["step"] returns its value
  std::string unit{};                  ///< unit of the values; empty: none
  std::vector<std::string> choices{};  ///< meaning of the values 0, 1, …; empty: the values are numbers in `unit`

  std::string head() const { return unit.empty() ? name : name + " [" + unit + ']'; }  ///< name with unit: "step [s]"
};

class Point;

/// Table of parameters, with one row for each point. `grid.hpp` and `sampling.hpp` create such tables. The study's
/// table of results has the same order of points.
class Points {
 public:
  /// Table with these `columns` and `values`.
  /// \param values (points × columns), row by row
  /// \param origin description of the rule that generated the points
  /// \throws InvalidInput for no point or no column, for a number of values that does not fill the rows, for names that
  /// are empty, equal or not printable, for units or choices that are not printable, and for values that are not finite
  /// or outside of the choices.
  Points(std::vector<Column> columns, std::vector<double> values, std::string origin)
      : columns_(std::move(columns)), values_(std::move(values)), origin_(std::move(origin)) {
    if (columns_.empty())
      throw InvalidInput("points.columns", {"study: the points need at least one column, but the list is empty."});
    for (std::size_t j = 0; j < columns_.size(); ++j) require_good(j);
    if (values_.empty() || values_.size() % columns_.size() != 0)
      throw InvalidInput("points.size",
                         {"study: ", ErrorValue{values_.size()}, " values do not fill the rows of ", columns_.size(),
                          " columns. Give a value for each column of each point, and at least one point."});
    for (std::size_t k = 0; k < values_.size(); ++k) require_good_value(columns_[k % columns_.size()], values_[k]);
  }

  std::size_t size() const { return values_.size() / columns_.size(); }  ///< number of points
  std::vector<Column> const& columns() const { return columns_; }        ///< parameters, in the order of the columns
  std::vector<double> const& values() const { return values_; }          ///< (points × columns) values, row by row
  std::string const& origin() const { return origin_; }  ///< description of the rule that generated the points
  /// Value of a `point` in a `column`, in the unit of the column.
  /// \param column index of a column that exists; it is not checked
  /// \throws std::out_of_range if there is no such point.
  double at(std::size_t point, std::size_t column) const { return values_.at(point * columns_.size() + column); }
  /// Row number `point`, from 0. This table must outlive the returned Point.
  Point operator[](std::size_t point) const;

 private:
  void require_good(std::size_t j) const {
    Column const& column = columns_[j];
    auto const printable = [](std::string const& text) {
      return !text.empty() && std::ranges::none_of(text, [](unsigned char c) { return c < ' ' || c == 127; });
    };
    char const* fault = printable(column.name) ? nullptr : "the name";
    if (!column.unit.empty() && !printable(column.unit)) fault = "the unit";
    for (std::string const& choice : column.choices)
      if (!printable(choice)) fault = "a choice";
    if (fault != nullptr)
      throw InvalidInput("points.columns",
                         {"study: ", fault, " of column ", j, ", counted from 0, \"", ErrorObject{column.name},
                          "\" is empty or not printable. Use text without line breaks."});
    for (std::size_t k = 0; k < j; ++k)
      if (columns_[k].name == column.name)
        throw InvalidInput("points.columns", {"study: duplicate column \"", ErrorObject{column.name},
                                              "\". Give each column a different name."});
  }
  static void require_good_value(Column const& column, double value) {
    if (!std::isfinite(value))
      throw InvalidInput("value.not_finite", {"study: a value of column \"", ErrorObject{column.name},
                                              "\" is not finite (", ErrorValue{value}, ")."});
    if (!column.choices.empty() &&
        !(value >= 0.0 && value < double(column.choices.size()) && value == std::floor(value)))
      throw InvalidInput("points.choice",
                         {"study: ", ErrorValue{value}, " is none of the ", column.choices.size(),
                          " choices of column \"", ErrorObject{column.name}, "\", which are counted from 0."});
  }

  std::vector<Column> columns_;
  std::vector<double> values_;
  std::string origin_;
};

/// Point of a study: a row of the table, read by the names of the columns. The table must outlive the point.
class Point {
 public:
  /// Row `index` of `points`, from 0.
  Point(Points const& points, std::size_t index) : points_(&points), index_(index) {}

  std::size_t index() const { return index_; }  ///< index of the row, from 0

  /// Value in a `column`, in the unit of the column.
  /// \throws StudyUsageError if the column does not exist.
  double operator[](std::string_view column) const { return points_->at(index_, place(column)); }

  /// Index of the point's choice in a `column`, from 0.
  /// \throws StudyUsageError if the column does not exist or has no choices.
  std::size_t choice(std::string_view column) const {
    std::size_t const j = place(column);
    if (points_->columns()[j].choices.empty())
      throw StudyUsageError("study.column_kind", {"study: column \"", ErrorObject{column},
                                                  "\" contains numbers, not choices. Use point[\"", column, "\"]."});
    return static_cast<std::size_t>(points_->at(index_, j));
  }
  /// Name of the point's choice in a `column`, as passed to `formulations`. \throws StudyUsageError like `choice`.
  std::string const& chosen(std::string_view column) const {
    return points_->columns()[place(column)].choices[choice(column)];
  }

  /// Calls f with one of the arguments `first`, `others`, selected by the index of the point's choice in `column`.
  /// Example: `point.with("integrator", run, GeneralisedAlpha{}, Radau{})`.
  /// \throws StudyUsageError unless there is one argument for each choice.
  template <class F, class First, class... Others>
  auto with(std::string_view column, F const& f, First const& first, Others const&... others) const {
    std::size_t const k = choice(column), count = points_->columns()[place(column)].choices.size();
    if (count != 1 + sizeof...(others))
      throw StudyUsageError("study.choices",
                            {"study: column \"", ErrorObject{column}, "\" has ", ErrorValue{count},
                             " choices, but Point::with has arguments for ", 1 + sizeof...(others), "."});
    return call_nth(k, f, first, others...);
  }

 private:
  std::size_t place(std::string_view name) const {
    std::vector<Column> const& columns = points_->columns();
    std::string all;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (columns[j].name == name) return j;
      all += (j ? ", \"" : "\"") + columns[j].name + '"';
    }
    throw StudyUsageError("study.no_column",
                          {"study: no column \"", ErrorObject{name}, "\"; the points have ", all, "."});
  }
  template <class F, class First, class... Others>
  static auto call_nth(std::size_t k, F const& f, First const& first, Others const&... others) {
    if constexpr (sizeof...(others) == 0)
      return f(first);
    else
      return k == 0 ? f(first) : call_nth(k - 1, f, others...);
  }

  Points const* points_;
  std::size_t index_;
};

inline Point Points::operator[](std::size_t point) const { return {*this, point}; }

}  // namespace polybody
