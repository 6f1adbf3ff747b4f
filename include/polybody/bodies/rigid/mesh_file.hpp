#pragma once
/// \file
/// Readers of triangle meshes: STL in its text and binary forms, and OBJ. An error names the file and the line.

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string_view>

#include <polybody/bodies/rigid/triangle_mesh.hpp>

namespace polybody {

namespace detail {

/// Words of a text file with their lines.
class MeshText {
 public:
  /// Text `text` of `file`; both must outlive the reader.
  MeshText(std::string const& file, std::string_view text) : file_(file), text_(text) {}

  /// Next word of the current line, in small letters if `small`; empty at the end of the line.
  std::string word(bool small = false) {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    std::string out;
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') out += text_[at_++];
    if (small)
      for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return out;
  }
  /// Goes to the next line. Returns false at the end of the file.
  bool next_line() {
    at_ = std::min(text_.find('\n', at_), text_.size());
    if (at_ == text_.size()) return false;
    ++at_, ++line_;
    return at_ < text_.size();
  }
  /// Next word of this or a later line, in small letters; empty at the end of the file.
  std::string any_word() {
    std::string out = word(true);
    while (out.empty() && next_line()) out = word(true);
    return out;
  }
  /// Reads the next word, which must be `expected`.
  void expect(std::string const& expected) {
    if (std::string const found = any_word(); found != expected)
      fail(found.empty() ? "the file ends before '" + expected + "'"
                         : "'" + found.substr(0, 40) + "' is not '" + expected + "'");
  }
  /// Reads a number from the next word of the line.
  double number() {
    std::string const given = word();
    std::string_view digits = given;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double x = 0.0;
    auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (given.empty() || error != std::errc() || end != digits.data() + digits.size() || !(std::abs(x) <= 1e20))
      fail("'" + given.substr(0, 40) + "' is not a number of magnitude up to 1e+20");
    return x;
  }
  /// Reads three numbers of the line.
  Vec3 point() {
    double const x = number(), y = number();
    return {x, y, number()};
  }
  /// \throws IoError with the file, the line and `what`.
  [[noreturn, gnu::cold]] void fail(std::string const& what) const {
    throw IoError("file.content", {ErrorObject{file_}, ", line ", line_, ": ", what, "."});
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
  std::string const& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  Index line_ = 1;
};

/// Adds triangles of three points to a mesh. Points with equal coordinates are one corner.
class MeshCorners {
 public:
  explicit MeshCorners(TriangleMesh& mesh) : mesh_(mesh) {}
  void add(std::array<Vec3, 3> const& corners, double unit) {
    std::array<Index, 3> t;
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> key;
      for (int k = 0; k < 3; ++k) key[std::size_t(k)] = corners[i][k] * unit + 0.0;  // −0 becomes 0
      auto const [at, is_new] = known_.try_emplace(key, Index(mesh_.points.size()));
      if (is_new) mesh_.points.emplace_back(key[0], key[1], key[2]);
      t[i] = at->second;
    }
    mesh_.triangles.push_back(t);
  }

 private:
  TriangleMesh& mesh_;
  std::map<std::array<double, 3>, Index> known_ = {};
};

/// Reads the text form of STL.
template <class = void>  // compiled only if used
void read_text_stl(MeshText text, double unit, TriangleMesh& mesh) {
  MeshCorners corners(mesh);
  for (std::string word = text.any_word(); !word.empty(); word = text.any_word()) {
    if (word == "solid" || word == "endsolid") {
      text.next_line();  // a name follows
      continue;
    }
    if (word != "facet") text.fail("'" + word.substr(0, 40) + "' is not 'facet', 'solid' or 'endsolid'");
    text.expect("normal");
    text.point();
    text.expect("outer");
    text.expect("loop");
    std::array<Vec3, 3> p;
    for (Vec3& corner : p) {
      text.expect("vertex");
      corner = text.point();
    }
    text.expect("endloop");
    text.expect("endfacet");
    corners.add(p, unit);
  }
}

/// Little-endian number of four bytes.
inline std::uint32_t four_bytes(char const* at) {
  std::uint32_t out = 0;
  for (int i = 3; i >= 0; --i) out = (out << 8) | static_cast<unsigned char>(at[i]);
  return out;
}

/// Reads the binary form of STL: a header of 80 bytes, the number of triangles, and 50 bytes for each triangle.
template <class = void>  // compiled only if used
void read_binary_stl(std::string const& file, std::string_view bytes, double unit, TriangleMesh& mesh) {
  MeshCorners corners(mesh);
  for (std::size_t i = 84; i < bytes.size(); i += 50) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 9; ++k) {
      double const x = double(std::bit_cast<float>(four_bytes(bytes.data() + i + 12 + 4 * k)));
      if (!(std::abs(x) <= 1e20))
        throw IoError("file.content",
                      {ErrorObject{file}, ": triangle ", (i - 84) / 50, ", counted from 0, has the coordinate ",
                       ErrorValue{x}, ", but magnitudes up to 1e+20 are allowed."});
      p[k / 3][Index(k % 3)] = x;
    }
    corners.add(p, unit);
  }
}

/// Reads the corner of a face of OBJ: a number of a point, from 1 or from the end, perhaps with other numbers after
/// '/'.
template <class = void>  // compiled only if used
Index obj_corner(MeshText& text, std::string const& word, std::size_t points) {
  std::string_view const digits = std::string_view(word).substr(0, word.find('/'));
  Index i = 0;
  auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), i);
  Index const count = Index(points);
  if (error != std::errc() || end != digits.data() + digits.size() || i == 0 || i > count || i < -count)
    text.fail("'" + word.substr(0, 40) + "' is not one of the " + std::to_string(points) + " points before this face");
  return i > 0 ? i - 1 : count + i;
}

/// Reads OBJ: points `v` and faces `f`. A face with more than three corners becomes a fan of triangles.
template <class = void>  // compiled only if used
void read_obj(MeshText text, double unit, TriangleMesh& mesh) {
  do {
    std::string const word = text.word();
    if (word == "v") {
      mesh.points.emplace_back(text.point() * unit);
    } else if (word == "f") {
      std::vector<Index> face;
      for (std::string corner = text.word(); !corner.empty() && corner[0] != '#'; corner = text.word())
        face.push_back(obj_corner(text, corner, mesh.points.size()));
      if (face.size() < 3) text.fail("a face needs at least three corners, but has " + std::to_string(face.size()));
      for (std::size_t i = 2; i < face.size(); ++i) mesh.triangles.push_back({face[0], face[i - 1], face[i]});
    } else if (!word.empty() && word[0] != '#') {
      constexpr std::array other = {"vn", "vt", "g", "o", "s", "usemtl", "mtllib", "l", "p"};
      if (std::find(other.begin(), other.end(), word) == other.end())
        text.fail("'" + word.substr(0, 40) + "' is not a statement of a mesh of points 'v' and faces 'f'");
    }
  } while (text.next_line());
}

}  // namespace detail

/// Reads a triangle mesh from an STL file, text or binary, or from an OBJ file (`file` ends with .obj). `unit` is the
/// length of the file's unit [m]: 1e-3 for millimetres. STL corners with equal coordinates become one corner. The
/// normals of the file are not used.
/// \throws IoError naming file and line, for other content; InvalidInput for a unit outside [1e-9, 1e9] m.
template <class = void>  // compiled only if used
TriangleMesh read_mesh(std::string const& file, double unit) {
  if (!(unit >= 1e-9 && unit <= 1e9))
    throw InvalidInput(
        "mesh.unit", {ErrorObject{file}, ": the unit must lie in [1e-09, 1e+09] m, but is ", ErrorValue{unit}, " m."});
  std::ifstream in(file, std::ios::binary);
  std::string content;
  for (char block[4096]; in.read(block, sizeof block), in.gcount() > 0;)
    content.append(block, static_cast<std::size_t>(in.gcount()));
  if (!in.is_open() || in.bad())
    throw IoError("file.open",
                  {ErrorObject{file}, ": the file cannot be opened. Check the path and the permission to read it."});
  TriangleMesh mesh;
  mesh.name = file;
  detail::MeshText text(file, content);
  if (file.ends_with(".obj") || file.ends_with(".OBJ"))
    detail::read_obj(text, unit, mesh);
  else if (content.size() >= 84 && content.size() == 84 + 50 * std::size_t(detail::four_bytes(content.data() + 80)))
    detail::read_binary_stl(file, content, unit, mesh);
  else if (detail::MeshText(text).any_word() == "solid")
    detail::read_text_stl(text, unit, mesh);
  else
    text.fail(
        "this is neither an STL text, which begins with 'solid', nor a binary STL file of 84 + 50 n bytes for its n "
        "triangles; an OBJ file needs a name that ends with .obj");
  if (mesh.triangles.empty()) text.fail("the file has no triangles");
  return mesh;
}

}  // namespace polybody
