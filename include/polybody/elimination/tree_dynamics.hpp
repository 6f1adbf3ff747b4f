#pragma once
/// \file
/// Accelerations of a tree of rigid bodies by three recursions [Featherstone 1983; 2008, §7.3]. The first computes
/// positions, angular velocities and biases from the roots to the tips. The second computes articulated inertias back
/// to the roots, the third accelerations to the tips. A joint is a sequence of single degrees of freedom with columns
/// S, so that only scalars are inverted. With the acceleration x = [a; α] of a body at its reference point
/// (tree_recursion.hpp), in world axes,
///   x = X x_p + Σ S u̇ + c,   X x = [a + α × d; α],   [f; m] = I x + p,   p ← p + I c.
/// c is the acceleration for u̇ = 0 and x_p = 0, I the inertia, and p the wrench for x = 0. Each degree of freedom,
/// from the last to the first, gives
///   D = Sᵀ I S,  w = −Sᵀ p,   I ← I − (I S) D⁻¹ (I S)ᵀ,  p ← p + (I S) D⁻¹ w,
/// then for the parent I_p += XᵀI X, p_p += Xᵀp. The last recursion computes u̇ = D⁻¹ (w − (I S)ᵀ x). In world axes the
/// articulated inertias need no rotation from body to body.
/// Theory: Eqs. 5.22 to 5.24.

#include <polybody/elimination/tree_recursion.hpp>

namespace polybody {

/// Forward dynamics of a tree of rigid bodies. T is the scalar type of the state; dual numbers give derivatives of the
/// accelerations.
template <StateScalar T = double>
class TreeDynamicsOf {
 public:
  TreeDynamicsOf() = default;
  /// Computes the constants of the bodies and allocates all memory.
  explicit TreeDynamicsOf(Sequence<TreeBody> const& bodies) : walk_(bodies) {}

  /// Computes u̇ of all degrees of freedom at (q, v) under weight alone. Returns −1 on success, otherwise the index of
  /// a body with a degree of freedom without inertia.
  Index accelerations_under_gravity(VecXOf<T> const& q, VecXOf<T> const& v, Vec3 const& gravity, VecXOf<T>& out) {
    walk_.place(q, v);
    walk_.add_velocity_forces();
    return solve(gravity, out);
  }
  /// Computes u̇ of all degrees of freedom at (q, v) for any forces. `residual` is M a − f of all bodies in full
  /// velocities at v̇ = 0, where f includes weight and gyroscopic moments. Returns −1 on success, otherwise the index
  /// of a body with a degree of freedom without inertia.
  Index accelerations(VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T> const& residual, VecXOf<T>& out) {
    walk_.place(q, v);
    for (std::size_t i = 0; i < walk_.links.size(); ++i) {
      TreeLink const& link = walk_.links[i];
      Body& b = walk_.bodies[i];
      T arm[3], axes[9], w[6];
      detail::set_product(b.axes, link.centre, 1, arm);
      detail::set_product(b.axes, link.full_axes, 3, axes);
      read_wrench(link, residual.data() + link.v0, axes, w);
      walk_.add_centrifugal(b);
      for (int k = 0; k < 3; ++k) {
        b.p[k] += w[k];
        b.p[3 + k] = w[3 + k];
      }
      detail::add_cross(arm, b.p, b.p + 3);
    }
    return solve(Vec3(0, 0, 0), out);
  }
  /// out = Tᵀ(M(T u̇ + b) − f) under weight alone: the generalised forces that the motion requires.
  void balance(VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T> const& a, Vec3 const& gravity, VecXOf<T>& out);

 private:
  using Walk = TreeRecursionOf<T>;
  using Body = typename Walk::Body;
  using Direction = typename Walk::Direction;
  using Kind = typename Walk::Kind;

  static void read_wrench(TreeLink const& link, T const* r, T const* axes, T* w) {
    bool const plane = link.layout == RigidLayout::plane;
    T const moment[3] = {plane ? T(0.0) : r[3], plane ? T(0.0) : r[4], plane ? r[2] : r[5]};
    for (int i = 0; i < 3; ++i) w[i] = plane && i == 2 ? T(0.0) : r[i];
    if (plane)
      for (int i = 0; i < 3; ++i) w[3 + i] = moment[i];
    else
      detail::set_product(axes, moment, 1, w + 3);
  }

  Index solve(Vec3 const& gravity, VecXOf<T>& out);
  bool eliminate(Body& b, bool carried);
  static void set_column(Direction& f, detail::ArticulatedInertia<T> const& inertia);
  /// Replaces the weight by an acceleration of the ground.
  void let_ground_fall(Vec3 const& gravity) {
    for (int k = 0; k < 3; ++k) walk_.ground.x[k] = T(-gravity[k]);
  }
  /// x = X x_p for the carrier p of body b.
  static void carry(Body const& p, Body& b) {
    for (int k = 0; k < 6; ++k) b.x[k] = p.x[k];
    detail::add_cross(p.x + 3, b.d, b.x);
  }
  static void add_column(Direction const& f, T const& u, T* x) {
    for (int j = f.kind == Kind::turn ? 3 : 0; j < (f.kind == Kind::slide ? 3 : 6); ++j) x[j] += f.s[j] * u;
  }
  static void add_back(Body const& b, Body& p) {
    for (int k = 0; k < 6; ++k) p.p[k] += b.p[k];
    detail::add_cross(b.d, b.p, p.p + 3);
  }

  Walk walk_;
};

/// Computes the product I S of a degree of freedom.
template <StateScalar T>
void TreeDynamicsOf<T>::set_column(Direction& f, detail::ArticulatedInertia<T> const& inertia) {
  for (T& x : f.u) x = T(0.0);
  if (f.kind != Kind::turn) inertia.add_by_acceleration(f.s, f.u);
  if (f.kind != Kind::slide) inertia.add_by_angular(f.s + 3, f.u);
}

/// Eliminates the degrees of freedom of a body from its inertia and force. Returns false if a degree of freedom has no
/// inertia.
template <StateScalar T>
bool TreeDynamicsOf<T>::eliminate(Body& b, bool carried) {
  b.inertia.add_by_acceleration(b.c, b.p);
  b.inertia.add_by_angular(b.c + 3, b.p);
  Direction* const f = walk_.directions.data() + b.first;
  double full[6] = {};  // D of each degree of freedom with the others fixed
  if (b.count > 1)
    for (int k = 0; k < b.count; ++k) {
      set_column(f[k], b.inertia);
      full[k] = value_of(Walk::along(f[k], f[k].u));
    }
  for (int k = b.count; k-- > 0;) {
    set_column(f[k], b.inertia);
    T const d = Walk::along(f[k], f[k].u);
    if (!(value_of(d) > 1e-14 * full[k])) return false;
    f[k].inverse = 1.0 / d;
    f[k].w = -Walk::along(f[k], b.p);
    if (k == 0 && !carried) break;
    b.inertia.remove(f[k].u, f[k].inverse);
    T const given = f[k].inverse * f[k].w;
    for (int i = 0; i < 6; ++i) b.p[i] += f[k].u[i] * given;
  }
  return true;
}

template <StateScalar T>
Index TreeDynamicsOf<T>::solve(Vec3 const& gravity, VecXOf<T>& out) {
  for (std::size_t i = walk_.links.size(); i-- > 0;) {
    Body& b = walk_.bodies[i];
    Index const parent = walk_.links[i].parent;
    if (!eliminate(b, parent >= 0)) return Index(i);
    if (parent < 0) continue;
    Body& p = walk_.bodies[std::size_t(parent)];
    p.inertia.add_carried(b.inertia, b.d);
    add_back(b, p);
  }
  let_ground_fall(gravity);
  for (std::size_t i = 0; i < walk_.links.size(); ++i) {
    Body& b = walk_.bodies[i];
    carry(walk_.carrier(i), b);
    for (int k = 0; k < b.count; ++k) {
      Direction const& f = walk_.directions[b.first + std::size_t(k)];
      T const u = f.inverse * (f.w - detail::dot(f.u, b.x, 6));
      out[f.velocity] = u;
      add_column(f, u, b.x);
    }
    for (int k = 0; k < 6; ++k) b.x[k] += b.c[k];
  }
  return -1;
}

template <StateScalar T>
void TreeDynamicsOf<T>::balance(VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T> const& a, Vec3 const& gravity,
                                VecXOf<T>& out) {
  walk_.place(q, v);
  walk_.add_velocity_forces();
  let_ground_fall(gravity);
  for (std::size_t i = 0; i < walk_.links.size(); ++i) {
    Body& b = walk_.bodies[i];
    carry(walk_.carrier(i), b);
    for (int k = 0; k < b.count; ++k) {
      Direction const& f = walk_.directions[b.first + std::size_t(k)];
      add_column(f, a[f.velocity], b.x);
    }
    for (int k = 0; k < 6; ++k) b.x[k] += b.c[k];
    b.inertia.add_by_acceleration(b.x, b.p);
    b.inertia.add_by_angular(b.x + 3, b.p);
  }
  for (std::size_t i = walk_.links.size(); i-- > 0;) {
    Body const& b = walk_.bodies[i];
    for (int k = 0; k < b.count; ++k) {
      Direction const& f = walk_.directions[b.first + std::size_t(k)];
      out[f.velocity] = Walk::along(f, b.p);
    }
    if (walk_.links[i].parent >= 0) add_back(b, walk_.carrier(i));
  }
}

}  // namespace polybody
