#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>
#include <random>

#include <polybody/study/limited_point.hpp>
#include <polybody/study/outcome.hpp>
#include <polybody/study/report.hpp>
#include <polybody/study/sampling.hpp>
#include <polybody/study/study.hpp>

#include "support/refusal.hpp"

namespace fs = std::filesystem;
using namespace polybody;

namespace study_test {

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}
void put(fs::path const& file, std::string_view text) { std::ofstream(file, std::ios::binary) << text; }

StudyOptions with_threads(int threads) { return {.threads = threads, .progress = false}; }

/// Numbers with many digits; the second output differs between calls, like a time. Point 4 of each six fails.
std::array<double, 2> values_at(Point const& p) {
  static std::atomic<int> calls = 0;
  if (p.index() % 6 == 4) throw NewtonConvergenceFailure{"step ", p["step"], "\nis too long"};
  return {std::sqrt(p["stiffness"]) / (3.0 + double(p.choice("integrator"))) + std::sin(p["step"]), double(++calls)};
}

/// In memory if the machine has such a folder: a test with a thousand files would wait for the disk.
fs::path parent() { return ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : testing::TempDir(); }

/// Each test has its own empty folder, and one study.
struct StudyFiles : testing::Test {
  fs::path const folder = parent() / ("polybody study " + std::to_string(std::random_device{}()));
  fs::path const file = folder / "a.study", table = folder / "a.csv";
  Points const points = grid(axis("stiffness", "N/m", {1e6, 1e8, 2.5e9}), formulations("integrator", {"Radau", "a, b"}),
                             axis("step", "s", {1e-2, 1e-3}));
  Study const study = make(points);

  StudyFiles() { fs::create_directories(folder); }
  ~StudyFiles() override { fs::remove_all(folder); }

  Study make(Points const& of, std::string const& about = "a sum of functions") const {
    return {{file, about}, of, outputs("sum [m]", measured("calls"))};
  }
  /// The text of the table, for bitwise comparisons.
  std::string table_of(StudyResults const& found) const {
    write_table(found, table);
    return text_of(table);
  }
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

TEST_F(StudyFiles, TheTableHasAPointInEachLineAndMeasuredOutputsBesideIt) {
  StudyResults const found = study.run(values_at, with_threads(1));
  EXPECT_TRUE(found.complete());
  EXPECT_EQ(found.failed(), 2u);
  std::string const text = table_of(found);
  EXPECT_TRUE(text.starts_with("point,stiffness [N/m],integrator,step [s],sum [m],failure\n0,1e+06,Radau,0.01,"))
      << text;
  EXPECT_TRUE(has(text, "\n4,1e+08,Radau,0.01,,step 0.01 is too long\n"));
  EXPECT_TRUE(has(text, "\n2,1e+06,\"a, b\",0.01,"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 13);
  std::string const all = text_of(folder / "a_measured.csv");
  EXPECT_TRUE(all.starts_with("point,stiffness [N/m],integrator,step [s],sum [m],calls,failure\n")) << all;
  EXPECT_TRUE(has(all, ",1,\n"));  // number of the first call
}

TEST_F(StudyFiles, ManyThreadsGiveTheTableOfOne) {
  std::string const one = table_of(study.run(values_at, with_threads(1)));
  for (int const threads : {2, 3, 8, 1000}) {
    fs::remove(file);
    EXPECT_EQ(table_of(study.run(values_at, with_threads(threads))), one);
  }
}

TEST_F(StudyFiles, AFinishedStudyIsNotRunAgain) {
  std::string const first = table_of(study.run(values_at, with_threads(2))), record = text_of(file);
  StudyResults const again = study.run([](Point const&) -> std::array<double, 2> { throw 1; }, with_threads(2));
  EXPECT_EQ(again.resumed, 12u);
  EXPECT_EQ(table_of(again), first);
  EXPECT_EQ(text_of(file), record);
}

TEST_F(StudyFiles, FailedPointsAreTriedAgainOnDemand) {
  std::string const failing = table_of(study.run(values_at, with_threads(1)));
  std::vector<std::size_t> tried;
  auto const good = [&](Point const& p) {
    tried.push_back(p.index());
    return std::array{1.0, 2.0};
  };
  EXPECT_EQ(table_of(study.run(good, with_threads(1))), failing);
  StudyResults const found = study.run(good, {.retry_failed = true, .progress = false});
  EXPECT_EQ(tried, (std::vector<std::size_t>{4, 10}));
  EXPECT_EQ(found.failed(), 0u);
  EXPECT_EQ(table_of(study.recorded()), table_of(found));  // the later line is used
}

TEST_F(StudyFiles, AnOutputThatIsNotFiniteIsAFailure) {
  Study const one({file}, axis("x", "", {0.0, 1.0}), outputs("1/x [1/m]"));
  StudyResults const found = one.run([](Point const& p) { return 1.0 / p["x"]; }, with_threads(1));
  EXPECT_EQ(found.outcomes[0]->failure, "The output \"1/x [1/m]\" is not finite (inf).");
  EXPECT_EQ(found.outcomes[1]->values, std::vector{1.0});
}

// An exception that is not a failure of a point ends the study; finished points remain.
TEST_F(StudyFiles, OtherExceptionsEndTheStudy) {
  auto const stops_at = [](std::size_t at, auto const& how) {
    return [at, how](Point const& p) {
      if (p.index() == at) how(p);
      return values_at(p);
    };
  };
  EXPECT_THROW(study.run(stops_at(5, [](Point const&) { throw std::bad_alloc(); }), with_threads(1)), std::bad_alloc);
  EXPECT_EQ(study.recorded().finished(), 5u);
  EXPECT_TRUE(has(message_of<StudyUsageError>(
                      [&] { study.run(stops_at(7, [](Point const& p) { p["no such"]; }), with_threads(2)); }),
                  "no column \"no such\""));
  EXPECT_GE(study.recorded().finished(), 7u);
  EXPECT_TRUE(has(message_of<StudyUsageError>([&] { study.run([](Point const&) { return 1.0; }); }),
                  "1 numbers, but the study has 2"));
}

TEST_F(StudyFiles, AProcessThatIsKilledLosesAndRepeatsNothing) {
  Points const many = grid(points, axis("sample", "", linear(0.0, 1.0, 10)));
  std::string const whole = table_of(make(many).run(values_at, with_threads(1)));
  fs::remove(file);
  Study const killed = make(many);
  auto const slow = [](Point const& p) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return values_at(p);
  };
  std::size_t finished = 0;
  for (int kills = 0; finished < many.size() && kills < 30; ++kills) {
    pid_t const child = ::fork();
    if (child == 0) {
      killed.run(slow, with_threads(2));
      std::_Exit(0);
    }
    std::size_t const goal = std::min(finished + 7, many.size());
    for (int i = 0; finished < goal && i < 10000; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (fs::exists(file)) finished = killed.recorded().finished();
    }
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    StudyResults const left = killed.recorded();
    ASSERT_GE(left.finished(), finished);
    finished = left.finished();
  }
  EXPECT_EQ(finished, many.size());
  StudyResults const found = killed.run(values_at, with_threads(2));
  EXPECT_EQ(table_of(found), whole);
  std::string const record = text_of(file);  // a line per point, and the head
  EXPECT_EQ(std::size_t(std::ranges::count(record, '\n')), many.size() + killed.kind().head.size());
}

TEST_F(StudyFiles, ARecordThatIsCutOffAnywhereGoesOn) {
  std::string const whole = table_of(study.run(values_at, with_threads(1))), record = text_of(file);
  std::size_t const head = study.kind().head.size();
  for (std::size_t length = 0; length <= record.size(); ++length) {
    std::string const part = record.substr(0, length);
    put(file, part);
    std::size_t const lines = std::size_t(std::ranges::count(part, '\n'));
    std::atomic<std::size_t> calls = 0;
    StudyResults const found = study.run(
        [&](Point const& p) {
          ++calls;
          return values_at(p);
        },
        with_threads(1));
    ASSERT_EQ(table_of(found), whole) << length;
    ASSERT_EQ(calls, 12 - (lines > head ? lines - head : 0)) << length;
    ASSERT_EQ(found.torn, !part.empty() && (part.back() != '\n' || lines < head)) << length;
  }
}

TEST_F(StudyFiles, AChangedByteIsRefusedWithItsLine) {
  study.run(values_at, with_threads(1));
  std::string const record = text_of(file);
  for (std::size_t at = 0; at + 1 < record.size(); ++at) {
    std::string changed = record;
    changed[at] = char(changed[at] ^ (at % 2 == 0 ? 1 : 0x80));
    put(file, changed);
    std::size_t const line = 1 + std::size_t(std::count(record.begin(), record.begin() + std::ptrdiff_t(at), '\n'));
    std::string const message = message_of<IoError>([&] { study.run(values_at, with_threads(1)); });
    ASSERT_TRUE(has(message, "file \"" + file.string() + "\", line " + std::to_string(line) + ": ")) << at << message;
    ASSERT_EQ(text_of(file), changed);  // unchanged
  }
  std::string cut = record;  // a missing line in the middle
  std::size_t const from = cut.find("\n3: ") + 1;
  put(file, cut.erase(from, cut.find('\n', from) + 1 - from));
  EXPECT_TRUE(has(message_of<IoError>([&] { study.recorded(); }), "a previous line is missing"));
  put(file, record.substr(0, record.size() - 1) + "x");  // the end of the last line is damaged: an incomplete line
  EXPECT_EQ(study.recorded().finished(), 11u);
}

TEST_F(StudyFiles, LinesThatNoStudyWritesAreRefused) {
  detail::RecordKind const kind = study.kind();
  detail::RecordChain chain;
  std::string const head = detail::head_text(kind, chain);
  auto const refused = [&](std::vector<std::string> const& lines) {
    detail::RecordChain after = chain;
    std::string text = head;
    for (std::string const& line : lines) text += after.line(line);
    return message_of<IoError>([&] { detail::record_content(kind, text); });
  };
  for (char const* line : {"12: 1 2", "3: 1", "3: 1 2 3", "3: 1 nan", "3: 1 inf", "3: 1 2x", "3:1 2",
                           "3 failed: ", "3 failed", "-3: 1 2", "x", "", "3: 1e999 2", "3: 1  2", "3"})
    EXPECT_TRUE(has(refused({"1: 1 2", line}), "line " + std::to_string(kind.head.size() + 2) + ": \"" + line)) << line;
  EXPECT_TRUE(has(refused({"1: 1 2", "1: 1 2"}), "point 1 occurs twice"));
  EXPECT_TRUE(has(refused({"1: 1 2", "1 failed: x"}), "point 1 occurs twice"));
}

TEST_F(StudyFiles, TheRecordOfAnotherStudyIsRefused) {
  study.run(values_at, with_threads(1));
  auto const message = [&](Study const& other) {
    return message_of<IoError>([&] { other.run(values_at, with_threads(1)); });
  };
  std::string const record = text_of(file);
  EXPECT_TRUE(has(message(make(points, "another sum")),
                  "line 2: the record belongs to another study: it has \"about: a sum of "
                  "functions\", but this study has \"about: another sum\""));
  Points const other_unit = grid(axis("stiffness", "kN/m", {1e6, 1e8, 2.5e9}),
                                 formulations("integrator", {"Radau", "a, b"}), axis("step", "s", {1e-2, 1e-3}));
  EXPECT_TRUE(has(message(make(other_unit)), "line 3: the record belongs to another study"));
  Points const other_choice = grid(axis("stiffness", "N/m", {1e6, 1e8, 2.5e9}),
                                   formulations("integrator", {"Radau", "HHT"}), axis("step", "s", {1e-2, 1e-3}));
  EXPECT_TRUE(has(message(make(other_choice)), "line 4: "));
  Points const other_value = grid(axis("stiffness", "N/m", {1e6, 1e8, 2.6e9}),
                                  formulations("integrator", {"Radau", "a, b"}), axis("step", "s", {1e-2, 1e-3}));
  EXPECT_TRUE(has(message(make(other_value)), "line 6: "));
  EXPECT_TRUE(has(message({{file, "a sum of functions"}, points, outputs("sum [m]", "calls")}), "line 8: "));
  EXPECT_TRUE(
      has(message({{file, "a sum of functions"}, points, outputs("sum [m]", measured("calls"), "more")}), "line 9: "));
  std::vector<RandomAxis> const random{uniform("stiffness", "", 0.0, 1.0)};
  Study const seed_1({file}, monte_carlo(5, 1, random), outputs("y"));
  Study const seed_2({file}, monte_carlo(5, 2, random), outputs("y"));
  EXPECT_EQ(text_of(file), record);
  fs::remove(file);
  seed_1.run([](Point const& p) { return p["stiffness"]; }, with_threads(1));
  EXPECT_TRUE(has(message_of<IoError>([&] { seed_2.run([](Point const&) { return 1.0; }); }), "seed 2"));
}

TEST_F(StudyFiles, AFileThatIsNoRecordIsLeftAsItIs) {
  for (std::string const text : {"t [s],x [m]\n1,2\n", "a letter", "\n", "polybody study 2\n", "polybody study x"}) {
    put(file, text);
    message_of<IoError>([&] { study.run(values_at, with_threads(1)); });
    EXPECT_EQ(text_of(file), text);
  }
  detail::RecordChain chain;
  put(file, chain.line("polybody study 2"));
  EXPECT_TRUE(has(message_of<IoError>([&] { study.recorded(); }), "line 1: the line is \"polybody study 2\""));
}

TEST_F(StudyFiles, WhatCannotBeWrittenIsRefusedAndLeavesNothing) {
  put(folder / "in the way", "");
  auto const message = [&](fs::path const& name) {
    return message_of<IoError>([&] { Study({name}, points, outputs("a", "b")).run(values_at, with_threads(1)); });
  };
  EXPECT_TRUE(has(message(folder / "in the way" / "a.study"), "has a folder that cannot be created: "));
  EXPECT_TRUE(has(message("/proc/no such folder/a.study"), "has a folder that cannot be created: "));
  EXPECT_TRUE(has(message("/proc/a.study"), "cannot be opened for writing: "));
  EXPECT_TRUE(has(message("/dev/full"), "not a regular file"));
  EXPECT_TRUE(has(message(folder), "not a regular file"));
  EXPECT_TRUE(has(message(folder / ""), "the path has no file name"));
  EXPECT_TRUE(has(message_of<IoError>([&] { study.recorded(); }), "cannot be read"));
  EXPECT_EQ(files(), 1u);
}

// A full disk accepts a part of a line. The record ends with the previous line, and the study continues if space is
// available again.
TEST_F(StudyFiles, AFullDiskLosesTheLineThatItDoesNotTake) {
  std::string const whole = table_of(study.run(values_at, with_threads(1))), record = text_of(file);
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  auto const handler = std::signal(SIGXFSZ, SIG_IGN);
  std::size_t const head = record.find("\n0: ") + 1;
  for (std::size_t const room : {std::size_t{10}, head - 1, head + 20, record.size() - 1}) {
    fs::remove(file);
    rlimit small = old;
    small.rlim_cur = room;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::string const message = message_of<IoError>([&] { study.run(values_at, with_threads(2)); });
    setrlimit(RLIMIT_FSIZE, &old);
    EXPECT_TRUE(has(message, "file \"" + file.string() + "\" cannot be written: File too large"));
    EXPECT_EQ(fs::exists(file), room >= head);  // a file without a line is removed
    EXPECT_TRUE(!fs::exists(file) || text_of(file).ends_with("\n"));
    EXPECT_EQ(table_of(study.run(values_at, with_threads(2))), whole);
  }
  std::signal(SIGXFSZ, handler);
}

TEST_F(StudyFiles, TwoRunsAtOnceAreRefused) {
  std::string message;
  study.run(
      [&](Point const& p) {
        if (p.index() == 3) {
          message = message_of<IoError>([&] { study.run(values_at, with_threads(1)); });
          EXPECT_EQ(study.recorded().finished(), 3u);  // reading needs no space
        }
        return values_at(p);
      },
      with_threads(1));
  EXPECT_TRUE(has(message, "is written by another run of the study"));
  EXPECT_TRUE(study.recorded().complete());
}

TEST_F(StudyFiles, StudiesThatCannotBeMeantAreRefused) {
  EXPECT_TRUE(has(refusal([&] { Study({file}, points, {}); }), "at least one output"));
  EXPECT_TRUE(has(refusal([&] { Study({file}, points, outputs("y", "y")); }), "duplicate column \"y\""));
  EXPECT_TRUE(has(refusal([&] { Study({file}, points, outputs("step [s]")); }), "duplicate column \"step [s]\""));
  EXPECT_TRUE(has(refusal([&] { Study({file}, points, outputs("")); }), "not printable"));
  EXPECT_TRUE(has(refusal([&] { make(points, "two\nlines"); }), "without line breaks"));
  EXPECT_TRUE(has(refusal([&] { study.run(values_at, with_threads(0)); }), "at least one thread"));
  EXPECT_EQ(files(), 0u);
}

TEST_F(StudyFiles, CurvesAreToldApartByParameters) {
  StudyResults const found = study.run(values_at, with_threads(2));
  std::vector<Curve> const curves = curves_of(found, "step", "sum [m]", {"integrator", "stiffness"});
  ASSERT_EQ(curves.size(), 6u);
  EXPECT_EQ(curves[0].label, "Radau, stiffness 1e+06 N/m");
  EXPECT_EQ(curves[1].label, "a, b, stiffness 1e+06 N/m");
  EXPECT_EQ(curves[1].x, (std::vector{1e-2, 1e-3}));
  EXPECT_EQ(curves[2].x, std::vector{1e-3});  // the other point failed
  EXPECT_EQ(curves[2].y, std::vector{found.outcomes[5]->values[0]});
  StudyResults const soft = where(found, [](Point const& p) { return p["stiffness"] == 1e6; });
  EXPECT_EQ(soft.finished(), 4u);
  EXPECT_EQ(curves_of(soft, "step", "sum [m]", {"integrator"}).size(), 2u);
  std::vector<Curve> const all = curves_of(found, "stiffness [N/m]", "sum [m]");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].x.size(), 10u);
  EXPECT_TRUE(
      has(refusal([&] { curves_of(found, "x", "sum [m]"); }), "no column \"x\"; the columns are \"stiffness [N/m]\""));
  EXPECT_TRUE(has(refusal([&] { curves_of(found, "step", "sum [m]", {"sum [m]"}); }), "is not a parameter"));
}

TEST_F(StudyFiles, TextsThatASpreadsheetEvaluatesGetASingleQuoteAndNumbersDoNot) {
  Study const one({file}, grid(formulations("body", {"=rigid", "ffr"}), axis("-x", "m", {-1.5})), outputs("+y", "@z"));
  StudyResults const found = one.run(
      [](Point const& p) {
        if (p.choice("body") == 1) throw Diverged{"-1 m is off"};
        return std::array{-2.5, 1.0};
      },
      with_threads(1));
  EXPECT_EQ(table_of(found), "point,body,'-x [m],'+y,'@z,failure\n0,'=rigid,-1.5,-2.5,1,\n1,ffr,-1.5,,,'-1 m is off\n");
}

/// A time limit for each point.
StudyOptions with_limit(int threads, double limit) {
  return {.threads = threads, .progress = false, .time_limit = limit};
}

TEST_F(StudyFiles, APointThatHangsFailsAfterItsTimeLimitAndTheOthersGoOn) {
  auto const f = [](Point const& p) {
    if (p.index() == 3 || p.index() == 7)
      for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return values_at(p);
  };
  StudyResults const plain = study.run(values_at, with_threads(1));
  fs::remove(file);
  for (int const threads : {1, 3}) {
    StudyResults const found = study.run(f, with_limit(threads, 0.2));
    EXPECT_TRUE(found.complete());
    EXPECT_EQ(found.failed(), 4u);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == 3 || i == 7) {
        EXPECT_EQ(found.outcomes[i]->failure, "The computation has not ended within the time limit of 0.2 s.");
      } else {
        EXPECT_EQ(found.outcomes[i]->failure, plain.outcomes[i]->failure);
        if (!found.outcomes[i]->failed())
          EXPECT_EQ(found.outcomes[i]->values[0], plain.outcomes[i]->values[0]);  // bits
      }
    }
    EXPECT_TRUE(has(table_of(found),
                    "\n3,1e+06,\"a, b\",0.001,,The computation has not ended within the time limit of 0.2 s.\n"));
    StudyResults const again = study.run(values_at, {.threads = threads, .retry_failed = true, .progress = false});
    EXPECT_EQ(again.failed(), 2u);
    EXPECT_EQ(again.resumed, 8u);
    fs::remove(file);
  }
}

TEST_F(StudyFiles, UnderATimeLimitACrashIsAFailureOfItsPoint) {
  StudyResults const found = study.run(
      [](Point const& p) {
        if (p.index() == 0) std::raise(SIGKILL);
        if (p.index() == 5) ::_exit(0);
        return values_at(p);
      },
      with_limit(2, 60.0));
  EXPECT_TRUE(found.complete());
  EXPECT_EQ(found.outcomes[0]->failure, "The process of the point ended without a result, by signal 9.");
  EXPECT_EQ(found.outcomes[5]->failure, "The process of the point ended without a result.");
  EXPECT_EQ(found.failed(), 4u);
}

TEST_F(StudyFiles, UnderATimeLimitErrorsOfTheProgramEndTheStudy) {
  auto const ends = [&](auto const& what) {
    return [&, what](Point const& p) {
      if (p.index() == 2) what(p);
      return values_at(p);
    };
  };
  auto const misuse = ends([](Point const& p) { (void)p["no such column"]; });
  EXPECT_TRUE(
      has(message_of<StudyUsageError>([&] { (void)study.run(misuse, with_limit(1, 60.0)); }), "no such column"));
  auto const own = ends([](Point const&) { throw std::runtime_error("an error of its own"); });
  EXPECT_TRUE(has(message_of<Error>([&] { (void)study.run(own, with_limit(2, 60.0)); }), "an error of its own"));
  auto const number = ends([](Point const&) { throw 3; });
  EXPECT_TRUE(
      has(message_of<Error>([&] { (void)study.run(number, with_limit(1, 60.0)); }), "not derived from std::exception"));
  StudyResults const found = study.run(values_at, with_limit(1, 60.0));
  EXPECT_GE(found.resumed, 2u);
  EXPECT_TRUE(found.complete());
}

TEST_F(StudyFiles, ATimeLimitIsPositiveOrZero) {
  for (double const limit : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_TRUE(has(refusal([&] { (void)study.run(values_at, with_limit(1, limit)); }), "the time limit of a point"));
  EXPECT_FALSE(fs::exists(file));
}

// The time of a second working thread does not count, nor does a wait.
TEST(StudyTime, IsThatOfTheThread) {
  std::atomic<bool> done = false;
  std::thread other([&] {
    while (!done) continue;
  });
  double const begin = thread_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  double const waited = thread_seconds() - begin;
  done = true;
  other.join();
  EXPECT_LT(waited, 0.025);
  double x = 1.0;
  while (thread_seconds() - begin < 0.002) x = std::cos(x);
  EXPECT_GT(thread_seconds() - begin, 0.0);
  EXPECT_NE(x, 1.0);
}

TEST_F(StudyFiles, StatisticsAreThoseOfTheFinishedPoints) {
  Study const one({file}, axis("x", "", {1.0, 2.0, 3.0, 4.0, 10.0}), outputs("y", "z"));
  StudyResults const found = one.run(
      [](Point const& p) {
        if (p["x"] == 10.0) throw Diverged{"off"};
        return std::array{p["x"] * p["x"], -std::exp(p["x"])};
      },
      with_threads(1));
  Statistics const y = statistics(found, "y");  // 1, 4, 9, 16
  EXPECT_EQ(y.count, 4u);
  EXPECT_DOUBLE_EQ(y.mean, 7.5);
  EXPECT_DOUBLE_EQ(y.deviation, std::sqrt(43.0));  // (42.25 + 12.25 + 2.25 + 72.25)/3
  EXPECT_DOUBLE_EQ(y.quantile(0.0), 1.0);
  EXPECT_DOUBLE_EQ(y.quantile(0.5), 6.5);
  EXPECT_DOUBLE_EQ(y.quantile(1.0), 16.0);
  EXPECT_DOUBLE_EQ(rank_correlation(found, "x", "y"), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation(found, "y", "z"), -1.0);
  EXPECT_TRUE(has(refusal([&] { statistics(found, "w"); }), "no column \"w\"; the columns are \"x\", \"y\", \"z\""));
  EXPECT_TRUE(has(refusal([&] { y.quantile(1.5); }), "must lie in [0, 1]"));
  // Ranks 1 2 3 4 and 1.5 1.5 3.5 3.5: Σab = 4, Σaa = 5, Σbb = 4.
  Study const ties({folder / "b.study"}, axis("x", "", {1.0, 2.0, 3.0, 4.0}), outputs("y"));
  StudyResults const tied = ties.run([](Point const& p) { return p["x"] < 2.5 ? 0.0 : 1.0; }, with_threads(1));
  EXPECT_DOUBLE_EQ(rank_correlation(tied, "x", "y"), 4.0 / std::sqrt(20.0));
}

}  // namespace study_test
