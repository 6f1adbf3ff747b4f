#pragma once
/// \file
/// File that is written under its own name from the beginning.
///
/// Not in polybody.hpp: it belongs to io/vtk.hpp.

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <polybody/math/errors.hpp>

namespace polybody {

/// Output file that has its final name from the beginning. Suitable if an incomplete file is useful, or if another file
/// refers to it only after its completion. A killed program leaves no temporary file. AtomicFile, in contrast, appears
/// only when complete. Move-only.
class FileInPlace {
 public:
  /// Creates `file`, which is empty, and its parent folders.
  /// \throws IoError if the system refuses.
  explicit FileInPlace(std::filesystem::path const& file) : name_(file.string()) {
    std::error_code reason;
    std::filesystem::create_directories(file.parent_path(), reason);
    if (reason) fail("its folder cannot be created", reason);
    file_.reset(std::fopen(name_.c_str(), "wb"));
    if (!file_) fail("cannot be created", {errno, std::generic_category()});
  }

  /// Writes `bytes` at the current position.
  /// \throws IoError if the system refuses.
  void write(std::string_view bytes) {
    errno = 0;
    require(std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  }
  /// Writes the buffered bytes to the system; up to 4096 bytes are one system call. \throws IoError if the system
  /// refuses.
  void flush() {
    errno = 0;
    require(std::fflush(file_.get()) == 0);
  }
  /// Sets the position of the next write to `place` [bytes from the beginning]. \throws IoError if the system refuses.
  void go_to(std::size_t place) {
    errno = 0;
    require(std::fseek(file_.get(), long(place), SEEK_SET) == 0);
  }

 private:
  struct Closer {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  void require(bool done) const {
    if (!done) fail("cannot be written", {errno, std::generic_category()});
  }
  [[noreturn, gnu::cold]] void fail(std::string const& what, std::error_code reason) const {
    throw IoError("file.write", {"file \"", ErrorObject{name_}, "\" ", what, (reason ? ": " + reason.message() : "")});
  }

  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace polybody
