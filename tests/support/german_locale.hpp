#pragma once
/// \file
/// A locale with decimal commas, for tests of numbers in texts and files.

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <random>
#include <string>

namespace polybody {

/// C functions and C++ streams write decimal commas until the end of its scope. `localedef` makes the C locale if the
/// system has none; `is_set` is false if that fails.
class GermanLocale {
 public:
  GermanLocale() : before_(std::setlocale(LC_ALL, nullptr)), global_(std::locale()) {
    std::locale::global(std::locale(std::locale::classic(), new Comma));
    if (!std::setlocale(LC_ALL, "de_DE.UTF-8")) make();
    char text[8];
    std::snprintf(text, sizeof text, "%.1f", 0.5);
    is_set = std::string(text) == "0,5";
  }
  GermanLocale(GermanLocale const&) = delete;
  GermanLocale& operator=(GermanLocale const&) = delete;
  ~GermanLocale() {
    std::locale::global(global_);
    std::setlocale(LC_ALL, before_.c_str());
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }

  bool is_set = false;  ///< C functions write decimal commas

 private:
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  void make() {
    folder_ = std::filesystem::temp_directory_path() / ("polybody locale " + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder_);
    std::string const to = "'" + (folder_ / "de_DE.ISO-8859-1").string() + "'";
    if (std::system(("localedef -i de_DE -f ISO-8859-1 " + to + " > /dev/null 2>&1").c_str()) != 0) return;
    ::setenv("LOCPATH", folder_.c_str(), 1);
    std::setlocale(LC_ALL, "de_DE.ISO-8859-1");
    ::unsetenv("LOCPATH");
  }

  std::string before_;
  std::locale global_;
  std::filesystem::path folder_;
};

}  // namespace polybody
