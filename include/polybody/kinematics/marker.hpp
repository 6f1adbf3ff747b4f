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
/// \throws InvalidInput if the serial number `model` is 0, which belongs to no model.
inline void require_filled(std::uint64_t model) {
  if (model == 0)
    throw InvalidInput("model.empty_handle", {"A default-constructed handle refers to no object of a model. Assign the "
                                              "result of add, connect or apply to it."});
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

  /// Marker at `origin` [m] with axes parallel to the world axes.
  template <class = void>  // compiled where it is used
  Point at(Vec3 const& origin) const {
    require_finite(origin, "Ground: the point");
    return Placement::at(origin);
  }
  /// Marker at `placement`. \throws InvalidInput if the axes of `placement` are not orthonormal and right-handed.
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
  std::string name = {};    ///< name given by the user
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
  /// Marker at the material point `point` [m], which may be written in braces.
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
  /// Reports numbers in braces at compile time if the function `at` of the body accepts no such point. For an invalid x
  /// without braces, `requires { handle.at(x); }` remains false.
  template <class Body = B>
    requires(
        !requires(B const b, Vec3 p) { b.at(p); } && !requires(B const b, Vec2 p) { b.at(p); })
  auto at(std::initializer_list<double>) const {
    static_assert(std::is_void_v<Body>,
                  "This body has no such point. A bar has at(s), the distance along its axis [m]; a rigid body has "
                  "at({x, y, z}) [m], a planar one at({x, y}). The members `at` of the body list all forms.");
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
