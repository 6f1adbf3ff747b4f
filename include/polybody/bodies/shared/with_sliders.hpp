#pragma once
/// \file
/// Point that slides along a flexible body, such as a pulley along a rope. Its position is an additional coordinate of
/// the body.
/// Theory: Eq. 2.48.

#include <algorithm>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/coordinate_units.hpp>
#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody {

/// Chain of elements whose axis is a sum of nodal vectors, r(x) = Σ s_i(x) e_i, smooth from element to element.
/// Component k of e_i is entry d i + k of an element in a space of dimension d.
template <class B>
concept SmoothAxis = std::derived_from<B, AddingCoordinates> && requires(B const b) {
  { b.length() } -> std::convertible_to<double>;
  { b.element_length() } -> std::convertible_to<double>;
  b.axis_shape(0.5);
};

/// Index of a slider on its body.
struct Slider {
  Index index = 0;  ///< index of the slider, counted from 0
};

/// Cable or beam with sliders: `WithSliders(AncfCable<>::from(bar, n), {s₁, …})`, where s [m] are the initial positions
/// along the axis. Markers: `at(s)` as for the body itself, and `at(Slider{k})`, a point without axes. A joint such as
/// Spherical connects a slider to another body. The coordinates are those of the body, followed by the positions s of
/// the sliders. A slider has no inertia. With ′ = ∂/∂s,
///   ṙ = Σ s_i ė_i + r′ ṡ,   r̈ = Σ s_i ë_i + r′ s̈ + 2 ṡ Σ s_i′ ė_i + r″ ṡ².
/// The equation of s is r′·f = 0: the force f on the slider has no component along the axis, so that the slider moves
/// without friction. The position of a slider is undetermined if no joint with constraint equations holds it, and the
/// linear solver reports this.
///
/// A slider depends on all columns of the body, because its element changes with s. Its Jacobian therefore has a column
/// for each generalised velocity of the body, and its load stiffness is dense. When the slider passes a node, r″ and
/// the accelerations jump. Beyond an end of the body, the cubic of the element at this end continues for one element
/// length, so that a step may end there. `slider_end_event` (run/sliders.hpp) is a terminal event at both ends of the
/// body.
template <Body B>
class WithSliders : public B {
  static_assert(SmoothAxis<B>,
                "WithSliders needs a body with a smooth (C1) axis: AncfCable, AncfBeam or planar::AncfCable. The axis "
                "of this body has kinks at its nodes.");

 public:
  static constexpr int point_columns = Eigen::Dynamic;
  using B::observes;

  /// Material point, or slider.
  struct Point {
    typename B::Point material = {};  ///< point of the body itself; not used for a slider
    Index slider = -1;                ///< column of the slider; −1 for a material point
  };

  /// Adds sliders at the positions `places` [m] to the body `line`.
  /// \throws InvalidInput for positions outside the body.
  WithSliders(B line, std::vector<double> places) : B(std::move(line)), places_(std::move(places)) {
    for (double& s : places_) s = require_inside(s, B::length(), "WithSliders: the position");
  }

  Index sliders() const { return Index(places_.size()); }  ///< number of sliders
  /// Index of the coordinate (and of the generalised velocity) of `slider`.
  /// \throws InvalidInput for a slider that the body does not have.
  Index column_of(Slider slider) const {
    if (slider.index < 0 || slider.index >= sliders())
      throw InvalidInput("slider.index", {ErrorObject{"WithSliders"}, ": slider ", ErrorValue{slider.index},
                                          " does not exist; the body has ", sliders(), " sliders, counted from 0."});
    return B::coordinates() + slider.index;
  }

  template <class... Args>
    requires requires(B const b, Args... args) { b.at(args...); }
  Point at(Args const&... args) const {
    return {B::at(args...), -1};
  }
  /// Marker on `slider`, a point without axes.
  /// \throws InvalidInput for a slider that the body does not have.
  Point at(Slider slider) const { return {{}, column_of(slider)}; }
  /// Kind of a marker at p: `observes` for a material point, a point without axes for a slider.
  static MarkerKind observes_at(Point const& p) { return p.slider < 0 ? observes : MarkerKind::point; }

  Index coordinates() const { return B::coordinates() + sliders(); }
  Index velocities() const { return coordinates(); }
  char const* coordinate_unit(Index i) const
    requires HasCoordinateUnits<B>
  {
    return i < B::coordinates() ? B::coordinate_unit(i) : "m";
  }
  using B::first_column;
  Index first_column(Point const& p) const { return p.slider < 0 ? B::first_column(p.material) : 0; }
  Index columns_of(Point const& p) const { return p.slider < 0 ? Index(B::point_columns) : velocities(); }

  void reference(std::span<double> q) const {
    B::reference(q.first(std::size_t(B::coordinates())));
    std::copy(places_.begin(), places_.end(), q.end() - sliders());
  }
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    B::rigid_velocity(q, v0, omega, v);
    std::fill(v.end() - sliders(), v.end(), 0.0);
  }

  /// Marker kinematics of a material point or a slider.
  /// \throws SliderOutOfRange for a slider more than one element length beyond an end.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    if (p.slider < 0) return B::template evaluate_marker<T>(p.material, axes, q, v, out);
    slide(p.slider, q, v, out);
    out.frame.A = axes.template cast<T>();
    out.shape = JacobianShape::dense;
    out.columns = velocities();
  }

  /// Load stiffness ∂(Jᵀw)/∂q. For a material point the function sets only the first rows and columns of k. For a
  /// slider Jᵀw = [s_i f; r′·f]. The derivative of s_i f with respect to s is s_i′ f, the transpose of the derivative
  /// of r′·f with respect to e_i. The last entry is ∂(r′·f)/∂s = r″·f.
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, MatX& k) const {
    if (p.slider < 0) {
      Mat<double, B::point_columns, B::point_columns> each;
      B::load_stiffness(p.material, q, w, each);
      k.topLeftCorner<B::point_columns, B::point_columns>() = each;
      return;
    }
    k.setZero();
    Place const at = place(q[std::size_t(p.slider)]);
    for (std::size_t i = 0; i < at.shape.s.size(); ++i)
      for (int c = 0; c < dimension; ++c) {
        Index const column = at.first + dimension * Index(i) + c;
        k(column, p.slider) = k(p.slider, column) = at.shape.ds[i] * w.f[c];
        k(p.slider, p.slider) += at.shape.dds[i] * q[std::size_t(column)] * w.f[c];
      }
  }

 private:
  static constexpr int dimension = B::world == World::plane ? 2 : 3;
  struct Place {
    Index first;  ///< first column of the element
    decltype(std::declval<B const&>().axis_shape(0.0)) shape;
  };
  Place place(double s) const {
    double const l = B::element_length();
    if (!(s >= -l && s <= B::length() + l) && std::isfinite(s))
      throw SliderOutOfRange(
          "slider.out_of_range",
          {ErrorObject{"WithSliders"}, ": a slider is more than one element length beyond the end of the body: s = ",
           ErrorValue{s}, " m, but the length is ", B::length(),
           " m. End the run at the ends of the body with slider_end_event, or hold the slider on the body."});
    Index const last = B::elements() - 1, e = std::isfinite(s) ? std::clamp(Index(s / l), Index(0), last) : 0;
    return {B::first_column(e), B::axis_shape(s / l - double(e))};
  }

  /// Marker kinematics of a slider. The shape functions are evaluated at the value of s. If s is a dual number, its
  /// derivatives enter through the derivatives of the shape functions.
  template <StateScalar T>
  void slide(Index column, std::span<T const> q, std::span<T const> v, MarkerKinematics<T>& out) const {
    std::fill_n(out.jacobian, 6 * velocities(), T(0.0));
    T const s = q[std::size_t(column)], rate = v[std::size_t(column)], beyond = s - T(value_of(s));
    Place const at = place(value_of(s));
    Vec<T, 3> slope = Vec<T, 3>::Zero(), slope_rate = slope, bend = slope;  // r′, Σ s_i′ ė_i, r″
    out.frame.r.setZero();
    out.frame.v.setZero();
    out.frame.w.setZero();
    for (std::size_t i = 0; i < at.shape.s.size(); ++i) {
      T const shape = T(at.shape.s[i]) + beyond * at.shape.ds[i], by_s = T(at.shape.ds[i]) + beyond * at.shape.dds[i];
      for (int c = 0; c < dimension; ++c) {
        std::size_t const j = std::size_t(at.first) + std::size_t(dimension) * i + std::size_t(c);
        out.frame.r[c] += shape * q[j];
        out.frame.v[c] += shape * v[j];
        slope[c] += by_s * q[j];
        slope_rate[c] += by_s * v[j];
        bend[c] += q[j] * at.shape.dds[i];
        out.jacobian[6 * j + std::size_t(c)] = shape;
      }
    }
    for (int c = 0; c < 3; ++c) {
      out.frame.v[c] += slope[c] * rate;
      out.bias[c] = (slope_rate[c] * 2.0 + bend[c] * rate) * rate;
      out.bias[3 + c] = T(0.0);
      out.jacobian[6 * column + c] = slope[c];
    }
  }

  std::vector<double> places_;  ///< initial positions [m]
};

}  // namespace polybody
