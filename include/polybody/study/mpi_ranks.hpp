#pragma once
/// \file
/// Ranks of a program under MPI. Needs mpi.h and the MPI library. In CMake: `find_package(MPI REQUIRED COMPONENTS CXX)`
/// and `target_link_libraries(program PRIVATE MPI::MPI_CXX)`.
///
/// Requires MPI.

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

#include <polybody/math/errors.hpp>

namespace polybody {

/// Initialises MPI; the destructor finalises MPI. A program creates one object of this type, at the beginning of main
/// and outside of a `try` block. A program that is started without mpirun has one rank.
class MpiRanks {
 public:
  /// Starts MPI with the arguments argc and argv of `main`.
  /// \throws Error if MPI does not start.
  MpiRanks(int& argc, char**& argv) {
    int ready = 0, threads = 0;
    MPI_Initialized(&ready);
    if (ready == 0) {
      if (MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads) != MPI_SUCCESS)
        throw Error("study.mpi", {"MPI does not start. Use the mpirun of the library that this program is linked to."});
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

  int rank() const { return rank_; }         ///< rank of this process, from 0
  int size() const { return size_; }         ///< number of ranks
  bool first() const { return rank_ == 0; }  ///< true for rank 0, which records and writes the results

  /// Ends all ranks with exit `code`. Needed after an error that occurs outside of `run_over_ranks` on one rank only,
  /// because the other ranks wait for this rank.
  [[noreturn]] void abort(int code = 1) const {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
  }

 private:
  bool own_ = false;
  int rank_ = 0, size_ = 1;
};

namespace detail {

/// Type of a message. A rank other than 0 requests a point and sends the outcome of its previous point (`asks`), or
/// stops the study because of an error (`stops`). Rank 0 answers with a point, or with `no_more`. At the end rank 0
/// sends the results to all other ranks (`found`), or the reason of a failure (`refused`).
enum class RankTag : int { asks = 1, stops, point, no_more, found, refused };

/// Text from another rank.
struct RankMessage {
  int from = 0;
  RankTag tag = RankTag::asks;
  std::string text;
};

/// Sends a text with a `tag` to the rank `to`.
/// \throws InvalidInput for a text of 2 GiB or more, which exceeds the limit of MPI.
template <class = void>  // compiled where it is used
void send(int to, RankTag tag, std::string const& text) {
  if (text.size() > std::size_t(std::numeric_limits<int>::max()))
    throw InvalidInput("study.message_size", {"study: ", ErrorValue{text.size()},
                                              " bytes are too many for one message to another rank; the limit is ",
                                              std::numeric_limits<int>::max(), " bytes."});
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, static_cast<int>(tag), MPI_COMM_WORLD);
}

/// Receives the next message from any rank. Polls at intervals of up to 2 ms, because waiting inside MPI occupies a
/// core.
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
