#pragma once
/// \file A random model as data, before it has a type: the kinds that a wide model type offers, and the choice of a
/// seed among them.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <polybody/kinematics/frame.hpp>

namespace polybody::random_models {

inline constexpr int ground = -1;  ///< replaces a kind or a body

/// A body of a wide type.
struct BodyKind {
  char const* name;
  bool planar;
  bool is_bar;           ///< made of elements along a line; otherwise rigid, with a point at any position
  bool tells_axis_only;  ///< its markers have a tangent but no axes
  bool objective;        ///< a rotation does not change its strain energy
  bool linear;           ///< its points are linear in its coordinates
};

/// Offset between the points of a and b in the reference configuration.
enum class Offset { none, along_axis, across };

struct JointKind {
  char const* geometry;
  char const* policy;
  int rows;  ///< number of multipliers
  Offset offset;
  bool asks_axis;     ///< requires the axis of its second marker: the joint's axis is then the tangent of a cable
  bool eliminates;    ///< eliminates coordinates from a time step
  bool linear;        ///< constraint equations that are linear in coordinates: axes are material lines
  int twin = ground;  ///< the same geometry with `Constraint`, for a policy that eliminates
};

struct ForceKind {
  char const* name;
  int markers;
};

/// A joint or a force of this kind is permitted between bodies of kinds a and b.
struct Pairing {
  int kind, a, b;
};

struct Kinds {
  std::vector<BodyKind> bodies;
  std::vector<JointKind> joints;
  std::vector<ForceKind> forces;
  std::vector<Pairing> joint_pairs, force_pairs;
};

struct BodyPlan {
  int kind;
  Placement place;
  double length, mass;
};

struct End {
  int body = ground;
  Vec3 point = Vec3::Zero();  ///< (3) world axes, in the reference configuration [m]
  double s = 0.0;             ///< distance of the point from the first end of a bar [m]
};

struct JointPlan {
  int kind;
  End a, b;
  Vec3 axis, side;  ///< (3) unit vectors, perpendicular; world axes at the reference configuration
  double size;      ///< a length [m]
  double stiffness, damping;
};

struct ForcePlan {
  int kind;
  End a, b;
  Vec3 vector;   ///< (3)
  bool follows;  ///< follows the axes of its marker
  double stiffness, damping, distance;
};

struct Plan {
  std::uint64_t seed;
  bool planar;
  Vec3 gravity;
  std::vector<BodyPlan> bodies;
  std::vector<JointPlan> joints;
  std::vector<ForcePlan> forces;

  /// Checks for joints with `JointCoordinates`.
  bool has_joint_coordinates(Kinds const& kinds) const;
  /// This model with `Constraint` as the policy.
  Plan twin(Kinds const& kinds) const;
  std::string text(Kinds const& kinds) const;
};

/// Random numbers that do not depend on the standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed * 0x9e3779b97f4a7c15ull + 1) {}
  double between(double low, double high) { return low + (high - low) * double(generator_() >> 11) * 0x1p-53; }
  int below(std::size_t n) { return int(generator_() % n); }
  bool chance(double p) { return between(0.0, 1.0) < p; }
  Vec3 vector(bool planar, double size);
  Vec3 unit(bool planar);
  VecX numbers(Index n, double size);

 private:
  std::mt19937_64 generator_;
};

/// The model of a seed. Pairings are taken in sequence: seed s of a program of `types` types begins at number s/types
/// of the list. Hence a range of seeds contains all pairings equally often, and one seed still determines its whole
/// model.
Plan draw(std::uint64_t seed, int types, Kinds const& kinds);

}  // namespace polybody::random_models
