#pragma once
/// \file
/// Contact geometry of a body that consists of several shapes.
/// Theory: Eq. 9.55.

#include <tuple>

#include <polybody/forces/contact.hpp>

namespace polybody {

/// Contact geometry whose shapes have their own positions and axes on the two bodies.
template <ContactGeometry G>
struct Placed {
  G geometry;              ///< geometry of the contact
  Placement place = {};    ///< position and axes of the shape of a, in the axes of marker a
  Placement partner = {};  ///< position and axes of the shape of b, in the axes of marker b
};
/// Type of the geometry from a constructor call.
template <class G>
Placed(G) -> Placed<G>;
/// Type of the geometry from a constructor call.
template <class G>
Placed(G, Placement) -> Placed<G>;
/// Type of the geometry from a constructor call.
template <class G>
Placed(G, Placement, Placement) -> Placed<G>;

/// Several shapes of body a against shapes of body b, for example two boxes and a capsule on a plane:
///   Compound const sledge(Placed{runner, Placement::at({0, 0.3, 0})}, Placed{runner, Placement::at({0, -0.3, 0})},
///                         Placed{bar, Placement::at({0.2, 0, 0.1})});
///   using Floor = Contact<Compound<BoxOnPlane, BoxOnPlane, CapsuleOnPlane>>;
/// The contact points are the points of all shapes.
template <ContactGeometry... Gs>
class Compound {
 public:
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr int most_points = (polybody::most_points<Gs>() + ... + 0);  ///< largest number of contact points

  explicit Compound(Placed<Gs>... shapes) : shapes_(std::move(shapes)...) {}  ///< geometry of these shapes

  void check(std::string const& name) const {
    each([&](auto const& shape) {
      shape.geometry.check(name);
      shape.place.check(name);
      shape.partner.check(name);
    });
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    bool may = false;
    each([&](auto const& shape) {
      may = may || shape.geometry.may_touch(frame_of<double>(a, shape.place), frame_of<double>(b, shape.partner));
    });
    return may;
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    int first = 0;
    each([&]<class G>(Placed<G> const& shape) {
      auto const renumbered = [&](ContactPoint<T> point) {
        point.slot += first;
        visit(point);
      };
      shape.geometry.template for_each_point<T>(frame_of<T>(a, shape.place), frame_of<T>(b, shape.partner), renumbered);
      first += polybody::most_points<G>();
    });
  }

 private:
  template <class F>
  void each(F&& f) const {
    std::apply([&](auto const&... shape) { (f(shape), ...); }, shapes_);
  }
  /// Position and axes of a shape in the world.
  template <StateScalar T>
  static Frame<T> frame_of(Frame<T> const& a, Placement const& place) {
    Frame<T> f;
    for (int i = 0; i < 3; ++i) {
      f.r[i] = a.r[i];
      for (int k = 0; k < 3; ++k) {
        f.r[i] += a.A(i, k) * place.origin[k];
        f.A(i, k) = a.A(i, 0) * place.axes(0, k) + a.A(i, 1) * place.axes(1, k) + a.A(i, 2) * place.axes(2, k);
      }
    }
    return f;
  }

  std::tuple<Placed<Gs>...> shapes_;
};

}  // namespace polybody
