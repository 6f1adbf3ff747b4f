#pragma once
// Random trees of rigid bodies from a seed, with every geometry that has joint coordinates.
#include <random>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>

namespace random_tree {

using namespace polybody;
using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;

struct Draws {
  std::mt19937 engine;
  double number(double from, double to) { return std::uniform_real_distribution<>(from, to)(engine); }
  int below(int n) { return std::uniform_int_distribution<>(0, n - 1)(engine); }
  Vec3 vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
  /// One of three orthogonal axes, which may be the world's.
  Vec3 axis() { return below(2) == 0 ? Vec3(Vec3::Unit(below(3))) : Vec3(vector(1.0).normalized()); }
};

/// A random tree from a seed: the joints connect each body to the ground, to an earlier body or, as roots, to
/// nothing.
template <class Body, class Policy, bool sprung>
struct Tree {
  template <class G>
  using J = Joint<G, Policy>;
  using Springs = std::conditional_t<sprung, Forces<SpringDamper>, Forces<>>;
  Model<Bodies<Body>,
        Joints<J<Revolute>, J<Prismatic>, J<Cylindrical>, J<Spherical>, J<Universal>, J<Screw>, J<PlanarJoint>,
               J<PointOnLine>, J<PointInPlane>, J<ConstantOrientation>, J<Weld>>,
        Springs>
      model{Gravity{1.0, -2.0, -9.81}};
  std::vector<BodyHandle<Body>> bodies;

  explicit Tree(unsigned seed) {
    Draws draw{std::mt19937(seed)};
    int const n = 1 + draw.below(9);
    for (int i = 0; i < n; ++i) {
      // half edges of a box
      Vec3 const half = Vec3(draw.number(0.1, 0.4), draw.number(0.1, 0.4), draw.number(0.1, 0.4));
      double const mass = draw.number(0.5, 3.0), third = mass / 3.0;
      Vec3 const squares = half.cwiseProduct(half);
      bodies.push_back(model.add(Body({.mass = mass,
                                       .inertia = (third * (Vec3::Constant(squares.sum()) - squares)).asDiagonal(),
                                       .placement = Placement::at(draw.vector(1.0), draw.vector(1.0))})));
      int const carrier = draw.below(i + 2) - 2;  // −1: the ground, −2: nothing
      if (carrier > -2) hang(draw, carrier, i);
    }
    if constexpr (sprung)
      for (int i = 0; i < n; ++i)
        model.apply(SpringDamper{.stiffness = 40.0, .damping = 3.0, .free_length = 0.2},
                    bodies[std::size_t(draw.below(n))].at(draw.vector(0.2)),
                    model.ground().at(Vec3(3, 3, 3) + draw.vector(0.5)));
  }

 private:
  void hang(Draws& draw, int carrier, int carried) {
    switch (draw.below(11)) {
      case 0:
        return connect(J<Revolute>{{.axis = draw.axis()}, {}}, draw, carrier, carried);
      case 1:
        return connect(J<Prismatic>{{.axis = draw.axis()}, {}}, draw, carrier, carried);
      case 2:
        return connect(J<Cylindrical>{{.axis = draw.axis()}, {}}, draw, carrier, carried);
      case 3:
        return connect(J<Spherical>{}, draw, carrier, carried);
      case 4:
        return connect(J<Universal>{{.first = Vec3::UnitX(), .second = Vec3::UnitY()}, {}}, draw, carrier, carried);
      case 5:
        return connect(J<Screw>{{.pitch = draw.number(-0.3, 0.3), .axis = draw.axis()}, {}}, draw, carrier, carried);
      case 6:
        return connect(J<PlanarJoint>{{.normal = draw.axis()}, {}}, draw, carrier, carried);
      case 7:
        return connect(J<PointOnLine>{{.axis = draw.axis()}, {}}, draw, carrier, carried);
      case 8:
        return connect(J<PointInPlane>{{.normal = draw.axis()}, {}}, draw, carrier, carried);
      case 9:
        return connect(J<ConstantOrientation>{}, draw, carrier, carried);
      default:
        return connect(J<Weld>{}, draw, carrier, carried);
    }
  }
  /// At a random point of the carried body, which is sometimes frame b and sometimes frame a.
  template <class Joint>
  void connect(Joint const& joint, Draws& draw, int carrier, int carried) {
    Vec3 const off = draw.vector(0.3);
    auto const pose = [&](int i) {
      std::array<double, 7> q{};
      bodies[std::size_t(i)].body().reference(std::span<double>(q));
      return std::pair(Vec3(q[0], q[1], q[2]), rotation_matrix<double>({q[3], q[4], q[5], q[6]}));
    };
    auto const [centre, axes] = pose(carried);
    Vec3 const point = centre + axes * off;
    auto const b = bodies[std::size_t(carried)].at(off);
    bool const backwards = draw.below(2) == 0;
    auto const join = [&](auto const& a) { backwards ? model.connect(joint, b, a) : model.connect(joint, a, b); };
    if (carrier < 0) {
      join(model.ground().at(point));
    } else {
      auto const [from, turned] = pose(carrier);
      join(bodies[std::size_t(carrier)].at(Vec3(turned.transpose() * (point - from))));
    }
  }
};

/// Random coordinates and velocities from a seed, with their accelerations and multipliers, as full states.
template <class T>
State moving(T const& tree, unsigned seed) {
  Draws draw{std::mt19937(seed + 7)};
  System system = stepped_system(tree.model);
  State x = reduce(system, tree.model.reference_state());
  VecX turn = x.v, moved = x.q;
  for (double& d : turn) d = draw.number(-1.0, 1.0);
  system.plus(x.q, turn, moved);
  x.q = moved;
  for (double& d : x.v) d = draw.number(-2.0, 2.0);
  ForwardDynamics<>(system).accelerations(system, {x.q, x.v, 0.0}, x.a, x.lambda);
  State full;
  VecX room;
  expand(system, x, full, room);
  return full;
}

}  // namespace random_tree
