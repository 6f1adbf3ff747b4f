#pragma once
/// \file
/// Reader for lines of numbers in a text file of a finite element program. An error names the file and the line.

#include <algorithm>
#include <cctype>
#include <fstream>
#include <istream>
#include <locale>
#include <sstream>
#include <string>

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
  /// Reports an error.
  /// \throws IoError with the file, the line and `what`.
  [[noreturn, gnu::cold]] void fail(std::string const& what) const {
    throw IoError("file.content", {ErrorObject{file_}, ", line ", line_, ": ", what, "."});
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

}  // namespace polybody
