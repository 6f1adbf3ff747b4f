#pragma once
/// \file
/// Readers of text files of finite element programs: lines of numbers, and sparse matrices in the coordinate format of
/// Matrix Market. An error names the file and the line.

#include <algorithm>
#include <cctype>
#include <fstream>
#include <istream>
#include <locale>
#include <sstream>
#include <string>
#include <unordered_set>
#include <vector>

#include <Eigen/SparseCore>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Reader of a file with lines of numbers. It skips comments and empty lines.
class NumberReader {
 public:
  /// Remaining text of a line without leading and trailing blanks, such as a name after numbers.
  struct Rest {
    std::string text;  ///< text without these blanks; a line without this text is refused
  };

  /// Opens a file in which `comment` begins a comment.
  /// \throws IoError for a file that cannot be read.
  NumberReader(std::string const& file, char comment) : file_(file), in_(file), comment_(comment) {
    if (in_) in_.peek();  // a folder can be opened, but not read
    if (!in_.is_open() || in_.bad())
      throw IoError("file.open",
                    {ErrorObject{file}, ": the file cannot be opened. Check the path and the permission to read it."});
    in_.clear();
  }
  /// Reads the next line without changes, up to LF, CR LF or CR; returns false at the end of the file.
  bool raw(std::string& line) {
    ++line_;
    line.clear();
    std::streambuf& from = *in_.rdbuf();
    constexpr int end = std::streambuf::traits_type::eof();
    for (int c = from.sbumpc(); c != end; c = from.sbumpc()) {
      if (c == '\r' && from.sgetc() == '\n') continue;
      if (c == '\r' || c == '\n') return true;
      line += char(c);
    }
    return !line.empty();
  }
  /// Reads the numbers of the next line that is not empty into `values`. The line must contain nothing else; `expected`
  /// describes the content of the line in the message. Returns false at the end of the file.
  /// \throws IoError for a line with other content.
  template <class... T>
  bool next(std::string const& expected, T&... values) {
    std::string line;
    do {
      if (!raw(line)) return false;
      line.resize(std::min(line.find(comment_), line.size()));
    } while (line.find_first_not_of(" \t\r\v\f") == std::string::npos);  // the blanks that `>>` skips
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string rest;
    if (!(read(words, values) && ...) || (words >> rest)) fail("\"" + line.substr(0, 60) + "\" is not " + expected);
    return true;
  }
  Index line() const { return line_; }  ///< number of the last line, counted from 1
  /// Reports an error.
  /// \throws IoError with the file, the last line and `what`.
  [[noreturn, gnu::cold]] void fail(std::string const& what) const { fail_at(line_, what); }
  /// Reports an error in an earlier line, or in the whole file if `line` is zero.
  /// \throws IoError with the file, the line and `what`.
  [[noreturn, gnu::cold]] void fail_at(Index line, std::string const& what) const {
    if (line == 0) throw IoError("file.content", {ErrorObject{file_}, ": ", what, "."});
    throw IoError("file.content", {ErrorObject{file_}, ", line ", line, ": ", what, "."});
  }

 private:
  /// Reads a number that ends at a blank: "1.5.5" is not 1.5 and 0.5, and "3-4" is not 3 and −4.
  template <class T>
  static bool read(std::istream& words, T& value) {
    return words >> value && (words.eof() || std::isspace(words.peek()));
  }

  static bool read(std::istream& words, Rest& rest) {
    std::getline(words >> std::ws, rest.text);
    rest.text.resize(rest.text.find_last_not_of(" \t\r\v\f") + 1);  // npos + 1 is 0
    return !rest.text.empty();
  }

  std::string file_;
  std::ifstream in_;
  char comment_;
  Index line_ = 0;
};

/// Reads a sparse m×n matrix from a Matrix Market file [Boisvert, Pozo & Remington 1996]: coordinate, real or integer,
/// general or symmetric. A symmetric matrix is given by its lower triangle. Eigen's unsupported loader is not used: it
/// returns half of a symmetric matrix and does not check indices. `need` is the end of the message "the matrix is 2×2,
/// but the …" and explains the required size.
/// \throws IoError, with the line, for any other content.
template <class = void>  // compiled only if used
Eigen::SparseMatrix<double> read_matrix(std::string const& file, Index m, Index n, std::string const& need) {
  NumberReader lines(file, '%');
  std::string banner;
  lines.raw(banner);
  for (char& c : banner) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  std::istringstream words(banner);
  std::string mark, object, format, field, kind;
  words >> mark >> object >> format >> field >> kind;
  if (mark != "%%matrixmarket" || object != "matrix" || format != "coordinate" ||
      (field != "real" && field != "integer") || (kind != "general" && kind != "symmetric"))
    lines.fail(
        "the first line must be '%%MatrixMarket matrix coordinate real general' or '%%MatrixMarket matrix coordinate "
        "real symmetric'; write the matrix in one of these formats");
  Index rows = 0, columns = 0, count = 0;
  std::string const sizes = "the number of rows, of columns and of entries";
  if (!lines.next(sizes, rows, columns, count)) lines.fail("the file ends before " + sizes);
  if (count < 0) lines.fail("the number of entries must not be negative, but is " + std::to_string(count));
  if (rows != m || columns != n)
    lines.fail("the matrix is " + std::to_string(rows) + "×" + std::to_string(columns) + ", but the " + need);
  if (kind == "symmetric" && m != n) lines.fail("a symmetric matrix has as many rows as columns");
  std::vector<Eigen::Triplet<double>> entries;
  std::unordered_set<Index> seen;
  for (Index e = 0; e < count; ++e) {
    Index i = 0, j = 0;
    double value = 0.0;
    if (!lines.next("a row, a column and a finite number", i, j, value))
      lines.fail("the file ends after " + std::to_string(e) + " of " + std::to_string(count) +
                 " entries; it is truncated");
    if (i < 1 || i > m || j < 1 || j > n)
      lines.fail("entry (" + std::to_string(i) + ", " + std::to_string(j) +
                 ") is outside the matrix, whose rows are 1 to " + std::to_string(m) + " and columns 1 to " +
                 std::to_string(n));
    if (kind == "symmetric" && i < j)
      lines.fail("a symmetric matrix is written by its lower triangle, but this entry is above the diagonal");
    if (!seen.insert(n * i + j).second)
      lines.fail("entry (" + std::to_string(i) + ", " + std::to_string(j) + ") occurs a second time");
    entries.emplace_back(int(i - 1), int(j - 1), value);
    if (kind == "symmetric" && i != j) entries.emplace_back(int(j - 1), int(i - 1), value);
  }
  lines.next("the end of the file after " + std::to_string(count) + " entries");
  Eigen::SparseMatrix<double> matrix(m, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace polybody
