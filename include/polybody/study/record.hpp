#pragma once
/// \file
/// File to which a study appends each finished point. Needs POSIX.
///
/// Not in polybody.hpp: it belongs to study/study.hpp.

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>

#include <polybody/study/record_content.hpp>

namespace polybody::detail {

/// Record of one study, locked by this process while it is open. Each line is passed to the system at once, so a
/// killed process loses no finished point. A line is synchronised to the disk (fsync) if the last synchronisation is
/// at least 0.1 s ago. A loss of power can therefore lose the lines of the last 0.1 s and those that the disk has not
/// stored. Not thread-safe.
class StudyRecord {
 public:
  /// Opens or creates the record, and removes the incomplete line of a killed run.
  /// \throws IoError with the file and, if possible, the line. The error occurs if the folder or the file cannot be
  /// created, another process has locked the file, or `record_content` refuses the content. An existing file then
  /// remains unchanged.
  explicit StudyRecord(RecordKind kind) : kind_(std::move(kind)) {
    open();
    try {
      content_ = record_content(kind_, bytes());
      if (content_.torn && ::ftruncate(file_, off_t(content_.whole)) != 0)
        fail("cannot be truncated after its last complete line");
      if (content_.whole == 0) write(head_text(kind_, content_.chain));
    } catch (...) {
      close();
      throw;
    }
  }
  StudyRecord(StudyRecord const&) = delete;
  StudyRecord& operator=(StudyRecord const&) = delete;
  ~StudyRecord() { close(); }

  std::vector<std::optional<Outcome>> const& found() const { return content_.outcomes; }  ///< outcomes when opened
  bool torn() const { return content_.torn; }

  /// Appends the outcome of a point.
  /// \throws IoError if the system refuses the bytes, for example if the disk is full. The record then ends with the
  /// previous line.
  void append(std::size_t point, Outcome const& outcome) {
    RecordChain const before = content_.chain;
    try {
      write(content_.chain.line(record_text(point, outcome)));
    } catch (...) {
      content_.chain = before;
      throw;
    }
    if (Clock::now() - synced_ < std::chrono::milliseconds(100)) return;
    if (::fsync(file_) != 0 && errno != EINVAL) fail("is written, but not synchronised to the disk");
    unsynced_ = false;
    synced_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[noreturn, gnu::cold]] void fail(std::string const& what, int reason = errno) const {
    throw IoError("file.write",
                  {"file \"", ErrorObject{kind_.file}, "\" ", what, ": ", std::generic_category().message(reason)});
  }

  void open() {
    namespace fs = std::filesystem;
    fs::path const path = kind_.file;
    if (!path.has_filename())
      throw IoError("file.name", {"file \"", ErrorObject{kind_.file}, "\": the path has no file name. Append one."});
    std::error_code reason;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), reason);
    if (reason) fail("has a folder that cannot be created", reason.value());
    if (fs::exists(path, reason) && !fs::is_regular_file(path, reason))
      throw IoError("file.write",
                    {"file \"", ErrorObject{kind_.file}, "\" exists and is not a regular file. Choose another name."});
    existed_ = fs::exists(path, reason);
    do {
      close();
      file_ = ::open(kind_.file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
      if (file_ < 0) fail("cannot be opened for writing");
      if (::flock(file_, LOCK_EX | LOCK_NB) != 0) refuse_lock(errno);
    } while (!is_in_place());
  }

  [[noreturn, gnu::cold]] void refuse_lock(int why) {
    ::close(std::exchange(file_, -1));
    if (why != EWOULDBLOCK) fail("cannot be locked", why);
    throw IoError("file.locked",
                  {"file \"", ErrorObject{kind_.file},
                   "\" is written by another run of the study. Wait until that ends, or choose another file."});
  }

  /// Returns true if the open file still has its name. Another run removes the file that it created if it has written
  /// no line.
  bool is_in_place() const {
    struct stat here = {}, named = {};
    return ::fstat(file_, &here) == 0 && ::stat(kind_.file.c_str(), &named) == 0 && here.st_ino == named.st_ino &&
           here.st_dev == named.st_dev;
  }

  std::string bytes() const {
    std::string all;
    char block[1 << 16];
    for (ssize_t got = 0; (got = ::pread(file_, block, sizeof block, off_t(all.size()))) != 0;) {
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail("cannot be read");
      all.append(block, std::size_t(got));
    }
    return all;
  }

  void write(std::string const& line) {
    unsynced_ = true;
    off_t const before = ::lseek(file_, 0, SEEK_END);
    for (std::size_t done = 0; done < line.size();) {
      ssize_t const got = ::write(file_, line.data() + done, line.size() - done);
      if (got >= 0) {
        done += std::size_t(got);
      } else if (int const why = errno; why != EINTR) {
        if (::ftruncate(file_, before) != 0) fail("cannot be written, and ends with a part of a line", why);
        fail("cannot be written", why);
      }
    }
  }

  /// Closes the file. Removes it if this run created it and it is empty.
  void close() noexcept {
    if (file_ < 0) return;
    struct stat status = {};
    if (!existed_ && ::fstat(file_, &status) == 0 && status.st_size == 0 && is_in_place()) ::unlink(kind_.file.c_str());
    if (unsynced_) ::fsync(file_);
    ::close(std::exchange(file_, -1));
  }

  RecordKind kind_;
  int file_ = -1;
  bool existed_ = false, unsynced_ = false;
  RecordContent content_;
  Clock::time_point synced_ = Clock::now();
};

}  // namespace polybody::detail
