#pragma once
/// \file
/// A point that slides along a flexible body, as a pulley along a rope: its place is one more coordinate of the body.

#include <algorithm>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/coordinate_units.hpp>
#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/math/shape_functions.hpp>

namespace polybody {

/// A chain of elements whose axis is a sum of nodal vectors, r(x) = Σ s_i(x) e_i, smooth from element to element.
/// Component k of e_i is entry d i + k of an element, d the dimension of its world.
template <class B>
concept SmoothAxis = std::derived_from<B, AddingCoordinates> && requires(B const b) {
  { b.length() } -> std::convertible_to<double>;
  { b.element_length() } -> std::convertible_to<double>;
  b.axis_shape(0.5);
};

/// Which of the sliding points of a body.
struct Slider {
  Index index = 0;  ///< counted from 0
};

/// A cable or beam with sliding points: `Sliding(AncfCable<>::from(bar, n), {s₁, …})`, s [m] along the axis at the
/// start. Markers: `at(s)` as of the body itself, and `at(Slider{k})`, a point without axes; joined to a bead by
/// Spherical, say, it is what slides. Coordinates: those of the body, then the places s. A place has no inertia; with
/// (′ = ∂/∂s)
///   ṙ = Σ s_i ė_i + r′ ṡ,   r̈ = Σ s_i ë_i + r′ s̈ + 2 ṡ Σ s_i′ ė_i + r″ ṡ²
/// its equation r′·f = 0 says that the force f on it has no part along the axis: it slides without friction. A place
/// that is not held by a joint with rows is undetermined, and the linear solver says so.
///
/// A slider touches all columns of the body, since its element changes with s: its rows are as long as the body, its
/// load stiffness is dense. As it passes a node, r″ jumps, and accelerations with it. Beyond an end the last cubic goes
/// on for the length of an element, so that a step can end there; see run/sliders.hpp for the event.
template <Body B>
class Sliding : public B {
  static_assert(
      SmoothAxis<B>,
      "The axis of this body has corners at its nodes, where a sliding point would be struck. Use a body of cubic "
      "elements: AncfCable, AncfBeam or planar::AncfCable.");

 public:
  static constexpr int point_columns = Eigen::Dynamic;
  using B::observes;

  /// A material point, or a slider.
  struct Point {
    typename B::Point material = {};  ///< of the body itself; without meaning for a slider
    Index slider = -1;                ///< its column; −1 for a material point
  };

  /// \throws InvalidInput for places outside the body.
  Sliding(B line, std::vector<double> places) : B(std::move(line)), places_(std::move(places)) {
    for (double& s : places_) s = require_inside(s, B::length(), "Sliding: the place");
  }

  Index sliders() const { return Index(places_.size()); }  ///< how many sliding points
  /// The coordinate (and the speed) of a slider's place. \throws InvalidInput for a slider that the body has not.
  Index column_of(Slider slider) const {
    if (slider.index < 0 || slider.index >= sliders())
      throw InvalidInput{"Sliding: there is no slider ", slider.index, "; the body has ", sliders(),
                         ", counted from 0."};
    return B::coordinates() + slider.index;
  }

  template <class... Args>
    requires requires(B const b, Args... args) { b.at(args...); }
  Point at(Args const&... args) const {
    return {B::at(args...), -1};
  }
  /// The slider as a marker, a point without axes. \throws InvalidInput for a slider that the body has not.
  Point at(Slider slider) const { return {{}, column_of(slider)}; }
  /// As the body's points, but a slider has no axes.
  static Observes observes_at(Point const& p) { return p.slider < 0 ? observes : Observes::point; }

  Index coordinates() const { return B::coordinates() + sliders(); }
  Index speeds() const { return coordinates(); }
  char const* coordinate_unit(Index i) const
    requires NamesUnits<B>
  {
    return i < B::coordinates() ? B::coordinate_unit(i) : "m";
  }
  using B::first_column;
  Index first_column(Point const& p) const { return p.slider < 0 ? B::first_column(p.material) : 0; }
  Index columns_of(Point const& p) const { return p.slider < 0 ? Index(B::point_columns) : speeds(); }

  void reference(std::span<double> q) const {
    B::reference(q.first(std::size_t(B::coordinates())));
    std::copy(places_.begin(), places_.end(), q.end() - sliders());
  }
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    B::rigid_velocity(q, v0, omega, v);
    std::fill(v.end() - sliders(), v.end(), 0.0);
  }

  /// \throws OffTheEnd for a slider more than an element beyond an end.
  template <StateScalar T>
  void publish(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v, Published<T>& out) const {
    if (p.slider < 0) return B::template publish<T>(p.material, axes, q, v, out);
    slide(p.slider, q, v, out);
    out.frame.A = axes.template cast<T>();
    out.shape = JacobianShape::dense;
    out.columns = speeds();
  }

  /// Into the first rows and columns of k. Of a slider Jᵀw = [s_i f; r′·f]: ∂/∂s of the first is the transpose of
  /// ∂/∂e_i of the second, s_i′ f, and ∂(r′·f)/∂s = r″·f.
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
    Index first;  ///< column of the element
    decltype(std::declval<B const&>().axis_shape(0.0)) shape;
  };
  Place place(double s) const {
    double const l = B::element_length();
    if (!(s >= -l && s <= B::length() + l) && std::isfinite(s))
      throw OffTheEnd{"Sliding: a point has gone off the end of its body, to s = ", s, " on a length of ", B::length(),
                      ". End the run there by the event reaches_an_end, or hold the point."};
    Index const last = B::elements() - 1, e = std::isfinite(s) ? std::clamp(Index(s / l), Index(0), last) : 0;
    return {B::first_column(e), B::axis_shape(s / l - double(e))};
  }

  /// Shapes at the value of s; what a dual s has beyond it moves them along their derivatives.
  template <StateScalar T>
  void slide(Index column, std::span<T const> q, std::span<T const> v, Published<T>& out) const {
    std::fill_n(out.jacobian, 6 * speeds(), T(0.0));
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

  std::vector<double> places_;  ///< at the start [m]
};

}  // namespace polybody
