#pragma once
/// \file
/// Binary data of a film: a head, a table of contents as JSON, and arrays of numbers. Not in polybody.hpp: it belongs
/// to io/film.hpp.
///
/// All numbers are little-endian. The head is
///   8 bytes   "pbfilm01"; the last two digits are the version
///   4 bytes   length c of the table of contents
///   4 bytes   zero
///   8 bytes   length d of the arrays
///   8 bytes   FNV-1a of the c + d bytes that follow (math/checksum.hpp)
/// The table of contents follows, then the arrays. The table refers to an array by ["f4", first byte, count of
/// numbers]. Types are `f4` and `f8` (IEEE floats of 4 and 8 bytes), `i1` and `i2` (signed integers), `u2` and `u4`
/// (unsigned integers).
///
/// A point of a part has the position r + A (p + step·d), in world axes. The origins r ("places") and the rotations A
/// ("turns", quaternions to be normalised) are stored for each frame. The points p are stored once. The deviations d
/// are stored for each frame of a deformable part. They are one-byte integers if the error is at most 1e-4 of the
/// part's size, otherwise two-byte integers. A scalar has the value low + (high − low)·u/65534 with a stored integer u;
/// u = 65535 means no value.

#include <deque>

#include <polybody/io/digits.hpp>
#include <polybody/io/film_scene.hpp>
#include <polybody/math/checksum.hpp>

namespace polybody::detail {

inline constexpr std::string_view film_magic = "pbfilm01";

/// JSON list whose items are the results of `item`.
template <class List, class Item>
std::string json_list(List const& list, Item const& item) {
  std::string text = "[";
  for (std::size_t i = 0; i < list.size(); ++i) text += (i ? "," : "") + item(list[i]);
  return text + ']';
}

/// Range of a scalar over all parts that have it. Quantises the values within the range.
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
  SceneContents(FilmScene const& scene, FilmArrays& arrays) : scene_(scene), arrays_(arrays) {
    ranges_.resize(scene.scalars().size());
    for (FilmPart const& part : scene.parts())
      for (std::size_t k = 0; k < ranges_.size(); ++k) ranges_[k].see(part.scalars[k]);
  }

  std::string json() {
    std::string text = "{\"name\":" + json_text(scene_.name()) + ",\"times\":" + arrays_.add(scene_.times());
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
    for (std::size_t k = 0; k < ranges_.size(); ++k)
      text += (k ? "," : "") + (p.scalars[k].empty() ? "null" : arrays_.add(ranges_[k].integers(p.scalars[k])));
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
  FilmArrays& arrays_;
  std::vector<ScalarRange> ranges_;
};

/// Encodes all scenes as bytes.
/// \param page JSON members of the table of contents except the scenes
template <class = void>
std::string film_bytes(std::string const& page, std::deque<FilmScene> const& scenes) {
  FilmArrays arrays;
  std::string contents =
      '{' + page +
      ",\"scenes\":" + json_list(scenes, [&](FilmScene const& scene) { return SceneContents(scene, arrays).json(); }) +
      '}';
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
