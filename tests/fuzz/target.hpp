#pragma once
/// \file
/// Common parts of the fuzz targets. A target is a file with libFuzzer's entry function, which passes its input to a
/// reader. The reader must return finite, consistent data, or throw an error of the library that names the file. Any
/// other exception, a sanitizer report or a violated property ends the program, and libFuzzer stores the input.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polybody/math/errors.hpp>

namespace polybody::fuzz {

inline std::string told(std::string const& text) { return text; }
inline std::string told(double x) { return number(x); }

/// Ends the program if `holds` is false, and prints these texts and numbers.
template <class... Part>
void require(bool holds, Part const&... property) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", (told(property) + ...).c_str());
  std::abort();
}

inline std::string_view text_of(std::uint8_t const* data, std::size_t size) {
  return {reinterpret_cast<char const*>(data), size};
}

/// Folder of this process, in memory if the machine provides it. The folder is removed at the end.
class Folder {
 public:
  Folder() { std::filesystem::create_directories(path_); }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(Folder const&) = delete;
  Folder& operator=(Folder const&) = delete;

  std::string file(std::string const& name) const { return (path_ / name).string(); }
  /// Writes a file with this text.
  std::string put(std::string const& name, std::string_view text) const {
    std::ofstream(file(name), std::ios::binary).write(text.data(), std::streamsize(text.size()));
    return file(name);
  }

 private:
  static std::filesystem::path parent() {
    std::filesystem::path const memory = "/dev/shm";
    return ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
  }
  std::filesystem::path path_ = parent() / ("polybody_fuzz_" + std::to_string(::getpid()));
};
inline Folder const& folder() {
  static Folder const one;
  return one;
}

/// Result of `read`, or nothing if it refuses the input. `names(message)` checks that the refusal names the required
/// object.
template <class Read, class Names>
auto accepted(Read&& read, Names&& names) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (Error const& error) {
    std::string const message = error.what();
    require(names(message), "the refusal must name the file, and the line where there is one: ", message);
    return std::nullopt;
  }
}

inline bool has(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

/// Bytes of an input as numbers of every magnitude. Each number consists of two bytes: a factor of −128 to 127 and a
/// power of ten. The power is zero for half of the inputs. The largest and the smallest powers overflow and
/// underflow.
class Numbers {
 public:
  Numbers(std::uint8_t const* data, std::size_t size) : data_(data), size_(size) {}
  std::size_t left() const { return size_ / 2; }
  /// Next byte, or zero at the end.
  std::uint8_t byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  double next() {
    int const factor = static_cast<std::int8_t>(byte()), power = static_cast<std::int8_t>(byte());
    if (power == -128) return factor < 0 ? -1.0 / 0.0 : factor > 0 ? 1.0 / 0.0 : 0.0 / 0.0;
    int const beyond = power > 63 ? power - 63 : power < -63 ? power + 63 : 0;
    return std::strtod((std::to_string(factor) + "e" + std::to_string(5 * beyond)).c_str(), nullptr);
  }

 private:
  std::uint8_t const* data_;
  std::size_t size_;
};

}  // namespace polybody::fuzz
