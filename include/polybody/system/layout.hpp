#pragma once
/// \file
/// Layout of a model: positions of its parts in the vectors, their names and their properties, without the model's C++
/// type.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <polybody/bodies/shared/coordinate_units.hpp>
#include <polybody/kinematics/frame.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/time_functions.hpp>
#include <polybody/system/data.hpp>

namespace polybody {

// Identity of a model. Serial numbers distinguish the handles of a model from those of other models. Objects that keep
// a reference to a model detect its changes from a count.

namespace detail {

/// Returns a new serial number for a model.
inline std::uint64_t next_serial() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Count of the changes of a model. It outlives the model as long as a watch refers to it.
struct ModelHistory {
  std::uint64_t changes = 1;  ///< number of additions, moves and destructions, plus one
  std::uint64_t moved = 0;    ///< value of `changes` at the last move to another object; 0: no move
  bool ended = false;         ///< true after the model is destroyed or another model is assigned to it
};

}  // namespace detail

/// Detector of changes of a model to which a run, system or recorder keeps a reference. A default-constructed watch
/// detects no changes.
class ModelWatch {
 public:
  ModelWatch() = default;
  /// Starts to watch a model. \param history change count of the model
  explicit ModelWatch(std::shared_ptr<detail::ModelHistory const> history) : history_(std::move(history)) {
    if (history_) changes_ = history_->changes;
  }

  /// \throws InvalidInput if a part was added, or the model was moved or destroyed, after the construction of the
  /// watch.
  void require_unchanged() const {
    if (history_ && history_->changes != changes_) refuse();
  }

 private:
  template <class = void>
  [[noreturn, gnu::cold]] void refuse() const {
    if (history_->moved > changes_)
      throw InvalidInput("model.moved",
                         {"The model was moved to another object while a run, system or recorder referred to it. "
                          "Construct these after the last move, or hold the model in a std::unique_ptr."});
    if (history_->ended)
      throw InvalidInput("model.destroyed", {"The model was destroyed or assigned to while a run, system or recorder "
                                             "still referred to it. Keep the model in a variable that outlives them."});
    throw InvalidInput("model.changed",
                       {"A body, joint or force was added to the model while a run, system or recorder referred to it. "
                        "Construct these after the last addition, or from a copy of the model."});
  }

  std::shared_ptr<detail::ModelHistory const> history_;
  std::uint64_t changes_ = 0;
};

namespace detail {

/// Identity of one model. A copy gets a new serial number and keeps the serial numbers of its ancestors. A move
/// transfers the identity; the source gets the identity of a new, empty model.
class ModelOrigin {
 public:
  ModelOrigin() = default;
  ModelOrigin(ModelOrigin const& other) : ancestors_(other.ancestors_) { ancestors_.push_back(other.serial_); }
  ModelOrigin(ModelOrigin&& other) noexcept
      : serial_(std::exchange(other.serial_, next_serial())),
        ancestors_(std::move(other.ancestors_)),
        history_(std::move(other.history_)) {
    if (history_) history_->moved = ++history_->changes;
  }
  ModelOrigin& operator=(ModelOrigin other) noexcept {  // the destructor of `other` ends the previous identity
    std::swap(serial_, other.serial_);
    ancestors_.swap(other.ancestors_);
    history_.swap(other.history_);
    return *this;
  }
  ~ModelOrigin() {
    if (!history_) return;
    ++history_->changes;
    history_->ended = true;
  }

  std::uint64_t serial() const { return serial_; }
  Sequence<std::uint64_t> const& ancestors() const { return ancestors_; }
  /// Counts a change. Call it before a part is added.
  void change() {
    if (!history_) history_ = std::make_shared<ModelHistory>();
    ++history_->changes;
  }
  ModelWatch watch() const { return ModelWatch(history_); }

 private:
  std::uint64_t serial_ = next_serial();
  Sequence<std::uint64_t> ancestors_;
  std::shared_ptr<ModelHistory> history_;  ///< null before the first part is added
};

/// True if a model accepts ground markers of the model with serial number `given`. `serial` and `ancestors` are the
/// serial numbers of the accepting model and of its ancestors.
inline bool accepts(std::uint64_t serial, Sequence<std::uint64_t> const& ancestors, std::uint64_t given) {
  return given == serial || std::find(ancestors.begin(), ancestors.end(), given) != ancestors.end();
}

}  // namespace detail

struct LinearConstraints;
struct PlacedWrench;

/// Position of a body among all coordinates, generalised velocities and constraint equations, and its properties.
struct BodyLayout {
  std::string name = {};          ///< name in messages
  Index q0 = 0, coordinates = 0;  ///< index of the first generalised coordinate, and number of coordinates
  Index v0 = 0, velocities = 0;   ///< index of the first generalised velocity, and number of velocities
  Index row = -1, rows = 0;       ///< index of the first constraint equation of the body itself, and number of these
  bool planar = false;            ///< true if the body moves in the plane
  bool constant_mass = false;     ///< true if M does not depend on q
  void const* type = nullptr;     ///< address that identifies the type of the body
  Index index = 0;                ///< index among the bodies of its type
  void const* body = nullptr;     ///< the body in the model
  /// Returns the ratio of axial forces to buckling loads for the body's q, v, v̇ under gravity and loads in world axes.
  /// Null for bodies that do not satisfy `WithoutGeometricStiffening`.
  double (*axial_share)(void const* body, std::span<double const> q, std::span<double const> v,
                        std::span<double const> a, Vec3 const& gravity, std::span<PlacedWrench const> loads) = nullptr;
  CoordinateUnits units = {};          ///< units of coordinates and velocities
  std::uint64_t made_in = 0;           ///< serial number of the model to which the body was added
  bool lossless = false;               ///< true if the body does not dissipate energy, because it is rigid
  bool changes = false;                ///< true if the mass depends on time
  double stretch_ratio = 0.0;          ///< EA l²/EI of a bar with elements of length l [1]; 0 for other bodies
  std::string_view unit_warning = {};  ///< warning of section matrices that are probably not in SI units, in the body
};

/// Markers of a joint, position of its constraint equations among those of the model, and its properties.
struct JointLayout {
  std::string name = {};                 ///< name in messages
  Index a = -1, b = -1;                  ///< marker indices
  Index row = -1, rows = 0;              ///< first equation and number of equations; −1 and 0: compliant joint
  bool eliminated = false;               ///< true if a time step eliminates the equations
  void const* type = nullptr;            ///< address that identifies the type of the joint
  Index index = 0;                       ///< index among the joints of its type
  LinearConstraints const* linear = {};  ///< equations that are linear in coordinates; null for other joints
  bool stores = true;                    ///< for a compliant joint: true if all its forces have a potential
  std::uint64_t made_in = 0;             ///< serial number of the model to which the joint was added
  bool lossless = true;                  ///< for a compliant joint: true if it has no damping
  void const* joint = nullptr;           ///< the joint in the model
  Motion (*law)(void const* joint, double t) = nullptr;  ///< prescribed motion at t [s]; null if there is none
  double period = 0.0;  ///< period of the prescribed value [rad], by which it may jump; 0: no jump allowed

  std::string title() const { return sentence_of({"joint \"", name, "\""}); }  ///< joint "name"
};

/// Markers of a force element, position of its first-order states, and its properties.
struct ForceLayout {
  std::string name = {};         ///< name in messages
  void const* type = nullptr;    ///< address that identifies the type of the force element
  Index index = 0;               ///< index among the force elements of its type
  void const* force = nullptr;   ///< the force element in the model
  Sequence<Index> markers = {};  ///< marker indices
  bool is_load = false;          ///< true if the load factor multiplies its wrenches
  Index v0 = -1, states = 0;     ///< first of its first-order states among the velocities, and number of states
  bool stores = false;           ///< true if it has a potential
  std::uint64_t made_in = 0;     ///< serial number of the model to which the force was added
  bool stores_in_part = false;   ///< true for a group in which not all laws have a potential
  bool lossless = false;         ///< true if its potential stores all work that is done on the element
  Index row = -1;                ///< first multiplier on which it depends; −1 for none
  /// For a contact of two markers a and b: returns true if they touch during a step from the frames `from` [a, b] to
  /// the frames `to` [a, b], but not at the ends of the step. Null for other forces.
  bool (*passes)(void const* force, Frame<double> const (&from)[2], Frame<double> const (&to)[2]) = nullptr;
  /// Power that its first-order states dissipate at time t [W]. Null for forces without `HasStatePotential`.
  double (*dissipation)(ForceLayout const& of, double t, Data<double> const& data) = nullptr;
};

/// Sizes of a model, and positions and names of its bodies, joints and forces.
struct ModelLayout {
  std::uint64_t serial = 0;                         ///< serial number of the model, which its handles contain
  Sequence<std::uint64_t> ancestors = {};           ///< serial numbers of the models from which this model was copied
  ModelWatch watch = {};                            ///< detects changes of the model
  Index coordinates = 0, velocities = 0, rows = 0;  ///< nq; nv, first-order states included; constraint equations
  Index states = 0;                                 ///< number of first-order states, which are the last velocities
  Sequence<Index> nonholonomic_equations = {};      ///< indices of the nonholonomic equations, ascending
  Sequence<BodyLayout> bodies = {};                 ///< bodies grouped by type; each type in the order of addition
  Sequence<JointLayout> joints = {};                ///< joints grouped by type; each type in the order of addition
  Sequence<ForceLayout> forces = {};                ///< forces grouped by type; each type in the order of addition
  Sequence<Index> owners = {};                      ///< body of each marker; −1 for the ground
  Sequence<MarkerKind> observes = {};               ///< kinematics that each marker provides
  Vec3 gravity = Vec3::Zero();                      ///< (3) gravity in world axes [m/s²]
  Sequence<double> breakpoints = {};                ///< breakpoints of drives and loads, at which a step ends [s]
  bool constant_mass = false;                       ///< true if M of no body depends on q
  bool has_groups = false;                          ///< true if the model can have force groups

  /// Number of generalised velocities of the bodies. The first-order states follow them.
  Index body_velocities() const { return velocities - states; }

  /// Name of the body that owns coordinate i.
  [[gnu::cold]] std::string name_of_coordinate(Index i) const {
    for (BodyLayout const& b : bodies)
      if (i >= b.q0 && i < b.q0 + b.coordinates) return sentence_of({"body \"", b.name, "\""});
    return "unknown";
  }
  /// Name of the owner of unknown i. For i < `velocities`, the owner is the body of velocity i, or the force element
  /// whose first-order state is velocity i. Otherwise the owner is the joint or body of constraint equation i −
  /// `velocities`.
  [[gnu::cold]] std::string name_of(Index i) const {
    Index const row = i - velocities;
    for (BodyLayout const& b : bodies)
      if (row < 0 ? i >= b.v0 && i < b.v0 + b.velocities : row >= b.row && row < b.row + b.rows)
        return sentence_of({"body \"", b.name, "\""});
    for (JointLayout const& j : joints)
      if (row >= 0 && row >= j.row && row < j.row + j.rows) return j.title();
    for (ForceLayout const& f : forces)
      if (row < 0 && i >= f.v0 && i < f.v0 + f.states) return sentence_of({"force \"", f.name, "\""});
    return "unknown";
  }
  /// Index in `joints` of the joint of each constraint equation; −1 for an equation of a body. Use this function for
  /// many names, because the cost of `name_of` grows with the number of bodies, joints and forces.
  [[gnu::cold]] Sequence<Index> joint_of_rows() const {
    Sequence<Index> of(std::size_t(rows), -1);
    for (std::size_t k = 0; k < joints.size(); ++k)
      for (Index i = std::max<Index>(joints[k].row, 0); i < std::min(joints[k].row + joints[k].rows, rows); ++i)
        of[std::size_t(i)] = Index(k);
    return of;
  }
};

namespace detail {
/// Object with a different address for each type.
template <class>
inline constexpr char type_tag = 0;
}  // namespace detail

}  // namespace polybody
