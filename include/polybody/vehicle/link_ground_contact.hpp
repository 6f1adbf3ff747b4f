#pragma once
/// \file
/// Contact of a track link with the ground.
/// Theory: Eq. 8.31.

#include <vector>

#include <polybody/forces/contact.hpp>
#include <polybody/vehicle/link_axes.hpp>
#include <polybody/vehicle/terrain.hpp>

namespace polybody {

/// Contact of points of a link's pad with a terrain. Marker a is the link's centre. Marker b is the ground; the
/// terrain's height h is a function of x and y in the axes of marker b. The normal is n = (−h_x, −h_y, 1)/√(1 + h_x² +
/// h_y²). A point (x, y, z) at the depth e = h(x, y) − z below the ground has the penetration d = e n_z.
template <Terrain G = FlatGround, MarkerKind observed = MarkerKind::frame>
struct LinkGroundContact {
  static constexpr MarkerKind needs = observed;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;

  G terrain = {};  ///< height as a function of x and y of marker b
  /// Points of the pad, n × (3), in the link's axes [m]. A cable has no roll: y is ignored and z points away from the
  /// ground.
  std::vector<Vec3> pad = {};

  void check(std::string const& name) const {
    terrain.check(name);
    if (pad.empty())
      throw InvalidInput("track_contact.points",
                         {ErrorObject{name}, ": the pad of a link needs at least one point. Set `pad`."});
    for (Vec3 const& p : pad) require_finite(p, name, ": a point of the pad", "m");
  }
  bool may_touch(Frame<double> const& link, Frame<double> const& ground) const {
    Vec3 const up = detail::column<double>(ground.A, 2);
    return difference<double>(link.r, ground.r).dot(up) < terrain.highest() + farthest();
  }
  ContactReach reach(Frame<double> const& ground) const {
    return ContactReach::half_space(ground.r, detail::column<double>(ground.A, 2), terrain.highest() + farthest());
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& link, Frame<T> const& ground, Visit&& visit) const {
    using std::sqrt;
    Vec<T, 3> const up = detail::column<T>(ground.A, 2);
    Mat<T, 3, 3> axes = link.A;
    if constexpr (observed != MarkerKind::frame) {  // z is normal to the tangent, close to the ground's z
      Vec<T, 3> const z = detail::across<T>(up, detail::column<T>(axes, 0));
      T const length = sqrt(z.squaredNorm());
      for (int i = 0; i < 3; ++i) {
        axes(i, 1) = T(0.0);
        axes(i, 2) = z[i] / length;
      }
    }
    for (Vec3 const& p : pad) {
      Vec<T, 3> const place = detail::point_in<T>(link.r, axes, {T(p[0]), T(p[1]), T(p[2])});
      Vec<T, 3> const arm = difference<T>(place, ground.r), local = ground.A.transpose() * arm;
      Height<T> const h = terrain.template height<T>(local[0], local[1]);
      if (!(value_of(h.z) > value_of(local[2]))) continue;  // no contact above the ground, nor for an upright cable
      T const nz = T(1.0) / sqrt(h.slope_x * h.slope_x + h.slope_y * h.slope_y + 1.0);
      Vec<T, 3> n;
      for (int i = 0; i < 3; ++i) n[i] = (up[i] - ground.A(i, 0) * h.slope_x - ground.A(i, 1) * h.slope_y) * nz;
      visit(ContactPoint<T>{place, n, (h.z - local[2]) * nz});
    }
  }

 private:
  double farthest() const {
    double far = 0.0;
    for (Vec3 const& p : pad) far = std::max(far, p.norm());
    return far;
  }
};

}  // namespace polybody
