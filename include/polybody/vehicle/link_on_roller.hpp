#pragma once
/// \file
/// A track's link on a road wheel, idler or roller. Not in polybody.hpp: of use to vehicles only.

#include <vector>

#include <polybody/forces/contact.hpp>
#include <polybody/vehicle/link_axes.hpp>

namespace polybody {

/// The rims of a roller on the inner face of a link. Marker a is the link's centre (x to the front pin, z to the
/// roller), marker b the roller's centre with its axle along y. A rim is a circle of radius R in its middle plane. It
/// meets the face z = h where its lowest point is above the link, |s| ≤ p/2, with depth d = R − (height of the axle
/// above the face). Each face ends where the next one begins. Within `handover` of that place both carry the share
/// x² (3 − 2x) of the force, x = (p/2 + ε − |s|)/2ε, so that a wheel passes from one to the next without a bump. In a
/// bend towards the wheel the strips above the faces overlap. Beyond a face its edge may meet the rim, as over a bump:
/// the depth of this point is d = R − c − (its distance from the axle), c the chamfer of the edge along the radius, but
/// at most its distance beyond the face, so that the force begins at zero. [after Choi, Lee & Shabana 1998:
/// inner-surface contact with one or both rims]
template <Observes observed = Observes::frame>
struct LinkOnRoller {
  static constexpr Observes needs = observed;
  static constexpr Observes needs_of_second = Observes::frame;

  Required<double> pitch;            ///< p, of the link [m]
  Required<double> half_thickness;   ///< h, from the pins' line to the face [m]
  Required<double> half_width;       ///< of the face [m]
  Required<double> radius;           ///< R, of the rims [m]
  double handover = 0.03;            ///< ε [m]
  double chamfer = 0.005;            ///< c [m]
  std::vector<double> rims = {0.0};  ///< where their middle planes are along the axle [m]

  void check(std::string const& name) const {
    require_positive(pitch, name, ": the pitch of the link");
    require_not_negative(half_thickness, name, ": the link's half thickness");
    require_positive(half_width, name, ": the link's half width");
    require_positive(radius, name, ": the radius of the roller");
    require_not_negative(chamfer, name, ": the chamfer of the link's edges");
    if (!(handover > 0.0 && handover < 0.5 * pitch))
      throw InvalidInput{name, ": the zone of the handover must be positive and below half the pitch, but is ",
                         handover, " m."};
    if (rims.empty()) throw InvalidInput{name, ": a roller needs at least one rim."};
    for (double const y : rims)
      if (!std::isfinite(y)) throw InvalidInput{name, ": the place of a rim must be finite."};
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
  /// The roller's middle from that of a link that it touches, at most. \param far that of a rim from the roller's
  /// middle
  double farthest(double far) const { return radius + half_thickness + half_width + pitch + far; }
  /// The axle, at `arm` from the link, is not higher above the face than the rims reach; nor is one of these, `far`
  /// along it. A cable's z lies along x × axle (`link_axes`).
  bool reaches(Frame<double> const& link, Vec3 const& arm, Vec3 const& axle, double far) const {
    double const height = (radius + half_thickness) * (1.0 + 1e-9);
    if constexpr (observed == Observes::frame) {
      Vec3 const z = detail::column<double>(link.A, 2);
      return arm.dot(z) < height + far * std::abs(axle.dot(z));
    } else {
      Vec3 const z = cross<double>(detail::column<double>(link.A, 0), axle);
      double const above = arm.dot(z);
      return above < 0.0 || above * above < height * height * z.squaredNorm();
    }
  }
  /// Where the axle stands over an edge of the face.
  template <StateScalar T>
  struct OverEdge {
    T across;          ///< along the edge, from the middle of the link [m]
    double side;       ///< sign of x, a factor: 1 at the front edge, −1 at the rear edge
    T beyond, height;  ///< outwards from the edge, and above the face [m]
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

/// Lateral guide of a track: a horn on the inner face of a link runs between the rims of a wheel and meets their inner
/// faces. Markers as for `LinkOnRoller`. The force is along the axle; its depth is the distance beyond the play, but at
/// most the distance of the tip within the rims. So the force grows from zero also where a horn enters beside its gap:
/// edges are chamfered by 45°.
template <Observes observed = Observes::frame>
struct HornOnRims {
  static constexpr Observes needs = observed;
  static constexpr Observes needs_of_second = Observes::frame;

  Vec3 tip = Vec3::Zero();  ///< (3) middle of the horn's upper end, in the link's axes [m]
  Required<double> play;    ///< to either side before it meets a rim [m]
  Required<double> radius;  ///< of the rims [m]

  void check(std::string const& name) const {
    require_finite(tip, name, ": the tip of the horn");
    require_not_negative(play, name, ": the play of the horn");
    require_positive(radius, name, ": the radius of the rims");
  }
  bool may_touch(Frame<double> const& link, Frame<double> const& roller) const {
    Vec3 const arm = difference<double>(roller.r, link.r), axle = detail::column<double>(roller.A, 1);
    double const across = arm.dot(axle), reach = radius + tip.norm();
    if (!(arm.squaredNorm() - across * across < reach * reach)) return false;
    double aside = tip[0] * axle.dot(detail::column<double>(link.A, 0)) - across;  // of the tip, along the axle
    double room = play * (1.0 - 1e-9);
    if constexpr (observed == Observes::frame)
      for (int i = 1; i < 3; ++i) aside += tip[i] * axle.dot(detail::column<double>(link.A, i));
    else
      room -= std::abs(tip[1]);  // a cable's z is across the axle
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

static_assert(ContactGeometry<LinkOnRoller<>> && ContactGeometry<LinkOnRoller<Observes::axis>> &&
              ContactGeometry<HornOnRims<>>);

}  // namespace polybody
