// Pictures and films of modes: the displaced edges of the model.
#include <polybody/io/mode_pictures.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <set>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace mode_pictures_test {

namespace fs = std::filesystem;

/// Two boxes of 1 m, 3 m apart. In mode 0 the second one moves along y by one unit, in mode 1 it turns about z.
struct Boxes {
  Model<Bodies<Rigid<>>, Joints<>> model;
  BodyHandle<Rigid<>> first = model.add(Rigid<>(1.0, Mat3::Identity()), "first");
  BodyHandle<Rigid<>> second = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({3, 0, 0})), "second");
  State x = model.reference_state();
  MatX shapes = MatX::Zero(12, 2);
  Visual visual{model};
  fs::path const folder = fs::path(testing::TempDir()) / ("modes " + std::to_string(::getpid()));

  Boxes() {
    visual.attach(first.centre(), box({1, 1, 1}), "first");
    visual.attach(second.centre(), box({1, 1, 1}), "second");
    shapes(7, 0) = 0.25;
    shapes(11, 1) = -8.0;
    fs::create_directories(folder);
  }
  ~Boxes() { fs::remove_all(folder); }
};

/// Blocks of a data file: curves of points.
std::vector<std::vector<Vec2>> curves_of(fs::path const& file) {
  std::ifstream stream(file);
  std::vector<std::vector<Vec2>> out;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("# ")) out.emplace_back();
    double a = 0.0, b = 0.0;
    if (std::sscanf(line.c_str(), "%lf %lf", &a, &b) == 2) out.back().emplace_back(a, b);
  }
  return out;
}

// Seen from above, the box moves along y by a tenth of the diagonal √(16 + 1 + 1), or turns by as much at its corners.
TEST(ModePictures, ShowTheModelAndItsDisplacement) {
  Boxes b;
  ModePictureOptions const from_above{.look_from = {0, 0, 1}, .up = {0, 1, 0}, .draw = false};
  EXPECT_EQ(write_modes(b.visual, b.x, b.shapes, b.folder / "two", from_above), DrawResult::script_only);
  auto const curves = curves_of(b.folder / "two.dat");
  ASSERT_EQ(curves.size(), 8u);  // two modes of two boxes, undeformed and displaced
  double const size = 0.1 * std::sqrt(18.0);
  for (std::size_t i = 0; i < curves[0].size(); ++i) {
    EXPECT_LT((curves[2][i] - curves[0][i]).norm(), 1e-12);
    EXPECT_LT((curves[3][i] - curves[1][i] - Vec2(0, size)).norm(), 1e-12);
    Vec2 const arm = curves[5][i] - Vec2(3, 0), moved = curves[7][i] - curves[5][i];
    EXPECT_LT((moved - size / std::sqrt(0.5) * Vec2(arm[1], -arm[0])).norm(), 1e-12);
  }
}

// The walk passes every edge of the surface and no other.
TEST(ModePictures, WalkAlongAllEdges) {
  Surface two = box({1, 2, 3});
  int const n = int(two.points.size());
  Surface const other = cylinder(1.0, 2.0, Vec3::UnitX(), 5);
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  int begin = 0;
  for (int const end : other.ends) {
    std::vector<int> polygon;
    for (int k = begin; k < end; ++k) polygon.push_back(n + other.corners[std::size_t(k)]);
    two.add_polygon(polygon);
    begin = end;
  }
  auto const walks = detail::edge_walks<>(two);
  ASSERT_EQ(walks.size(), 2u);
  std::set<std::pair<int, int>> walked, edges;
  for (auto const& walk : walks)
    for (std::size_t i = 0; i + 1 < walk.size(); ++i) walked.insert(std::minmax(walk[i], walk[i + 1]));
  begin = 0;
  for (int const end : two.ends) {
    for (int k = begin; k < end; ++k)
      edges.insert(std::minmax(two.corners[std::size_t(k)], two.corners[std::size_t(k + 1 == end ? begin : k + 1)]));
    begin = end;
  }
  EXPECT_EQ(edges.size(), 12u + 15u);
  EXPECT_EQ(walked, edges);
}

TEST(ModePictures, FilmsOfAModeHaveOnePeriod) {
  Boxes b;
  FilmScene scene("mode 1", 30.0);
  record_mode(scene, b.visual, b.x, b.shapes, 0);
  EXPECT_EQ(scene.times().size(), 61u);
  EXPECT_NEAR(scene.times().back(), 2.0, 1e-12);
  detail::ModeShape const mode(b.visual, b.x, std::as_const(b.shapes).col(0), 0.1);
  EXPECT_NEAR((mode.displaced(1.0)[1].surface.points[0] - mode.parts()[1].surface.points[0])[1], 0.1 * std::sqrt(18.0),
              1e-12);
  EXPECT_NEAR((mode.displaced(-1.0)[1].surface.points[0] - mode.parts()[1].surface.points[0])[1],
              -0.1 * std::sqrt(18.0), 1e-12);
}

TEST(ModePictures, TitlesNameTheFrequency) {
  auto const titles = mode_titles<>(Vec2(2.0 * std::numbers::pi * 5.367, -3.0));
  EXPECT_EQ(titles[0], "mode 1, 5.367 Hz");
  EXPECT_EQ(titles[1], "mode 2, unstable");
}

TEST(ModePictures, RefuseWhatCannotBeDrawn) {
  Boxes b;
  fs::path const stem = b.folder / "none";
  EXPECT_TRUE(has(refusal([&] { write_modes(b.visual, b.x, MatX::Zero(6, 1), stem); }),
                  "a mode has 6 entries, but the state has 12 velocities"));
  EXPECT_TRUE(
      has(refusal([&] { write_modes(b.visual, b.x, MatX(12, 0), stem); }), "the matrix of shapes has no columns"));
  EXPECT_TRUE(has(refusal([&] { write_modes(b.visual, b.x, b.shapes, stem, {.size = 0.0}); }), "size"));
  EXPECT_TRUE(
      has(refusal([&] { write_modes(b.visual, b.x, b.shapes, stem, {.look_from = {0, 0, 2}}); }), "not parallel"));
  Visual empty(b.model);
  EXPECT_TRUE(has(refusal([&] { write_modes(empty, b.x, b.shapes, stem); }), "the Visual has no shape"));
  FilmScene scene("mode", 30.0);
  EXPECT_TRUE(has(refusal([&] { record_mode(scene, b.visual, b.x, b.shapes, 2); }), "mode 2 does not exist"));
  EXPECT_FALSE(fs::exists(stem.string() + ".dat"));
}

}  // namespace mode_pictures_test
