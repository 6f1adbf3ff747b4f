#pragma once
/// \file
/// Markers, material points of a body in a model, and handles of bodies.

#include <cstdint>
#include <initializer_list>
#include <string>

#include <polybody/kinematics/body_table.hpp>
#include <polybody/kinematics/frame.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

namespace detail {
/// Refuses a point in braces.
template <class B>
constexpr void refuse_point() {
  static_assert(std::is_void_v<B>,
                "This body has no such point. A bar has at(s), the distance along its axis [m]; a rigid body has "
                "at({x, y, z}) [m], a planar one at({x, y}). The members `at` of the body list all forms.");
}
/// \throws InvalidInput for the serial number 0, which belongs to no model.
inline void require_filled(std::uint64_t model) {
  if (model == 0)
    throw InvalidInput("model.empty_handle", {"A default-constructed handle refers to no object of a model. Assign the "
                                              "result of add, connect or apply to it."});
}
}  // namespace detail

/// Material point of a body of type B in a model with a given serial number.
template <class B>
struct Marker {
  using BodyType = B;                                  ///< type of its body
  static constexpr World world = B::world;             ///< plane or space
  static constexpr MarkerKind observes = B::observes;  ///< provides a point, an axis or a frame

  std::uint64_t model = 0;       ///< serial number of the model that created it
  Index body = 0;                ///< number of the body among the bodies of its type
  typename B::Point point = {};  ///< position on the body
};

/// The world as a body without coordinates. Its points are placements.
struct Ground {
  static constexpr World world = World::both;                ///< connects to bodies of the plane and of space
  static constexpr MarkerKind observes = MarkerKind::frame;  ///< its markers provide a full frame
  using Point = Placement;                                   ///< position and axes of a marker

  /// Marker at `origin` [m] with axes parallel to the world axes.
  template <class = void>  // compiled where it is used
  Point at(Vec3 const& origin) const {
    require_finite(origin, "Ground: the point");
    return Placement::at(origin);
  }
  /// Marker at `placement`. \throws InvalidInput if its axes are not orthonormal and right-handed.
  template <class = void>  // compiled where it is used
  Point at(Placement const& placement) const {
    placement.check("Ground");
    return placement;
  }
};

/// Handle of a body in a model; it creates markers on the body. A default-constructed handle refers to no body. Its
/// use throws until a handle is assigned to it.
template <class B>
struct BodyHandle {
  std::uint64_t model = 0;  ///< serial number of the model that created it
  Index index = 0;          ///< number among the bodies of its type
  std::string name = {};    ///< name given by the user
  /// Bodies of this type, shared with the model and not copied; null for the ground.
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

  /// Marker at a material point; `args` as for the function `at` of the body. \throws InvalidInput with the name of
  /// the body for an invalid point, and for a default-constructed handle.
  template <class... Args>
    requires requires(B const b, Args... args) { b.at(args...); }
  Marker<B> at(Args const&... args) const {
    return named([&](B const& on) { return on.at(args...); });
  }
  /// Marker at the material point `point`, which may be written in braces [m].
  Marker<B> at(Vec3 const& point) const
    requires(B::world != World::plane) && requires(B const b, Vec3 p) { b.at(p); }
  {
    return named([&](B const& on) { return on.at(point); });
  }
  /// Marker at the material point `point` (2) of a planar body, as for the function `at` of the body [m].
  Marker<B> at(Vec2 const& point) const
    requires(B::world == World::plane) && requires(B const b, Vec2 p) { b.at(p); }
  {
    return named([&](B const& on) { return on.at(point); });
  }
  /// Marker at the centre of mass, for bodies in which it is a material point (rigid bodies). The position of the
  /// centre of mass of every body is computed by `centre_of_mass` (run/energy.hpp).
  Marker<B> centre() const
    requires requires(B const b) { b.centre(); }
  {
    return named([](B const& on) { return on.centre(); });
  }
  /// Refuses numbers in braces for a body whose function `at` accepts no such point. `requires { handle.at(x); }` stays
  /// false for an invalid x without braces.
  template <class Body = B>
    requires(
        !requires(B const b, Vec3 p) { b.at(p); } && !requires(B const b, Vec2 p) { b.at(p); })
  auto at(std::initializer_list<double>) const {
    detail::refuse_point<Body>();
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
