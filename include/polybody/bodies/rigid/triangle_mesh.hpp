#pragma once
/// \file
/// Closed triangle meshes: volume, centre of mass and inertia tensor of the solid that a mesh encloses.
/// Theory: Eqs. 10.6 to 10.9.

#include <array>
#include <map>
#include <string>
#include <vector>

#include <polybody/bodies/rigid/inertia.hpp>

namespace polybody {

/// Closed surface of triangles. The corners of a triangle are counterclockwise when seen from outside.
struct TriangleMesh {
  std::vector<Vec3> points = {};                     ///< corners [m], each within 1e20 m of the origin
  std::vector<std::array<Index, 3>> triangles = {};  ///< indices of the corners in `points`, from 0
  std::string name = "TriangleMesh";                 ///< name in messages; a file name for a mesh from a file
};

namespace detail {

/// Edges of a mesh that prevent a closed and oriented surface.
struct MeshEdges {
  std::size_t open = 0;      ///< edges with an odd number of triangles
  std::size_t reversed = 0;  ///< other edges at which neighbours have opposite orientation
};

/// Examines the edges of a mesh. Triangles traverse each edge of a closed and oriented surface equally often in both
/// directions.
template <class = void>  // compiled only if used
MeshEdges edges_of(TriangleMesh const& mesh) {
  struct Count {
    Index uses = 0, balance = 0;
  };
  std::map<std::pair<Index, Index>, Count> counts;
  for (std::array<Index, 3> const& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      Index const a = t[i], b = t[(i + 1) % 3];
      if (a == b) continue;
      Count& count = counts[{std::min(a, b), std::max(a, b)}];
      ++count.uses;
      count.balance += a < b ? 1 : -1;
    }
  MeshEdges out;
  for (auto const& [edge, count] : counts) {
    out.open += count.uses % 2 != 0;
    out.reversed += count.uses % 2 == 0 && count.balance != 0;
  }
  return out;
}

/// \throws InvalidInput for a mesh without triangles, a triangle without its corners, and a coordinate beyond 1e20 m.
template <class = void>  // compiled only if used
[[gnu::cold]] void require_corners(TriangleMesh const& mesh) {
  if (mesh.triangles.empty())
    throw InvalidInput("mesh.empty", {ErrorObject{mesh.name}, ": the mesh has no triangles."});
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(mesh.points[i][k]) <= 1e20))
        throw InvalidInput("mesh.coordinate", {ErrorObject{mesh.name}, ": a coordinate of point ", i,
                                               ", counted from 0, must lie in [-1e+20, 1e+20] m, but is ",
                                               ErrorValue{mesh.points[i][k]}, " m."});
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (Index const corner : mesh.triangles[i])
      if (corner < 0 || corner >= Index(mesh.points.size()))
        throw InvalidInput("mesh.corner",
                           {ErrorObject{mesh.name}, ": triangle ", i, ", counted from 0, has the corner ",
                            ErrorValue{corner}, ", but the mesh has ", mesh.points.size(), " points."});
}

/// \throws InvalidInput unless the surface is closed and its triangles have one orientation.
template <class = void>  // compiled only if used
[[gnu::cold]] void require_closed(TriangleMesh const& mesh) {
  MeshEdges const edges = edges_of(mesh);
  if (edges.open > 0)
    throw InvalidInput("mesh.open", {ErrorObject{mesh.name}, ": the mesh is not closed: ", ErrorValue{edges.open},
                                     " edges belong to an odd number of triangles. Close the holes and merge corners "
                                     "that should coincide."});
  if (edges.reversed > 0)
    throw InvalidInput("mesh.orientation",
                       {ErrorObject{mesh.name}, ": at ", ErrorValue{edges.reversed},
                        " edges, neighbouring triangles have opposite orientations. Order the corners of all triangles "
                        "counterclockwise when seen from outside."});
}

}  // namespace detail

/// Inertia of the homogeneous solid inside a closed mesh, with `density` [kg/m³], in the axes of the mesh. By the
/// divergence theorem, the integrals are sums over tetrahedra from the centre o of the bounding box to each triangle.
/// With corners p₁, p₂, p₃ from o, D = p₁·(p₂ × p₃) and s = p₁ + p₂ + p₃   [Mirtich 1996],
///   V = Σ D/6,  ∫ x dV = Σ D s/24,  ∫ x xᵀ dV = Σ D (p₁p₁ᵀ + p₂p₂ᵀ + p₃p₃ᵀ + s sᵀ)/120.
/// \throws InvalidInput for an open mesh, with the number of open edges; for triangles with different orientations; and
/// for a volume that is not positive, as for a mesh that is turned inside out.
template <class = void>  // compiled only if used
Inertia solid_inertia(TriangleMesh const& mesh, double density) {
  require_positive(density, mesh.name, ": the density");
  detail::require_corners(mesh);
  detail::require_closed(mesh);
  Vec3 least = mesh.points[std::size_t(mesh.triangles[0][0])], most = least;
  for (std::array<Index, 3> const& t : mesh.triangles)
    for (Index const corner : t) {
      least = least.cwiseMin(mesh.points[std::size_t(corner)]);
      most = most.cwiseMax(mesh.points[std::size_t(corner)]);
    }
  Vec3 const origin = 0.5 * (least + most);
  double const size = (most - least).norm();
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::array<Index, 3> const& t : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.points[std::size_t(t[i])] - origin;
    double const d = p[0].dot(p[1].cross(p[2]));
    Vec3 const s = p[0] + p[1] + p[2];
    volume += d / 6.0;
    first += s * (d / 24.0);
    second +=
        (p[0] * p[0].transpose() + p[1] * p[1].transpose() + p[2] * p[2].transpose() + s * s.transpose()) * (d / 120.0);
  }
  if (!(std::abs(volume) > 1e-12 * size * size * size) || size < 1e-20)
    throw InvalidInput("mesh.volume", {ErrorObject{mesh.name}, ": the enclosed volume is ", ErrorValue{volume},
                                       " m³, which is zero within round-off for a mesh of size ", size, " m."});
  if (volume < 0.0)
    throw InvalidInput("mesh.volume",
                       {ErrorObject{mesh.name}, ": the enclosed volume is negative (", ErrorValue{volume},
                        " m³): the triangles are turned inside out. Reverse the order of the corners of "
                        "each triangle."});
  Vec3 const c = first / volume;
  second -= volume * (c * c.transpose());
  Mat3 const tensor = density * (second.trace() * identity() - second);
  Inertia const out{density * volume, origin + c, 0.5 * (tensor + tensor.transpose())};
  out.check(mesh.name);
  return out;
}

}  // namespace polybody
