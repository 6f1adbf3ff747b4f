#pragma once
/// \file
/// Parameter studies on several threads, with records that survive an interruption, and checkpoints of runs. For
/// studies on several processes see study/mpi.hpp. Requires POSIX.

#include <polybody/io/checkpoint.hpp>
#include <polybody/io/state_table.hpp>
#include <polybody/study/grid.hpp>
#include <polybody/study/limited_point.hpp>
#include <polybody/study/report.hpp>
#include <polybody/study/sampling.hpp>
#include <polybody/study/study.hpp>
