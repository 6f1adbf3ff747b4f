#pragma once
/// \file
/// Animations of a model for ParaView, as VTK's XML files: a collection (.pvd) and an unstructured grid (.vtu) for
/// each state.

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <polybody/io/text_files.hpp>
#include <polybody/io/visual.hpp>
#include <polybody/math/errors.hpp>

namespace polybody {

// File that is written under its own name from the beginning.

/// Output file that has its final name from the beginning. Suitable if an incomplete file is useful, or if another file
/// refers to it only after its completion. A killed program leaves no temporary file. AtomicFile, in contrast, appears
/// only when complete. Move-only.
class FileInPlace {
 public:
  /// Creates `file`, which is empty, and its parent folders.
  /// \throws IoError if the file cannot be created.
  explicit FileInPlace(std::filesystem::path const& file) : name_(file.string()) {
    std::error_code reason;
    std::filesystem::create_directories(file.parent_path(), reason);
    if (reason) fail("its folder cannot be created", reason);
    file_.reset(std::fopen(name_.c_str(), "wb"));
    if (!file_) fail("cannot be created", {errno, std::generic_category()});
  }

  /// Writes `bytes` at the current position.
  /// \throws IoError if the bytes cannot be written.
  void write(std::string_view bytes) {
    errno = 0;
    require(std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  }
  /// Writes the buffered bytes to the file, with one system call for up to 4096 bytes. \throws IoError if this fails.
  void flush() {
    errno = 0;
    require(std::fflush(file_.get()) == 0);
  }
  /// Sets the position of the next write to `place` [bytes from the beginning]. \throws IoError if this fails.
  void go_to(std::size_t place) {
    errno = 0;
    require(std::fseek(file_.get(), long(place), SEEK_SET) == 0);
  }

 private:
  struct Closer {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  void require(bool done) const {
    if (!done) fail("cannot be written", {errno, std::generic_category()});
  }
  [[noreturn, gnu::cold]] void fail(std::string const& what, std::error_code reason) const {
    throw IoError("file.write", {"file \"", ErrorObject{name_}, "\" ", what, (reason ? ": " + reason.message() : "")});
  }

  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
};

namespace detail {

/// `text` escaped for an XML attribute.
template <class = void>
std::string xml_text(std::string const& text) {
  std::string out;
  for (char const c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

/// Arrays of a VTK file: their XML elements, and their raw appended data. The length of each array precedes its bytes
/// [VTK File Formats, XML].
struct VtkArrays {
  std::string heads, bytes;

  template <class T>
  void add(char const* name, int components, std::vector<T> const& values) {
    char const* const type = std::is_same_v<T, float> ? "Float32"
                             : sizeof(T) == 8         ? "Int64"
                             : sizeof(T) == 4         ? "Int32"
                                                      : "UInt8";
    heads += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(bytes.size()) + "\"/>\n";
    std::uint64_t const length = values.size() * sizeof(T);
    bytes.append(reinterpret_cast<char const*>(&length), sizeof length);
    bytes.append(reinterpret_cast<char const*>(values.data()), std::size_t(length));
  }
  void add(char const* name, std::vector<Vec3> const& values) {
    std::vector<float> out;
    for (Vec3 const& x : values)
      for (int i = 0; i < 3; ++i) out.push_back(float(x[i]));
    add(name, 3, out);
  }
};

/// Writes all parts to the file `name` as one unstructured grid of polygons.
/// \param rest positions of the points in the reference state
template <class = void>
void write_vtu(std::filesystem::path const& name, std::vector<VisualPart> const& parts, std::vector<Vec3> const& rest) {
  std::vector<Vec3> points, moved, velocities;
  std::vector<float> stress;
  std::vector<std::int64_t> corners, ends;
  std::vector<std::int32_t> part_of_cell;
  bool stressed = false;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    VisualPart const& part = parts[k];
    std::int64_t const first_point = std::int64_t(points.size()), first_corner = std::int64_t(corners.size());
    for (int const i : part.surface.corners) corners.push_back(first_point + i);
    for (int const i : part.surface.ends) ends.push_back(first_corner + i);
    part_of_cell.insert(part_of_cell.end(), part.surface.ends.size(), std::int32_t(k));
    for (Vec3 const& p : part.surface.points) {
      moved.push_back(p - rest[points.size()]);
      points.push_back(p);
    }
    velocities.insert(velocities.end(), part.velocities.begin(), part.velocities.end());
    for (double const s : part.axial_stress) stress.push_back(float(s));
    stressed = stressed || !part.axial_stress.empty();
    stress.resize(points.size(), std::numeric_limits<float>::quiet_NaN());  // NaN for a part without stresses
  }

  VtkArrays arrays;
  std::string const n = std::to_string(points.size()), cells = std::to_string(ends.size());
  arrays.heads = "<Piece NumberOfPoints=\"" + n + "\" NumberOfCells=\"" + cells + "\">\n<Points>\n";
  arrays.add("points", points);
  arrays.heads += "</Points>\n<Cells>\n";
  arrays.add("connectivity", 1, corners);
  arrays.add("offsets", 1, ends);
  arrays.add("types", 1, std::vector<std::uint8_t>(ends.size(), 7));  // VTK_POLYGON
  arrays.heads += "</Cells>\n<PointData>\n";
  arrays.add("displacement", moved);
  arrays.add("velocity", velocities);
  if (stressed) arrays.add("axial_stress", 1, stress);
  arrays.heads += "</PointData>\n<CellData>\n";
  arrays.add("part", 1, part_of_cell);
  arrays.heads += "</CellData>\n</Piece>\n";

  std::string const order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  FileInPlace file(name);
  file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" + order +
             "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n" + arrays.heads +
             "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  file.write(arrays.bytes);
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.flush();
}

}  // namespace detail

/// Writer of ParaView animations, one state after the other:
///   VtkWriter writer("out/run.pvd", visual);
///   for (State const& now : simulate(…)) writer.write(now);
/// The example writes out/run.pvd and out/run/run_000000.vtu, …. The point data are the `displacement` from the
/// reference state [m], the `velocity` [m/s] and the `axial_stress` [N/m²]. The stress is NaN if a part does not
/// provide it. The cell data are `part`, the index of the part in the visual, from 0. Numbers are float32. A grid is
/// complete before the collection refers to it, and the collection is valid after every state. A run that is
/// interrupted, even by a signal, therefore leaves an animation up to its last state, and no temporary file. The
/// visual must outlive the writer.
template <class = void>  // compiled where it is used
class VtkWriterOf {
 public:
  /// Writes a collection without states to `file`.
  /// \throws InvalidInput unless the name of the file ends in .pvd.
  /// \throws IoError if the file cannot be written.
  VtkWriterOf(std::filesystem::path const& file, Visual& visual)
      : visual_(&visual), file_(std::filesystem::absolute(file)), collection_((check(file), file_)) {
    for (VisualPart const& part : visual.at(visual.reference()))
      rest_.insert(rest_.end(), part.surface.points.begin(), part.surface.points.end());
    add("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n");
  }

  /// Writes the grid of state x and adds it to the collection.
  /// \throws InvalidInput unless the time of x is later than the previous time.
  /// \throws NonFiniteValue for coordinates that are not finite; IoError if a file cannot be written.
  void write(State const& x) {
    if (!(x.t > last_))
      throw InvalidInput("film.time_order",
                         {"VtkWriter: the times of the states in \"", ErrorObject{file_.string()},
                          "\" must increase, but t = ", ErrorTime{x.t}, " s follows ", last_, " s."});
    std::vector<VisualPart> const& parts = visual_->at(x);
    for (VisualPart const& part : parts)
      for (Vec3 const& p : part.surface.points)
        if (!p.allFinite())
          throw NonFiniteValue("film.not_finite", {"VtkWriter: a point of \"", ErrorObject{part.name},
                                                   "\" is not finite at t = ", ErrorTime{x.t}, " s."});
    std::string index = std::to_string(count_);
    index.insert(0, index.size() < 6 ? 6 - index.size() : 0, '0');
    std::filesystem::path const stem = file_.stem(), grid = stem / (stem.string() + "_" + index + ".vtu");
    detail::write_vtu(file_.parent_path() / grid, parts, rest_);
    add("<DataSet timestep=\"" + detail::all_digits(x.t) + "\" part=\"0\" file=\"" +
        detail::xml_text(grid.generic_string()) + "\"/>\n");
    last_ = x.t;
    ++count_;
  }

  std::size_t states() const { return count_; }  ///< number of states written

 private:
  static void check(std::filesystem::path const& file) {
    if (file.extension() != ".pvd")
      throw InvalidInput("file.name", {"VtkWriter: the name of a collection must end in .pvd, but is \"",
                                       ErrorObject{file.string()}, "\"."});
  }
  /// Replaces the closing tags of the collection by an entry and the closing tags, in one system call.
  void add(std::string const& entry) {
    collection_.go_to(end_);
    collection_.write(entry + "</Collection>\n</VTKFile>\n");
    collection_.flush();
    end_ += entry.size();
  }

  Visual* visual_;
  std::filesystem::path file_;
  FileInPlace collection_;
  std::size_t end_ = 0;  ///< size of the collection without its closing tags [bytes]
  std::vector<Vec3> rest_;
  std::size_t count_ = 0;
  double last_ = -std::numeric_limits<double>::infinity();
};

using VtkWriter = VtkWriterOf<>;  ///< writes ParaView animations

}  // namespace polybody
