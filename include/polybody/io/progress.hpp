#pragma once
/// \file
/// Progress bar with the remaining time, on the terminal.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

#include <polybody/math/errors.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Returns true if std::cerr is a terminal; false on systems without isatty.
inline bool stderr_is_terminal() {
#if __has_include(<unistd.h>)
  return ::isatty(STDERR_FILENO) == 1;
#else
  return false;
#endif
}

/// Progress bar of a run, on one line of at most 79 characters that is redrawn in place:
///
///     pendulum  42% [==============>                   ]  0:00:21  ETA 0:00:29
///
/// Nothing is drawn if stderr is not a terminal. Not thread-safe.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< returns a time [s] that never decreases, from any origin

  /// Progress bar with this `label` from `start` to `end`, in the unit of the argument of `update`, such as simulated
  /// time [s]. `start` may be greater than `end`. Throws InvalidInput if `start` or `end` is not finite.
  Progress(double start, double end, std::string label = "")
      : Progress(start, end, std::move(label), std::cerr, stderr_is_terminal(), steady_seconds) {}

  /// Progress bar with this `label` from `start` to `end`, drawn on the stream `out`. `clock` measures the elapsed
  /// time. The bar is drawn only if `terminal` is true.
  Progress(double start, double end, std::string label, std::ostream& out, bool terminal, Clock clock = steady_seconds)
      : start_(start),
        end_(end),
        label_(shortened(std::move(label))),
        out_(out),
        terminal_(terminal),
        clock_(std::move(clock)) {
    if (!std::isfinite(start) || !std::isfinite(end))
      throw InvalidInput("value.not_finite", {"progress \"", ErrorObject{label_},
                                              "\": start and end must be finite, but are ", start, " and ", end, "."});
    if (terminal_) began_ = clock_();
  }

  Progress(Progress const&) = delete;
  Progress& operator=(Progress const&) = delete;

  /// Draws the last progress and ends the line, so that the next output begins on a new line.
  ~Progress() {
    try {
      end_line();
    } catch (...) {  // NOLINT(bugprone-empty-catch): a stream may throw; a lost bar must not end the program
    }
  }

  /// Sets the progress to `now`. The bar is redrawn at most ten times a second.
  void update(double now) {
    if (!terminal_ || std::isnan(now)) return;
    done_ = end_ == start_ ? 1.0 : std::clamp((now - start_) / (end_ - start_), 0.0, 1.0);
    double const seconds = clock_();
    if (drawn_ && seconds - last_drawn_ < 0.1) return;
    draw(seconds);
  }

  /// Draws 100 % and ends the line. Later calls have no effect.
  void finish() {
    done_ = 1.0;
    drawn_ = true;
    end_line();
  }

 private:
  static constexpr std::size_t line_width = 79, label_width = 24;

  static double steady_seconds() {
    using Seconds = std::chrono::duration<double>;
    return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  /// Formats a time in seconds as h:mm:ss.
  static std::string h_mm_ss(double seconds) {
    if (!(seconds < 3.6e6)) return ">999:59:59";
    auto const full = static_cast<unsigned>(std::max(0.0, seconds));
    char text[32];
    std::snprintf(text, sizeof text, "%u:%02u:%02u", full / 3600, full / 60 % 60, full % 60);
    return text;
  }

  static bool begins_sign(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }  // UTF-8

  static std::size_t width(std::string const& text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, begins_sign));
  }

  static std::string shortened(std::string text) {
    std::ranges::replace_if(text, [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
    while (width(text) > label_width) text.pop_back();  // removes the last UTF-8 character byte by byte
    return text;
  }

  void draw(double seconds) {
    double const elapsed = seconds - began_;
    std::string const left = done_ > 0 ? h_mm_ss(std::round(elapsed / done_ - elapsed)) : "-:--:--";
    char percent[8];
    std::snprintf(percent, sizeof percent, "%3d%%", static_cast<int>(100 * done_ + 1e-9));
    std::string const head = (label_.empty() ? "" : label_ + ' ') + percent + " [";
    std::string const tail = "]  " + h_mm_ss(elapsed) + "  ETA " + left;
    std::size_t const room = line_width - width(head) - tail.size();
    std::string bar(static_cast<std::size_t>(done_ * static_cast<double>(room)), '=');
    if (bar.size() < room) bar += '>';
    bar.resize(room, ' ');
    out_ << '\r' << head << bar << tail << std::flush;
    last_drawn_ = seconds;
    drawn_ = true;
  }

  void end_line() {
    if (!terminal_ || !drawn_) return;
    terminal_ = false;
    draw(clock_());
    out_ << '\n' << std::flush;
  }

  double start_, end_;
  std::string label_;
  std::ostream& out_;
  bool terminal_;
  Clock clock_;
  double began_ = 0.0, last_drawn_ = 0.0, done_ = 0.0;
  bool drawn_ = false;
};

/// Callback for `RunOptions::progress` that draws a progress bar over the simulated time of a run. The bar begins
/// with the first step and is complete when the run ends:
///
///     simulate(model, x, integrator, {.end_time = 10.0, .step = 1e-3, .progress = progress_bar("pendulum")}).run();
///
/// `make(run)` creates the bar at the first step. Each run needs a separate callback.
template <class Make>
  requires std::is_invocable_r_v<std::unique_ptr<Progress>, Make const&, RunProgress const&>
std::function<void(RunProgress const&)> progress_bar(Make make) {
  return [make = std::move(make), bar = std::shared_ptr<Progress>()](RunProgress const& run) mutable {
    if (!bar) bar = make(run);
    run.done ? bar->finish() : bar->update(run.now);
  };
}
/// Progress bar with this `label` on stderr, drawn if stderr is a terminal.
inline std::function<void(RunProgress const&)> progress_bar(std::string label = "") {
  return progress_bar([label = std::move(label)](RunProgress const& run) {
    return std::make_unique<Progress>(run.start, run.end_time, label);
  });
}

}  // namespace polybody
