// Triangle meshes as OBJ, STL text or binary STL, by the first byte. Indices are within the points, and points are
// finite. The inertia of a mesh is that of a possible solid, or the mesh is refused.
#include <polybody/bodies/rigid/mesh_file.hpp>

#include "fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody;
  using namespace polybody::fuzz;
  std::string_view text = text_of(data, size);
  bool const obj = text.starts_with('o');
  text = text.substr(size > 0);
  std::string const file = folder().put(obj ? "mesh.obj" : "mesh.stl", text);
  auto const named = [&](std::string const& message) { return message.starts_with(file); };
  auto const mesh = accepted([&] { return read_mesh(file, 1.0); }, named);
  if (!mesh) return 0;
  require(!mesh->triangles.empty(), "a mesh has triangles");
  for (Vec3 const& p : mesh->points)
    for (double const x : p) require(std::abs(x) <= 1e20, "points are finite: ", x);
  for (auto const& t : mesh->triangles)
    for (Index const i : t) require(i >= 0 && i < Index(mesh->points.size()), "corners are points of the mesh");
  auto const solid = accepted([&] { return solid_inertia(*mesh, 1.0); }, named);
  if (!solid) return 0;
  require(solid->mass > 0.0 && std::isfinite(solid->mass), "the mass is positive: ", double(solid->mass));
  (void)Rigid<>(solid->body());
  return 0;
}
