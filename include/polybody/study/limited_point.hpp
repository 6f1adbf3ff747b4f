#pragma once
/// \file
/// Computation of a study's point in a separate process with a time limit, and the processor time of one thread. Needs
/// POSIX.

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <ctime>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Processor time of the calling thread so far [s]. In contrast, std::clock adds the times of all threads.
inline double thread_seconds() {
  timespec now = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace polybody

#if __has_include(<sys/prctl.h>)
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>

#include <polybody/study/record_lines.hpp>

namespace polybody::detail {

/// Child process that computes one point, with a pipe for its answer. The destructor kills the process.
class PointProcess {
 public:
  /// Starts the process. The process sends the text that `answer` returns.
  /// \throws Error if the operating system cannot create another process.
  template <class F>
  explicit PointProcess(F const& answer) {
    static std::mutex one_at_a_time;  // otherwise a process that another thread starts inherits the pipe
    std::unique_lock lock(one_at_a_time);
    int ends[2];
    if (::pipe(ends) != 0) fail("pipes");
    for (int const end : ends) (void)::fcntl(end, F_SETFD, FD_CLOEXEC);
    std::fflush(stdout);
    process_ = ::fork();
    if (process_ < 0) {
      int const why = errno;
      ::close(ends[0]);
      ::close(ends[1]);
      fail("processes", why);
    }
    if (process_ == 0) {
      lock.unlock();
      ::close(ends[0]);
      send(ends[1], answer());
    }
    ::close(ends[1]);
    pipe_ = ends[0];
  }
  PointProcess(PointProcess const&) = delete;
  PointProcess& operator=(PointProcess const&) = delete;
  ~PointProcess() {
    if (process_ > 0) (void)end();
    if (pipe_ >= 0) ::close(pipe_);
  }

  /// Returns the answer of the process, or nothing if the answer is not complete within `limit` [s].
  std::optional<std::string> answer(double limit) {
    using Clock = std::chrono::steady_clock;
    auto const began = Clock::now();
    std::string text;
    for (char block[4096];;) {
      double const left = limit - std::chrono::duration<double>(Clock::now() - began).count();
      if (left <= 0.0) return std::nullopt;
      pollfd ready{pipe_, POLLIN, 0};
      int const ms = static_cast<int>(std::min(1e3 * left + 1.0, 1e6));
      if (::poll(&ready, 1, ms) <= 0) continue;
      ssize_t const got = ::read(pipe_, block, sizeof block);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return text;
      text.append(block, std::size_t(got));
    }
  }
  /// Kills the process. Returns the number of the signal that ended the process, or zero if the process ended by
  /// itself.
  int end() {
    (void)::kill(process_, SIGKILL);
    return wait();
  }
  /// Waits until the process ends. Returns the number of the signal that ended the process, or zero.
  int wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  [[noreturn, gnu::cold]] static void fail(char const* what, int why = errno) {
    throw Error("study.process", {"study: the operating system has no more ", ErrorObject{what},
                                  " for a point with a time limit: ", std::strerror(why), ". Use fewer threads."});
  }
  /// Sends the answer and ends the process of the point, without the exit handlers of the program.
  [[noreturn]] static void send(int pipe, std::string const& text) {
    for (std::size_t done = 0; done < text.size();) {
      ssize_t const got = ::write(pipe, text.data() + done, text.size() - done);
      if (got > 0) done += std::size_t(got);
      if (got < 0 && errno != EINTR) break;
    }
    std::fflush(stdout);
    ::_exit(0);
  }

  pid_t process_ = 0;
  int pipe_ = -1;
};

/// Outcome of `found()`, computed in a separate process. The outcome is a failure if the process crashes, ends without
/// a result, or does not end within `limit` [s].
/// \throws StudyUsageError if `found` throws it; Error with the message of another exception of `found`, or if the
/// operating system cannot create another process.
template <class F>
Outcome outcome_within(double limit, std::size_t outputs, F const& found) {
  pid_t const parent = ::getpid();
  PointProcess process([&]() -> std::string {
#ifdef PR_SET_PDEATHSIG
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (::getppid() != parent) ::_exit(1);
    try {
      return "o" + record_text(0, found()) + '\n';
    } catch (StudyUsageError const& error) {
      return std::string("m") + error.what() + '\n';
    } catch (std::exception const& error) {
      return std::string("e") + error.what() + '\n';
    } catch (...) {
      return "ean exception that is not derived from std::exception\n";
    }
  });
  std::optional<std::string> text = process.answer(limit);
  if (!text) {
    (void)process.end();
    return {{}, sentence_of({"The computation has not ended within the time limit of ", limit, " s."})};
  }
  int const signal = process.wait();
  if (!text->ends_with('\n'))
    return {{},
            sentence_of({"The process of the point ended without a result", signal != 0 ? ", by signal " : "",
                         signal != 0 ? std::to_string(signal) : "", "."})};
  text->pop_back();
  std::string const rest = text->substr(1);
  if (text->front() == 'm') throw StudyUsageError("study.point", {rest});
  if (text->front() == 'e') throw Error("study.point", {rest});
  return outcome_in(rest, 1, outputs).value().second;
}

}  // namespace polybody::detail
