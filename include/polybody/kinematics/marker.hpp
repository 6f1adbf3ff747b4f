#pragma once
/// \file
/// Markers as the user holds them: a material point of a body of a certain model.

#include <cstdint>
#include <string>

#include <polybody/kinematics/body_entries.hpp>
#include <polybody/kinematics/frame.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

namespace detail {
/// \throws InvalidInput for the serial number of no model.
inline void require_filled(std::uint64_t model) {
  if (model == 0)
    throw InvalidInput(
        "A handle made by default names nothing in a model. Assign it what add, connect or apply returned.");
}
}  // namespace detail

/// A material point of a body of type B in the model with this serial number.
template <class B>
struct Marker {
  using BodyType = B;                                ///< the body that it is on
  static constexpr World world = B::world;           ///< plane or space
  static constexpr Observes observes = B::observes;  ///< whether it knows a point, an axis, a frame

  std::uint64_t model = 0;       ///< the serial of the model that made it
  Index body = 0;                ///< among the bodies of its type
  typename B::Point point = {};  ///< on the body
};

/// The world as a body without coordinates. Its points are placements.
struct Ground {
  static constexpr World world = World::both;            ///< joints connect it to bodies of the plane and of space
  static constexpr Observes observes = Observes::frame;  ///< its markers know a frame
  using Point = Placement;                               ///< place and axes of a marker

  /// The marker at `origin` [m], axes parallel to the world's.
  template <class = void>  // compiled where it is used
  Point at(Vec3 const& origin) const {
    require_finite(origin, "Ground: the point");
    return Placement::at(origin);
  }
  /// The marker there, with these axes. \throws InvalidInput for axes that are no rotation.
  template <class = void>  // compiled where it is used
  Point at(Placement const& placement) const {
    placement.check("Ground");
    return placement;
  }
};

/// Handle of a body in a model: names it and makes markers on it. One made by default names nothing and refuses to be
/// used until a handle is assigned to it.
template <class B>
struct BodyHandle {
  std::uint64_t model = 0;  ///< the serial of the model that made it
  Index index = 0;          ///< among the parts of its type
  std::string name = {};    ///< the user's own
  /// The model's bodies of this type, shared with the model and not copied; none for the ground.
  std::shared_ptr<Sequence<detail::BodyEntry<B>> const> bodies = {};

  /// The body as the model holds it; the reference is valid until a body of this type is added to the model.
  /// \throws InvalidInput for a handle made by default.
  B const& body() const {
    detail::require_filled(bodies || std::is_same_v<B, Ground> ? model : 0);
    if constexpr (std::is_same_v<B, Ground>) {
      static constexpr Ground ground = {};
      return ground;
    } else {
      return (*bodies)[std::size_t(index)].body;
    }
  }

  /// A marker at a material point; `args` as for the body's own `at`. \throws InvalidInput with its name, or for a
  /// handle made by default.
  template <class... Args>
    requires requires(B const b, Args... args) { b.at(args...); }
  Marker<B> at(Args const&... args) const {
    return named([&](B const& on) { return on.at(args...); });
  }
  /// The same for a point in braces.
  Marker<B> at(Vec3 const& point) const
    requires(B::world != World::plane) && requires(B const b, Vec3 p) { b.at(p); }
  {
    return named([&](B const& on) { return on.at(point); });
  }
  /// The same in the plane; `point` (2) as for the body's own `at` [m].
  Marker<B> at(Vec2 const& point) const
    requires(B::world == World::plane) && requires(B const b, Vec2 p) { b.at(p); }
  {
    return named([&](B const& on) { return on.at(point); });
  }

 private:
  template <class F>
  Marker<B> named(F&& point) const {
    B const& on = body();
    try {
      return {model, index, point(on)};
    } catch (InvalidInput const& e) {
      throw InvalidInput{"\"", name, "\": ", e.what()};
    }
  }
};

}  // namespace polybody
