#pragma once
/// \file
/// Forces and moments on a marker, as dead loads and follower loads, and forces that are distributed along a bar.
/// Theory: Eqs. 3.6, 3.7.

#include <vector>

#include <polybody/forces/force_element.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/math/element_functions.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Axes of a load's components.
enum class LoadAxes {
  world,  ///< dead load: constant direction in the world
  marker  ///< follower load: rotates with the marker, which must have axes
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
  static_assert(detail::require_time_function<Law>());
  static constexpr int markers = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  Vec3 force = Vec3::Zero();        ///< (3) force [N]
  LoadAxes axes = LoadAxes::world;  ///< axes of the components
  Law law = {};                     ///< factor as a function of time

  void check(std::string const& name) const {
    require_finite(force, name, ": the force", "N");
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
  static_assert(detail::require_time_function<Law>());
  static constexpr int markers = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::axis;

  Vec3 moment = Vec3::Zero();       ///< (3) moment [N m]
  LoadAxes axes = LoadAxes::world;  ///< axes of the components
  Law law = {};                     ///< factor as a function of time

  void check(std::string const& name) const {
    require_finite(moment, name, ": the moment", "N m");
    check_time_function(law, name + ": the time function");
  }

  template <StateScalar T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const& frame, double t) const {
    Wrench<T> w;
    w.m = detail::load_in_world<T>(moment, law(t).value, axes, frame[0]);
    return {w};
  }
};

/// Range of a bar, measured from its first end and divided into equal pieces.
struct BarRange {
  Required<double> from;   ///< start of the range [m]
  Required<double> to;     ///< end of the range [m]
  Required<Index> pieces;  ///< number of equal pieces, at least 1, with two point forces each
};

/// Applies the distributed force `per_length` [N/m], a dead or follower load, to a range of a bar as two point forces
/// on each piece. For a dead load, the generalised forces are exact for shape functions up to third order if each
/// element has its own piece. The forces are named "`name`, point 1" and so on; without a name, the model names them.
/// The force types of the model must include `PointForce<Law>`. Returns the handles of the forces.
/// \throws InvalidInput if the range is empty, if an end of it lies outside the bar, or for less than one piece. The
/// model then stays unchanged.
template <class M, class B, TimeFunction Law = Constant>
auto apply_distributed(M& model, BodyHandle<B> const& bar, PointForce<Law> const& per_length, BarRange const& range,
                       std::string const& name = "") {
  std::string const what = name.empty() ? "distributed force" : name;
  double const from = range.from, to = range.to;
  Index const pieces = range.pieces;
  if (!(to > from) || !std::isfinite(from) || !std::isfinite(to))
    throw InvalidInput("distributed_force.range",
                       {"\"", ErrorObject{what}, "\": a distributed force needs a range from < to, but has from = ",
                        from, " m, to = ", to, " m."});
  if (pieces < 1)
    throw InvalidInput("distributed_force.pieces",
                       {"\"", ErrorObject{what}, "\": a distributed force needs at least one piece, but has ",
                        ErrorValue{pieces}, "."});
  for (double const end : {from, to}) (void)bar.at(end);
  double const l = (to - from) / double(pieces);
  std::vector<decltype(model.apply(per_length, bar.at(from), name))> handles;
  for (Index i = 0; i < pieces; ++i)
    for (auto const& g : gauss<2>) {
      PointForce<Law> part = per_length;
      part.force *= g.weight * l;
      std::string const own = name.empty() ? "" : name + ", point " + std::to_string(handles.size() + 1);
      handles.push_back(model.apply(part, bar.at(from + (double(i) + g.xi) * l), own));
    }
  return handles;
}

}  // namespace polybody
