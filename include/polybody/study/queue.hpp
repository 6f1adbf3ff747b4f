#pragma once
/// \file
/// Record file of a study, and the queue of its unfinished points, which all threads share.

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <system_error>

#include <polybody/io/progress.hpp>
#include <polybody/study/record_lines.hpp>

namespace polybody::detail {

// Record of a study: a file to which the study appends each finished point. The reader of a record distinguishes
// complete lines, the incomplete line of a killed run, and invalid content. Needs POSIX.

/// Identity of the study to which a record must belong.
struct RecordKind {
  std::string file;               ///< name of the file, for messages
  std::vector<std::string> head;  ///< lines of the head, from `record_head`
  std::size_t points = 0, outputs = 0;
};

/// Content of a record.
struct RecordContent {
  std::vector<std::optional<Outcome>> outcomes{};  ///< outcomes of all points
  std::size_t whole = 0;                           ///< size up to the end of the last complete line [bytes]; 0: no head
  bool torn = false;                               ///< true: an incomplete line follows
  RecordChain chain{};                             ///< state of the chain after the last complete line
};

[[noreturn, gnu::cold]] inline void refuse_record(RecordKind const& kind, std::size_t line, std::string const& why) {
  throw IoError("file.content", {"file \"", ErrorObject{kind.file}, "\", line ", line, ": ", why});
}

/// Text of the head of a record, with checksums.
template <class = void>
std::string head_text(RecordKind const& kind, RecordChain& chain) {
  std::string text;
  for (std::string const& line : kind.head) text += chain.line(line);
  return text;
}

template <class = void>
void require_head_line(RecordKind const& kind, std::size_t line, std::string const& text) {
  std::string const& ours = kind.head[line - 1];
  if (text == ours) return;
  if (line == 1) refuse_record(kind, line, "the line is \"" + text + "\", but this program expects \"" + ours + "\"");
  refuse_record(kind, line,
                "the record belongs to another study: it has \"" + text + "\", but this study has \"" + ours +
                    "\". Use another file for this study, or remove the old file");
}

/// Stores the outcome of a line. A failed point may occur again if a later run has computed it again.
template <class = void>
void take_outcome(RecordKind const& kind, std::size_t line, std::string const& text, RecordContent& content) {
  auto found = outcome_in(text, kind.points, kind.outputs);
  if (!found) refuse_record(kind, line, "\"" + text + "\" is not an outcome of this study");
  std::optional<Outcome>& place = content.outcomes[found->first];
  if (place && !place->failed()) refuse_record(kind, line, "point " + std::to_string(found->first) + " occurs twice");
  place = std::move(found->second);
}

/// Reads the `bytes` of a record. The last line, or the head, may be incomplete after a killed run.
/// \throws IoError with file and line for damage, another study, or a file that is not a record.
template <class = void>
RecordContent record_content(RecordKind const& kind, std::string_view bytes) {
  RecordContent content{.outcomes = std::vector<std::optional<Outcome>>(kind.points)};
  RecordChain at_start;
  std::string const head = head_text(kind, at_start);
  if (bytes.size() < head.size() && std::string_view(head).starts_with(bytes)) {
    content.torn = !bytes.empty();
    return content;
  }
  std::size_t line = 0;
  for (std::size_t end; (end = bytes.find('\n', content.whole)) != bytes.npos; content.whole = end + 1) {
    ++line;
    auto const text = content.chain.text(bytes.substr(content.whole, end - content.whole));
    if (!text && line == 1)
      refuse_record(kind, line, "the file is not a record of a study, or its first line is damaged");
    if (!text)
      refuse_record(
          kind, line,
          "the line is damaged, or a previous line is missing: the checksum is wrong. Remove the file to start "
          "the study again, or restore an undamaged copy");
    if (line <= kind.head.size())
      require_head_line(kind, line, *text);
    else
      take_outcome(kind, line, *text, content);
  }
  if (line < kind.head.size())
    refuse_record(kind, line + 1, "the file is not a record of this study: its head is incomplete");
  content.torn = content.whole < bytes.size();
  return content;
}

/// Record of one study, locked by this process while it is open. Each line is written to the operating system at once,
/// so a killed process loses no finished point. A line is synchronised to the disk (fsync) if the last synchronisation
/// is at least 0.1 s ago. A loss of power can therefore lose the lines since the last synchronisation, and lines that
/// the disk has not stored. Not thread-safe.
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
  /// \throws IoError if the line cannot be written, for example if the disk is full. The record then ends with the
  /// previous line. IoError is also thrown if the line is written, but cannot be synchronised to the disk.
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
                   "\" is written by another run of the study. Wait until this run ends, or choose another file."});
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

namespace polybody {

/// Options for running a study.
struct StudyOptions {
  int threads = 1;  ///< number of threads; no effect with several ranks, each of which computes one point at a time
  bool retry_failed = false;  ///< computes points again that failed in an earlier run
  bool progress = true;       ///< shows a bar with the remaining time if stderr is a terminal
  /// Wall-clock time limit of a point [s]; zero: no limit. A point that exceeds it is recorded as failed, and the study
  /// continues. With a limit, each point is computed in a separate process. Changes that the function makes to
  /// variables are then lost, and a crash is a failure of one point only.
  double time_limit = 0.0;
};

namespace detail {

/// Thread-safe queue that distributes points in the order of the table. Outcomes are recorded in the order in which the
/// points finish.
class StudyQueue {
 public:
  StudyQueue(StudyRecord& record, StudyOptions const& options, std::string const& label)
      : record_(record), outcomes_(record.found()) {
    for (std::size_t i = 0; i < outcomes_.size(); ++i)
      if (!outcomes_[i] || (options.retry_failed && outcomes_[i]->failed())) left_.push_back(i);
    if (options.progress && !left_.empty()) progress_.emplace(0.0, double(left_.size()), label);
  }

  std::size_t left() const { return left_.size(); }  ///< number of points that this run must compute

  /// Returns the next point, or nothing if all are distributed or the study is stopped.
  std::optional<std::size_t> next() {
    std::lock_guard const lock(mutex_);
    if (error_ || given_ == left_.size()) return std::nullopt;
    return left_[given_++];
  }

  /// Records the outcome of a point. The study stops if the record cannot be written.
  void finish(std::size_t point, Outcome outcome) {
    std::lock_guard const lock(mutex_);
    try {
      record_.append(point, outcome);
      outcomes_[point] = std::move(outcome);
      if (progress_) progress_->update(double(++finished_));
    } catch (...) {
      if (!error_) error_ = std::current_exception();
    }
  }

  /// Stops the distribution of points. `rethrow` throws `why` of the first stop.
  void stop(std::exception_ptr why) {
    std::lock_guard const lock(mutex_);
    if (!error_) error_ = std::move(why);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

  /// Computes points until none is left: `outcome(i)` returns the outcome of point i.
  template <class F>
  void work(F const& outcome) {
    try {
      while (auto const point = next()) finish(*point, outcome(*point));
    } catch (...) {
      stop(std::current_exception());
    }
  }

  std::vector<std::optional<Outcome>> take() {
    if (progress_) progress_->finish();
    return std::move(outcomes_);
  }

 private:
  StudyRecord& record_;
  std::vector<std::optional<Outcome>> outcomes_;
  std::vector<std::size_t> left_{};
  std::size_t given_ = 0, finished_ = 0;
  std::optional<Progress> progress_{};
  std::exception_ptr error_{};
  std::mutex mutex_{};
};

}  // namespace detail

}  // namespace polybody
