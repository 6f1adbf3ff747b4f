#include "tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <polybody/math/errors.hpp>

namespace atlas {

using polybody::ErrorObject;
using polybody::InvalidInput;

namespace {

std::string masked(std::string const& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    bool const digit = text[i] >= '0' && text[i] <= '9';
    if (!digit) {
      out += text[i];
      continue;
    }
    char* end = nullptr;
    std::strtod(text.c_str() + i, &end);
    i = std::size_t(end - text.c_str()) - 1;
    out += '#';
  }
  return out;
}

bool same_key(TextRow const& a, TextRow const& b, Table const& table) {
  if (a.size() < table.keys || b.size() < table.keys) return false;
  for (std::size_t j = 0; j < table.keys; ++j)
    if (table.masked_keys ? masked(a[j]) != masked(b[j]) : a[j] != b[j]) return false;
  return true;
}

std::string joined(TextRow const& row, std::size_t count) {
  std::string out;
  for (std::size_t j = 0; j < std::min(count, row.size()); ++j) out += (j ? ", " : "") + row[j];
  return out;
}

TextRow texts(std::vector<Cell> const& row) {
  TextRow out;
  for (Cell const& cell : row) out.push_back(cell.text);
  return out;
}

// True if the cell of a page agrees with the result.
bool agrees(Cell const& found, std::string const& page) {
  if (found.kind == Cell::Kind::time) return true;
  if (found.kind == Cell::Kind::text) return masked(found.text) == masked(page);
  double const shown = number_in(page);
  if (!std::isfinite(found.value) || !std::isfinite(shown)) return found.text == page;
  return std::abs(shown - found.value) <= found.tolerance;
}

}  // namespace

Cell Cell::number(double value, int digits, double tolerance) {
  return {std::isfinite(value) ? polybody::number(value, digits) : "–", Kind::number, value, tolerance};
}

double number_in(std::string const& cell) {
  char* end = nullptr;
  double const x = std::strtod(cell.c_str(), &end);
  return end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : x;
}

std::string markdown(Table const& table) {
  std::string out = "## " + table.title + "\n\n" + table.note + "\n\n|", line = "|";
  for (std::string const& head : table.heads) {
    out += ' ' + head + " |";
    line += "---|";
  }
  out += '\n' + line + '\n';
  for (auto const& row : table.rows) {
    out += '|';
    for (Cell const& cell : row) out += ' ' + cell.text + " |";
    out += '\n';
  }
  return out + '\n';
}

std::vector<TextRow> rows_of(std::string_view page, std::string const& title) {
  std::istringstream lines{std::string(page)};
  std::vector<TextRow> rows;
  bool within = false, known = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) within = line == "## " + title;
    known = known || within;
    if (!within || !line.starts_with("| ")) continue;
    TextRow row;
    for (std::size_t at = 2, next; (next = line.find(" |", at)) != line.npos; at = next + 3)
      row.push_back(line.substr(at, next - at));
    rows.push_back(std::move(row));
  }
  if (!known) throw InvalidInput{"the page has no table \"", ErrorObject{title}, "\". Write the page again."};
  if (!rows.empty()) rows.erase(rows.begin());  // heads
  return rows;
}

std::vector<std::string> differences(Table const& table, std::string_view page) {
  std::vector<TextRow> const shown = rows_of(page, table.title);
  std::vector<std::string> out;
  for (auto const& row : table.rows) {
    TextRow const words = texts(row);
    std::string const name = table.title + ", " + joined(words, table.keys) + ": ";
    auto const same =
        std::find_if(shown.begin(), shown.end(), [&](TextRow const& other) { return same_key(words, other, table); });
    if (same == shown.end())
      out.push_back(name + "the page has no such row.");
    else if (same->size() != row.size())
      out.push_back(name + "the row of the page has another number of cells.");
    else
      for (std::size_t j = table.keys; j < row.size(); ++j)
        if (!agrees(row[j], (*same)[j]))
          out.push_back(name + "the page has " + (*same)[j] + ", the run " + row[j].text + " (" + table.heads[j] +
                        ").");
  }
  for (TextRow const& other : shown) {
    auto const is_same = [&](auto const& row) { return same_key(texts(row), other, table); };
    if (std::none_of(table.rows.begin(), table.rows.end(), is_same))
      out.push_back(table.title + ", " + joined(other, table.keys) + ": the run has no such row.");
  }
  return out;
}

std::string_view part_of(std::string_view text) {
  std::size_t const begin = text.find(begin_marker), end = text.find(end_marker);
  if (begin == text.npos || end == text.npos || end < begin)
    throw InvalidInput{"the page has no part between \"", ErrorObject{std::string(begin_marker)}, "\" and \"",
                       std::string(end_marker), "\"."};
  std::size_t const first = begin + begin_marker.size();
  return text.substr(first, end - first);
}

std::string with_part(std::string_view text, std::string const& made) {
  std::string_view const old = part_of(text);
  std::size_t const first = std::size_t(old.data() - text.data());
  return std::string(text.substr(0, first)) + "\n\n" + made + std::string(text.substr(first + old.size()));
}

}  // namespace atlas
