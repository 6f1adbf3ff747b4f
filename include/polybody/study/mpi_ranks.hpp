#pragma once
/// \file
/// The ranks of a program under MPI. Needs mpi.h and a library: in CMake, `find_package(MPI REQUIRED COMPONENTS CXX)`
/// and `target_link_libraries(program PRIVATE MPI::MPI_CXX)`.
///
/// Not in polybody.hpp: it needs MPI.

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

#include <polybody/math/errors.hpp>

namespace polybody {

/// MPI from here to the end of its scope: one at the beginning of main, outside of its `try`. A program that is started
/// without mpirun has one rank.
class MpiRanks {
 public:
  /// Takes those of `main`, argc and argv. \throws Error where MPI does not start.
  MpiRanks(int& argc, char**& argv) {
    int ready = 0, threads = 0;
    MPI_Initialized(&ready);
    if (ready == 0) {
      if (MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads) != MPI_SUCCESS)
        throw Error{"MPI does not start. Is its mpirun that of the library this program is linked to?"};
      own_ = true;
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  MpiRanks(MpiRanks const&) = delete;
  MpiRanks& operator=(MpiRanks const&) = delete;
  ~MpiRanks() {
    if (own_) MPI_Finalize();
  }

  int rank() const { return rank_; }         ///< of this process, from 0
  int size() const { return size_; }         ///< how many there are
  bool first() const { return rank_ == 0; }  ///< the one that records, and writes what all have found

  /// Ends the ranks with `code`, for an error that one alone has met outside of `run_over_ranks`: the others wait for
  /// it.
  [[noreturn]] void abort(int code = 1) const {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
  }

 private:
  bool own_ = false;
  int rank_ = 0, size_ = 1;
};

namespace detail {

/// What a message means. A worker asks for a point, with the outcome of its last one, or stops the study with an error;
/// the answer is a point or that there are no more. When all have ended the first rank tells each what was found, or
/// why nothing was.
enum class RankTag : int { asks = 1, stops, point, no_more, found, refused };

/// A text from another rank.
struct RankMessage {
  int from = 0;
  RankTag tag = RankTag::asks;
  std::string text;
};

/// \throws InvalidInput for a text of more than 2 GB, which MPI does not take.
template <class = void>  // compiled where it is used
void send(int to, RankTag tag, std::string const& text) {
  if (text.size() > std::size_t(std::numeric_limits<int>::max()))
    throw InvalidInput{"study: ", text.size(), " bytes are too many for one message to another rank."};
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, static_cast<int>(tag), MPI_COMM_WORLD);
}

/// The next message from any rank. Looks for it up to every two milliseconds, as waiting inside MPI takes a whole core.
template <class = void>
RankMessage receive() {
  MPI_Status status;
  std::chrono::microseconds pause(20);
  for (int there = 0;; pause = std::min(2 * pause, std::chrono::microseconds(2000))) {
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there != 0) break;
    std::this_thread::sleep_for(pause);
  }
  int length = 0;
  MPI_Get_count(&status, MPI_CHAR, &length);
  RankMessage message{status.MPI_SOURCE, RankTag(status.MPI_TAG), std::string(static_cast<std::size_t>(length), '\0')};
  MPI_Recv(message.text.data(), length, MPI_CHAR, message.from, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return message;
}

}  // namespace detail

}  // namespace polybody
