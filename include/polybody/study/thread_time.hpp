#pragma once
/// \file
/// The processor time of one thread: what a point costs beside others that run at the same time. Needs POSIX.
///
/// Not in polybody.hpp: of use to studies only.

#include <ctime>

namespace polybody {

/// Seconds of processor time that the calling thread has taken so far; std::clock adds those of all threads up.
inline double thread_seconds() {
  timespec now = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace polybody
