#pragma once
/// \file
/// Constants of a body in a tree, in the axes of the joint that carries it and about the point of this joint.

#include <polybody/solvers/articulated_inertia.hpp>
#include <polybody/system/tree_body.hpp>

namespace polybody {

/// Constants of a body. A root has six degrees of freedom relative to the ground, or three in the plane; its reference
/// point is its centre of mass.
struct TreeLink {
  Index parent, qn, vn, v0;          ///< see `TreeBody`
  RigidLayout layout;                ///< layout of the body's coordinates
  bool backwards;                    ///< true if frame b of the joint belongs to the parent
  bool turned;                       ///< true if the axes of this joint and of the parent's joint differ
  int degrees_of_freedom;            ///< number of velocities of the joint, or of the body if it is a root
  JointMotions motions;              ///< motions of the joint, from frame a to frame b
  double entry[9], arm[3];           ///< axes and origin [m] of the joint's frame, in the axes of the parent's joint
  double mass, first[3], second[6];  ///< [kg], [kg m], [kg m²]; moments about the reference point
  double centre[3];                  ///< centre of mass, from the reference point [m]
  double full_axes[9];               ///< axes of the body's velocities (3×3 by columns)
};

/// Computes the constants of `body`. \param parent null for the ground
template <class T = double>  // a template, to be compiled only if it is used
[[gnu::cold]] TreeLink tree_link(TreeBody const& body, TreeBody const* parent) {
  using M3 = Mat<T, 3, 3>;
  TreeLink link;
  link.parent = body.parent;
  link.qn = body.qn;
  link.vn = body.vn;
  link.v0 = body.v0;
  link.layout = body.layout;
  link.backwards = body.backwards;
  link.motions = body.motions;
  Placement from, to;
  if (body.carried()) {
    from = body.from;
    to = body.to;
  } else {
    bool const plane = body.layout == RigidLayout::plane;
    for (int k = 0; k < (plane ? 2 : 3); ++k) link.motions.add({JointMotion::Kind::slide, k});
    link.motions.add(plane ? JointMotion{JointMotion::Kind::turn, 2} : JointMotion{JointMotion::Kind::ball, 0});
  }
  if (parent) {
    Placement const before = parent->carried() ? parent->to : Placement{};
    from.origin = before.axes.transpose() * Vec3(from.origin - before.origin);
    from.axes = M3(before.axes.transpose() * from.axes);
  }
  link.turned = !from.axes.isIdentity(0.0);
  link.degrees_of_freedom = link.motions.velocities();
  Vec3 const c = to.axes.transpose() * Vec3(-to.origin);
  M3 inertia = to.axes.transpose() * body.inertia;  // about the reference point
  inertia = M3(inertia * to.axes);
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) inertia(k, l) += body.mass * ((k == l ? c.squaredNorm() : 0.0) - c[k] * c[l]);
  link.mass = body.mass;
  for (int k = 0; k < 3; ++k) {
    link.arm[k] = from.origin[k];
    link.centre[k] = c[k];
    link.first[k] = body.mass * c[k];
    for (int l = 0; l < 3; ++l) {
      link.entry[3 * l + k] = from.axes(k, l);
      link.full_axes[3 * l + k] = to.axes(l, k);
      link.second[detail::symmetric_place[k][l]] = inertia(k, l);
    }
  }
  return link;
}

}  // namespace polybody
