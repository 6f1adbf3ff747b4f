#pragma once
/// \file
/// Recursion over a tree of rigid bodies from the roots to the tips. It computes positions, angular velocities, and the
/// motion of each body due to the degrees of freedom of its joint. The reference point of a body is the point of the
/// joint that carries it; d is the vector from the parent's reference point to that of the body. All vectors are in
/// world axes. With reference points at the joints, the distance of the bodies from the world's origin does not affect
/// round-off.

#include <cmath>

#include <polybody/elimination/articulated_inertia.hpp>
#include <polybody/elimination/tree_body.hpp>
#include <polybody/math/quaternion.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

// Constants of a body in a tree, in the axes of the joint that carries it and about the point of this joint.

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
  double full_axes[9];               ///< axes of the body in those of the joint's frame (3×3 by columns)
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

/// Kinematics of a tree of rigid bodies. T is the scalar type of the state; dual numbers give derivatives.
template <StateScalar T = double>
struct TreeRecursionOf {
  /** Motion of a degree of freedom: rotation, translation, or both. */ enum class Kind : unsigned char {
    turn,
    slide,
    general
  };
  /// One degree of freedom: its column S of [v; ω]; and I S, D⁻¹ and a force, which the calling algorithm computes.
  struct Direction {
    T s[6], u[6], inverse, w;  ///< S, I S, D⁻¹, the force along S
    Kind kind;                 ///< kind of motion; for `turn` and `slide`, one half of S is zero
    /// Number of degrees of freedom that are eliminated together, counted at the first of them: 3 at the first of a
    /// ball joint, 0 at its other two, 1 at all other joints.
    unsigned char together;
    Index velocity;  ///< index in the reduced velocities
  };
  /// State of a body: joint axes (3×3 by columns), d, ω, and the acceleration c = [a; α] for u̇ = 0 and a parent
  /// without acceleration. The force p and the acceleration x are computed by the calling algorithm.
  struct Body {
    T axes[9], d[3], w[3], c[6], p[6], x[6];  ///< joint axes, d, ω, c, p, x, in world axes
    detail::ArticulatedInertia<T> inertia;    ///< articulated inertia about the reference point
    std::size_t first;                        ///< index of its first degree of freedom in `directions`
    int count;                                ///< number of its degrees of freedom
  };

  Sequence<TreeLink> links;        ///< constants, one for each body
  Sequence<Body> bodies;           ///< states of the bodies, parents before children
  Sequence<Direction> directions;  ///< degrees of freedom of all bodies, body by body
  Body ground = {};                ///< at rest; carrier of the roots

  TreeRecursionOf() = default;
  /// Computes the constants of the bodies and allocates all memory.
  explicit TreeRecursionOf(Sequence<TreeBody> const& tree);
  /// Carrier of body i: its parent, or the ground.
  Body& carrier(std::size_t i) { return links[i].parent < 0 ? ground : bodies[std::size_t(links[i].parent)]; }
  /// Computes the kinematics and the inertia of all bodies and sets p to zero; x is unchanged.
  void place(VecXOf<T> const& q, VecXOf<T> const& v) {
    for (std::size_t i = 0; i < links.size(); ++i) {
      place(links[i], carrier(i), q.data() + links[i].qn, v.data() + links[i].vn, bodies[i]);
      set_inertia(links[i], bodies[i]);
    }
  }
  /// Adds to p of each body the centrifugal force ω × (ω × h) and the gyroscopic moment ω × Θ ω, with the first and
  /// second moments of mass h and Θ.
  void add_velocity_forces() {
    for (Body& b : bodies) {
      T spin[6] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
      b.inertia.add_by_angular(b.w, spin);
      detail::add_cross(b.w, spin + 3, b.p + 3);
      add_centrifugal(b);
    }
  }
  /// p += ω × (ω × h), with the first moment of mass h.
  static void add_centrifugal(Body& b) {
    T const* const h = b.inertia.first;
    T const mc[3] = {h[5], h[6], h[1]};
    T rate[3] = {T(0.0), T(0.0), T(0.0)};
    detail::add_cross(b.w, mc, rate);
    detail::add_cross(b.w, rate, b.p);
  }
  /** Sᵀx, x (6). */ static T along(Direction const& f, T const* x) {
    switch (f.kind) {
      case Kind::turn:
        return detail::dot(f.s + 3, x + 3, 3);
      case Kind::slide:
        return detail::dot(f.s, x, 3);
      default:
        return detail::dot(f.s, x, 6);
    }
  }

 private:
  void place(TreeLink const& link, Body const& parent, T const* q, T const* u, Body& b);
  void move(JointMotion const& m, double sign, T const* x, T const* u, Body& b);
  /// Moves the reference point by the vector `by`, which is fixed in the current frame of the joint.
  void go(T const* by, Body& b);
  Direction& add_direction(Kind kind, Body& b) {
    Direction& f = directions[b.first + std::size_t(b.count++)];
    f.kind = kind;
    f.together = 1;
    for (T& x : f.s) x = T(0.0);
    return f;
  }
  static void turn(int axis, T const& angle, T* axes);
  static void set_inertia(TreeLink const& link, Body& b);
};

template <StateScalar T>
TreeRecursionOf<T>::TreeRecursionOf(Sequence<TreeBody> const& tree) : bodies(tree.size()) {
  for (int i = 0; i < 3; ++i) ground.axes[4 * i] = T(1.0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    bool const has_parent = tree[i].parent >= 0;
    links.push_back(tree_link(tree[i], has_parent ? &tree[std::size_t(tree[i].parent)] : nullptr));
    bodies[i].first = count;
    count += std::size_t(links.back().degrees_of_freedom);
  }
  directions.resize(count);
}

template <StateScalar T>
void TreeRecursionOf<T>::place(TreeLink const& link, Body const& parent, T const* q, T const* u, Body& b) {
  if (link.turned)
    detail::set_product(parent.axes, link.entry, 3, b.axes);
  else
    for (int i = 0; i < 9; ++i) b.axes[i] = parent.axes[i];
  for (int i = 0; i < 3; ++i) b.w[i] = parent.w[i];
  for (int i = 0; i < 3; ++i) b.d[i] = b.c[i] = b.c[3 + i] = T(0.0);
  b.count = 0;
  T arm[3];
  detail::set_product(parent.axes, link.arm, 1, arm);
  go(arm, b);
  Index velocity = link.vn;
  if (link.backwards) {
    q += link.motions.coordinates();
    int k = link.degrees_of_freedom;
    for (int i = link.motions.count; i-- > 0;) {
      JointMotion const& m = link.motions.list[std::size_t(i)];
      k -= m.velocities();
      int const before = b.count;
      move(m, -1.0, q -= m.coordinates(), u + k, b);
      for (int j = before; j < b.count; ++j)
        directions[b.first + std::size_t(j)].velocity = velocity + k + (j - before);
    }
    return;
  }
  for (JointMotion const& m : link.motions) {
    move(m, 1.0, q, u, b);
    q += m.coordinates();
    u += m.velocities();
  }
  for (int j = 0; j < b.count; ++j) directions[b.first + std::size_t(j)].velocity = velocity + j;
}

template <StateScalar T>
void TreeRecursionOf<T>::go(T const* by, Body& b) {
  T rate[3] = {T(0.0), T(0.0), T(0.0)};
  detail::add_cross(b.w, by, rate);
  detail::add_cross(b.w, rate, b.c);
  detail::add_cross(b.c + 3, by, b.c);
  for (int i = 0; i < 3; ++i) b.d[i] += by[i];
  for (int j = 0; j < b.count; ++j) {
    Direction& f = directions[b.first + std::size_t(j)];
    if (f.kind == Kind::slide) continue;
    detail::add_cross(f.s + 3, by, f.s);
    f.kind = Kind::general;
  }
}

template <StateScalar T>
void TreeRecursionOf<T>::move(JointMotion const& m, double sign, T const* x, T const* u, Body& b) {
  if (m.kind == JointMotion::Kind::ball) {
    Mat<T, 3, 3> const turned = rotation_matrix<T>(Quaternion<T>(x[0], x[1], x[2], x[3]));
    T before[9], spin[3] = {T(0.0), T(0.0), T(0.0)};
    for (int i = 0; i < 9; ++i) before[i] = b.axes[i];
    Mat<T, 3, 3> const back = turned.transpose();
    detail::set_product(before, sign > 0.0 ? turned.data() : back.data(), 3, b.axes);
    T const* const axes = sign > 0.0 ? b.axes : before;  // axes of frame b
    for (int k = 0; k < 3; ++k) {
      Direction& f = add_direction(Kind::turn, b);
      f.together = k == 0 ? 3 : 0;
      for (int i = 0; i < 3; ++i) {
        f.s[3 + i] = axes[3 * k + i] * sign;
        spin[i] += f.s[3 + i] * u[k];
      }
    }
    detail::add_cross(b.w, spin, b.c + 3);
    for (int i = 0; i < 3; ++i) b.w[i] += spin[i];
    return;
  }
  T n[3], by[3];
  for (int i = 0; i < 3; ++i) n[i] = b.axes[3 * m.axis + i] * sign;
  if (m.kind != JointMotion::Kind::turn) {
    bool const slide = m.kind == JointMotion::Kind::slide;
    double const part = slide ? 1.0 : m.pitch;
    T const twice = u[0] * (2.0 * part);
    for (int i = 0; i < 3; ++i) by[i] = n[i] * (x[0] * part);
    go(by, b);
    for (int i = 0; i < 3; ++i) by[i] = n[i] * twice;
    detail::add_cross(b.w, by, b.c);
    Direction& f = add_direction(slide ? Kind::slide : Kind::general, b);
    for (int i = 0; i < 3; ++i) {
      f.s[i] = n[i] * part;
      if (!slide) f.s[3 + i] = n[i];
    }
    if (slide) return;
  } else {
    Direction& f = add_direction(Kind::turn, b);
    for (int i = 0; i < 3; ++i) f.s[3 + i] = n[i];
  }
  for (int i = 0; i < 3; ++i) by[i] = n[i] * u[0];
  detail::add_cross(b.w, by, b.c + 3);
  for (int i = 0; i < 3; ++i) b.w[i] += by[i];
  turn(m.axis, x[0] * sign, b.axes);
}

/// Rotates `axes` by an angle about one of these axes.
template <StateScalar T>
void TreeRecursionOf<T>::turn(int axis, T const& angle, T* axes) {
  using std::cos, std::sin;
  T const c = cos(angle), s = sin(angle);
  T *const i = axes + 3 * ((axis + 1) % 3), *const j = axes + 3 * ((axis + 2) % 3);
  for (int k = 0; k < 3; ++k) {
    T const from_i = i[k], from_j = j[k];
    i[k] = from_i * c + from_j * s;
    j[k] = from_j * c - from_i * s;
  }
}

/// Sets the inertia of the body alone in world axes, A Θ Aᵀ, and p = 0.
template <StateScalar T>
void TreeRecursionOf<T>::set_inertia(TreeLink const& link, Body& b) {
  T mc[3], half[9];
  detail::set_product(b.axes, link.first, 1, mc);
  b.inertia.set(link.mass, mc);
  double full[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) full[3 * j + i] = link.second[detail::symmetric_place[i][j]];
  detail::set_product(b.axes, full, 3, half);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      b.inertia.second[detail::symmetric_place[i][j]] =
          half[i] * b.axes[j] + half[3 + i] * b.axes[3 + j] + half[6 + i] * b.axes[6 + j];
  for (T& x : b.p) x = T(0.0);
}

}  // namespace polybody
