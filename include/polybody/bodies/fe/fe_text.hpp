#pragma once
/// \file
/// Text files of finite element programs: lines, fields, and numbers in Fortran's notation.

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <polybody/bodies/ffr/matrix_file.hpp>

namespace polybody::detail {

/// Text without leading and trailing blanks.
inline std::string_view trimmed(std::string_view text) {
  std::size_t const begin = text.find_first_not_of(" \t\r\v\f");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\v\f") + 1 - begin);
}

/// Copy in capital letters.
inline std::string capitals(std::string_view text) {
  std::string all(text);
  for (char& c : all) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return all;
}

/// Words of a line. The characters of `separators` end a word.
inline std::vector<std::string_view> words_of(std::string_view line, char const* separators = " \t\r\v\f") {
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(separators); begin != line.npos;) {
    std::size_t const end = std::min(line.find_first_of(separators, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return words;
}

/// Cells of a line between commas, without blanks around them. A cell may be empty.
inline std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    std::size_t const end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    if (end == line.size()) return cells;
    begin = end + 1;
  }
}

/// Number in Fortran's notation, such as 1.5, 2.5+10, 1.0D-3 or 1.25-101; NaN for any other text.
inline double fortran_number(std::string_view text) {
  std::string plain;
  for (char const c : text) {
    bool const sign = c == '+' || c == '-', after_digit = !plain.empty() && plain.back() != 'e';
    if (sign && after_digit && plain != "-") plain += 'e';
    if (c == '+' && plain.empty()) continue;
    plain += c == 'd' || c == 'D' || c == 'E' ? 'e' : c;
  }
  double value = 0.0;
  auto const [end, fault] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  return fault == std::errc() && end == plain.data() + plain.size() ? value : std::nan("");
}

/// Columns of a Fortran format such as 1P,3E23.16 or 10I8: the number and the width of the fields of a line.
struct FixedColumns {
  std::size_t per_line = 0;  ///< fields of a line; zero if the format has no such fields
  std::size_t width = 0;     ///< characters of a field

  /// Reads `format` from its first letter among `letters`.
  static FixedColumns of(std::string_view format, char const* letters) {
    FixedColumns columns;
    std::size_t const letter = format.find_first_of(letters);
    if (letter == format.npos) return columns;
    std::size_t first = letter;
    while (first > 0 && std::isdigit(static_cast<unsigned char>(format[first - 1]))) --first;
    char const *const begin = format.data(), *const end = begin + format.size();
    std::size_t count = 1, width = 0;
    if (first < letter) std::from_chars(begin + first, begin + letter, count);
    std::from_chars(begin + letter + 1, end, width);
    if (count > 0 && count <= 1000 && width > 0 && width <= 1000) columns = {count, width};
    return columns;
  }
  /// Fields of a line. The last field may be shorter; fields of blanks at the end are omitted.
  std::vector<std::string_view> fields(std::string_view line) const {
    std::vector<std::string_view> all;
    line = line.substr(0, line.find_last_not_of(" \t\r\v\f") + 1);
    for (std::size_t k = 0; k < per_line && k * width < line.size(); ++k)
      all.push_back(trimmed(line.substr(k * width, width)));
    return all;
  }
};

/// Reader of the lines of a text file. An error names the file and the line.
class FeText {
 public:
  /// Opens a file.
  /// \throws IoError for a file that cannot be read.
  explicit FeText(std::string const& file) : file_(file), lines_(file, '\0') {}

  std::string const& file() const { return file_; }
  Index line() const { return line_; }  ///< number of the last line that `next` has read, counted from 1
  /// Reads the next line; returns false at the end of the file.
  bool next(std::string& line) {
    peek(line);
    skip();
    if (got_ || line_ == 0) line_ = lines_.line();
    return got_;
  }
  /// Reads the next line with a word.
  bool next_filled(std::string& line) {
    while (next(line))
      if (!trimmed(line).empty()) return true;
    return false;
  }
  /// Skips the line that `peek` has kept.
  void skip() { kept_ = false; }
  /// Reads the next line and keeps it for `next`.
  bool peek(std::string& line) {
    if (!kept_) got_ = lines_.raw(ahead_);
    kept_ = true;
    line = ahead_;
    return got_;
  }
  [[noreturn]] void fail(std::string const& what) const { lines_.fail_at(line(), what); }
  [[noreturn]] void fail_at(Index line, std::string const& what) const { lines_.fail_at(line, what); }

  /// Integer of a field; `what` describes the field in the message.
  Index integer(std::string_view text, char const* what) const {
    Index value = 0;
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
    auto const [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size()) fail(quoted(text) + " is not " + what);
    return value;
  }
  /// Finite number of a field.
  double real(std::string_view text, char const* what) const {
    double const value = fortran_number(trimmed(text));
    if (!std::isfinite(value)) fail(quoted(trimmed(text)) + " is not " + what + ", a finite number");
    return value;
  }
  /// First characters of a field, in double quotes.
  static std::string quoted(std::string_view text) { return '"' + std::string(text.substr(0, 60)) + '"'; }

 private:
  std::string file_;
  NumberReader lines_;
  std::string ahead_;
  Index line_ = 0;
  bool kept_ = false, got_ = false;
};

}  // namespace polybody::detail
