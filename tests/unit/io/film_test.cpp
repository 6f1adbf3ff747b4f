// Films: the data that a Film writes, and their playback in a browser. The viewer's own decoder reads the data in
// node (film_decode.mjs), and chromium plays the film (film_browser.mjs).
#include <polybody/io/film.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <source_location>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/io/vtk.hpp>

#include "support/refusal.hpp"

namespace film_test {

namespace fs = std::filesystem;
using namespace polybody;
using Cable = AncfCable<EngineeringStrain>;

/// The viewer of this build, or a path that does not exist.
fs::path viewer() {
  char const* const given = std::getenv("POLYBODY_VIEWER");
  return given ? given : POLYBODY_VIEWER;
}

/// Exit code of a script in this test's folder, which may write to `out`; 77 if the script cannot run on this
/// machine.
int run_node(std::string const& script, fs::path const& out,
             std::source_location const& test = std::source_location::current()) {
  fs::path const folder = fs::path(test.file_name()).parent_path();
  int const status = std::system(("node '" + (folder / script.substr(0, script.find(' '))).string() + "'" +
                                  script.substr(script.find(' ')) + " > '" + out.string() + "' 2>&1")
                                     .c_str());
  int const code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return code == 127 ? 77 : code;
}

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A brick with two boxes, and a cable that bends and twists, in eleven frames over one second.
struct FilmFiles : testing::Test {
  static constexpr int frames = 11;
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody film & co " + std::to_string(::getpid()));
  fs::path const bare_viewer = folder / "viewer.html";  // accepts a film and cannot play it
  Bar const bar{.length = 2.0,
                .section = Rectangle{.height = 0.1, .width = 0.06},
                .material = Material{.density = 1000.0, .young = 1e9, .poisson = 0.3}};
  Model<Bodies<Rigid<>, Cable>, Joints<>> model;
  BodyHandle<Rigid<>> brick = model.add(Rigid<>(2.0, Mat3::Identity()), "brick");
  BodyHandle<Cable> cable = model.add(Cable::from(bar, 5), "cable");
  Visual visual{model};
  State x = model.reference_state();
  double bend = 0.1;  // amplitude of the cable's coordinates [m]

  FilmFiles() {
    visual.attach(brick.at({1, 0, 0}), box({0.2, 0.4, 0.6}), "box 1");
    visual.attach(brick.at({0, 0, 1}), box({0.2, 0.4, 0.6}), "box 2");
    visual.sweep(cable, bar, 5);
    fs::create_directories(folder);
    std::ofstream(bare_viewer) << "<title>film</title><!--polybody-film--><p>end</p>";
  }
  ~FilmFiles() override { fs::remove_all(folder); }

  void go_to(int frame) {
    double const t = 0.1 * frame;
    x = model.reference_state();
    x.t = t;
    x.q.head(7) << 20.0 * t, 0.5 * std::sin(6 * t), 1.0 + t, std::cos(t), 0, std::sin(t), 0;
    for (Index i = 7; i < x.q.size(); ++i) x.q[i] += bend * std::sin(7.0 * t + double(i));
    model.set_velocity(x, brick, Vec3(1, 0, 2), Vec3(0, 0, 3));
  }

  /// One scene with all kinds of content; also the same states for ParaView, if a collection is named.
  void record(Film& film, std::string const& name, fs::path const& collection = {}) {
    FilmScene& scene = film.scene(name, formulation_family<Cable>);
    scene.colour(axial_stress_colours());
    FilmArrows const forces = scene.arrows("force", "N");
    std::optional<VtkWriter> writer;
    if (!collection.empty()) writer.emplace(collection, visual);
    for (int k = 0; k < frames; ++k) {
      go_to(k);
      scene.plot("height \"z\"", "m", x.t, x.q[2]);
      scene.record(x.t, visual.at(x));
      for (int i = 0; i < k % 3; ++i) scene.arrow(forces, Vec3(i, k, 0), Vec3(-5.0 * k, i, 40));
      if (writer) writer->write(x);
    }
  }
  Film film_with(fs::path const& page) {
    return Film({.viewer = page, .title = "Boxes & <cable>", .frames_per_second = 10, .follow = "box 1"});
  }
};

// The error of points is half a step of the deviations plus the errors of rotations and float32; the error of arrows
// is half a step. Deviations of the second scene are so small that one byte is enough.
TEST_F(FilmFiles, HoldWhatWasRecordedAndAreRefusedWhereverTheyAreDamaged) {
  Film film = film_with(bare_viewer);
  std::array<double, 2> const bends{0.1, 0.002};
  std::vector<double> half_steps;  // half a quantisation step of the scalars [MPa]
  for (double const size : bends) {
    bend = size;
    record(film, "bent by " + number(size));
    double low = 0.0, high = 0.0;
    for (int k = 0; k < frames; ++k) {
      go_to(k);
      for (double const s : visual.at(x)[2].axial_stress) low = std::min(low, s), high = std::max(high, s);
    }
    half_steps.push_back(1e-6 * (0.501 * (high - low) / 65534.0));
  }
  film.write(folder / "film.html");
  int const code = run_node("film_decode.mjs '" + (folder / "film.html").string() + "'", folder / "found.txt");
  if (code == 77) GTEST_SKIP() << "node is missing (Debian: nodejs)";
  EXPECT_EQ(code, 0) << text_of(folder / "found.txt").substr(0, 2000);
  std::ifstream found(folder / "found.txt");
  int points = 0, scalars = 0, arrows = 0, plots = 0;
  std::vector<double> colours;
  std::map<std::pair<int, int>, int> of_frame;
  for (std::string line; std::getline(found, line);) {
    std::istringstream words(line);
    std::string what;
    int scene, frame, of, k = 0;
    words >> what >> scene >> frame >> of;
    if (what == "scalar") words >> k;
    std::vector<double> const numbers{std::istream_iterator<double>(words), std::istream_iterator<double>()};
    bend = bends[std::size_t(scene)];
    go_to(frame);
    VisualPart const& part = visual.at(x)[what == "part" || what == "scalar" ? std::size_t(of) : 0];
    if (what == "part") {
      ASSERT_EQ(numbers.size(), 3 * part.surface.points.size());
      for (std::size_t i = 0; i < numbers.size(); ++i, ++points)
        EXPECT_NEAR(numbers[i], part.surface.points[i / 3][Index(i % 3)],
                    of < 2       ? 1e-4 * 0.4 + 3e-6
                    : scene == 0 ? 1e-5
                                 : 0.5 * 0.02 / 127)
            << line;
    } else if (what == "scalar") {
      EXPECT_EQ(of, 2);
      ASSERT_EQ(numbers.size(), part.axial_stress.size());
      for (std::size_t i = 0; i < numbers.size(); ++i, ++scalars)
        EXPECT_NEAR(numbers[i], 1e-6 * part.axial_stress[i], half_steps[std::size_t(scene)]) << line;
    } else if (what == "arrow") {
      int const i = of_frame[{scene, frame}]++;  // frames 1, 2, 4, 5, … have 1, 2, 1, 2, … arrows
      ++arrows;
      std::vector<double> const wanted{double(i), double(frame), 0, -5.0 * frame, double(i), 40};
      for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(numbers[c], wanted[c], c < 3 ? 0.0 : 0.5 * 50 / 32767.0 + 1e-6);
    } else if (what == "colour") {
      colours.push_back(numbers.at(0));
    } else if (what == "plot") {
      ASSERT_EQ(numbers.size(), 2u * frames);
      for (int i = 0; i < frames; ++i, ++plots) EXPECT_NEAR(numbers[std::size_t(frames + i)], 1.0 + 0.1 * i, 1e-6);
    }
  }
  EXPECT_EQ(points, 2 * 3 * frames * (8 + 8 + 24));
  EXPECT_EQ(scalars, 2 * frames * 24);
  EXPECT_EQ(arrows, 20);
  EXPECT_EQ(plots, 2 * frames);
  EXPECT_EQ(colours, (std::vector<double>{double(formulation_style(families::cable_engineering).colour), 0.0}));
}

// A scene has the colour of its formulation in all films; other scenes have colours that are unused in their film.
TEST_F(FilmFiles, HaveTheColoursOfTheirFormulations) {
  auto const colours = [](std::vector<std::string_view> const& formulations) {
    std::deque<FilmScene> scenes;
    for (std::string_view const formulation : formulations)
      scenes.emplace_back("scene", 30.0, formulation_colour(formulation));
    return detail::scene_colours(scenes);
  };
  using families::cable_green, families::lrvf;
  int const orange = 3, blue = 0;
  EXPECT_EQ(colours({"Constraint", cable_green}), (std::vector{blue, orange}));
  EXPECT_EQ(colours({cable_green, lrvf}), (std::vector{orange, blue}));
  EXPECT_EQ(colours({"", cable_green, lrvf, lrvf, "my body"}), (std::vector{1, orange, blue, 2, 4}));
  EXPECT_EQ(colours(std::vector<std::string_view>(10)), (std::vector{0, 1, 2, 3, 4, 5, 6, 7, 0, 1}));
}

// Ten pictures per second while other tests use the processors; alone it draws 45.
TEST_F(FilmFiles, PlayInABrowser) {
  if (!fs::exists(viewer())) GTEST_SKIP() << "there is no viewer " << viewer() << ": it needs npm";
  Film film = film_with(viewer());
  record(film, "one", folder / "one.pvd");
  record(film, "two", folder / "two.pvd");
  film.write(folder / "film.html");
  auto const quoted = [&](char const* name) { return " '" + (folder / name).string() + "'"; };
  char const* const pictures = std::getenv("POLYBODY_PICTURES");  // a folder for the pictures
  int const code = run_node("film_browser.mjs" + (pictures ? " --pictures '" + std::string(pictures) + "'" : "") +
                                quoted("film.html") + " --damage --rate 2 --places" + quoted("one.pvd") + " --places" +
                                quoted("two.pvd"),
                            folder / "told.txt");
  if (code == 77) GTEST_SKIP() << "node or chromium is missing (Debian: nodejs chromium)";
  EXPECT_EQ(code, 0) << text_of(folder / "told.txt");
}

TEST_F(FilmFiles, SharesShapesAndFollowsTheNumberOfFrames) {
  Film film = film_with(bare_viewer);
  record(film, "one");
  std::size_t const size = film.write(folder / "film.html");
  std::string const page = text_of(folder / "film.html");
  EXPECT_EQ(size, page.size());
  EXPECT_TRUE(page.starts_with("<title>Boxes &amp; &lt;cable> · film</title><script type="));
  EXPECT_TRUE(page.ends_with("</script><p>end</p>"));
  FilmScene& scene = film.scene("two");
  EXPECT_TRUE(scene.due(0.0));
  go_to(0);
  scene.record(0.0, visual.at(x));
  EXPECT_FALSE(scene.due(0.09));
  EXPECT_TRUE(scene.due(0.1));
  EXPECT_EQ(scene.parts()[0].shape, scene.parts()[1].shape);
  EXPECT_EQ(scene.shapes().size(), 2u);
}

/// Bytes of a film in its page [RFC 4648, §4], as text: the table of contents can be searched.
std::string content_of_film(fs::path const& file) {
  std::string const page = text_of(file), head = "id=\"film\">";
  std::string const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned buffer = 0;
  int bits = 0;
  for (std::size_t i = page.find(head) + head.size(); page[i] != '<' && page[i] != '='; ++i) {
    buffer = (buffer << 6) | unsigned(digits.find(page[i]));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += char((buffer >> bits) & 255u);
  }
  return bytes;
}

/// Content of a film of one frame of a model with one rod.
template <class Body, class M, class Centre>
std::string content_of_rod(M& model, Body const& body, Centre const& centre, FilmOptions const& options,
                           fs::path const& file) {
  auto const rod = model.add(body, "rod");
  Visual visual(model);
  visual.attach(model.ground().at(Vec3::Zero()), box({0.1, 0.1, 0.1}), "stand");
  visual.attach(rod.at(centre), box({1, 0.1, 0.1}), "shape of the rod");
  Film film(options);
  film.scene("one").record(visual, model.reference_state());
  film.write(file);
  return content_of_film(file);
}

TEST_F(FilmFiles, ShowPlanarModelsUprightAndOthersFromTheSide) {
  FilmOptions options{.viewer = bare_viewer};
  fs::path const file = folder / "film.html";
  auto const plane = [&] {
    Model<Bodies<planar::Rigid>, Joints<>> flat;
    return content_of_rod(flat, planar::Rigid(1.0, 0.1), Vec2(0, 0), options, file);
  };
  auto const space = [&] {
    Model<Bodies<Rigid<>>, Joints<>> deep;
    return content_of_rod(deep, Rigid<>(1.0, Mat3::Identity()), Vec3(0, 0, 0), options, file);
  };
  EXPECT_TRUE(has(plane(), "\"lookFrom\":[0,0,1],\"up\":[0,1,0],\"follow\":\"\",\"floor\":\"behind\""));
  EXPECT_TRUE(has(space(), "\"lookFrom\":[-2,-3,1.5],\"up\":[0,0,1],\"follow\":\"\",\"floor\":\"ground\""));
  options.look_from = Vec3(1, 0, 1);
  options.floor = FilmFloor::none;
  EXPECT_TRUE(has(plane(), "\"lookFrom\":[1,0,1],\"up\":[0,1,0],\"follow\":\"\",\"floor\":\"none\""));
  options.look_from = Vec3(0, 1, 0);  // upwards in the plane, but not in space
  EXPECT_TRUE(has(refusal([&] { (void)plane(); }), "look_from and up"));
  EXPECT_TRUE(has(space(), "\"lookFrom\":[0,1,0],\"up\":[0,0,1]"));
}

TEST_F(FilmFiles, NameTheBodiesWithoutAShape) {
  EXPECT_EQ(visual.bodies_without_shape(), std::vector<std::string>{});
  Visual part(model);
  EXPECT_EQ(part.bodies_without_shape(), (std::vector<std::string>{"brick", "cable"}));
  part.attach(brick.at({1, 0, 0}), box({0.2, 0.4, 0.6}));
  EXPECT_EQ(part.bodies_without_shape(), std::vector<std::string>{"cable"});
  Film film({.viewer = bare_viewer});
  film.scene("one").record(part, x);
  film.write(folder / "film.html");
  EXPECT_TRUE(has(content_of_film(folder / "film.html"), "\"withoutShape\":[\"cable\"]"));
}

TEST_F(FilmFiles, RefuseAViewerThatIsNotThere) {
  EXPECT_TRUE(
      has(message_of<IoError>([] { Film({.viewer = {}}); }), "the viewer is missing. Build polybody's CMake target"));
  EXPECT_TRUE(has(message_of<IoError>([&] { Film({.viewer = folder / "none.html"}); }),
                  "none.html\" does not exist. Build polybody's"));
  EXPECT_TRUE(has(message_of<IoError>([&] { Film({.viewer = folder}); }), "does not exist"));
  std::ofstream(folder / "page.html") << "<p>";
  EXPECT_TRUE(has(message_of<IoError>([&] { Film({.viewer = folder / "page.html"}); }), "is not a film viewer"));
  EXPECT_TRUE(has(refusal([&] { Film({.viewer = bare_viewer, .frames_per_second = 0.0}); }), "frames per second"));
  EXPECT_TRUE(has(refusal([&] { Film({.viewer = bare_viewer, .up = Vec3(2, 3, -1.5)}); }), "look_from and up"));
}

TEST_F(FilmFiles, LeaveNothingHalfWritten) {
  Film film = film_with(bare_viewer);
  EXPECT_TRUE(has(refusal([&] { film.write(folder / "film.html"); }), "has no scene"));
  FilmScene& scene = film.scene("one");
  EXPECT_TRUE(has(refusal([&] { film.write(folder / "film.html"); }), "\"one\" has no frame"));
  EXPECT_TRUE(has(refusal([&] { film.scene("one"); }), "duplicate scene name \"one\""));
  scene.record(0.0, visual.at(x));
  std::ofstream(folder / "plain") << "x";
  EXPECT_TRUE(has(message_of<IoError>([&] { film.write(folder / "plain" / "film.html"); }), "film.html"));
  fs::create_directories(folder / "taken.html");
  EXPECT_TRUE(has(message_of<IoError>([&] { film.write(folder / "taken.html"); }), "not a regular file"));
  Film lost({.viewer = bare_viewer, .follow = "nobody"});
  lost.scene("one").record(0.0, visual.at(x));
  EXPECT_TRUE(has(refusal([&] { lost.write(folder / "film.html"); }), "no part \"nobody\". Set FilmOptions::follow"));
  EXPECT_FALSE(fs::exists(folder / "film.html"));
  for (auto const& entry : fs::recursive_directory_iterator(folder)) EXPECT_NE(entry.path().extension(), ".tmp");
}

TEST_F(FilmFiles, RefuseWhatCannotBeShown) {
  Film film = film_with(bare_viewer);
  FilmScene& scene = film.scene("one");
  scene.colour({"one too few", "-", [](VisualPart const& part) {
                  return std::vector<double>(part.name == "cable" ? part.velocities.size() - 1 : 0);
                }});
  EXPECT_TRUE(has(refusal([&] { scene.colour({"one too few", "-", {}}); }), "already has a colour scalar"));
  EXPECT_TRUE(has(refusal([&] { scene.arrow({0}, Vec3::Zero(), Vec3::Zero()); }), "Record a frame first"));
  EXPECT_TRUE(has(refusal([&] { scene.record(0.0, {}); }), "the frame has no parts"));
  EXPECT_TRUE(has(refusal([&] { scene.record(0.0, visual.at(x)); }), "on \"cable\" differs from the number of points"));
  FilmScene& two = film.scene("two");
  FilmArrows const forces = two.arrows("force", "N");
  two.record(0.5, visual.at(x));
  EXPECT_TRUE(has(refusal([&] { two.arrows("late", "N"); }), "must be defined before the first frame"));
  EXPECT_TRUE(has(refusal([&] { two.record(0.5, visual.at(x)); }), "t = 0.5 s follows 0.5 s"));
  EXPECT_TRUE(has(refusal([&] { two.record(1.0, {visual.at(x)[0]}); }), "differ from the parts of the first frame"));
  Vec3 const nan = Vec3::Constant(std::nan(""));
  EXPECT_TRUE(
      has(message_of<NonFiniteValue>([&] { two.arrow(forces, nan, Vec3::Zero()); }), "\"force\" is not finite"));
  EXPECT_TRUE(has(message_of<NonFiniteValue>([&] { two.plot("p", "N", 0.0, std::nan("")); }), "\"p\" is not finite"));
  two.plot("p", "N", 0.0, 1.0);
  EXPECT_TRUE(has(refusal([&] { two.plot("p", "N", 0.0, 1.0); }), "must increase"));
  EXPECT_TRUE(
      has(refusal([&] { two.plot("p", "kN", 1.0, 1.0); }), "has the unit \"N\", but a further point has \"kN\""));
  x.q[0] = std::nan("");
  EXPECT_TRUE(
      has(message_of<NonFiniteValue>([&] { two.record(1.0, visual.at(x)); }), "\"box 1\" is not finite at t = 1 s"));
  EXPECT_EQ(two.times().size(), 1u);
}

TEST(FilmBytes, AreWhatTheStandardsSay) {
  using namespace polybody::detail;
  FilmArrays arrays;
  EXPECT_EQ(arrays.add(std::vector<std::int8_t>{-1, 2, 3}), "[\"i1\",0,3]");
  EXPECT_EQ(arrays.add(std::vector<float>{1.0f}), "[\"f4\",8,1]");
  EXPECT_EQ(arrays.add(std::vector<float>{1.0f}), "[\"f4\",8,1]");  // stored once
  EXPECT_EQ(arrays.bytes(), std::string("\xff\2\3\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 16));
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");  // RFC 4648, §10
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
  EXPECT_EQ(json_text("a\"\\\n\x01é"), "\"a\\\"\\\\\\u000a\\u0001é\"");
  std::string bytes;
  append_bytes(bytes, 1.0f);
  append_bytes(bytes, std::int16_t(-2));
  EXPECT_EQ(bytes, std::string("\0\0\x80\x3f\xfe\xff", 6));
  std::vector<float> const values{0.5f, -2.0f, 1.0f};
  Quantised const q = quantised(values);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(q.step * q.integers[i], values[i], 0.5 * q.step + 1e-12);
  EXPECT_EQ(quantised({0.0f}).integers[0], 0);
}

}  // namespace film_test
