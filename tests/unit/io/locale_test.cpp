// Texts and files do not change under a locale with decimal commas.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/io/progress.hpp>
#include <polybody/io/run_table.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/diagnose.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/run/summary.hpp>
#include <polybody/study/report.hpp>
#include <polybody/study/sampling.hpp>
#include <polybody/study/study.hpp>
#include <polybody/system/model.hpp>

#include "support/german_locale.hpp"
#include "support/refusal.hpp"

namespace fs = std::filesystem;
using namespace polybody;

namespace locale_test {

using M = Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, Constraint>>, Forces<SpringDamper>>;

M pendulum() {
  M model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1234567.5, 0.125, Placement::at({0.5, 0, 0})), "rod");
  model.connect(Joint<planar::Revolute, Constraint>{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.5, 0)), "pin");
  model.apply(SpringDamper{.stiffness = 12345.75, .damping = 0.25, .free_length = 0.5},
              model.ground().at({0.25, 0.5, 0}), rod.at(Vec2(0.5, 0)), "spring");
  return model;
}

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// All text that the library prints for the pendulum, and the text of the files it writes.
std::string all_texts(fs::path const& folder) {
  fs::create_directories(folder);
  M const model = pendulum();
  State x = model.reference_state();
  RunOptions const options{.end_time = 0.05, .step = 0.0025};
  std::ostringstream told;
  told << summary(model) << '\n' << number(9.81) << ' ' << number(-1234567.5) << ' ' << number(1.5e-300) << '\n';
  told << sentence_of({"a ", 0.5, ", ", 1234567, ", ", 1e10, "\n"});
  told << refusal([&] { (void)simulate(model, x, GeneralisedAlpha{.rho_inf = 1.5}, options); }) << '\n';
  told << diagnose(model, x);
  told << message_of<InvalidInput>([] {
    SpringDamper{.stiffness = -1.5, .damping = 0.25, .free_length = 0.5}.check("spring");
  }) << '\n';
  Table const table = tabulate(simulate(model, x, GeneralisedAlpha{}, options),
                               {{"angle [rad]", [](State const& now) { return now.q[2]; }}});
  plot(table, folder / "run", false);
  for (auto const* end : {".csv", ".dat", ".gp"}) told << text_of((folder / "run").string() + end);
  EXPECT_EQ(read_csv(folder / "run.csv").rows, table.rows);
  Study const study({folder / "a.study", "a square"}, axis("step", "s", {0.5, 1.25e-3}), outputs("square [s²]"));
  write_table(study.run([](Point const& p) { return p["step"] * p["step"]; }, {.progress = false}), folder / "a.csv");
  told << text_of(folder / "a.study") << text_of(folder / "a.csv");
  EXPECT_TRUE(study.recorded().complete());
  std::ostringstream bar;
  bar.imbue(std::locale::classic());
  double now = 0.0;
  Progress progress(0.0, 2.5, "run", bar, true, [&] { return now += 1234.5; });
  progress.update(1.25);
  progress.finish();
  told << bar.str() << '\n';
  return told.str();
}

TEST(Locale, TextsAndFilesHaveDecimalPoints) {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody texts " + std::to_string(std::random_device{}()));
  std::string const plain = all_texts(folder);
  fs::remove_all(folder);
  std::string german;
  {
    GermanLocale const locale;
    if (!locale.is_set) GTEST_SKIP() << "no locale with decimal commas can be made";
    german = all_texts(folder);
  }
  fs::remove_all(folder);
  EXPECT_EQ(german, plain);
  EXPECT_TRUE(has(plain, "-9.81"));
}

TEST(Locale, NumbersOfMessagesHaveNineDigits) {
  EXPECT_EQ(number(0.1), "0.1");
  EXPECT_EQ(number(1.0 / 3.0), "0.333333333");
  EXPECT_EQ(number(1234567890.5), "1.23456789e+09");
  EXPECT_EQ(number(-0.0), "-0");
  EXPECT_EQ(number(1e-5), "1e-05");
  EXPECT_EQ(number(123456789.0), "123456789");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(number(5e-324), "4.94065646e-324");
}

}  // namespace locale_test
