// Files of a VtkWriter, read back by VTK's own reader (vtk_read.py), and the files that remain after a run is
// interrupted.
#include <polybody/io/vtk.hpp>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <map>
#include <thread>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/rigid/rigid.hpp>

#include "support/refusal.hpp"
#include "support/vtk_reader.hpp"

namespace vtk_test {

namespace fs = std::filesystem;
using namespace polybody;
using Cable = AncfCable<EngineeringStrain>;

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}
int count(std::string const& text, std::string const& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// A box of 0.2 × 0.4 × 0.6 m at (1, 0, 0) of a rigid body. A cable of 2 m along x with a section of 0.1 × 0.06 m, in
/// five pieces.
struct VtkFiles : testing::Test {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody vtk & co " + std::to_string(::getpid()));
  Bar const bar{.length = 2.0,
                .section = Rectangle{.height = 0.1, .width = 0.06},
                .material = Material{.density = 1000.0, .young = 1e9, .poisson = 0.3}};
  Model<Bodies<Rigid<>, Cable>, Joints<>> model;
  BodyHandle<Rigid<>> brick = model.add(Rigid<>(2.0, Mat3::Identity()), "brick");
  BodyHandle<Cable> cable = model.add(Cable::from(bar, 5), "cable");
  Visual visual{model};
  State x = model.reference_state();

  VtkFiles() {
    visual.attach(brick.at({1, 0, 0}), box({0.2, 0.4, 0.6}), "box");
    visual.sweep(cable, bar, 5);
    fs::create_directories(folder);
  }
  ~VtkFiles() override { fs::remove_all(folder); }

  /// The brick at (4, 5, 6) is rotated by a quarter turn about z, rotates at 3 rad/s about the world's z and rises at
  /// 2 m/s. The cable is stretched by a thousandth.
  void move() {
    x.t = 0.25;
    x.q.head(7) << 4, 5, 6, std::sqrt(0.5), 0, 0, std::sqrt(0.5);
    x.q.tail(x.q.size() - 7) *= 1.001;
    model.set_velocity(x, brick, Vec3(0, 0, 2), Vec3(0, 0, 3));
  }
};

// Points: 8 + 6·4; polygons: 6 + 2 + 5·4. Numbers are float32, so seven digits.
TEST_F(VtkFiles, AreReadByVtk) {
  VtkWriter writer(folder / "run.pvd", visual);
  writer.write(x);
  move();
  writer.write(x);
  EXPECT_EQ(writer.states(), 2u);
  auto const lines = read_by_vtk(folder / "run.pvd");
  if (lines.empty()) GTEST_SKIP() << "VTK for python is missing (Debian: python3-vtk9)";
  std::map<std::string, std::vector<double>> found;
  int states = 0;
  for (auto const& line : lines) {
    bool const state = line[0] == "state";
    states += state;
    std::vector<double>& numbers = found[std::to_string(states) + (state ? " state" : " " + line[1] + " " + line[2])];
    for (std::size_t i = state ? 1 : 3; i < line.size(); ++i) numbers.push_back(std::stod(line[i]));
  }
  ASSERT_EQ(states, 2);
  double const section = 0.1 * 0.06, brick_volume = 0.2 * 0.4 * 0.6;
  // the corner (1.1, -0.2, z) moves furthest, by (3.1, 6.3, 6); the fastest corner is at (4.2, 6.1, z)
  std::map<std::string, std::vector<double>> const expected{
      {"1 state", {0.0, 32, 28, brick_volume + 2.0 * section, 0, 2, -0.2, 0.2, -0.3, 0.3}},
      {"1 point displacement", {3, 0, 0}},
      {"1 point velocity", {3, 0, 0}},
      {"1 point axial_stress", {1, 0, 0}},
      {"1 cell part", {1, 0, 1}},
      {"2 state", {0.25, 32, 28, brick_volume + 2.002 * section, 0, 4.2, -0.05, 6.1, -0.03, 6.3}},
      {"2 point displacement", {3, 0, std::sqrt(3.1 * 3.1 + 6.3 * 6.3 + 36.0)}},
      {"2 point velocity", {3, 0, std::sqrt(9.0 * (4.2 * 4.2 + 6.1 * 6.1) + 4.0)}},
      {"2 point axial_stress", {1, 1e6, 1e6}},
      {"2 cell part", {1, 0, 1}}};
  ASSERT_EQ(found.size(), expected.size());
  for (auto const& [name, numbers] : expected) {
    ASSERT_EQ(found[name].size(), numbers.size()) << name;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      EXPECT_NEAR(found[name][i], numbers[i], 1e-6 * std::max(1.0, numbers[i])) << name << ", number " << i;
  }
}

TEST_F(VtkFiles, AreCompleteAfterEveryState) {
  fs::path const file = folder / "deep" / "a \"run\".pvd";
  VtkWriter writer(file, visual);
  EXPECT_EQ(count(text_of(file), "<DataSet"), 0);
  EXPECT_EQ(count(text_of(file), "</VTKFile>"), 1);
  for (int i = 1; i <= 3; ++i) {
    writer.write(x);
    x.t += 0.1;
    EXPECT_EQ(count(text_of(file), "<DataSet"), i);
    EXPECT_EQ(count(text_of(file), "</VTKFile>"), 1);
  }
  EXPECT_TRUE(
      has(text_of(file), "timestep=\"0.1\" part=\"0\" file=\"a &quot;run&quot;/a &quot;run&quot;_000001.vtu\""));
  fs::path const grid = folder / "deep" / "a \"run\"" / "a \"run\"_000001.vtu";
  EXPECT_TRUE(text_of(grid).ends_with("</VTKFile>\n"));
  // 32 points of 3 + 3 + 3 + 1 float32; 24 + 88 corners, 28 ends of int64, 28 types, 28 parts of int32; eight lengths
  auto const begin = text_of(grid).find("\n_") + 2, end = text_of(grid).find("\n</AppendedData>");
  EXPECT_EQ(end - begin, std::size_t(32 * 40 + 8 * (24 + 88 + 28) + 28 + 4 * 28 + 8 * 8));
}

TEST_F(VtkFiles, AStateThatCannotBeWrittenLeavesTheOthers) {
  fs::path const file = folder / "run.pvd";
  VtkWriter writer(file, visual);
  writer.write(x);
  EXPECT_TRUE(has(refusal([&] { writer.write(x); }), "must increase, but t = 0 s follows 0 s"));
  x.t = 1.0;
  x.q[0] = std::nan("");
  EXPECT_TRUE(has(message_of<NonFiniteValue>([&] { writer.write(x); }), "\"box\" is not finite at t = 1 s"));
  x = model.reference_state();
  x.t = 2.0;
  fs::create_directories(folder / "run" / "run_000001.vtu");
  EXPECT_TRUE(has(message_of<IoError>([&] { writer.write(x); }), "run_000001.vtu"));
  EXPECT_EQ(count(text_of(file), "<DataSet"), 1);
  EXPECT_EQ(writer.states(), 1u);
  fs::remove(folder / "run" / "run_000001.vtu");
  writer.write(x);
  EXPECT_EQ(count(text_of(file), "<DataSet"), 2);
}

// A program that writes without pause is killed at a random time. The files that exist can be read, and no other file
// exists.
TEST_F(VtkFiles, AKillLeavesNoTemporaryFile) {
  fs::path const file = folder / "run.pvd";
  for (int i = 0; i < 50; ++i) {
    pid_t const child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) try {
        VtkWriter writer(file, visual);
        for (;; x.t += 0.1) writer.write(x);
      } catch (...) {
        _exit(1);
      }
    for (int k = 0; k < 100000 && !fs::exists(folder / "run" / "run_000009.vtu"); ++k)
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    kill(child, SIGKILL);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    for (auto const& entry : fs::recursive_directory_iterator(folder))
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    std::string const text = text_of(file);
    EXPECT_TRUE(text.ends_with("</VTKFile>\n"));
    for (int k = 0; k < count(text, "<DataSet"); ++k) {
      std::string const index = std::to_string(k);
      fs::path const grid = folder / "run" / ("run_" + std::string(6 - index.size(), '0') + index + ".vtu");
      EXPECT_TRUE(text_of(grid).ends_with("</VTKFile>\n")) << grid;
    }
    fs::remove_all(folder / "run");
  }
}

TEST_F(VtkFiles, RefuseANameThatParaViewWouldNotKnow) {
  EXPECT_TRUE(has(refusal([&] { VtkWriter(folder / "run.vtk", visual); }), "must end in .pvd, but is"));
  std::ofstream(folder / "plain") << "x";
  EXPECT_TRUE(has(message_of<IoError>([&] { VtkWriter(folder / "plain" / "run.pvd", visual); }), "plain"));
}

}  // namespace vtk_test
