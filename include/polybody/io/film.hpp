#pragma once
/// \file
/// Film of a run as one HTML file that plays in any browser, without a network. Not in polybody.hpp: few programs
/// need it.

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <optional>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/file_content.hpp>
#include <polybody/io/film_encoding.hpp>

namespace polybody {

/// Position of the grid of a scene: below the scene, behind the scene, or no grid.
enum class FilmFloor { ground, behind, none };

/// Options of a film: title, viewer, frame rate and camera.
struct FilmOptions {
  /// HTML page of the viewer, `polybody_viewer.html`. CMake's target `viewer` builds it in the build folder and
  /// installs it in share/polybody/viewer.
  std::filesystem::path viewer;
  std::string title = "polybody";   ///< title of the page
  double frames_per_second = 30.0;  ///< frames per second of simulated time [1/s]
  /// (3) direction from the scene to the camera in world axes (empty: (−2, −3, 1.5), or z if all scenes are planar).
  std::optional<Vec3> look_from = {};
  std::optional<Vec3> up = {};  ///< (3) upward direction in world axes (empty: z, or y if planar)
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
                  {"Film: \"", ErrorObject{file.string()}, "\" is not a viewer of films of polybody.", remedy});
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
/// A part with constant shape needs 20 bytes a frame. A deformable part needs 3 or 6 more bytes for each point. A
/// colour scalar needs 2 bytes for each point.
class Film {
 public:
  /// Empty film. Checks the options and reads the viewer.
  /// \throws InvalidInput for a frame rate that is not positive, and for view directions that are parallel or not
  /// finite.
  /// \throws IoError if the viewer does not exist.
  explicit Film(FilmOptions options) : options_(std::move(options)) {
    require_positive(options_.frames_per_second, "Film: the frames per second");
    if (options_.look_from || options_.up) require_view(view(false));
    page_ = detail::viewer_page(options_.viewer);
  }

  /// Adds a scene with this `name`. The reference remains valid as long as the film exists.
  /// \throws InvalidInput if another scene has the same name.
  FilmScene& scene(std::string name) {
    for (FilmScene const& other : scenes_)
      if (other.name() == name)
        throw InvalidInput("film.scene", {"Film: duplicate scene name \"", ErrorObject{name}, "\"."});
    return scenes_.emplace_back(std::move(name), options_.frames_per_second);
  }

  std::size_t scenes() const { return scenes_.size(); }  ///< number of scenes

  /// Writes the film to `file`, which appears when it is complete.
  /// \return size of the file [bytes]
  /// \throws InvalidInput if the film has no scene, a scene has no frames, or a scene has no part with the name
  /// `follow`.
  /// \throws IoError if the file cannot be written.
  std::size_t write(std::filesystem::path const& file) const {
    if (scenes_.empty()) throw InvalidInput("film.scene", {"Film \"", ErrorObject{options_.title}, "\" has no scene."});
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
      throw InvalidInput("film.scene", {"Film: the scene \"", ErrorObject{scene.name()}, "\" has no frame."});
    bool found = options_.follow.empty();
    for (detail::FilmPart const& part : scene.parts()) found = found || part.name == options_.follow;
    if (!found)
      throw InvalidInput("film.scene", {"Film: the scene \"", ErrorObject{scene.name()}, "\" has no part \"",
                                        options_.follow, "\" to follow."});
  }

  bool planar() const { return std::ranges::all_of(scenes_, &FilmScene::planar); }

  /// Directions to the camera and upwards.
  std::array<Vec3, 2> view(bool planar) const {
    return {options_.look_from.value_or(planar ? Vec3(0, 0, 1) : Vec3(-2, -3, 1.5)),
            options_.up.value_or(planar ? Vec3(0, 1, 0) : Vec3(0, 0, 1))};
  }
  static void require_view(std::array<Vec3, 2> const& view) {
    if (!(view[0].cross(view[1]).norm() > 1e-6 * view[0].norm() * view[1].norm()))
      throw InvalidInput("film.camera", {ErrorObject{"Film"}, ": look_from and up must be finite and not parallel."});
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
