#pragma once
/// \file
/// Where the parts of a model stand in its vectors, and what they are called: all that is asked about a model without
/// its type.

#include <cstdint>
#include <span>
#include <string>

#include <polybody/bodies/shared/coordinate_units.hpp>
#include <polybody/kinematics/frame.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/time_functions.hpp>
#include <polybody/system/model_watch.hpp>

namespace polybody {

struct LinearConstraints;
struct PlacedWrench;

/// Where a body stands among all coordinates, speeds and rows.
struct BodyLayout {
  std::string name = {};          ///< its name in messages
  Index q0 = 0, coordinates = 0;  ///< its first coordinate, and how many it has
  Index v0 = 0, velocities = 0;   ///< its first speed, and how many it has
  Index row = -1, rows = 0;       ///< rows of its own
  bool planar = false;            ///< it moves in the plane
  bool constant_mass = false;     ///< M does not depend on q
  void const* type = nullptr;     ///< tells types of bodies apart
  Index index = 0;                ///< among the bodies of its type
  void const* body = nullptr;     ///< the body itself, in the model
  /// At its q, v, v̇ under gravity and loads in world axes; none of a body that does not say it
  /// (WithoutGeometricStiffening).
  double (*axial_share)(void const* body, std::span<double const> q, std::span<double const> v,
                        std::span<double const> a, Vec3 const& gravity, std::span<PlacedWrench const> loads) = nullptr;
  CoordinateUnits units = {};  ///< of its coordinates and speeds
  std::uint64_t made_in = 0;   ///< serial number of the model that it was added to
  bool lossless = false;       ///< nothing in it dissipates: it is rigid
  bool changes = false;        ///< its mass depends on time
};

/// Where a joint stands: its markers, and its rows among all.
struct JointLayout {
  std::string name = {};                 ///< its name in messages
  Index a = -1, b = -1;                  ///< published markers
  Index row = -1, rows = 0;              ///< none of a compliant joint
  bool eliminated = false;               ///< from a time step
  void const* type = nullptr;            ///< tells types of joints apart
  Index index = 0;                       ///< among the joints of its type
  LinearConstraints const* linear = {};  ///< rows of a joint that is linear in coordinates, in the model
  bool stores = true;                    ///< of a compliant joint: all rows have a potential
  std::uint64_t made_in = 0;             ///< serial number of the model that it was added to
  bool lossless = true;                  ///< of a compliant joint: it has no damping
  void const* joint = nullptr;           ///< the joint itself, in the model
  Motion (*law)(void const* joint, double t) = nullptr;  ///< prescribed at t [s]; null where nothing is
  double period = 0.0;  ///< by which the prescribed value may jump [rad]; 0: by nothing
};

/// Where a force element stands: its markers, and its first-order states.
struct ForceLayout {
  std::string name = {};         ///< its name in messages
  void const* type = nullptr;    ///< tells types of forces apart
  Index index = 0;               ///< among the forces of its type
  void const* force = nullptr;   ///< the force element itself, in the model
  Sequence<Index> markers = {};  ///< published
  bool is_load = false;          ///< scaled by the load factor of `equilibrium`
  Index v0 = -1, states = 0;     ///< first-order states of its own, among the speeds
  bool stores = false;           ///< it has a potential
  std::uint64_t made_in = 0;     ///< serial number of the model that it was added to
  bool stores_in_part = false;   ///< a group of which some laws have one
  bool lossless = false;         ///< all work that it takes goes into its potential
  /// Two markers a and b: whether they move through a contact from frames [a, b] to [a, b] by which neither end of the
  /// step is touched; null for other forces.
  bool (*passes)(void const* force, Frame<double> const (&from)[2], Frame<double> const (&to)[2]) = nullptr;
};

/// Counts, places and names of a model; bodies, joints and forces in the order of their types.
struct ModelLayout {
  std::uint64_t serial = 0;                         ///< of the model, as its handles know it
  Sequence<std::uint64_t> ancestors = {};           ///< serial numbers of the models that it was copied from
  ModelWatch watch = {};                            ///< notices changes of the model
  Index coordinates = 0, velocities = 0, rows = 0;  ///< nq; nv, with first-order states behind; rows
  Index states = 0;                                 ///< first-order ones: the last of the speeds
  Sequence<Index> nonholonomic_equations = {};      ///< rows without a position, ascending
  Sequence<BodyLayout> bodies = {};                 ///< by types, in the order in which they were added
  Sequence<JointLayout> joints = {};                ///< by types, in the order in which they were added
  Sequence<ForceLayout> forces = {};                ///< by types, in the order in which they were added
  Sequence<Index> owners = {};                      ///< of each published marker: the body, −1 for the ground
  Sequence<MarkerKind> observes = {};               ///< kinematics that each published marker provides
  Vec3 gravity = Vec3::Zero();                      ///< (3) world axes [m/s²]
  Sequence<double> breakpoints = {};                ///< times at which a drive or a load wants a step to end
  bool constant_mass = false;                       ///< M of no body depends on q
  bool has_groups = false;                          ///< of forces

  /// Speeds of the bodies alone; first-order states stand behind them.
  Index body_velocities() const { return velocities - states; }

  /// Name of the body that owns coordinate i.
  [[gnu::cold]] std::string name_of_coordinate(Index i) const {
    for (BodyLayout const& b : bodies)
      if (i >= b.q0 && i < b.q0 + b.coordinates) return sentence_of({"body \"", b.name, "\""});
    return "unknown";
  }
  /// Name of the body that owns speed i, or the force whose first-order state it is; or of the joint or body that owns
  /// row i − speeds.
  [[gnu::cold]] std::string name_of(Index i) const {
    Index const row = i - velocities;
    for (BodyLayout const& b : bodies)
      if (row < 0 ? i >= b.v0 && i < b.v0 + b.velocities : row >= b.row && row < b.row + b.rows)
        return sentence_of({"body \"", b.name, "\""});
    for (JointLayout const& j : joints)
      if (row >= 0 && row >= j.row && row < j.row + j.rows) return sentence_of({"joint \"", j.name, "\""});
    for (ForceLayout const& f : forces)
      if (row < 0 && i >= f.v0 && i < f.v0 + f.states) return sentence_of({"force \"", f.name, "\""});
    return "unknown";
  }
};

namespace detail {
/// An address for each type.
template <class>
inline constexpr char type_tag = 0;
}  // namespace detail

}  // namespace polybody
