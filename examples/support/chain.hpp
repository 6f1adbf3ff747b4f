#pragma once
/// \file Pendulums: links hinged in a row, at rest in one line, under gravity along −y, in the plane or in space.

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>

namespace polybody {

/// One link. Zero inertia and `com` at its end give a point mass on a massless bar.
struct Link {
  double length = 1.0;
  double mass = 1.0;
  double inertia = 0.0;  ///< about the centre of mass, transverse to the link
  double com = 0.5;      ///< distance of the centre of mass from the first end
};

/// A uniform thin bar.
inline Link bar_link(double length = 1.0, double mass = 1.0) {
  return {length, mass, mass * length * length / 12.0, 0.5 * length};
}
/// A point mass at the end of a massless bar.
inline Link point_link(double length = 1.0, double mass = 1.0) { return {length, mass, 0.0, length}; }

template <class Policy>
struct InPlane {
  using Body = planar::Rigid;
  using PolicyType = Policy;
  using Hinge = Joint<planar::Revolute, Policy>;
  static Body body(Link const& l, Placement const& place) { return {l.mass, l.inertia, place}; }
  static Hinge hinge(Policy const& policy) { return {{}, policy}; }
  static Marker<Body> at(BodyHandle<Body> const& link, double x) { return link.at(Vec2(x, 0.0)); }
};

/// The chain in space with pins along z. If constraint equations guide the links, the links have no inertia about
/// their own axis.
template <class Policy>
struct InSpace {
  using Body = Rigid<>;
  using PolicyType = Policy;
  using Hinge = Joint<Revolute, Policy>;
  static Body body(Link const& l, Placement const& place) {
    double const own = std::is_same_v<Policy, Constraint> ? 0.0 : l.inertia;
    return {l.mass, Vec3(own, l.inertia, l.inertia).asDiagonal().toDenseMatrix(), place};
  }
  static Hinge hinge(Policy const& policy) { return {Revolute{.axis = Vec3::UnitZ()}, policy}; }
  static Marker<Body> at(BodyHandle<Body> const& link, double x) { return link.at(Vec3(x, 0.0, 0.0)); }
};

/// Chain on ball joints; every link has the same inertia about every axis.
template <class Policy>
struct OnBallJoints {
  using Body = Rigid<>;
  using PolicyType = Policy;
  using Hinge = Joint<Spherical, Policy>;
  static Body body(Link const& l, Placement const& place) { return {l.mass, Mat3::Identity() * l.inertia, place}; }
  static Hinge hinge(Policy const& policy) { return {{}, policy}; }
  static Marker<Body> at(BodyHandle<Body> const& link, double x) { return link.at(Vec3(x, 0.0, 0.0)); }
};

/// n equal links from the origin; the model of most rigid cases. Body axes: x along the link.
template <class World>
struct Chain {
  using Body = typename World::Body;
  using Hinge = typename World::Hinge;
  using ModelType = Model<Bodies<Body>, Joints<Hinge>>;

  Link link;
  ModelType model;
  std::vector<BodyHandle<Body>> links;
  std::vector<ElementHandle<Hinge>> hinges;

  /// \param angle of the line from the downward vertical [rad]
  Chain(int n, Link const& each, double g = 9.81, double angle = 0.5 * std::numbers::pi,
        typename World::PolicyType const& policy = {})
      : link(each), model(Gravity{0, -g, 0}) {
    Vec3 const along(std::sin(angle), -std::cos(angle), 0.0);
    for (int i = 0; i < n; ++i) {
      Vec3 const com = (double(i) * link.length + link.com) * along;
      links.push_back(model.add(World::body(link, Placement::planar(com[0], com[1], angle - 0.5 * std::numbers::pi)),
                                "link " + std::to_string(i + 1)));
      std::string const pin = "pin " + std::to_string(i + 1);
      auto const here = World::at(links.back(), -link.com);
      if (i == 0)
        hinges.push_back(model.connect(World::hinge(policy), model.ground().at(Vec3(0, 0, 0)), here, pin));
      else
        hinges.push_back(model.connect(World::hinge(policy), end(i - 1), here, pin));
    }
  }

  Marker<Body> end(int i) const { return World::at(links[std::size_t(i)], link.length - link.com); }

  /// Angle of link i from the downward vertical, in (−π, π].
  double angle(State const& x, int i = 0) const {
    Vec3 const axis = frame(model, x, end(i)).A.col(0);
    return std::atan2(axis[0], -axis[1]);
  }
  Vec3 tip(State const& x) const { return position(model, x, end(int(links.size()) - 1)); }
};

}  // namespace polybody
