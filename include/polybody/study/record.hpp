#pragma once
/// \file
/// The file to which a study appends each finished point. Needs POSIX.
///
/// Not in polybody.hpp: it comes with study/study.hpp.

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

/// The record of one study, locked for this process as long as it is open. A line goes to the system in one piece, so a
/// killed process loses nothing that it has finished; to the disk it goes as soon as a tenth of a second has passed
/// since the last time, so a machine that loses its power loses that and what the disk had not got. Not for several
/// threads.
class StudyRecord {
 public:
  /// Opens or begins the record, drops what a killed run has left torn. \throws IoError with the file, and the line
  /// where there is one, if its folder or the file cannot be made, another process has it, or it is refused
  /// (`record_content`); what was there is then left as it is.
  explicit StudyRecord(RecordKind kind) : kind_(std::move(kind)) {
    open();
    try {
      content_ = record_content(kind_, bytes());
      if (content_.torn && ::ftruncate(file_, off_t(content_.whole)) != 0) fail("cannot be cut after its last line");
      if (content_.whole == 0) write(head_text(kind_, content_.chain));
    } catch (...) {
      close();
      throw;
    }
  }
  StudyRecord(StudyRecord const&) = delete;
  StudyRecord& operator=(StudyRecord const&) = delete;
  ~StudyRecord() { close(); }

  std::vector<std::optional<Outcome>> const& found() const { return content_.outcomes; }  ///< when it was opened
  bool torn() const { return content_.torn; }

  /// \throws IoError if the system refuses the bytes (a full disk, for one); the record then ends with the line before.
  void append(std::size_t point, Outcome const& outcome) {
    RecordChain const before = content_.chain;
    try {
      write(content_.chain.line(record_text(point, outcome)));
    } catch (...) {
      content_.chain = before;
      throw;
    }
    if (Clock::now() - synced_ < std::chrono::milliseconds(100)) return;
    if (::fsync(file_) != 0 && errno != EINVAL) fail("is written, but the disk did not take it");
    unsynced_ = false;
    synced_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[noreturn, gnu::cold]] void fail(std::string const& what, int reason = errno) const {
    throw IoError{"file '", kind_.file, "' ", what, ": ", std::generic_category().message(reason)};
  }

  void open() {
    namespace fs = std::filesystem;
    fs::path const path = kind_.file;
    if (!path.has_filename()) throw IoError{"file '", kind_.file, "': the name of a file is missing"};
    std::error_code reason;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), reason);
    if (reason) fail("has a folder that cannot be created", reason.value());
    if (fs::exists(path, reason) && !fs::is_regular_file(path, reason))
      throw IoError{"file '", kind_.file, "' exists and is not a regular file; choose another name"};
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
    throw IoError{"file '", kind_.file,
                  "' is written by another run of the study. Wait until that ends, or choose another file"};
  }

  /// Whether the open file still has its name: a run that could write no line removes the file that it began.
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

  /// A file of ours in which nothing stands is removed.
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
