#pragma once
/// \file
/// Encoding of the data of a film: numbers as bytes, bytes as base 64, texts as JSON strings. Not in polybody.hpp: it
/// belongs to io/film.hpp.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody::detail {

/// Appends a number in little-endian byte order, independent of the machine.
template <class T>
void append_bytes(std::string& bytes, T number) {
  using Small = std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>;
  using Bits =
      std::conditional_t<sizeof(T) == 8, std::uint64_t, std::conditional_t<sizeof(T) == 4, std::uint32_t, Small>>;
  Bits const bits = std::bit_cast<Bits>(number);
  for (unsigned i = 0; i < sizeof(T); ++i) bytes += char((bits >> (8 * i)) & 0xff);
}

/// Letter and size of a number type in the film's table of contents.
template <class T>
constexpr char const* type_letters() {
  return std::is_same_v<T, double>         ? "f8"
         : std::is_same_v<T, float>        ? "f4"
         : std::is_same_v<T, std::int16_t> ? "i2"
         : std::is_same_v<T, std::int8_t>  ? "i1"
         : sizeof(T) == 2                  ? "u2"
                                           : "u4";
}

/// Consecutive arrays, each aligned to eight bytes. Arrays with equal bytes are stored once, for example the equal
/// rotations of the parts of one body.
class FilmArrays {
 public:
  /// Appends an array unless an equal one exists.
  /// \return location of the array, as written in the table of contents: ["type", first byte, count of numbers]
  template <class T>
  std::string add(std::vector<T> const& values) {
    std::string own;
    own.reserve(values.size() * sizeof(T));
    for (T const value : values) append_bytes(own, value);
    auto const [found, added] = first_byte_.try_emplace(std::move(own), bytes_.size());
    if (added) {
      bytes_ += found->first;
      bytes_.resize((bytes_.size() + 7) / 8 * 8);
    }
    return std::string("[\"") + type_letters<T>() + "\"," + std::to_string(found->second) + ',' +
           std::to_string(values.size()) + ']';
  }

  std::string const& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::unordered_map<std::string, std::size_t> first_byte_;
};

/// Base 64 encoding [RFC 4648, §4].
template <class = void>
std::string base64(std::string_view bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::size_t const count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// JSON string of a text [RFC 8259, §7].
template <class = void>
std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < ' ')
      out += std::string("\\u00") + "0123456789abcdef"[c / 16] + "0123456789abcdef"[c % 16];
    else
      out += c;
  }
  return out + '"';
}

/// Numbers quantised to integers of a magnitude up to 127 or 32767: number ≈ integer·step, |error| ≤ step/2.
struct Quantised {
  std::vector<std::int16_t> integers = {};
  double step = 0.0;
};
template <class = void>
Quantised quantised(std::vector<float> const& values, double most = 32767.0) {
  float largest = 0.0f;
  for (float const x : values) largest = std::max(largest, std::abs(x));
  Quantised out{.step = double(largest) / most};
  out.integers.reserve(values.size());
  for (float const x : values)
    out.integers.push_back(std::int16_t(largest > 0.0f ? std::lround(double(x) / out.step) : 0));
  return out;
}

/// Unit quaternion (w, x, y, z) of a rotation in integers of 16 bits. The error is less than 1e-4 rad.
template <class = void>
std::array<std::int16_t, 4> quantised_rotation(Mat3 const& axes) {
  Eigen::Quaterniond const q = Eigen::Quaterniond(axes).normalized();
  auto const integer = [](double x) { return std::int16_t(std::lround(32767.0 * x)); };
  return {integer(q.w()), integer(q.x()), integer(q.y()), integer(q.z())};
}

/// Rotation matrix that the viewer computes from a quantised quaternion (w, x, y, z).
template <class = void>
Mat3 rotation_of(std::array<std::int16_t, 4> const& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace polybody::detail
