#pragma once
/// \file
/// Output file that appears under its name only when it is complete.

#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <polybody/io/temporary_file.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

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
