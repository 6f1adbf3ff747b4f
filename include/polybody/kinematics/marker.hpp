#pragma once
/// \file
/// Markers (material points of a body in a model), and handles of bodies, which create markers.

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include <polybody/kinematics/frame.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

// Storage of the bodies of one type, shared by a model and its handles.

/// Body of a model with the positions of its coordinates and velocities in the vectors of the model.
template <class B>
struct BodyTableEntry {
  B body;
  std::string name;
  Index q0;                   ///< index of its first coordinate in the model
  Index v0;                   ///< index of its first generalised velocity in the model
  Index row = -1;             ///< index of the first constraint equation of the body itself; −1 if it has none
  std::uint64_t made_in = 0;  ///< serial number of the model to which it was added
};

/// Array of the bodies of one type, stored by value, so that loops read them without indirection. Handles share the
/// array, which exists as long as the model or one of the handles. A copy of a model has a separate array.
template <class B>
class BodyTable {
 public:
  using Entry = BodyTableEntry<B>;

  BodyTable() = default;
  BodyTable(BodyTable const& other) {
    if (other.array_) array_ = std::make_shared<Sequence<Entry>>(*other.array_);
    see();
  }
  BodyTable(BodyTable&& other) noexcept : array_(std::move(other.array_)) {
    see();
    other.see();
  }
  BodyTable& operator=(BodyTable other) noexcept {
    array_.swap(other.array_);
    see();
    return *this;
  }
  ~BodyTable() = default;

  void push_back(Entry entry) {
    if (!array_) array_ = std::make_shared<Sequence<Entry>>();
    array_->push_back(std::move(entry));
    see();
  }

  std::size_t size() const { return size_; }
  Entry const& operator[](std::size_t i) const { return first_[i]; }
  Entry const& front() const { return *first_; }
  Entry const& back() const { return first_[size_ - 1]; }
  Entry const* begin() const { return first_; }
  Entry const* end() const { return first_ + size_; }

  /// Array that handles share with the model. It also contains bodies that are added later.
  std::shared_ptr<Sequence<Entry> const> shared() const { return array_; }

 private:
  void see() {
    first_ = array_ ? array_->data() : nullptr;
    size_ = array_ ? array_->size() : 0;
  }

  std::shared_ptr<Sequence<Entry>> array_;  ///< null until the first body is added
  Entry const* first_ = nullptr;            ///< first entry of the array
  std::size_t size_ = 0;
};

}  // namespace polybody::detail

namespace polybody {

namespace detail {
/// \throws InvalidInput if the serial number `model` is 0, which belongs to no model.
inline void require_filled(std::uint64_t model) {
  if (model == 0)
    throw InvalidInput("model.empty_handle", {"A default-constructed handle refers to no object of a model. Assign the "
                                              "result of add, connect or apply to the handle."});
}
}  // namespace detail

/// Material point of a body of type B in a model with a given serial number.
template <class B>
struct Marker {
  using BodyType = B;                                  ///< type of the body
  static constexpr World world = B::world;             ///< plane or space
  static constexpr MarkerKind observes = B::observes;  ///< kinematics that the marker provides: point, axis or frame

  std::uint64_t model = 0;       ///< serial number of the model that created the marker
  Index body = 0;                ///< number of the body among the bodies of its type
  typename B::Point point = {};  ///< position on the body
};

/// The world as a body without coordinates. A point of the ground is a placement.
struct Ground {
  static constexpr World world = World::both;                ///< connects to bodies of the plane and of space
  static constexpr MarkerKind observes = MarkerKind::frame;  ///< its markers provide a full frame
  using Point = Placement;                                   ///< position and axes of a marker

  /// Marker at `origin` (3) [m] with axes parallel to the world axes. \throws InvalidInput if `origin` is not finite.
  template <class = void>  // compiled where it is used
  Point at(Vec3 const& origin) const {
    require_finite(origin, "Ground: the point");
    return Placement::at(origin);
  }
  /// Marker at `placement`. \throws InvalidInput if `placement` is not finite, or if its axes are not orthonormal and
  /// right-handed.
  template <class = void>  // compiled where it is used
  Point at(Placement const& placement) const {
    placement.check("Ground");
    return placement;
  }
};

/// Handle of a body in a model; it creates markers on the body. A default-constructed handle refers to no body, and its
/// member functions throw.
template <class B>
struct BodyHandle {
  std::uint64_t model = 0;  ///< serial number of the model that created the handle
  Index index = 0;          ///< number of the body among the bodies of its type
  std::string name = {};    ///< name of the body, given or generated
  /// Array of the bodies of this type, shared with the model and not copied; null for the ground.
  std::shared_ptr<Sequence<detail::BodyTableEntry<B>> const> bodies = {};

  /// Body in the model. The reference is valid until a body of this type is added to the model.
  /// \throws InvalidInput for a default-constructed handle.
  B const& body() const {
    detail::require_filled(bodies || std::is_same_v<B, Ground> ? model : 0);
    if constexpr (std::is_same_v<B, Ground>) {
      static constexpr Ground ground = {};
      return ground;
    } else {
      return (*bodies)[std::size_t(index)].body;
    }
  }

  /// Marker at the material point that the function `at` of the body returns for `args`. \throws InvalidInput with the
  /// name of the body for an invalid point, and for a default-constructed handle.
  template <class... Args>
    requires requires(B const b, Args... args) { b.at(args...); }
  Marker<B> at(Args const&... args) const {
    return named([&](B const& on) { return on.at(args...); });
  }
  /// Marker at the material point `point` (3) [m], in the axes that the body's function `at` uses. The point may be
  /// written in braces: `at({x, y, z})`.
  Marker<B> at(Vec3 const& point) const
    requires(B::world != World::plane) && requires(B const b, Vec3 p) { b.at(p); }
  {
    return named([&](B const& on) { return on.at(point); });
  }
  /// Marker at the material point `point` (2) of a planar body [m], in the axes that the body's function `at` uses.
  Marker<B> at(Vec2 const& point) const
    requires(B::world == World::plane) && requires(B const b, Vec2 p) { b.at(p); }
  {
    return named([&](B const& on) { return on.at(point); });
  }
  /// Marker at the centre of mass of a rigid body. In flexible bodies the centre of mass is not a material point;
  /// `centre_of_mass` (run/energy.hpp) computes its position for every body.
  Marker<B> centre() const
    requires requires(B const b) { b.centre(); }
  {
    return named([](B const& on) { return on.centre(); });
  }
  /// Overload for numbers in braces that the body's function `at` does not accept; it yields a compile-time message.
  /// For an invalid x without braces, `requires { handle.at(x); }` remains false.
  template <class Body = B>
    requires(
        !requires(B const b, Vec3 p) { b.at(p); } && !requires(B const b, Vec2 p) { b.at(p); })
  auto at(std::initializer_list<double>) const {
    static_assert(std::is_void_v<Body>,
                  "This body has no such point. A bar has at(s), the distance along its axis [m]; a rigid body has "
                  "at({x, y, z}) [m], a planar rigid body at({x, y}). The members `at` of the body list all forms.");
    return Marker<B>{};
  }

 private:
  template <class F>
  Marker<B> named(F&& point) const {
    B const& on = body();
    try {
      return {model, index, point(on)};
    } catch (InvalidInput const& e) {
      throw InvalidInput({"\"", ErrorObject{name}, "\": ", ErrorCause{e}});
    }
  }
};

}  // namespace polybody
