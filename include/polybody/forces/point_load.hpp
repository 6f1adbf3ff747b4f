#pragma once
/// \file
/// Forces and moments on a marker: dead loads and follower loads.

#include <polybody/forces/force_element.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Axes of a load's components.
enum class LoadAxes {
  world,  ///< dead load: constant direction in the world
  marker  ///< follower load: rotates with the marker
};

namespace detail {

template <StateScalar T>
Vec<T, 3> load_in_world(Vec3 const& load, double scale, LoadAxes axes, Frame<T> const& frame) {
  double const x = load[0] * scale, y = load[1] * scale, z = load[2] * scale;
  if (axes == LoadAxes::world) return {T(x), T(y), T(z)};
  Vec<T, 3> turned;
  for (int i = 0; i < 3; ++i) turned[i] = frame.A(i, 0) * x + frame.A(i, 1) * y + frame.A(i, 2) * z;
  return turned;
}

}  // namespace detail

/// Force on a marker, `force` times a function of time.
template <class Law = Constant>
struct PointForce {
  static_assert(TimeFunction<Law>,
                "The law must be a function of time that returns a Motion. Write a lambda as "
                "[](double t) -> Motion { return {value, rate, acceleration}; }.");
  static constexpr int markers = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  Vec3 force = Vec3::Zero();        ///< (3) force [N]
  LoadAxes axes = LoadAxes::world;  ///< axes of the components
  Law law = {};                     ///< factor as a function of time

  void check(std::string const& name) const {
    require_finite(force, name, ": the force");
    check_time_function(law, name + ": the time function");
  }

  template <StateScalar T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const& frame, double t) const {
    Wrench<T> w;
    w.f = detail::load_in_world<T>(force, law(t).value, axes, frame[0]);
    return {w};
  }
};

/// Moment on a marker, `moment` times a function of time. In space a dead moment is not conservative. If a marker
/// provides only its tangent, only the part of the moment orthogonal to the tangent acts.
template <class Law = Constant>
struct PointMoment {
  static_assert(TimeFunction<Law>,
                "The law must be a function of time that returns a Motion. Write a lambda as "
                "[](double t) -> Motion { return {value, rate, acceleration}; }.");
  static constexpr int markers = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::axis;

  Vec3 moment = Vec3::Zero();       ///< (3) moment [N m]
  LoadAxes axes = LoadAxes::world;  ///< axes of the components
  Law law = {};                     ///< factor as a function of time

  void check(std::string const& name) const {
    require_finite(moment, name, ": the moment");
    check_time_function(law, name + ": the time function");
  }

  template <StateScalar T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const& frame, double t) const {
    Wrench<T> w;
    w.m = detail::load_in_world<T>(moment, law(t).value, axes, frame[0]);
    return {w};
  }
};

}  // namespace polybody
