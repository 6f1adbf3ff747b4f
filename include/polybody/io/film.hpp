#pragma once
/// \file
/// Film of one or more runs as one HTML file that plays in any browser, without a network.

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <optional>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/film_scene.hpp>
#include <polybody/io/formulation_style.hpp>
#include <polybody/io/text_files.hpp>
#include <polybody/math/checksum.hpp>

namespace polybody::detail {

// Binary data of a film: a head, a table of contents as JSON, and arrays of numbers.
//
// All numbers are little-endian. The head is
//   8 bytes   "pbfilm01"; the last two digits are the version
//   4 bytes   length c of the table of contents
//   4 bytes   zero
//   8 bytes   length d of the arrays
//   8 bytes   FNV-1a of the c + d bytes that follow (math/checksum.hpp)
// The table of contents follows, then the arrays. The table refers to an array by ["f4", first byte, count of
// numbers]. Types are `f4` and `f8` (IEEE floats of 4 and 8 bytes), `i1` and `i2` (signed integers), `u2` and `u4`
// (unsigned integers).
//
// A point of a part has the position r + A (p + step·d), in world axes. The origins r ("places") and the rotations A
// ("turns", quaternions to be normalised) are stored for each frame. The points p are stored once. The deviations d
// are stored for each frame of a deformable part. They are one-byte integers if the error is at most 1e-4 of the
// part's size, otherwise two-byte integers. A scalar has the value low + (high − low)·u/65534 with a stored integer u;
// u = 65535 means no value.

inline constexpr std::string_view film_magic = "pbfilm01";

/// JSON list whose items are the results of `item`.
template <class List, class Item>
std::string json_list(List const& list, Item const& item) {
  std::string text = "[";
  for (std::size_t i = 0; i < list.size(); ++i) {
    text += i ? "," : "";
    text += item(list[i]);
  }
  return text + ']';
}

/// Range of a scalar over all parts with values of this scalar. Quantises values within the range.
struct ScalarRange {
  float low = std::numeric_limits<float>::infinity(), high = -low;

  void see(std::vector<float> const& values) {
    for (float const x : values)
      if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
  }
  std::vector<std::uint16_t> integers(std::vector<float> const& values) const {
    double const step = (double(high) - double(low)) / 65534.0;
    std::vector<std::uint16_t> out;
    for (float const x : values)
      out.push_back(!std::isfinite(x) ? 65535 : std::uint16_t(step > 0.0 ? std::lround((double(x) - low) / step) : 0));
    return out;
  }
};

/// Table of contents of one scene. The numbers of the scene are appended to `arrays`.
class SceneContents {
 public:
  SceneContents(FilmScene const& scene, int colour, FilmArrays& arrays)
      : scene_(scene), colour_(colour), arrays_(arrays) {
    ranges_.resize(scene.scalars().size());
    for (FilmPart const& part : scene.parts())
      for (std::size_t k = 0; k < ranges_.size(); ++k) ranges_[k].see(part.scalars[k]);
  }

  std::string json() {
    std::string text = "{\"name\":" + json_text(scene_.name()) + ",\"colour\":" + std::to_string(colour_) +
                       ",\"times\":" + arrays_.add(scene_.times());
    text += ",\"withoutShape\":" + json_list(scene_.invisible(), [](std::string const& s) { return json_text(s); });
    text += ",\"scalars\":[";
    for (std::size_t k = 0; k < ranges_.size(); ++k) text += (k ? "," : "") + scalar(k);
    text += "],\"shapes\":" + json_list(scene_.shapes(), [&](FilmShape const& s) { return shape(s); });
    text += ",\"parts\":" + json_list(scene_.parts(), [&](FilmPart const& p) { return part(p); });
    text += ",\"arrows\":" + json_list(scene_.arrow_sets(), [&](FilmArrowSet const& a) { return arrows(a); });
    text += ",\"plots\":" + json_list(scene_.histories(), [&](FilmHistory const& h) { return history(h); });
    return text + '}';
  }

 private:
  static std::string named(std::string const& label, std::string const& unit) {
    return "{\"label\":" + json_text(label) + ",\"unit\":" + json_text(unit);
  }

  std::string scalar(std::size_t k) const {
    ScalarRange const& r = ranges_[k];
    bool const some = r.low <= r.high;  // false: no part has a value
    return named(scene_.scalars()[k].label, scene_.scalars()[k].unit) + ",\"low\":" + all_digits(some ? r.low : 0.0) +
           ",\"high\":" + all_digits(some ? r.high : 0.0) + '}';
  }

  std::string shape(FilmShape const& s) {
    auto const full = [](std::vector<int> const& v) { return std::vector<std::uint32_t>(v.begin(), v.end()); };
    return "{\"points\":" + arrays_.add(s.points) + ",\"corners\":" + arrays_.add(full(s.corners)) +
           ",\"ends\":" + arrays_.add(full(s.ends)) + '}';
  }

  std::string part(FilmPart const& p) {
    std::string text = "{\"name\":" + json_text(p.name) + ",\"shape\":" + std::to_string(p.shape) +
                       ",\"places\":" + arrays_.add(p.places) + ",\"turns\":" + arrays_.add(p.turns);
    if (!p.rigid) {
      Quantised q = quantised(p.deviations, 127.0);
      bool const fine = 0.5 * q.step <= 1e-4 * size_of(p);
      if (!fine) q = quantised(p.deviations);
      text += ",\"deviations\":" + (fine ? arrays_.add(std::vector<std::int8_t>(q.integers.begin(), q.integers.end()))
                                         : arrays_.add(q.integers));
      text += ",\"step\":" + all_digits(q.step);
    }
    text += ",\"scalars\":[";
    for (std::size_t k = 0; k < ranges_.size(); ++k) {
      text += k ? "," : "";
      text += p.scalars[k].empty() ? "null" : arrays_.add(ranges_[k].integers(p.scalars[k]));
    }
    return text + "]}";
  }

  /// Diagonal of the bounding box of a part [m].
  static double size_of(FilmPart const& p) {
    Vec3 low = p.points.front(), high = low;
    for (Vec3 const& x : p.points) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    return (high - low).norm();
  }

  std::string arrows(FilmArrowSet const& a) {
    Quantised const q = quantised(a.vectors);
    return named(a.label, a.unit) + ",\"shown\":" + (a.visible ? "true" : "false") +
           ",\"counts\":" + arrays_.add(a.counts) + ",\"places\":" + arrays_.add(a.places) +
           ",\"vectors\":" + arrays_.add(q.integers) + ",\"step\":" + all_digits(q.step) + '}';
  }

  std::string history(FilmHistory const& h) {
    return named(h.label, h.unit) + ",\"times\":" + arrays_.add(h.times) + ",\"values\":" + arrays_.add(h.values) + '}';
  }

  FilmScene const& scene_;
  int colour_;
  FilmArrays& arrays_;
  std::vector<ScalarRange> ranges_;
};

/// Colours of the scenes in plots, indices into the colours of plot.hpp. A scene has its preferred colour if no earlier
/// scene has it, otherwise the first colour that no scene has. From nine scenes on, colours repeat.
template <class = void>
std::vector<int> scene_colours(std::deque<FilmScene> const& scenes) {
  std::vector<int> colours(scenes.size(), -1);
  auto const taken = [&](int colour) { return std::ranges::count(colours, colour) > 0; };
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (int const colour = scenes[i].preferred_colour(); colour >= 0 && !taken(colour)) colours[i] = colour;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (colours[i] >= 0) continue;
    int colour = 0;
    while (colour < int(palette.size()) && taken(colour)) ++colour;
    colours[i] = colour < int(palette.size()) ? colour : int(i % palette.size());
  }
  return colours;
}

/// Encodes all scenes as bytes.
/// \param page JSON members of the table of contents except the scenes
template <class = void>
std::string film_bytes(std::string const& page, std::deque<FilmScene> const& scenes) {
  FilmArrays arrays;
  std::vector<int> const colours = scene_colours(scenes);
  auto colour = colours.begin();
  std::string contents =
      '{' + page + ",\"scenes\":" +
      json_list(scenes, [&](FilmScene const& scene) { return SceneContents(scene, *colour++, arrays).json(); }) + '}';
  contents.resize((contents.size() + 7) / 8 * 8, ' ');
  std::string const& numbers = arrays.bytes();
  std::string bytes(film_magic);
  append_bytes(bytes, std::uint32_t(contents.size()));
  append_bytes(bytes, std::uint32_t(0));
  append_bytes(bytes, std::uint64_t(numbers.size()));
  contents += numbers;
  append_bytes(bytes, checksum(contents));
  return bytes + contents;
}

}  // namespace polybody::detail

namespace polybody {

/// Position of the grid of a scene: below the scene, behind the scene, or no grid.
enum class FilmFloor { ground, behind, none };

/// Options of a film: viewer, title, frame rate, camera and grid.
struct FilmOptions {
  /// HTML page of the viewer, `polybody_viewer.html`. CMake's target `viewer` builds it in the build folder and
  /// installs it in share/polybody/viewer.
  std::filesystem::path viewer;
  std::string title = "polybody";   ///< title of the page
  double frames_per_second = 30.0;  ///< frames per second of simulated time [1/s]
  /// (3) direction from the scene to the camera in world axes (empty: (−2, −3, 1.5), or z if all scenes are planar).
  std::optional<Vec3> look_from = {};
  std::optional<Vec3> up = {};  ///< (3) upward direction in world axes (empty: z, or y if all are planar)
  std::string follow = {};      ///< name of the part that the camera follows; empty: none
  /// Position of the grid: below the scene and normal to `up`, or behind the scene and normal to `look_from`. Empty:
  /// below, or behind if all scenes are planar.
  std::optional<FilmFloor> floor = {};
};

namespace detail {

/// Placeholder for the film in the viewer's file. The file contains the placeholder once.
inline constexpr std::string_view film_slot = "<!--polybody-film-->";

/// Returns the text of the viewer's page.
/// \throws IoError if the file does not exist or is not a viewer.
template <class = void>
std::string viewer_page(std::filesystem::path const& file) {
  char const* const remedy =
      " Build polybody's CMake target 'viewer', which needs npm, and set FilmOptions::viewer to polybody_viewer.html "
      "in the build folder, or in share/polybody/viewer of an installation.";
  if (file.empty()) throw IoError("film.viewer", {ErrorObject{"Film"}, ": the viewer is missing.", remedy});
  std::optional<std::string> page = content_of(file);
  if (!page)
    throw IoError("film.viewer", {"Film: the viewer \"", ErrorObject{file.string()}, "\" does not exist.", remedy});
  std::size_t const slot = page->find(film_slot);
  if (slot == page->npos || page->find(film_slot, slot + 1) != page->npos)
    throw IoError("film.viewer",
                  {"Film: \"", ErrorObject{file.string()}, "\" is not a film viewer of polybody.", remedy});
  return std::move(*page);
}

/// Escapes a text for an HTML element.
template <class = void>
std::string html_text(std::string const& text) {
  std::string out;
  for (char const c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return out;
}

}  // namespace detail

/// Film of several scenes side by side, with a common clock and camera:
///   Film film({.viewer = "polybody_viewer.html", .title = "The arm"});
///   FilmScene& scene = film.scene("LRVF");
///   for (State const& now : simulate(…))
///     if (scene.due(now.t)) scene.record(visual, now);
///   film.write("out/arm.html");
/// In each frame, a part with constant shape needs 20 bytes. A deformable part needs 3 or 6 more bytes for each point,
/// and a colour scalar 2 bytes for each point. In the file, these bytes are base 64 text, which is longer by a third.
class Film {
 public:
  /// Empty film. Checks the options and reads the viewer.
  /// \throws InvalidInput for a frame rate that is not positive, and for view directions that are parallel or not
  /// finite.
  /// \throws IoError if the viewer does not exist or is not a viewer of polybody.
  explicit Film(FilmOptions options) : options_(std::move(options)) {
    require_positive(options_.frames_per_second, "Film: the frames per second");
    if (options_.look_from || options_.up) require_view(view(false));
    page_ = detail::viewer_page(options_.viewer);
  }

  /// Adds a scene with this `name`. The reference remains valid as long as the film exists.
  /// \param formulation family of the body, such as `formulation_family<Lrvf<>>`, or name of the policy of the joints.
  /// It determines the colour of the scene in plots, as in other figures (`formulation_colour`). With other names, or
  /// if an earlier scene has this colour, the scene has the first unused colour.
  /// \throws InvalidInput if another scene has the same name.
  FilmScene& scene(std::string name, std::string_view formulation = {}) {
    for (FilmScene const& other : scenes_)
      if (other.name() == name)
        throw InvalidInput("film.scene", {"Film: duplicate scene name \"", ErrorObject{name}, "\"."});
    return scenes_.emplace_back(std::move(name), options_.frames_per_second, formulation_colour(formulation));
  }

  std::size_t scenes() const { return scenes_.size(); }  ///< number of scenes

  /// Writes the film to `file`, which appears when it is complete.
  /// \return size of the file [bytes]
  /// \throws InvalidInput if the film has no scene, if a scene has no frames or no part with the name `follow`, or if
  /// the view directions are parallel.
  /// \throws IoError if the file cannot be written.
  std::size_t write(std::filesystem::path const& file) const {
    if (scenes_.empty())
      throw InvalidInput("film.scene",
                         {"Film \"", ErrorObject{options_.title}, "\" has no scene. Call scene(name) first."});
    for (FilmScene const& scene : scenes_) require_complete(scene);
    require_view(view(planar()));
    std::size_t const slot = page_.find(detail::film_slot);
    std::string text = page_.substr(0, slot);
    std::size_t const title = text.find("<title>");
    if (title != text.npos) text.insert(title + 7, detail::html_text(options_.title) + " · ");
    text += "<script type=\"application/x-polybody-film\" id=\"film\">";
    text += detail::base64(detail::film_bytes(contents(), scenes_));
    text += "</script>";
    text += page_.substr(slot + detail::film_slot.size());
    AtomicFile out(file);
    out.write(text);
    out.close();
    return text.size();
  }

 private:
  void require_complete(FilmScene const& scene) const {
    if (scene.times().empty())
      throw InvalidInput("film.scene", {"Film: the scene \"", ErrorObject{scene.name()},
                                        "\" has no frame. Record at least one frame."});
    bool found = options_.follow.empty();
    for (detail::FilmPart const& part : scene.parts()) found = found || part.name == options_.follow;
    if (!found)
      throw InvalidInput("film.scene", {"Film: the scene \"", ErrorObject{scene.name()}, "\" has no part \"",
                                        options_.follow, "\". Set FilmOptions::follow to the name of a part."});
  }

  bool planar() const { return std::ranges::all_of(scenes_, &FilmScene::planar); }

  /// Directions to the camera and upwards.
  std::array<Vec3, 2> view(bool planar) const {
    return {options_.look_from.value_or(planar ? Vec3(0, 0, 1) : Vec3(-2, -3, 1.5)),
            options_.up.value_or(planar ? Vec3(0, 1, 0) : Vec3(0, 0, 1))};
  }
  static void require_view(std::array<Vec3, 2> const& view) {
    if (!(view[0].cross(view[1]).norm() > 1e-6 * view[0].norm() * view[1].norm()))
      throw InvalidInput("film.camera",
                         {ErrorObject{"Film"},
                          ": look_from and up must be finite and not parallel, but the sine of the angle "
                          "between them is ",
                          view[0].normalized().cross(view[1].normalized()).norm(), "."});
  }

  /// JSON members of the film's table of contents, without the scenes.
  std::string contents() const {
    auto const vector = [](Vec3 const& v) {
      return '[' + detail::all_digits(v[0]) + ',' + detail::all_digits(v[1]) + ',' + detail::all_digits(v[2]) + ']';
    };
    bool const flat = planar();
    auto const [look_from, up] = view(flat);
    FilmFloor const floor = options_.floor.value_or(flat ? FilmFloor::behind : FilmFloor::ground);
    char const* const floors[] = {"ground", "behind", "none"};
    return "\"title\":" + detail::json_text(options_.title) +
           ",\"framesPerSecond\":" + detail::all_digits(options_.frames_per_second) +
           ",\"lookFrom\":" + vector(look_from) + ",\"up\":" + vector(up) +
           ",\"follow\":" + detail::json_text(options_.follow) + ",\"floor\":\"" + floors[int(floor)] + '"';
  }

  FilmOptions options_;
  std::string page_;
  std::deque<FilmScene> scenes_;
};

}  // namespace polybody
