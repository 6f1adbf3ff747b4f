#pragma once
/// \file
/// Contact of a track link with a road wheel, idler or roller.
/// Theory: Eqs. 8.32 to 8.35.

#include <vector>

#include <polybody/forces/contact.hpp>
#include <polybody/vehicle/link_axes.hpp>

namespace polybody {

/// Contact of the rims of a roller with the inner face of a link [after Choi, Lee & Shabana 1998: inner-surface contact
/// with one or both rims]. Marker a is the link's centre, with x to the front pin and z to the roller. Marker b is the
/// roller's centre, with its axle along y. A rim is a circle of radius R in its middle plane.
///
/// The point of a rim nearest to the link, with the coordinate s along x, touches the face z = h if |s| ≤ p/2. The
/// penetration is d = R − (height of the axle above the face). The face of a link ends at the edges |s| = p/2. The
/// faces of the next links begin there. Within the distance ε = `handover` of an edge, each of the two links carries
/// the fraction x² (3 − 2x) of the force, with x = (p/2 + ε − |s|)/2ε. So the force is continuous if a wheel passes
/// from one link to the next. If the track bends towards the wheel, the regions above neighbouring faces overlap.
///
/// A rim beyond the face may touch the edge of the face, for example on a bump. The penetration of the edge is d = R −
/// c − (distance of the edge from the axle), with the chamfer c of the edge along the radius. This penetration is
/// limited to the distance of the rim beyond the face, so that the force begins at zero.
template <MarkerKind observed = MarkerKind::frame>
struct LinkRollerContact {
  static constexpr MarkerKind needs = observed;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;

  Required<double> pitch;            ///< p, pitch of the link [m]
  Required<double> half_thickness;   ///< h, distance from the line between the pins to the face [m]
  Required<double> half_width;       ///< half width of the face [m]
  Required<double> radius;           ///< R, radius of the rims [m]
  double handover = 0.03;            ///< ε, half length of the transition between two links [m]
  double chamfer = 0.005;            ///< c, chamfer of the edges [m]; should exceed the penetrations of the rims
  std::vector<double> rims = {0.0};  ///< positions of the rims' middle planes along the axle [m]

  void check(std::string const& name) const {
    require_positive(pitch, name, ": the pitch of the link", "m");
    require_not_negative(half_thickness, name, ": the link's half thickness", "m");
    require_positive(half_width, name, ": the link's half width", "m");
    require_positive(radius, name, ": the radius of the roller", "m");
    require_not_negative(chamfer, name, ": the chamfer of the link's edges", "m");
    if (!(chamfer < radius))
      throw InvalidInput("track_contact.chamfer",
                         {ErrorObject{name}, ": the chamfer must be smaller than the radius of the roller, ",
                          double(radius), " m, but is ", ErrorValue{chamfer}, " m."});
    if (!(handover > 0.0 && handover < 0.5 * pitch))
      throw InvalidInput("track_contact.handover",
                         {ErrorObject{name}, ": the handover distance must be positive and below half the pitch, ",
                          0.5 * pitch, " m, but is ", ErrorValue{handover}, " m."});
    if (rims.empty())
      throw InvalidInput("track_contact.rims", {ErrorObject{name}, ": a roller needs at least one rim. Set `rims`."});
    for (double const y : rims) require_finite(y, name, ": the position of a rim", "m");
  }
  bool may_touch(Frame<double> const& link, Frame<double> const& roller) const {
    double const far = farthest_rim(), within = farthest(far);
    Vec3 const arm = difference<double>(roller.r, link.r), x = detail::column<double>(link.A, 0);
    if (arm.squaredNorm() > within * within) return false;
    Vec3 const axle = detail::column<double>(roller.A, 1);
    double const askew = std::abs(axle.dot(x));
    double const margin = std::max(handover, double(radius)) + askew * far;
    return std::abs(arm.dot(x)) < 0.5 * pitch + margin && reaches(link, arm, axle, far);
  }
  ContactReach reach(Frame<double> const& roller) const {
    return ContactReach::sphere(roller.r, farthest(farthest_rim()));
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& link, Frame<T> const& roller, Visit&& visit) const {
    Vec<T, 3> const axle = detail::column<T>(roller.A, 1);
    Mat<T, 3, 3> const axes = link_axes<observed, T>(link, axle);
    for (double const rim : rims) {
      Vec<T, 3> const middle = detail::shifted<T>(roller.r, axle, T(rim)), arm = difference<T>(middle, link.r);
      Vec<T, 3> const local = axes.transpose() * arm;
      T const height = local[2] - double(half_thickness), depth = T(radius.value) - height;
      if (std::abs(value_of(local[1])) > half_width) continue;
      double const side = value_of(local[0]) < 0.0 ? -1.0 : 1.0;
      T const beyond = local[0] * side - 0.5 * pitch, to_end = T(handover) - beyond;
      if (value_of(beyond) > 0.0 && value_of(beyond) < radius)
        meet_edge<T>(link, axes, {local[1], side, beyond, height}, visit);
      if (value_of(to_end) <= 0.0 || value_of(height) <= 0.0 || value_of(depth) <= 0.0) continue;
      Vec<T, 3> const on_face(local[0], local[1], T(half_thickness.value));
      ContactPoint<T> point{detail::point_in<T>(link.r, axes, on_face), {-axes(0, 2), -axes(1, 2), -axes(2, 2)}, depth};
      if (value_of(to_end) < 2.0 * handover) {
        T const x = to_end * (0.5 / handover), slope = x * (T(1.0) - x) * (3.0 * side / handover);
        point.handover = {x * x * (x * -2.0 + 3.0), detail::scaled<T>(detail::column<T>(axes, 0), slope), middle};
      }
      visit(point);
    }
  }

 private:
  double farthest_rim() const {
    double far = 0.0;
    for (double const y : rims) far = std::max(far, std::abs(y));
    return far;
  }
  /// Upper bound of the distance between the centres of the roller and of a link in contact [m]. \param far upper bound
  /// of the distance of a rim from the roller's centre [m]
  double farthest(double far) const { return radius + half_thickness + half_width + pitch + far; }
  /// Returns true if the rims can reach the face: for at least one point of the axle within ±`far` of its middle, the
  /// height above the face must be less than the radius of the rims. `arm` is the vector from the link to the middle of
  /// the `axle`. The z axis of a cable is along x × axle (`link_axes`).
  bool reaches(Frame<double> const& link, Vec3 const& arm, Vec3 const& axle, double far) const {
    double const height = (radius + half_thickness) * (1.0 + 1e-9);
    if constexpr (observed == MarkerKind::frame) {
      Vec3 const z = detail::column<double>(link.A, 2);
      return arm.dot(z) < height + far * std::abs(axle.dot(z));
    } else {
      Vec3 const z = cross<double>(detail::column<double>(link.A, 0), axle);
      double const above = arm.dot(z);
      return above < 0.0 || above * above < height * height * z.squaredNorm();
    }
  }
  /// Position of the axle relative to an edge of the face.
  template <StateScalar T>
  struct OverEdge {
    T across;          ///< position along the edge, from the middle of the link [m]
    double side;       ///< factor 1 at the front edge (x > 0), −1 at the rear edge
    T beyond, height;  ///< distance outwards from the edge, and height above the face [m]
  };
  template <StateScalar T, class Visit>
  void meet_edge(Frame<T> const& link, Mat<T, 3, 3> const& axes, OverEdge<T> const& axle, Visit& visit) const {
    using std::sqrt;
    T const distance = sqrt(axle.beyond * axle.beyond + axle.height * axle.height),
            overlap = T(radius - chamfer) - distance;
    T const depth = value_of(overlap) < value_of(axle.beyond) ? overlap : axle.beyond;
    if (!(value_of(depth) > 0.0)) return;
    Vec<T, 3> const edge(T(0.5 * pitch * axle.side), axle.across, T(half_thickness.value));
    T const forward = axle.beyond * -axle.side;
    Vec<T, 3> normal;
    for (int i = 0; i < 3; ++i) normal[i] = (axes(i, 0) * forward - axes(i, 2) * axle.height) / distance;
    visit(ContactPoint<T>{detail::point_in<T>(link.r, axes, edge), normal, depth});
  }
};

/// Lateral guide of a track. A horn on the inner face of a link runs between the rims of a wheel and touches their
/// inner faces. The markers are those of `LinkRollerContact`. The force is parallel to the axle. The penetration is the
/// distance of the tip from the middle plane of the wheel minus `play`. The penetration is limited to the radial
/// distance of the tip inside the circle of the rims. So the force also grows from zero if a horn moves radially onto a
/// rim. This limit represents edges with a chamfer of 45°.
template <MarkerKind observed = MarkerKind::frame>
struct GuideHornContact {
  static constexpr MarkerKind needs = observed;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;

  Vec3 tip = Vec3::Zero();  ///< (3) middle of the horn's upper end, in the link's axes [m]
  Required<double> play;    ///< free lateral distance on either side between horn and rim [m]
  Required<double> radius;  ///< radius of the rims [m]

  void check(std::string const& name) const {
    require_finite(tip, name, ": the tip of the horn", "m");
    require_not_negative(play, name, ": the play of the horn", "m");
    require_positive(radius, name, ": the radius of the rims", "m");
  }
  bool may_touch(Frame<double> const& link, Frame<double> const& roller) const {
    Vec3 const arm = difference<double>(roller.r, link.r), axle = detail::column<double>(roller.A, 1);
    double const across = arm.dot(axle), reach = radius + tip.norm();
    if (!(arm.squaredNorm() - across * across < reach * reach)) return false;
    double aside = tip[0] * axle.dot(detail::column<double>(link.A, 0)) - across;  // offset of the tip along the axle
    double room = play * (1.0 - 1e-9);
    if constexpr (observed == MarkerKind::frame)
      for (int i = 1; i < 3; ++i) aside += tip[i] * axle.dot(detail::column<double>(link.A, i));
    else
      room -= std::abs(tip[1]);  // z of a cable is perpendicular to the axle
    return std::abs(aside) > room;
  }
  ContactReach reach(Frame<double> const& roller) const {
    return ContactReach::cylinder(roller.r, detail::column<double>(roller.A, 1), radius + tip.norm());
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& link, Frame<T> const& roller, Visit&& visit) const {
    using std::sqrt;
    Vec<T, 3> const axle = detail::column<T>(roller.A, 1);
    Vec<T, 3> const place =
        detail::point_in<T>(link.r, link_axes<observed, T>(link, axle), {T(tip[0]), T(tip[1]), T(tip[2])});
    Vec<T, 3> const arm = difference<T>(place, roller.r);
    T const across = arm.dot(axle), beyond = (value_of(across) < 0.0 ? -across : across) - double(play);
    T const within = T(radius.value) - sqrt(detail::shifted<T>(arm, axle, -across).squaredNorm());
    T const depth = value_of(beyond) < value_of(within) ? beyond : within;
    if (value_of(depth) > 0.0)
      visit(ContactPoint<T>{place, value_of(across) < 0.0 ? axle : detail::scaled<T>(axle, T(-1.0)), depth});
  }
};

static_assert(ContactGeometry<LinkRollerContact<>> && ContactGeometry<LinkRollerContact<MarkerKind::axis>> &&
              ContactGeometry<GuideHornContact<>>);

}  // namespace polybody
