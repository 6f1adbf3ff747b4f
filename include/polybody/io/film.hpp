#pragma once
/// \file
/// A run as one HTML file that plays in any browser, without a network. Not in polybody.hpp: few programs need it.

#include <deque>
#include <filesystem>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/file_content.hpp>
#include <polybody/io/film_encoding.hpp>

namespace polybody {

/// What lies under a scene.
enum class FilmFloor { ground, behind, none };

/// What a film is called, where its viewer is, and how it is looked at.
struct FilmOptions {
  /// The page that plays: `polybody_viewer.html`, which CMake's target `viewer` makes in the build folder and
  /// installs in share/polybody/viewer.
  std::filesystem::path viewer;
  std::string title = "polybody";      ///< of the page
  double frames_per_second = 30.0;     ///< of simulated time [1/s]
  Vec3 look_from = Vec3(-2, -3, 1.5);  ///< (3) direction from what is seen to the eye, world axes
  Vec3 up = Vec3::UnitZ();             ///< (3) direction that is up in the picture, world axes
  std::string follow = {};             ///< name of the part that the camera goes with; empty: none
  /// A grid: across `up` below all that is seen, or across `look_from` behind it.
  FilmFloor floor = FilmFloor::ground;
};

namespace detail {

/// Where the viewer takes the film, once in its file.
inline constexpr std::string_view film_slot = "<!--polybody-film-->";

/// \throws IoError for a viewer that is not there or is none.
template <class = void>
std::string viewer_page(std::filesystem::path const& file) {
  char const* const remedy =
      " Build polybody's CMake target 'viewer', which needs npm, and name polybody_viewer.html of the build folder, or "
      "of "
      "share/polybody/viewer where polybody is installed, in FilmOptions::viewer.";
  if (file.empty()) throw IoError{"Film: no viewer is named.", remedy};
  std::optional<std::string> page = content_of(file);
  if (!page) throw IoError{"Film: there is no viewer '", file.string(), "'.", remedy};
  std::size_t const slot = page->find(film_slot);
  if (slot == page->npos || page->find(film_slot, slot + 1) != page->npos)
    throw IoError{"Film: '", file.string(), "' is not a viewer of films of polybody.", remedy};
  return std::move(*page);
}

/// Text of an HTML element.
template <class = void>
std::string html_text(std::string const& text) {
  std::string out;
  for (char const c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return out;
}

}  // namespace detail

/// Scenes side by side, which share clock and camera:
///   Film film({.viewer = "polybody_viewer.html", .title = "The arm"});
///   FilmScene& scene = film.scene("LRVF");
///   for (State const& now : simulate(…))
///     if (scene.due(now.t)) scene.record(now.t, visual.at(now));
///   film.write("out/arm.html");
/// Parts that a frame carries cost 20 bytes a frame; parts that deform 3 or 6 more for each point, and 2 for each
/// colour.
class Film {
 public:
  /// \throws InvalidInput for options that cannot be meant; IoError where the viewer is not there: before the run.
  explicit Film(FilmOptions options) : options_(std::move(options)) {
    require_positive(options_.frames_per_second, "Film: the frames per second");
    double const across = options_.look_from.cross(options_.up).norm();
    if (!(across > 1e-6 * options_.look_from.norm() * options_.up.norm()))
      throw InvalidInput{"Film: look_from and up must be finite and not along each other."};
    page_ = detail::viewer_page(options_.viewer);
  }

  /// One more scene; the reference stays valid. \throws InvalidInput for a name that another scene has.
  FilmScene& scene(std::string name) {
    for (FilmScene const& other : scenes_)
      if (other.name() == name) throw InvalidInput{"Film: two scenes are called \"", name, "\"."};
    return scenes_.emplace_back(std::move(name), options_.frames_per_second);
  }

  std::size_t scenes() const { return scenes_.size(); }  ///< so far

  /// The file appears when it is complete. \return its size [bytes] \throws InvalidInput without a scene or for one
  /// without frames, or where `follow` is no part of a scene; IoError.
  std::size_t write(std::filesystem::path const& file) const {
    if (scenes_.empty()) throw InvalidInput{"Film '", options_.title, "' has no scene."};
    for (FilmScene const& scene : scenes_) require_complete(scene);
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
    if (scene.times().empty()) throw InvalidInput{"Film: the scene \"", scene.name(), "\" has no frame."};
    bool found = options_.follow.empty();
    for (detail::FilmPart const& part : scene.parts()) found = found || part.name == options_.follow;
    if (!found)
      throw InvalidInput{"Film: the scene \"", scene.name(), "\" has no part \"", options_.follow, "\" to follow."};
  }

  /// Members of the table of contents that are not scenes.
  std::string contents() const {
    auto const vector = [](Vec3 const& v) {
      return '[' + detail::all_digits(v[0]) + ',' + detail::all_digits(v[1]) + ',' + detail::all_digits(v[2]) + ']';
    };
    char const* const floors[] = {"ground", "behind", "none"};
    return "\"title\":" + detail::json_text(options_.title) +
           ",\"framesPerSecond\":" + detail::all_digits(options_.frames_per_second) +
           ",\"lookFrom\":" + vector(options_.look_from) + ",\"up\":" + vector(options_.up) +
           ",\"follow\":" + detail::json_text(options_.follow) + ",\"floor\":\"" + floors[int(options_.floor)] + '"';
  }

  FilmOptions options_;
  std::string page_;
  std::deque<FilmScene> scenes_;
};

}  // namespace polybody
