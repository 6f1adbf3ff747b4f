#include <polybody/io/csv.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <clocale>
#include <concepts>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <type_traits>

#include "support/refusal.hpp"

namespace fs = std::filesystem;
using namespace polybody;

namespace csv_test {

static_assert(!std::copyable<Csv> && std::movable<Csv>);
static_assert(!std::copyable<AtomicFile> && std::movable<AtomicFile>);
static_assert(std::is_nothrow_move_constructible_v<Csv> && std::is_nothrow_destructible_v<Csv>);

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void put(fs::path const& file, std::string_view text) { std::ofstream(file, std::ios::binary) << text; }

/// Each test has its own empty folder.
struct CsvFiles : testing::Test {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody csv " + std::to_string(std::random_device{}()));
  fs::path const file = folder / "run.csv";

  CsvFiles() { fs::create_directories(folder); }
  ~CsvFiles() override { fs::remove_all(folder); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

TEST_F(CsvFiles, WritesHeadAndRowsOfEveryKind) {
  Csv csv(file, {"t [s]", "x [m]"});
  csv.row(0, 1.5);
  csv.row({0.1, -2.0});
  std::vector<double> const values{1e300, -0.0};
  csv.row(values);
  EXPECT_EQ(csv.rows(), 3u);
  csv.close();
  EXPECT_EQ(text_of(file), "t [s],x [m]\n0,1.5\n0.1,-2\n1e+300,-0\n");
}

TEST_F(CsvFiles, WritesATextBeforeNumbers) {
  Csv csv(file, {"quantity", "soft", "stiff"});
  std::vector<double> const values{1.0, 0.1}, few{1.0};
  csv.row("tip, x [m]", values);
  csv.row("", values);
  EXPECT_TRUE(
      has(refusal([&] { csv.row("mass [kg]", few); }), "row 3: the row has 2 values, but the table has 3 columns"));
  csv.close();
  EXPECT_EQ(text_of(file), "quantity,soft,stiff\n\"tip, x [m]\",1,0.1\n,1,0.1\n");
  EXPECT_TRUE(has(message_of<IoError>([&] { read_csv(file); }), "\"tip, x [m]\" is not a finite number"));
}

TEST_F(CsvFiles, NumbersReadBackBitForBit) {
  std::vector<double> values{0.0,
                             -0.0,
                             0.1,
                             1.0 / 3.0,
                             5e-324,
                             2.2250738585072011e-308,
                             std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::min(),
                             std::numeric_limits<double>::epsilon(),
                             -1e22,
                             9007199254740993.0};
  std::mt19937_64 random(7);
  while (values.size() < 4000)
    if (double const x = std::bit_cast<double>(random()); std::isfinite(x)) values.push_back(x);
  {
    Csv csv(file, {"value"});
    for (double const x : values) csv.row(x);
  }
  auto const back = read_csv(file).column("value");
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back[i]), std::bit_cast<std::uint64_t>(values[i]));
}

TEST_F(CsvFiles, OddHeadsAreQuotedAndReadBack) {
  std::vector<std::string> const heads{"a,b",           "say \"hi\"", "two\nlines", " edge ",  "\"",
                                       "plain [m/s^2]", "crlf\r\n",   "θ [rad]",    "\ttab\t", ","};
  {
    Csv csv(file, heads);
    csv.row(0, 1, 2, 3, 4, 5, 6, 7, 8, 9);
  }
  EXPECT_TRUE(text_of(file).starts_with("\"a,b\",\"say \"\"hi\"\"\",\"two\nlines\","));
  Table const table = read_csv(file);
  EXPECT_EQ(table.columns, heads);
  for (std::size_t j = 0; j < heads.size(); ++j)
    EXPECT_EQ(table.column(heads[j]), std::vector<double>{static_cast<double>(j)});
}

TEST_F(CsvFiles, AHeadThatBeginsLikeAByteOrderMarkIsQuotedAndReadBack) {
  std::vector<std::string> const heads{"\xEF\xBB\xBF", "x"};
  {
    Csv csv(file, heads);
    csv.row(1, 2);
  }
  EXPECT_EQ(read_csv(file).columns, heads);
}

TEST_F(CsvFiles, CreatesParentFoldersAndReplacesAnOldFile) {
  fs::path const deep = folder / "a" / "b c" / "run.csv";
  for (double const x : {1.0, 2.0}) {
    Csv csv(deep, {"x"});
    csv.row(x);
    csv.close();
    csv.close();  // a second close has no effect
    EXPECT_EQ(read_csv(deep).column("x"), std::vector<double>{x});
  }
}

TEST_F(CsvFiles, RelativeNameStaysInTheFolderWhereItWasOpened) {
  fs::path const before = fs::current_path();
  fs::current_path(folder);
  std::optional<Csv> csv(std::in_place, "plain.csv", std::vector<std::string>{"x"});
  fs::current_path(before);
  csv->row(1);
  csv.reset();
  EXPECT_EQ(text_of(folder / "plain.csv"), "x\n1\n");
}

TEST_F(CsvFiles, RefusesHeadsThatCannotBeMeant) {
  using Heads = std::vector<std::string>;
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { Csv(file, Heads{}); }), "at least one column"));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { Csv(file, Heads{"x", ""}); }),
                  "the head of column 2, counted from 1, is empty"));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { Csv(file, Heads{"x", "y", "x"}); }), "\"x\""));
  EXPECT_EQ(files(), 0u);
}

TEST_F(CsvFiles, RefusesBadRowsByNameAndGoesOnUnharmed) {
  Csv csv(file, {"t [s]", "x [m]"});
  csv.row(0, 0);
  auto const few = message_of<InvalidInput>([&] { csv.row(1); });
  EXPECT_TRUE(has(few, file.string()));
  EXPECT_TRUE(has(few, "row 2: the row has 1 values, but the table has 2 columns"));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { csv.row(1, 2, 3); }), "3 values"));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { csv.row(); }), "0 values"));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { csv.row({}); }), "0 values"));
  auto const nan = message_of<InvalidInput>([&] { csv.row(1, std::nan("")); });
  EXPECT_TRUE(has(nan, file.string()));
  EXPECT_TRUE(has(nan, "row 2"));
  EXPECT_TRUE(has(nan, "\"x [m]\""));
  auto const infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { csv.row({-infinity, 1}); }), "\"t [s]\""));
  csv.row(1, 1);
  csv.close();
  EXPECT_EQ(text_of(file), "t [s],x [m]\n0,0\n1,1\n");
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { csv.row(2, 2); }), "already closed"));
}

TEST_F(CsvFiles, NothingUnderTheFinalNameUntilClosed) {
  put(file, "old");
  Csv csv(file, {"x"});
  for (int i = 0; i < 5000; ++i) csv.row(i);
  EXPECT_EQ(text_of(file), "old");
  EXPECT_LE(files(), 2u);  // on Linux the temporary file has no name
  csv.close();
  EXPECT_EQ(read_csv(file).rows.size(), 5000u);
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvFiles, AnExceptionKeepsTheRowsSoFar) {
  auto const interrupted = [&](int rows) {
    Csv csv(file, {"x"});
    for (int i = 0; i < rows; ++i) csv.row(i);
    throw std::runtime_error("stop");
  };
  EXPECT_THROW(interrupted(0), std::runtime_error);
  EXPECT_EQ(files(), 0u);
  put(file, "old");
  EXPECT_THROW(interrupted(0), std::runtime_error);
  EXPECT_EQ(text_of(file), "old");
  EXPECT_THROW(interrupted(5000), std::runtime_error);
  EXPECT_EQ(read_csv(file).rows.size(), 5000u);
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvFiles, AnExceptionLeavesNothingOfAFileWhosePartsAreOfNoUse) {
  put(file, "old");
  auto const interrupted = [&] {
    AtomicFile out(file);
    out.write("half");
    throw std::runtime_error("stop");
  };
  EXPECT_THROW(interrupted(), std::runtime_error);
  EXPECT_EQ(text_of(file), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvFiles, AWriterMadeWhileAnExceptionUnwindsStillCloses) {
  struct Report {
    fs::path file;
    ~Report() {
      Csv csv(file, {"x"});
      csv.row(1);
    }
  };
  try {
    Report report{file};
    throw std::runtime_error("stop");
  } catch (std::runtime_error const&) {
  }
  EXPECT_EQ(text_of(file), "x\n1\n");
}

TEST_F(CsvFiles, MovesTakeTheFileAlong) {
  fs::path const second = folder / "second.csv";
  Csv a(file, {"x"});
  a.row(1);
  Csv b(std::move(a));
  EXPECT_THROW(a.row(2), InvalidInput);  // NOLINT: what a moved-from writer does
  b.row(2);
  b = Csv(second, {"y"});  // closes the first file
  EXPECT_EQ(text_of(file), "x\n1\n2\n");
  b.row(3);
  b.close();
  EXPECT_EQ(text_of(second), "y\n3\n");
  EXPECT_EQ(files(), 2u);
}

TEST_F(CsvFiles, SystemRefusalsNameTheFileAndTheReason) {
  put(folder / "plain", "x");
  auto const below = message_of<IoError>([&] { Csv(folder / "plain" / "run.csv", {"x"}); });
  EXPECT_TRUE(has(below, (folder / "plain" / "run.csv").string()));
  EXPECT_TRUE(has(below, "ot a directory"));
  fs::create_directories(folder / "taken");
  EXPECT_TRUE(has(message_of<IoError>([&] { Csv(folder / "taken", {"x"}); }), "not a regular file"));
  EXPECT_TRUE(has(message_of<IoError>([&] { Csv("/dev/null", {"x"}); }), "not a regular file"));
  EXPECT_TRUE(has(message_of<IoError>([&] { Csv("", {"x"}); }), "the path has no file name"));
  EXPECT_TRUE(has(message_of<IoError>([&] { Csv(folder / "", {"x"}); }), "the path has no file name"));
  {
    Csv csv(file, {"x"});
    fs::create_directories(file / "in the way");
    EXPECT_TRUE(has(message_of<IoError>([&] { csv.close(); }), "cannot be renamed to its final name: "));
  }
  EXPECT_EQ(files(), 3u);  // plain, taken, run.csv/: no temporary file
}

TEST_F(CsvFiles, AFullDiskLeavesNothing) {
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  auto const handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old;
  small.rlim_cur = 10000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  auto const fill = [&](int rows, bool close) {
    Csv csv(file, {"x"});
    for (int i = 0; i < rows; ++i) csv.row(1.0 / 3.0);
    if (close) csv.close();
  };
  auto const in_row = message_of<IoError>([&] { fill(5000, true); });
  auto const in_close = message_of<IoError>([&] { fill(550, true); });  // the last buffer only
  testing::internal::CaptureStderr();
  fill(550, false);
  auto const told = testing::internal::GetCapturedStderr();
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  for (auto const& text : {in_row, in_close, told}) {
    EXPECT_TRUE(has(text, file.string()));
    EXPECT_TRUE(has(text, "File too large"));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(CsvFiles, AFailedWriteIsNotForgottenWhenItsExceptionIsCaught) {
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  auto const handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old;
  small.rlim_cur = 10000;
  {
    Csv csv(file, {"x"});
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(for (int i = 0; i < 5000; ++i) csv.row(1.0 / 3.0), IoError);
    setrlimit(RLIMIT_FSIZE, &old);
  }
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(files(), 0u);
}

TEST_F(CsvFiles, FollowsASymbolicLink) {
  fs::create_directories(folder / "real");
  put(folder / "real" / "data.csv", "old");
  fs::create_symlink(folder / "real" / "data.csv", file);
  Csv csv(file, {"x"});
  csv.row(1);
  csv.close();
  EXPECT_TRUE(fs::is_symlink(file));
  EXPECT_EQ(text_of(folder / "real" / "data.csv"), "x\n1\n");
}

TEST_F(CsvFiles, FollowsALinkToAFileThatIsNotThereYet) {
  fs::create_symlink(fs::path("below") / "second", file);
  fs::create_directories(folder / "below");
  fs::create_symlink(folder / "deep" / "data.csv", folder / "below" / "second");
  for (double const x : {1.0, 2.0}) {
    Csv csv(file, {"x"});
    csv.row(x);
    csv.close();
    EXPECT_TRUE(fs::is_symlink(file));
    EXPECT_TRUE(fs::is_symlink(folder / "below" / "second"));
    EXPECT_EQ(read_csv(folder / "deep" / "data.csv").column("x"), std::vector<double>{x});
  }
}

TEST_F(CsvFiles, NamesThatCannotBeMadeAreRefusedWhenTheFileIsOpened) {
  auto const refused = [&](fs::path const& name) { return message_of<IoError>([&] { AtomicFile const out(name); }); };
  EXPECT_TRUE(has(refused(folder / std::string(300, 'n')), "name too long"));
  EXPECT_TRUE(has(refused(folder / std::string(300, 'n') / "run.csv"), "name too long"));
  fs::create_symlink(folder / std::string(300, 'n'), folder / "long");
  EXPECT_TRUE(has(refused(folder / "long"), "name too long"));
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  EXPECT_TRUE(has(refused(folder / "a"), "oo many levels of symbolic links"));
  EXPECT_TRUE(has(refused(folder / "a" / "run.csv"), "oo many levels of symbolic links"));
  EXPECT_TRUE(has(refused(folder / "a"), (folder / "a").string()));
  EXPECT_EQ(files(), 3u);
}

TEST_F(CsvFiles, KeepsThePermissionsOfAFileThatItReplaces) {
  auto const write = [&](std::string_view text) {
    AtomicFile out(file);
    out.write(text);
    out.close();
  };
  auto const old_mask = ::umask(022);
  write("first");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0644));  // the permissions of any new file
  for (int const mode : {0600, 0640, 0666, 0755, 0400}) {
    fs::permissions(file, fs::perms(mode));
    write("secret");
    EXPECT_EQ(fs::status(file).permissions(), fs::perms(mode)) << std::oct << mode;
    EXPECT_EQ(text_of(file), "secret");
  }
  fs::permissions(file, fs::perms(0600));
  fs::create_symlink(file, folder / "link");
  Csv(folder / "link", {"x"}).row(1);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0600));
  ::umask(old_mask);
}

TEST_F(CsvFiles, AKilledWriterLeavesNothingBehind) {
  put(file, "old");
  {
    AtomicFile const out(folder / "probe");
    if (files() != 1u) GTEST_SKIP() << "this file system has no files without a name";
  }
  fs::remove(folder / "probe");
  pid_t const writer = ::fork();
  ASSERT_GE(writer, 0);
  if (writer == 0) {
    Csv csv(file, {"x"});
    for (int i = 0; i < 5000; ++i) csv.row(i);
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(text_of(file), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvFiles, DiscardLeavesNothing) {
  AtomicFile out(file);
  out.write("half");
  out.discard();
  EXPECT_FALSE(out.is_open());
  out.close();
  EXPECT_EQ(files(), 0u);
}

TEST_F(CsvFiles, TheDecimalPointIsAPointInEveryLocale) {
  std::string const before = std::setlocale(LC_ALL, nullptr);
  for (char const* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, name);
  {
    Csv csv(file, {"x"});
    csv.row(0.5);
  }
  auto const table = read_csv(file);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(text_of(file), "x\n0.5\n");
  EXPECT_EQ(table.column("x"), std::vector<double>{0.5});
}

TEST_F(CsvFiles, ReadsWhatOtherProgramsWrite) {
  put(file, "\xEF\xBB\xBF t , \"x, y\" \r\n+1.5, \"2\"\t\r\n\r\n 1E3 ,.5\r\n-1,4\r\n\r\n");
  Table const table = read_csv(file);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"t", "x, y"}));
  EXPECT_EQ(table.column("t"), (std::vector<double>{1.5, 1000, -1}));
  EXPECT_EQ(table.column("x, y"), (std::vector<double>{2, 0.5, 4}));
  put(file, "t");
  EXPECT_EQ(read_csv(file).columns, std::vector<std::string>{"t"});
  EXPECT_TRUE(read_csv(file).rows.empty());
  put(file, "t\n7");  // no line feed at the end
  EXPECT_EQ(read_csv(file).column("t"), std::vector<double>{7});
}

TEST_F(CsvFiles, LinesEndWithLfCrLfOrCr) {
  for (std::string const end : {"\n", "\r\n", "\r"}) {
    for (std::string const& last : {std::string(), end, end + end}) {
      put(file, "t,\"x\"" + end + "1,2 " + end + end + "\"3\", 4" + last);
      Table const table = read_csv(file);
      EXPECT_EQ(table.columns, (std::vector<std::string>{"t", "x"}));
      EXPECT_EQ(table.rows, (std::vector<std::vector<double>>{{1, 2}, {3, 4}}));
    }
    put(file, "a,b" + end + "1,2" + end + "3" + end);
    EXPECT_TRUE(has(message_of<IoError>([&] { read_csv(file); }),
                    "line 3: the line has 1 fields, but the table has 2 columns"));
    put(file, "a,b" + end + "1,\"2\"3" + end);
    EXPECT_TRUE(has(message_of<IoError>([&] { read_csv(file); }), "line 2: text follows a closing quote"));
  }
}

// Spreadsheets evaluate such texts: "=HYPERLINK(…)" in a head opens a page.
TEST_F(CsvFiles, TextsThatASpreadsheetEvaluatesGetASingleQuoteAndReadBack) {
  std::vector<std::string> const heads{"=1+2", "-x [m]", "+y", "@z", "'=1", "'quoted'", "''-", "a=b", "=\"a,b\"", "-"};
  {
    Csv csv(file, heads);
    csv.row(-1, 2, -3, 4, 5, 6, 7, 8, 9, -10);
  }
  EXPECT_EQ(text_of(file),
            "'=1+2,'-x [m],'+y,'@z,''=1,'quoted','''-,a=b,\"'=\"\"a,b\"\"\",'-\n-1,2,-3,4,5,6,7,8,9,-10\n");
  EXPECT_EQ(read_csv(file).columns, heads);
  Csv csv(file, {"quantity", "soft"});
  csv.row("-tip [m]", std::vector{-0.5});
  csv.close();
  EXPECT_EQ(text_of(file), "quantity,soft\n'-tip [m],-0.5\n");
}

TEST_F(CsvFiles, ReadingNamesFileAndLine) {
  auto const refusal = [&](std::string_view text) {
    put(file, text);
    auto const said = message_of<IoError>([&] { read_csv(file); });
    EXPECT_TRUE(has(said, file.string()));
    return said;
  };
  EXPECT_TRUE(has(refusal("a,b\n1,2\n3\n"), "line 3: the line has 1 fields, but the table has 2 columns"));
  EXPECT_TRUE(has(refusal("a,b\n1,2,\n"), "line 2: the line has 3 fields"));
  EXPECT_TRUE(has(refusal("a,b\n\n1,2,3\n"), "line 3: the line has 3 fields"));
  EXPECT_TRUE(has(refusal("\"a\nb\",c\n1,2\n1,x\n"), "line 4: column \"c\": \"x\""));
  for (auto const* bad : {"nan", "inf", "1e999", "1.5m", "0x10", "--1", "+-1", "+", "1 2", "", "1;2"})
    EXPECT_TRUE(has(refusal(std::string("a,b\n1,2\n3,") + bad + "\n"), "line 3: column \"b\""));
  EXPECT_TRUE(has(refusal("a\n\"1\n"), "line 2: a quote is never closed"));
  EXPECT_TRUE(has(refusal("a\n\"1\"2\n"), "line 2: text follows a closing quote"));
  EXPECT_TRUE(has(refusal(""), "is empty"));
  EXPECT_TRUE(has(refusal("\n\n"), "is empty"));
  auto const missing = message_of<IoError>([&] { read_csv(folder / "none.csv"); });
  EXPECT_TRUE(has(missing, "none.csv"));
  EXPECT_TRUE(has(missing, "No such file"));
  EXPECT_TRUE(has(message_of<IoError>([&] { read_csv(folder); }), "cannot be read"));
}

TEST(CsvTable, ColumnMustBeThereOnce) {
  Table const table{{"t", "x", "x"}, {{1, 2, 3}, {4, 5, 6}}};
  EXPECT_EQ(table.column("t"), (std::vector<double>{1, 4}));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { table.column("y"); }), "no column \"y\"; the table has \"t\", \"x\""));
  EXPECT_TRUE(has(message_of<InvalidInput>([&] { table.column("x"); }), "duplicate column"));
  EXPECT_TRUE(has(message_of<InvalidInput>([] { Table{}.column("t"); }), "has none"));
}

}  // namespace csv_test
