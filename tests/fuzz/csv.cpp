// Tables from comma-separated values. An accepted table has a number under every head. It is written and read again
// with the same result.
#include <bit>
#include <set>

#include <polybody/io/csv.hpp>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

bool same(Table const& a, Table const& b) {
  if (a.columns != b.columns || a.rows.size() != b.rows.size()) return false;
  for (std::size_t i = 0; i < a.rows.size(); ++i)
    for (std::size_t j = 0; j < a.columns.size(); ++j)
      if (std::bit_cast<std::uint64_t>(a.rows[i][j]) != std::bit_cast<std::uint64_t>(b.rows[i][j])) return false;
  return true;
}

void check(Table const& table) {
  require(!table.columns.empty(), "a table has columns");
  for (auto const& row : table.rows) {
    require(row.size() == table.columns.size(), "a row has a number for each column");
    for (double const x : row) require(std::isfinite(x), "numbers of a table are finite");
  }
  std::set<std::string> const different(table.columns.begin(), table.columns.end());
  if (different.size() != table.columns.size() || different.contains("")) return;  // `Csv` refuses these heads
  std::string const file = folder().file("again.csv");
  Csv csv(file, table.columns);
  for (auto const& row : table.rows) csv.row(row);
  csv.close();
  require(same(read_csv(file), table), "a table that is written is read as the same");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::string const file = folder().put("table.csv", text_of(data, size));
  auto const table = accepted([&] { return polybody::read_csv(file); },
                              [&](std::string const& message) {
                                return has(message, "file \"" + file + "\", line ") ||
                                       message == "file \"" + file + "\" is empty, but needs a head line.";
                              });
  if (table) check(*table);
  return 0;
}
