#pragma once
// Tables of the atlas in Markdown, and their check against the tables of a page.
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace atlas {

// A cell of a table. The check compares numbers within a tolerance, and texts with their numbers masked. It does not
// compare processor times, nor results that depend on them.
struct Cell {
  enum class Kind { text, number, time };
  std::string text = {};
  Kind kind = Kind::text;
  double value = 0.0, tolerance = 0.0;

  static Cell of(std::string text) { return {std::move(text)}; }
  static Cell number(double value, int digits, double tolerance);
  static Cell time(std::string text) { return {std::move(text), Kind::time}; }
};

struct Table {
  std::string title;               // heading
  std::string note;                // sentence below the heading
  std::vector<std::string> heads;  // of the columns
  std::size_t keys;                // number of columns that identify a row
  std::vector<std::vector<Cell>> rows = {};
  bool masked_keys = false;  // true: the numbers in the keys are masked
};

// The table as Markdown, with its heading and its note.
std::string markdown(Table const& table);

// Rows of the table with this title in a page, as texts. Throws InvalidInput if the page has no such table.
using TextRow = std::vector<std::string>;
std::vector<TextRow> rows_of(std::string_view page, std::string const& title);

// Differences between a table and the table of the page with the same title, one sentence each.
std::vector<std::string> differences(Table const& table, std::string_view page);

// Number at the beginning of a cell; NaN if there is none.
double number_in(std::string const& cell);

// Page `text` whose part between the markers is `made`.
std::string with_part(std::string_view text, std::string const& made);
// Part of the page between the markers. Throws InvalidInput if the page has no markers.
std::string_view part_of(std::string_view text);
inline constexpr std::string_view begin_marker = "<!-- made by atlas: begin -->",
                                  end_marker = "<!-- made by atlas: end -->";

}  // namespace atlas
