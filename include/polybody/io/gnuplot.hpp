#pragma once
/// \file
/// Functions that find and run the program gnuplot, and quote text for its scripts.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <polybody/io/atomic_file.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

/// First executable `gnuplot` in the folders of the environment variable PATH; empty if there is none.
template <class = void>  // compiled where it is used
std::optional<std::filesystem::path> find_gnuplot() {
  namespace fs = std::filesystem;
  char const* const path = std::getenv("PATH");
  for (std::string_view rest = path ? path : ""; !rest.empty();) {
    std::string_view const folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(folder.size() == rest.size() ? rest.size() : folder.size() + 1);
    if (folder.empty()) continue;
    std::error_code reason;
    fs::path const program = fs::absolute(fs::path(folder) / "gnuplot", reason);
    auto const status = fs::status(program, reason);
    auto const may_run = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    if (fs::is_regular_file(status) && (status.permissions() & may_run) != fs::perms::none) return program;
  }
  return std::nullopt;
}

namespace detail {

/// `text` in single quotes. `escape` replaces each single quote within the text.
template <class = void>
std::string single_quoted(std::string_view text, std::string_view escape) {
  std::string quoted = "'";
  for (char const c : text) c == '\'' ? quoted += escape : quoted += c;
  return quoted + '\'';
}

/// Text quoted as one word for a POSIX shell.
template <class = void>
std::string shell_word(std::string_view text) {
  return single_quoted(text, R"('\'')");
}

/// Gnuplot string expression for a text. The text is in single quotes, because gnuplot executes `...` in double quotes
/// as a command.
template <class = void>
std::string gnuplot_text(std::string_view text) {
  std::string expression = single_quoted(text, "''");
  for (std::size_t at = 0; (at = expression.find('\n', at)) != expression.npos; at += 7)
    expression.replace(at, 1, "'.\"\\n\".'");
  return expression;
}

/// Runs gnuplot, the file `program`, on `script` in the folder of the script. The gnuplot variable png contains the
/// name of a temporary file, to which the script draws. This file then replaces the file `png`. Throws IoError with the
/// script's name and gnuplot's message.
template <class = void>
void run_gnuplot(std::filesystem::path const& program, std::filesystem::path const& script,
                 std::filesystem::path const& png) {
  namespace fs = std::filesystem;
  struct Temporary {
    fs::path file;
    ~Temporary() {
      std::error_code ignored;
      fs::remove(file, ignored);
    }
  };
  Temporary const drawing{temporary_next_to(png)}, words{temporary_next_to(png)};
  fs::path const folder = fs::absolute(script).parent_path();
  std::string const command = "cd " + shell_word(folder.string()) + " && " + shell_word(program.string()) + " -d -e " +
                              shell_word("png='./" + drawing.file.filename().string() + "'") + ' ' +
                              shell_word("./" + script.filename().string()) + " </dev/null >" +
                              shell_word(words.file.filename().string()) + " 2>&1";
  bool const ran = std::system(command.c_str()) == 0;
  std::error_code reason;
  if (!ran || fs::file_size(drawing.file, reason) == 0 || reason) {
    std::ifstream said(words.file);
    throw IoError("gnuplot.failed", {"gnuplot failed on \"", ErrorObject{script.string()},
                                     "\": ", std::string(std::istreambuf_iterator<char>(said), {})});
  }
  fs::rename(drawing.file, png, reason);
  if (reason)
    throw IoError("file.write",
                  {"file \"", ErrorObject{png.string()}, "\" cannot be renamed to its final name: ", reason.message()});
}

}  // namespace detail

}  // namespace polybody
