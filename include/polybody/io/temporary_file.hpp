#pragma once
/// \file
/// Temporary file of an AtomicFile, and its POSIX calls. On systems without O_TMPFILE the file has a name from the
/// beginning. On systems without POSIX the operating system decides when the bytes are written to the disk.

#if __has_include(<unistd.h>)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <utility>

#include <polybody/math/compiler.hpp>

namespace polybody::detail {

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

}  // namespace polybody::detail
