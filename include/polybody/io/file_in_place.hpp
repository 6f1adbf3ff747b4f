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

/// Output file for content that is useful while it grows, or that is not read until another file refers to it. A
/// killed program leaves no temporary file. Compare AtomicFile. Move-only.
class FileInPlace {
 public:
  /// Creates the parent folders of `file` and an empty file.
  /// \throws IoError.
  explicit FileInPlace(std::filesystem::path const& file) : name_(file.string()) {
    std::error_code reason;
    std::filesystem::create_directories(file.parent_path(), reason);
    if (reason) fail("its folder cannot be created", reason);
    file_.reset(std::fopen(name_.c_str(), "wb"));
    if (!file_) fail("cannot be created", {errno, std::generic_category()});
  }

  /// Writes `bytes`.
  /// \throws IoError, as the other functions.
  void write(std::string_view bytes) {
    errno = 0;
    require(std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  }
  /// Passes buffered bytes to the system, up to 4096 bytes in one call.
  void flush() {
    errno = 0;
    require(std::fflush(file_.get()) == 0);
  }
  /// Sets the position of the next write to `place` [bytes].
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
