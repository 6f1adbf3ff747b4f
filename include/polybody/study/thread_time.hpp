#pragma once
/// \file
/// Processor time of one thread: the computing time of a point of a study, even if other threads compute other points
/// at the same time. Needs POSIX.

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
