#pragma once
/// \file
/// Studies distributed over the ranks of MPI. `mpirun -np 4 program` starts a program on four ranks. Rank 0 distributes
/// the points to free ranks, computes points itself, and writes the record. The format of the record is that of a run
/// with threads. A run over ranks can therefore continue the record of a run with threads, and vice versa. If a rank
/// dies, mpirun ends all ranks, and the next run continues the record.
///
/// Requires MPI: mpi.h and the MPI library. In CMake: `find_package(MPI REQUIRED COMPONENTS CXX)` and
/// `target_link_libraries(program PRIVATE MPI::MPI_CXX)`.

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

#include <polybody/math/errors.hpp>
#include <polybody/study/study.hpp>

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

/// Text of the results, which rank 0 sends to all other ranks at the end: counts, and a line for each finished point.
template <class = void>  // compiled where it is used
std::string text_of(StudyResults const& results) {
  std::string text = std::to_string(results.resumed) + (results.torn ? " 1\n" : " 0\n");
  for (std::size_t i = 0; i < results.outcomes.size(); ++i)
    if (results.outcomes[i]) text += record_text(i, *results.outcomes[i]) + '\n';
  return text;
}

template <class = void>
StudyResults results_in(std::string_view text, Study const& study) {
  std::vector<std::optional<Outcome>> outcomes(study.points().size());
  std::string const head(text.substr(0, text.find('\n')));
  text.remove_prefix(head.size() + 1);
  for (std::size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1))
    if (auto one = outcome_in(text.substr(0, end), outcomes.size(), study.outputs().size()))
      outcomes[one->first] = std::move(one->second);
  return study.results(std::move(outcomes), std::stoul(head), head.ends_with('1'));
}

/// Distributes points from rank 0 until every other rank has the message that no points are left.
template <class = void>
void give_points(MpiRanks const& ranks, Study const& study, StudyQueue& queue) {
  for (int working = ranks.size() - 1; working > 0;) {
    RankMessage const message = receive();
    if (message.tag == RankTag::stops)
      queue.stop(std::make_exception_ptr(Error{"study: rank ", message.from, ": ", message.text}));
    else if (auto outcome = outcome_in(message.text, study.points().size(), study.outputs().size()))
      queue.finish(outcome->first, std::move(outcome->second));
    auto const next = queue.next();
    send(message.from, next ? RankTag::point : RankTag::no_more, next ? std::to_string(*next) : "");
    if (!next) --working;
  }
}

/// Computes points on a rank other than 0. An exception of f that is not a failure of the point ends the study.
template <class F>
StudyResults work_for_first(Study const& study, F const& f, StudyOptions const& options) {
  std::exception_ptr own;
  send(0, RankTag::asks, "");
  RankMessage message = receive();
  for (; message.tag == RankTag::point || message.tag == RankTag::no_more; message = receive()) {
    if (message.tag == RankTag::no_more) continue;
    std::size_t const i = std::stoul(message.text);
    try {
      send(0, RankTag::asks, record_text(i, outcome_of(f, study.points()[i], study.outputs(), options)));
    } catch (std::exception const& error) {
      own = std::current_exception();
      send(0, RankTag::stops, error.what());
    } catch (...) {
      own = std::current_exception();
      send(0, RankTag::stops, "an exception that is not derived from std::exception");
    }
  }
  if (own) std::rethrow_exception(own);
  if (message.tag == RankTag::refused) throw IoError("study.rank", {message.text});
  return results_in(message.text, study);
}

/// Part of a run on rank 0: writes the record, distributes points, and computes points in a second thread. Only the
/// first thread calls MPI.
template <class F>
StudyResults run_first(MpiRanks const& ranks, Study const& study, F const& f, StudyOptions const& options) {
  StudyRecord record(study.kind());
  StudyQueue queue(record, options, study.label());
  std::thread own(
      [&] { queue.work([&](std::size_t i) { return outcome_of(f, study.points()[i], study.outputs(), options); }); });
  give_points(ranks, study, queue);
  own.join();
  queue.rethrow();
  return study.results(queue.take(), study.points().size() - queue.left(), record.torn());
}

/// Checks that all ranks have the same study: the checksums of all ranks must be equal.
template <class = void>
void require_same_study(Study const& study) {
  std::string all;
  for (std::string const& line : study.kind().head) all += line + '\n';
  unsigned long long const own = checksum(all + study.kind().file);
  unsigned long long least = 0, most = 0;
  MPI_Allreduce(&own, &least, 1, MPI_UNSIGNED_LONG_LONG, MPI_MIN, MPI_COMM_WORLD);
  MPI_Allreduce(&own, &most, 1, MPI_UNSIGNED_LONG_LONG, MPI_MAX, MPI_COMM_WORLD);
  if (least != most)
    throw InvalidInput("study.ranks_differ",
                       {"study \"", ErrorObject{study.kind().file},
                        "\": the ranks have different studies. Start all ranks with the same program and options."});
}

}  // namespace detail

/// Runs a study like `study.run(f, options)`, distributed over all ranks. All ranks must call this function. All ranks
/// get the results, or an exception. A rank on which f threw gets the original exception. If f threw on another rank
/// than rank 0, then rank 0 gets an Error that names this rank. The other ranks get an IoError with the message of rank
/// 0. If there is only one rank, this function calls `study.run`, which uses threads.
template <class F>
StudyResults run_over_ranks(MpiRanks const& ranks, Study const& study, F const& f, StudyOptions const& options = {}) {
  if (ranks.size() == 1) return study.run(f, options);
  detail::check(options);
  detail::require_same_study(study);
  if (!ranks.first()) return detail::work_for_first(study, f, options);
  auto const tell = [&](detail::RankTag tag, std::string const& text) {
    for (int to = 1; to < ranks.size(); ++to) detail::send(to, tag, text);
  };
  try {
    StudyResults results = detail::run_first(ranks, study, f, options);
    tell(detail::RankTag::found, detail::text_of(results));
    return results;
  } catch (std::exception const& error) {
    tell(detail::RankTag::refused, error.what());
    throw;
  } catch (...) {
    tell(detail::RankTag::refused, "an exception that is not derived from std::exception");
    throw;
  }
}

}  // namespace polybody
