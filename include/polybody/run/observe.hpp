#pragma once
/// \file
/// Questions about a single state: frames of points, gaps and reactions of joints, counts.

#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody {

/// Frame of a material point in state x. \throws InvalidInput for a marker of another model.
template <class M, class B>
Frame<double> frame(M const& model, State const& x, Marker<B> const& marker) {
  model.require_own(marker.model, "frame");
  if constexpr (std::is_same_v<B, Ground>) {
    return {.r = marker.point.origin, .A = marker.point.axes};
  } else {
    auto const& e = std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)];
    std::vector<double> jacobian(std::size_t(6 * point_columns(e.body, marker.point)));
    Published<double> p;
    p.jacobian = jacobian.data();
    e.body.template publish<double>(marker.point, Mat3::Identity(), detail::body_part(x.q, e.q0, e.body.coordinates()),
                                    detail::body_part(x.v, e.v0, e.body.speeds()), p);
    return p.frame;
  }
}

/// Position of a material point [m].
template <class M, class B>
Vec3 position(M const& model, State const& x, Marker<B> const& marker) {
  return frame(model, x, marker).r;
}

/// Coordinates of one body in state x, to be handed to the body's own questions (strains, centre line).
template <class M, class B>
std::span<double const> coordinates_of(M const& model, State const& x, BodyHandle<B> const& handle) {
  auto const& e = model.entry(handle);
  return detail::body_part(x.q, e.q0, e.body.coordinates());
}
template <class M, class B>
std::span<double const> speeds_of(M const& model, State const& x, BodyHandle<B> const& handle) {
  auto const& e = model.entry(handle);
  return detail::body_part(x.v, e.v0, e.body.speeds());
}

namespace detail {

template <class M, class J, class F>
auto ask_joint(M const& model, State const& x, ElementHandle<J> const& handle, F&& f) {
  auto const& e = model.entry(handle);
  System system(model, with<Entries::motion>);
  system.evaluate(x.q, x.v, x.t);
  Index const owner = model.place_of(handle);
  for (RowBlock<double> const& block : system.data().rows)
    if (block.source != RowSource::body && block.owner == owner) return f(e, block, system.data());
  throw InvalidInput("\"" + e.name + "\" has no rows.");
}

/// Gbᵀλ of linear rows as a wrench about the joint point: those of the position give the force, a gradient r_α with its
/// λ_α the moment r_α × λ_α. (What stretches r_α is no wrench.)
template <class = void>  // compiled where it is used
Vec6 linear_wrench(LinearRows const& rows, State const& x) {
  Vec6 w = Vec6::Zero();
  Index const size = rows.positions;
  w.head(size) = x.lambda.segment(rows.row, size);
  Index row = size;
  for (LinearRows::Gradient const& g : rows.gradients) {
    Vec3 now = g.fixed, force = g.axis * x.lambda[rows.row + row];
    if (g.map.cols() > 0) now.head(size) = g.map * x.q.segment(rows.b.q0, g.map.cols());
    if (g.rows > 1) force.head(size) = x.lambda.segment(rows.row + row, size);
    w.tail<3>() += now.cross(force);
    row += g.rows;
  }
  return w;
}

}  // namespace detail

/// Violation of a joint's rows in state x.
template <class M, class J>
  requires(!LinearInCoordinates<typename J::PolicyType>)
Vec<double, J::rows> gap(M const& model, State const& x, ElementHandle<J> const& joint) {
  return detail::ask_joint(model, x, joint, [](auto const&, RowBlock<double> const& block, auto const&) {
    return Vec<double, J::rows>(block.g);
  });
}

/// Axes for the components of a reaction.
enum class ReactionAxes { world, joint };

/// Force and moment that the joint exerts on its second body, about the joint point there:
/// −Gbᵀλ [thesis Eq. 3.3 and the rule of equipollent forces]; "joint" are the axes of the second marker.
template <class M, class J>
Wrench<double> reaction(M const& model, State const& x, ElementHandle<J> const& joint,
                        ReactionAxes axes = ReactionAxes::world) {
  return detail::ask_joint(model, x, joint, [&](auto const& e, RowBlock<double> const& block, auto const& data) {
    Vec6 w;
    if constexpr (LinearInCoordinates<typename J::PolicyType>)
      w = detail::linear_wrench(model.linear_rows()[std::size_t(e.linear)], x);
    else
      wrench_at(block, block.b, block.multiplier(x.lambda), w.data());
    w = -w;
    Wrench<double> wrench{w.head<3>(), w.tail<3>()};
    if (axes == ReactionAxes::joint) {
      Mat3 const& axes_of_b = data.markers[std::size_t(e.b)].frame.A;
      wrench = {axes_of_b.transpose() * wrench.f, axes_of_b.transpose() * wrench.m};
    }
    return wrench;
  });
}

/// The largest force of any joint on its second body [N], whatever its policy; `system` must have been evaluated at x.
template <class = void>
double peak_joint_force(System const& system, State const& x) {
  double peak = 0.0;
  for (RowBlock<double> const& block : system.data().rows) {
    double w[6];
    if (block.source == RowSource::linear) {
      for (int i = 0; i < 3; ++i) w[i] = i < block.positions ? x.lambda[block.row + i] : 0.0;
    } else {
      wrench_at(block, block.b, block.multiplier(x.lambda), w);
    }
    peak = std::max(peak, std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
  }
  return peak;
}

/// Counts of a model as thesis Table 3.4 makes them: a unit quaternion counts four coordinates and one
/// constraint. What policies eliminate is not counted.
struct Census {
  Index coordinates = 0;
  Index constraints = 0;
  Index speeds = 0;              ///< unknown rates of the integrator
  Index rows = 0;                ///< multipliers of the integrator
  Index degrees_of_freedom = 0;  ///< coordinates − constraints
};

template <class M>
Census census(M const& model) {
  Coordinates const c = coordinates_of(model);
  Index const coordinates = c ? c.narrow->coordinates : model.coordinates();
  Index const speeds = c ? c.narrow->speeds : model.speeds(), rows = c ? c.narrow->rows : model.rows();
  Index const constraints = rows + coordinates - speeds;
  return {coordinates, constraints, speeds, rows, coordinates - constraints};
}

/// Largest |Φ|, |Φ̇| and |Φ̈| of a state.
struct Violation {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

template <class = void>
Violation violation(System& system, State const& x) {
  system.evaluate(x.q, x.v, x.t);
  if (system.rows() == 0) return {};
  VecX phi = VecX::Zero(system.rows()), rate = phi, second = phi;
  system.violation(phi);
  system.violation_rate(rate);
  system.acceleration_bias(second);
  VecX of_accelerations = phi;
  system.rows_times(x.a, of_accelerations);
  second += of_accelerations;
  return {phi.cwiseAbs().maxCoeff(), rate.cwiseAbs().maxCoeff(), second.cwiseAbs().maxCoeff()};
}

}  // namespace polybody
