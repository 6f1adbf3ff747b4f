#pragma once
// Ranks of MPI, or one rank if the program is built without MPI. The source of a study is the same in both cases.
#include <polybody/study/study.hpp>

#ifdef POLYBODY_WITH_MPI
#include <polybody/study/mpi.hpp>

using Ranks = polybody::MpiRanks;
#else
struct Ranks {
  Ranks(int, char**) {}
  static bool first() { return true; }
};

template <class F>
polybody::StudyResults run_over_ranks(Ranks const&, polybody::Study const& study, F const& f,
                                      polybody::StudyOptions const& options) {
  return study.run(f, options);
}
#endif
