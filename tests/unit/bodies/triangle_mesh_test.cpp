// Inertia of the solid inside a closed mesh, and readers of STL and OBJ.
#include <polybody/bodies/rigid/mesh_file.hpp>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "support/refusal.hpp"

namespace polybody::triangle_mesh_test {

using std::numbers::pi;
using Points = std::vector<Vec3>;
using Triangles = std::vector<std::array<Index, 3>>;

std::string written(std::string const& name, std::string const& text) {
  std::string const path = std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + "_mesh_" + name);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// Box from the origin to (a, b, c).
TriangleMesh box(double a, double b, double c) {
  TriangleMesh out;
  for (int i = 0; i < 8; ++i) out.points.emplace_back(i & 1 ? a : 0.0, i & 2 ? b : 0.0, i & 4 ? c : 0.0);
  out.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return out;
}

/// Text form of STL.
std::string stl_of(TriangleMesh const& mesh) {
  std::string text = "solid a part\n";
  for (auto const& t : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (Index const i : t) {
      text += "  vertex";
      for (double const x : mesh.points[std::size_t(i)]) text += ' ' + std::to_string(x);
      text += '\n';
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid a part\n";
}

/// Binary form of STL.
std::string binary_stl_of(TriangleMesh const& mesh) {
  std::string bytes(80, 'h');
  auto const add = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  add(std::uint32_t(mesh.triangles.size()));
  for (auto const& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) add(0.0f);
    for (Index const i : t)
      for (double const x : mesh.points[std::size_t(i)]) add(float(x));
    add(std::uint16_t(0));
  }
  return bytes;
}

// Any tessellation of a cuboid has its exact mass, centre and inertia, also far from the origin.
TEST(TriangleMesh, CuboidIsExact) {
  TriangleMesh mesh = box(0.5, 2.0, 3.0);
  for (Vec3& p : mesh.points) p += Vec3(7, -5, 11);
  Inertia const solid = solid_inertia(mesh, 200.0), exact = Inertia::box(600.0, {0.5, 2, 3});
  EXPECT_NEAR(solid.mass, 600.0, 1e-12 * 600);
  EXPECT_LT((solid.centre - Vec3(7.25, -4, 12.5)).norm(), 1e-13);
  EXPECT_LT((solid.tensor - exact.tensor).norm(), 1e-12 * exact.tensor.norm());
}

/// Icosahedron with edges 2, the corners (0, ±1, ±φ) and cyclic permutations.
TriangleMesh icosahedron() {
  TriangleMesh out;
  double const phi = 0.5 * (1.0 + std::sqrt(5.0));
  for (int axis = 0; axis < 3; ++axis)
    for (double const s : {-1.0, 1.0})
      for (double const t : {-phi, phi}) {
        Vec3 p = Vec3::Zero();
        p[(axis + 1) % 3] = s;
        p[(axis + 2) % 3] = t;
        out.points.push_back(p);
      }
  for (Index i = 0; i < 12; ++i)
    for (Index j = 0; j < 12; ++j)
      for (Index k = 0; k < 12; ++k) {
        Vec3 const &a = out.points[std::size_t(i)], &b = out.points[std::size_t(j)], &c = out.points[std::size_t(k)];
        auto const edge = [](Vec3 const& p, Vec3 const& q) { return std::abs((p - q).norm() - 2.0) < 1e-9; };
        if (i < j && i < k && j != k && edge(a, b) && edge(b, c) && edge(c, a) && (b - a).cross(c - a).dot(a) > 0.0)
          out.triangles.push_back({i, j, k});
      }
  return out;
}
/// Divides each triangle into four, and moves the new corners to the unit sphere.
TriangleMesh divided(TriangleMesh const& mesh) {
  TriangleMesh out{.points = mesh.points};
  std::map<std::pair<Index, Index>, Index> middles;
  auto const middle = [&](Index a, Index b) {
    auto const [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, Index(out.points.size()));
    if (is_new) out.points.push_back((out.points[std::size_t(a)] + out.points[std::size_t(b)]).normalized());
    return at->second;
  };
  for (auto const& [a, b, c] : mesh.triangles) {
    Index const ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (auto const& t : Triangles{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) out.triangles.push_back(t);
  }
  return out;
}

// Regular icosahedron of edge a: V = 5 (3 + √5) a³/12, J = m φ² a²/10 about any axis.
TEST(TriangleMesh, IcosahedronHasItsClosedForm) {
  TriangleMesh const mesh = icosahedron();
  ASSERT_EQ(mesh.triangles.size(), 20u);
  double const phi = 0.5 * (1.0 + std::sqrt(5.0)), mass = 5.0 * (3.0 + std::sqrt(5.0)) * 8.0 / 12.0;
  Inertia const solid = solid_inertia(mesh, 1.0);
  EXPECT_NEAR(solid.mass, mass, 1e-13 * mass);
  EXPECT_LT((solid.tensor - mass * phi * phi * 4.0 / 10.0 * identity()).norm(), 1e-13 * mass);
}

// The error of an icosphere against the ball falls by four with each division of the edges.
TEST(TriangleMesh, IcosphereConvergesToTheBall) {
  TriangleMesh mesh = icosahedron();
  for (Vec3& p : mesh.points) p.normalize();
  double const exact = 8.0 * pi / 15.0;  // (2/5)(4π/3)
  double error = 0.0;
  for (int n = 0; n < 6; ++n) {
    double const now = exact - solid_inertia(mesh, 1.0).tensor(0, 0);
    if (n >= 4) {
      EXPECT_NEAR(error / now, 4.0, 0.05);
    }
    error = now;
    mesh = divided(mesh);
  }
  EXPECT_LT(error, 2e-3 * exact);
}

/// Torus with the radii `big` and `small` about z, `n` × `n` corners.
TriangleMesh torus(double big, double small, Index n) {
  TriangleMesh out;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      double const u = 2 * pi * double(i) / double(n), v = 2 * pi * double(j) / double(n),
                   r = big + small * std::cos(v);
      out.points.emplace_back(r * std::cos(u), r * std::sin(u), small * std::sin(v));
      Index const a = i * n + j, b = (i + 1) % n * n + j, c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
      out.triangles.push_back({a, b, c});
      out.triangles.push_back({a, c, d});
    }
  return out;
}

// V = 2π² R r², J_z = m (R² + 3 r²/4), J_x = m (R²/2 + 5 r²/8); two meshes, extrapolated in n⁻².
TEST(TriangleMesh, TorusHasItsClosedForm) {
  double const big = 2.0, small = 0.5, mass = 2 * pi * pi * big * small * small;
  Inertia const coarse = solid_inertia(torus(big, small, 60), 1.0), fine = solid_inertia(torus(big, small, 120), 1.0);
  auto const limit = [](double c, double f) { return f + (f - c) / 3.0; };
  EXPECT_NEAR(limit(coarse.mass, fine.mass), mass, 2e-5 * mass);
  EXPECT_NEAR(limit(coarse.tensor(2, 2), fine.tensor(2, 2)), mass * (big * big + 0.75 * small * small), 1e-4 * mass);
  EXPECT_NEAR(limit(coarse.tensor(0, 0), fine.tensor(0, 0)), mass * (0.5 * big * big + 0.625 * small * small),
              1e-4 * mass);
}

// Two boxes side by side are the box of both: integrals of meshes add like parts.
TEST(TriangleMesh, PartsAddUp) {
  TriangleMesh second = box(1, 2, 3);
  for (Vec3& p : second.points) p[0] += 1.0;
  Inertia const both = solid_inertia(box(1, 2, 3), 5.0) + solid_inertia(second, 5.0);
  Inertia const whole = solid_inertia(box(2, 2, 3), 5.0);
  EXPECT_LT((both.tensor - whole.tensor).norm(), 1e-12 * whole.tensor.norm());
  EXPECT_LT((both.centre - whole.centre).norm(), 1e-14);
}

TEST(TriangleMesh, FilesOfEachFormAgree) {
  TriangleMesh const mesh = box(1, 2, 4);
  std::string obj = "# a box\no box\n";
  for (Vec3 const& p : mesh.points)
    obj += "v " + std::to_string(p[0]) + ' ' + std::to_string(p[1]) + " +" + std::to_string(p[2]) + "\n";
  // faces of four corners, with numbers of normals, and from the end
  obj += "f 1//1 3//1 4//1 2//1\nf 5 6 8 7\nf -8 -7 -3 -4\nf 3/1 7/1 8/1 4/1\r\nf 1 5 7 3\nf 2 4 8 6 # the last\n";
  Inertia const exact = solid_inertia(mesh, 1e9);
  for (auto const& [name, text] :
       {std::pair{"text.stl", stl_of(mesh)}, {"binary.stl", binary_stl_of(mesh)}, {"a.obj", obj}}) {
    TriangleMesh const read = read_mesh(written(name, text), 1e-3);
    EXPECT_EQ(read.points.size(), 8u) << name;
    EXPECT_EQ(read.triangles.size(), 12u) << name;
    Inertia const solid = solid_inertia(read, 1e18);  // 10⁹ times the density in a thousandth of each length
    EXPECT_NEAR(solid.mass, exact.mass, 1e-12 * exact.mass) << name;
    EXPECT_LT((solid.tensor * 1e6 - exact.tensor).norm(), 1e-12 * exact.tensor.norm()) << name;
  }
}

TEST(TriangleMesh, RefusesOpenAndTurnedSurfaces) {
  TriangleMesh mesh = box(1, 1, 1);
  mesh.triangles.pop_back();
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(mesh, 1.0); }),
                  "TriangleMesh: the mesh is not closed: 3 edges belong to an odd number of triangles"));
  mesh = box(1, 1, 1);
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(mesh, 1.0); }), "at 3 edges, neighbouring triangles"));
  mesh = box(1, 1, 1);
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(mesh, 1.0); }), "the enclosed volume is negative (-1 m³)"));
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(box(1, 1, 0), 1.0); }), "the enclosed volume is 0 m³"));
  mesh.triangles[0][1] = 8;
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(mesh, 1.0); }),
                  "triangle 0, counted from 0, has the corner 8, but the mesh has 8 points"));
  mesh = box(1, 1, 1e21);
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(mesh, 1.0); }), "must lie in [-1e+20, 1e+20] m, but is 1e+21 m"));
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia(box(1, 1, 1), 0.0); }), "the density must be positive"));
  EXPECT_TRUE(has(refusal([&] { (void)solid_inertia({}, 1.0); }), "the mesh has no triangles"));
}

/// Refusal of a file with this text.
std::string refused(std::string const& name, std::string const& text) {
  return message_of<IoError>([&] { (void)read_mesh(written(name, text), 1.0); });
}

TEST(TriangleMesh, RefusesWrongFilesWithFileAndLine) {
  EXPECT_TRUE(has(refused("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n"),
                  "mesh_a.stl, line 4: 'x' is not a number"));
  EXPECT_TRUE(has(refused("b.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nendloop\n"),
                  "line 5: 'endloop' is not 'vertex'"));
  EXPECT_TRUE(has(refused("c.stl", "solid a\nendsolid\n"), "the file has no triangles"));
  EXPECT_TRUE(has(refused("d.stl", "solid a\nfacet normal 0 0 1\nouter\n"), "the file ends before 'loop'"));
  EXPECT_TRUE(has(refused("e.stl", binary_stl_of(box(1, 1, 1)).substr(0, 100)), "neither an STL text"));
  EXPECT_TRUE(has(refused("f.stl", binary_stl_of(box(1e30, 1, 1))), "triangle 0, counted from 0, has the coordinate"));
  EXPECT_TRUE(has(refused("a.obj", "v 0 0 0\nf 1 2 3\n"),
                  "mesh_a.obj, line 2: '2' is not one of the 1 points before this face"));
  EXPECT_TRUE(has(refused("b.obj", "v 0 0 0\nf 1 1\n"), "a face needs at least three corners, but has 2"));
  EXPECT_TRUE(has(refused("c.obj", "v 0 0 0\ncurv 1 2\n"), "line 2: 'curv' is not a statement"));
  EXPECT_TRUE(
      has(message_of<IoError>([] { (void)read_mesh("missing.stl", 1.0); }), "missing.stl: the file cannot be opened"));
  EXPECT_TRUE(
      has(refusal([] { (void)read_mesh("a.stl", 0.0); }), "a.stl: the unit must lie in [1e-09, 1e+09] m, but is 0 m"));
}

}  // namespace polybody::triangle_mesh_test
