#pragma once
/// \file
/// A file that is written under its own name from the beginning.
///
/// Not in polybody.hpp: it comes with io/vtk.hpp.

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <polybody/math/errors.hpp>

namespace polybody {

/// For what is of use while it grows, or is not read before another file names it: no temporary file is left when the
/// program is killed. Compare AtomicFile. Move-only.
class FileInPlace {
 public:
  /// Creates the parent folders and empties the file. \throws IoError.
  explicit FileInPlace(std::filesystem::path const& file) : name_(file.string()) {
    std::error_code reason;
    std::filesystem::create_directories(file.parent_path(), reason);
    if (reason) fail("its folder cannot be created", reason);
    file_.reset(std::fopen(name_.c_str(), "wb"));
    if (!file_) fail("cannot be created", {errno, std::generic_category()});
  }

  /// Writes `bytes`. \throws IoError, as the others.
  void write(std::string_view bytes) {
    errno = 0;
    require(std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  }
  /// Hands what is written to the system: up to 4096 bytes at once.
  void flush() {
    errno = 0;
    require(std::fflush(file_.get()) == 0);
  }
  /// The next bytes are written from this place on.
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
    throw IoError{"file '", name_, "' ", what, (reason ? ": " + reason.message() : "")};
  }

  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace polybody
