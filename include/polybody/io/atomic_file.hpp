#pragma once
/// \file
/// A file that appears under its own name only when it is complete.

#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <polybody/math/errors.hpp>

namespace polybody {

namespace detail {

/// A hidden name in the folder of `file` that no other writer uses: ".polybody-<16 hex
/// digits>.tmp".
inline std::filesystem::path temporary_beside(std::filesystem::path const& file) {
  std::random_device random;
  std::string name = ".polybody-";
  for (int digit = 0; digit < 16; ++digit) name += "0123456789abcdef"[random() % 16];
  return file.parent_path() / (name + ".tmp");
}

}  // namespace detail

/// Writes bytes to a hidden temporary file in the same folder and renames it into place on
/// `close()`, so a reader sees the old file or the whole new one, never a half-written one.
/// Destroyed without `close()`: closes, unless a write has failed, or an exception is in flight and
/// `keep_on_exception()` was not called; then the temporary is removed and whatever was there before
/// stays. Move-only.
class AtomicFile {
 public:
  /// Creates the parent folders and opens the temporary file. A symbolic link is followed.
  /// Throws IoError (file name and the system's reason) if that fails or if `file` exists and is
  /// not a regular file.
  explicit AtomicFile(std::filesystem::path const& file) : name_(file.string()) {
    namespace fs = std::filesystem;
    if (!file.has_filename()) throw IoError{"file '", name_, "': the name of a file is missing"};
    std::error_code reason;
    fs::path const whole = fs::absolute(file, reason);
    if (reason) fail("its folder cannot be found", reason);
    fs::create_directories(whole.parent_path(), reason);
    if (reason) fail("its folder cannot be created", reason);
    target_ = fs::is_symlink(whole, reason) ? fs::weakly_canonical(whole, reason) : whole;
    if (fs::exists(target_, reason) && !fs::is_regular_file(target_, reason))
      throw IoError{"file '", name_, "' exists and is not a regular file; choose another name"};
    temporary_ = detail::temporary_beside(target_);
    file_.reset(std::fopen(temporary_.string().c_str(), "wbx"));
    if (!file_) fail("cannot be created", {errno, std::generic_category()});
  }

  AtomicFile(AtomicFile&&) noexcept = default;  ///< The source is left closed.

  /// First finishes the file held so far as the destructor does; the source is left closed.
  AtomicFile& operator=(AtomicFile&& other) noexcept {
    AtomicFile taken(std::move(other));
    std::swap(name_, taken.name_);
    std::swap(target_, taken.target_);
    std::swap(temporary_, taken.temporary_);
    std::swap(file_, taken.file_);
    std::swap(failed_, taken.failed_);
    std::swap(exceptions_, taken.exceptions_);
    std::swap(kept_, taken.kept_);
    return *this;
  }

  /// See the class. A destructor cannot throw: a failure of this last close is printed to stderr.
  ~AtomicFile() {
    if (!file_) return;
    try {
      failed_ || (!kept_ && std::uncaught_exceptions() > exceptions_) ? discard() : close();
    } catch (std::exception const& error) {
      std::fprintf(stderr, "polybody: %s\n", error.what());
    }
  }

  /// Appends `bytes`. Throws IoError if the system refuses them (a full disk, for one) and
  /// InvalidInput if the file is closed.
  void write(std::string_view bytes) {
    if (!file_) throw InvalidInput{"file '", name_, "' is already closed; nothing can be added"};
    errno = 0;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size()) return;
    failed_ = true;
    fail("cannot be written", {errno, std::generic_category()});
  }

  /// What is written is of use although more was to come: an exception puts it in place, too.
  void keep_on_exception() noexcept { kept_ = true; }

  /// Flushes and renames into place; a second call does nothing. Throws IoError (file name and the
  /// system's reason), also if an earlier write failed; the temporary is then removed.
  void close() {
    if (!file_) return;
    errno = 0;
    bool const written = std::fclose(file_.release()) == 0 && !failed_;
    std::error_code reason(errno, std::generic_category());
    if (written) std::filesystem::rename(temporary_, target_, reason);
    if (written && !reason) return;
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    fail(written ? "cannot be put in place" : "could not be written completely", reason);
  }

  /// Gives the file up: the temporary is removed, nothing appears under the final name.
  void discard() noexcept {
    if (!file_) return;
    file_.reset();
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }

  bool is_open() const noexcept { return file_ != nullptr; }  ///< Neither closed nor given up.
  std::string const& name() const noexcept { return name_; }  ///< The path as it was given.

 private:
  struct Closer {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  [[noreturn, gnu::cold]] void fail(std::string const& what, std::error_code reason) const {
    throw IoError{"file '", name_, "' ", what, (reason ? ": " + reason.message() : "")};
  }

  std::string name_;
  std::filesystem::path target_, temporary_;
  std::unique_ptr<std::FILE, Closer> file_;
  bool failed_ = false, kept_ = false;
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace polybody
