#pragma once
/// \file
/// Output file that appears under its name only when it is complete, its temporary file, and the POSIX calls of this
/// file. On systems without O_TMPFILE the temporary file has a name from the beginning. On systems without POSIX the
/// operating system decides when the bytes are written to the disk.

#if __has_include(<unistd.h>)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <polybody/math/errors.hpp>

namespace polybody {

namespace detail {

/// Random hidden name in the folder of `file`: ".polybody-<16 hex digits>.tmp".
inline std::filesystem::path temporary_next_to(std::filesystem::path const& file) {
  std::random_device random;
  std::string name = ".polybody-";
  for (int digit = 0; digit < 16; ++digit) name += "0123456789abcdef"[random() % 16];
  return file.parent_path() / (name + ".tmp");
}

/// File that replaces another one when it is complete. Linux creates it without a name (O_TMPFILE), so a killed program
/// leaves no file. On file systems without unnamed files the file has a hidden name. Move-only.
class TemporaryFile {
 public:
  TemporaryFile() = default;  ///< No file.
  /// Creates a file in the existing folder of `target`. The caller checks `is_open`; errno contains the reason of a
  /// failure.
  explicit TemporaryFile(std::filesystem::path const& target) : target_(target), name_(temporary_next_to(target)) {
#ifdef O_TMPFILE
    std::filesystem::path const folder = target.parent_path();
    int const file = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    bool const can_be_named = file >= 0 && ::access(link_to(file).c_str(), F_OK) == 0;
    if (can_be_named) file_ = ::fdopen(file, "wb");
    if (file >= 0 && !file_) ::close(file);
    if (file_) return;
#endif
    file_ = std::fopen(name_.string().c_str(), "wbx");
    is_named_ = file_ != nullptr;
  }
  TemporaryFile(TemporaryFile&& other) noexcept { swap(other); }
  TemporaryFile& operator=(TemporaryFile&& other) noexcept {
    TemporaryFile taken(std::move(other));
    swap(taken);
    return *this;
  }
  ~TemporaryFile() { discard(); }

  bool is_open() const noexcept { return file_ != nullptr; }
  /// Stream for writing.
  std::FILE* stream() const noexcept { return file_; }
  /// Sets the permissions of the file to `permissions`, those of the replaced file.
  void set_permissions(std::filesystem::perms permissions) const {
#if __has_include(<unistd.h>)
    (void)::fchmod(::fileno(file_), static_cast<mode_t>(permissions & std::filesystem::perms::mask));
#else
    std::error_code ignored;
    std::filesystem::permissions(name_, permissions, ignored);
#endif
  }

  /// Writes all bytes to the disk. After a loss of power, either the old file or the complete new file exists. Returns
  /// false if the bytes cannot be written; errno contains the reason.
  bool flush() const {
    if (std::fflush(file_) != 0) return false;
#if __has_include(<unistd.h>)
    if (::fsync(::fileno(file_)) != 0 && errno != EINVAL && errno != ENOSYS) return false;
#endif
    return true;
  }
  /// Closes the file and renames it to its target. If this fails, removes the file and returns the reason.
  std::error_code put_in_place() {
    if (!is_named_ && !give_name()) {
      std::error_code const reason(errno, std::generic_category());
      discard();
      return reason;
    }
    is_named_ = true;
    errno = 0;
    std::error_code reason;
    if (std::fclose(std::exchange(file_, nullptr)) != 0) reason = {errno, std::generic_category()};
    if (!reason) std::filesystem::rename(name_, target_, reason);
    if (reason) {
      remove();
      return reason;
    }
    is_named_ = false;
    sync_folder();
    return {};
  }
  /// Closes and removes the file.
  void discard() noexcept {
    if (file_) std::fclose(std::exchange(file_, nullptr));
    if (is_named_) remove();
  }

 private:
  void swap(TemporaryFile& other) noexcept {
    std::swap(target_, other.target_);
    std::swap(name_, other.name_);
    std::swap(file_, other.file_);
    std::swap(is_named_, other.is_named_);
  }
  void remove() noexcept {
    std::error_code ignored;
    std::filesystem::remove(name_, ignored);
    is_named_ = false;
  }
#ifdef O_TMPFILE
  static std::string link_to(int file) { return "/proc/self/fd/" + std::to_string(file); }
#endif
  bool give_name() const {
#ifdef O_TMPFILE
    return ::linkat(AT_FDCWD, link_to(::fileno(file_)).c_str(), AT_FDCWD, name_.c_str(), AT_SYMLINK_FOLLOW) == 0;
#else
    return false;  // the file has a name
#endif
  }
  void sync_folder() const noexcept {
#if __has_include(<unistd.h>)
    int const folder = ::open(target_.parent_path().c_str(), O_RDONLY | O_CLOEXEC);
    if (folder < 0) return;
    (void)::fsync(folder);
    ::close(folder);
#endif
  }

  std::filesystem::path target_, name_;
  std::FILE* file_ = nullptr;
  bool is_named_ = false;
};

/// Target of the chain of symbolic links that begins at `file`. The target need not exist. `reason` becomes an error if
/// the links form a loop.
inline std::filesystem::path end_of_links(std::filesystem::path file, std::error_code& reason) {
  namespace fs = std::filesystem;
  for (int links = 0; fs::is_symlink(fs::symlink_status(file, reason)); ++links) {
    if (links == 40) reason = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    fs::path const next = reason ? fs::path() : fs::read_symlink(file, reason);
    if (reason) return file;
    file = next.is_absolute() ? next : file.parent_path() / next;
  }
  reason.clear();
  return file;
}

}  // namespace detail

/// Output file that is written to a temporary file in the same folder and renamed on `close()`. A reader finds the old
/// file or the complete new file, even after a loss of power (fsync). The new file gets the permissions of the file
/// that it replaces. A killed program leaves no temporary file if the system supports unnamed files (O_TMPFILE of
/// Linux). Otherwise a killed program leaves ".polybody-<16 hex digits>.tmp", which can be deleted. The destructor
/// closes and renames an open file. If a write has failed, or if an exception is in flight and `keep_on_exception()`
/// was not called, the destructor removes the temporary file instead. An existing file then remains unchanged.
/// Move-only.
class AtomicFile {
 public:
  /// Creates the parent folders of `file` and opens the temporary file. A symbolic link is followed, even if its target
  /// does not exist yet. Throws IoError with the file name and the system's reason if the file cannot be created.
  /// Reasons include a name that is too long, links that form a loop, and a `file` that exists and is not a regular
  /// file.
  explicit AtomicFile(std::filesystem::path const& file) : name_(file.string()) {
    namespace fs = std::filesystem;
    if (!file.has_filename())
      throw IoError("file.name", {"file \"", ErrorObject{name_}, "\": the path has no file name. Append one."});
    std::error_code reason;
    fs::path const full = fs::absolute(file, reason);
    if (reason) fail("its folder cannot be found", reason);
    fs::path const target = detail::end_of_links(full, reason);
    if (reason) fail("cannot be created", reason);
    fs::create_directories(target.parent_path(), reason);
    if (reason) fail("its folder cannot be created", reason);
    fs::file_status const status = fs::status(target, reason);
    if (status.type() == fs::file_type::none) fail("cannot be created", reason);
    bool const exists = status.type() != fs::file_type::not_found;
    if (exists && !fs::is_regular_file(status))
      throw IoError("file.write",
                    {"file \"", ErrorObject{name_}, "\" exists and is not a regular file. Choose another name."});
    file_ = detail::TemporaryFile(target);
    if (!file_.is_open()) fail("cannot be created", {errno, std::generic_category()});
    if (exists) file_.set_permissions(status.permissions());
  }

  AtomicFile(AtomicFile&&) noexcept = default;  ///< The moved-from file is closed.

  /// Moves `other` to this object, which then closes or discards its previous file by the rule of the destructor.
  /// `other` is closed.
  AtomicFile& operator=(AtomicFile&& other) noexcept {
    AtomicFile taken(std::move(other));
    std::swap(name_, taken.name_);
    std::swap(file_, taken.file_);
    std::swap(failed_, taken.failed_);
    std::swap(exceptions_, taken.exceptions_);
    std::swap(kept_, taken.kept_);
    return *this;
  }

  /// Closes or discards the file by the rule in the comment of the class. A failure of `close` is printed to stderr,
  /// because a destructor cannot throw.
  ~AtomicFile() {
    if (!is_open()) return;
    try {
      failed_ || (!kept_ && std::uncaught_exceptions() > exceptions_) ? discard() : close();
    } catch (std::exception const& error) {
      std::fprintf(stderr, "polybody: %s\n", error.what());
    }
  }

  /// Appends `bytes`. Throws IoError if they cannot be written (for example if the disk is full), and InvalidInput if
  /// the file is closed.
  void write(std::string_view bytes) {
    if (!is_open())
      throw InvalidInput("file.closed",
                         {"file \"", ErrorObject{name_}, "\" is already closed, so nothing can be written to it."});
    errno = 0;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.stream()) == bytes.size()) return;
    failed_ = true;
    fail("cannot be written", {errno, std::generic_category()});
  }

  /// Keeps an incomplete file after an exception: the bytes written so far then appear under the final name.
  void keep_on_exception() noexcept { kept_ = true; }

  /// Flushes the file and renames it to its final name. A second call has no effect. Throws IoError with the file name
  /// and, if known, the system's reason if this fails or an earlier write has failed. Before `close` throws, it removes
  /// the temporary file.
  void close() {
    if (!is_open()) return;
    errno = 0;
    bool const written = !failed_ && file_.flush();
    std::error_code reason(errno, std::generic_category());
    if (written) reason = file_.put_in_place();
    if (written && !reason) return;
    file_.discard();
    fail(written ? "cannot be renamed to its final name" : "could not be written completely", reason);
  }

  /// Removes the temporary file. No file appears under the final name.
  void discard() noexcept { file_.discard(); }

  bool is_open() const noexcept { return file_.is_open(); }   ///< True until the file is closed or discarded.
  std::string const& name() const noexcept { return name_; }  ///< Path as passed to the constructor.

 private:
  [[noreturn, gnu::cold]] void fail(std::string const& what, std::error_code reason) const {
    throw IoError("file.write", {"file \"", ErrorObject{name_}, "\" ", what, (reason ? ": " + reason.message() : "")});
  }

  std::string name_;
  detail::TemporaryFile file_;
  bool failed_ = false, kept_ = false;
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace polybody
