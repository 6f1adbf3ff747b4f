#pragma once
// Files of a VtkWriter, read by VTK's own reader.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <source_location>
#include <sstream>
#include <string>
#include <vector>

namespace polybody {

/// Output of `vtk_read.py`, by the words before the numbers; empty if no python has VTK. The path of the script is
/// relative to the calling test, in a folder next to its own.
inline std::vector<std::vector<std::string>> read_by_vtk(
    std::filesystem::path const& collection, std::source_location const& test = std::source_location::current()) {
  namespace fs = std::filesystem;
  fs::path const script = fs::path(test.file_name()).parent_path().parent_path() / "io" / "vtk_read.py";
  fs::path const out = collection.string() + ".txt";
  for (char const* const python : {"python3", "/usr/bin/python3"}) {
    std::string const what =
        " -B '" + script.string() + "' '" + collection.string() + "' > '" + out.string() + "' 2> /dev/null";
    int const status = std::system((python + what).c_str());
    int const code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (code == 77 || code == 127) continue;  // VTK or this python is not installed
    EXPECT_EQ(code, 0);
    std::vector<std::vector<std::string>> lines;
    std::ifstream stream(out);
    for (std::string line; std::getline(stream, line);) {
      std::istringstream words(line);
      lines.emplace_back(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>());
    }
    return lines;
  }
  return {};
}

}  // namespace polybody
