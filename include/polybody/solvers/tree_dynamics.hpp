#pragma once
/// \file
/// Accelerations of a tree of rigid bodies by three walks [Featherstone 1983; 2008, §7.3]: places, spins and biases
/// from the roots to the tips, articulated inertias back to the roots, accelerations to the tips. A joint is a row of
/// single freedoms with columns S, so that nothing larger than a number is inverted. With x = [a; α] of a body's
/// reference point, the point of the joint that carries it, d the arm from its parent's, all in world axes,
///   x = X x_p + Σ S u̇ + c,   X x = [a + α × d; α],   [f; m] = I x + p,
/// p + I c takes the place of p, and each freedom from the last to the first
///   D = Sᵀ I S,  w = −Sᵀ p,   I − (I S) D⁻¹ (I S)ᵀ that of I,  p + (I S) D⁻¹ w that of p;
/// the parent gets I_p += XᵀI X, p_p += Xᵀp; on the way back u̇ = D⁻¹ (w − (I S)ᵀ x).
/// Articulated inertias need no turn from body to body in world axes; reference points at the joints keep the numbers
/// those of the bodies, however far they are from the world's origin.

#include <cmath>

#include <polybody/math/quaternion.hpp>
#include <polybody/solvers/articulated_inertia.hpp>
#include <polybody/solvers/tree_link.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// T is the scalar of the state: dual numbers give the derivatives of the same walks.
template <StateScalar T = double>
class TreeDynamicsOf {
 public:
  TreeDynamicsOf() = default;
  /// The constants of the bodies; allocates all there is to be.
  explicit TreeDynamicsOf(Sequence<TreeBody> const& bodies);

  /// u̇ of all freedoms at (q, v) under weight alone. −1, or the body whose freedom has no inertia.
  Index accelerations_by_weight(VecXOf<T> const& q, VecXOf<T> const& v, Vec3 const& gravity, VecXOf<T>& out) {
    place_all(q, v);
    for (Body& b : bodies_) {
      T spin[6] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
      b.inertia.add_by_angular(b.w, spin);
      detail::add_cross(b.w, spin + 3, b.p + 3);  // ω × Θ ω
      add_centrifugal(b);
    }
    return solve(gravity, out);
  }
  /// The same under any forces: `unbalance` is M a − f of all bodies by their whole speeds at v̇ = 0, weight and
  /// gyroscopic moments among f.
  Index accelerations(VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T> const& unbalance, VecXOf<T>& out) {
    place_all(q, v);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      Link const& link = links_[i];
      Body& b = bodies_[i];
      T arm[3], axes[9], w[6];
      detail::set_product(b.axes, link.centre, 1, arm);
      detail::set_product(b.axes, link.whole_axes, 3, axes);
      read_wrench(link, unbalance.data() + link.v0, axes, w);
      add_centrifugal(b);
      for (int k = 0; k < 3; ++k) {
        b.p[k] += w[k];
        b.p[3 + k] = w[3 + k];
      }
      detail::add_cross(arm, b.p, b.p + 3);
    }
    return solve(Vec3(0, 0, 0), out);
  }

 private:
  using Link = TreeLink;
  enum class Kind : unsigned char { turn, slide, general };
  struct Freedom {
    T s[6], u[6], inverse, w;  ///< S, I S, D⁻¹
    Kind kind;
    Index speed;
  };
  struct Body {
    T axes[9], d[3], w[3], c[6], p[6], x[6];
    detail::ArticulatedInertia<T> inertia;
    std::size_t first;  ///< of its freedoms
    int count;
  };

  void place_all(VecXOf<T> const& q, VecXOf<T> const& v);
  void place(Link const& link, Body const& parent, T const* q, T const* u, Body& b);
  void move(JointMotion const& m, double sign, T const* x, T const* u, Body& b);
  /// The reference point goes along `by`, at rest in the frame that has arrived.
  void go(T const* by, Body& b);
  Freedom& add_freedom(Kind kind, Body& b) {
    Freedom& f = freedoms_[b.first + std::size_t(b.count++)];
    f.kind = kind;
    for (T& x : f.s) x = T(0.0);
    return f;
  }
  static void turn(int axis, T const& angle, T* axes);
  static void set_inertia(Link const& link, Body& b);
  /// p: ω × (ω × m c).
  static void add_centrifugal(Body& b) {
    T const* const h = b.inertia.first;
    T const mc[3] = {h[5], h[6], h[1]};
    T rate[3] = {T(0.0), T(0.0), T(0.0)};
    detail::add_cross(b.w, mc, rate);
    detail::add_cross(b.w, rate, b.p);
  }
  static void read_wrench(Link const& link, T const* r, T const* axes, T* w) {
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
  static void set_column(Freedom& f, detail::ArticulatedInertia<T> const& inertia);
  static T along(Freedom const& f, T const* x) {
    switch (f.kind) {
      case Kind::turn:
        return detail::dot(f.s + 3, x + 3, 3);
      case Kind::slide:
        return detail::dot(f.s, x, 3);
      default:
        return detail::dot(f.s, x, 6);
    }
  }

  Sequence<Link> links_;
  Sequence<Body> bodies_;
  Sequence<Freedom> freedoms_;
  Body ground_ = {};
};

template <StateScalar T>
TreeDynamicsOf<T>::TreeDynamicsOf(Sequence<TreeBody> const& bodies) : bodies_(bodies.size()) {
  for (int i = 0; i < 3; ++i) ground_.axes[4 * i] = T(1.0);
  std::size_t freedoms = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bool const has_parent = bodies[i].parent >= 0;
    links_.push_back(tree_link(bodies[i], has_parent ? &bodies[std::size_t(bodies[i].parent)] : nullptr));
    bodies_[i].first = freedoms;
    freedoms += std::size_t(links_.back().freedoms);
  }
  freedoms_.resize(freedoms);
}

template <StateScalar T>
void TreeDynamicsOf<T>::place_all(VecXOf<T> const& q, VecXOf<T> const& v) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link const& link = links_[i];
    Body& b = bodies_[i];
    place(link, link.parent < 0 ? ground_ : bodies_[std::size_t(link.parent)], q.data() + link.qn, v.data() + link.vn,
          b);
    set_inertia(link, b);
  }
}

template <StateScalar T>
void TreeDynamicsOf<T>::place(Link const& link, Body const& parent, T const* q, T const* u, Body& b) {
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
  Index speed = link.vn;
  if (link.backwards) {
    q += link.motions.coordinates();
    int k = link.freedoms;
    for (int i = link.motions.count; i-- > 0;) {
      JointMotion const& m = link.motions.list[std::size_t(i)];
      k -= m.speeds();
      int const before = b.count;
      move(m, -1.0, q -= m.coordinates(), u + k, b);
      for (int j = before; j < b.count; ++j) freedoms_[b.first + std::size_t(j)].speed = speed + k + (j - before);
    }
    return;
  }
  for (JointMotion const& m : link.motions) {
    move(m, 1.0, q, u, b);
    q += m.coordinates();
    u += m.speeds();
  }
  for (int j = 0; j < b.count; ++j) freedoms_[b.first + std::size_t(j)].speed = speed + j;
}

template <StateScalar T>
void TreeDynamicsOf<T>::go(T const* by, Body& b) {
  T rate[3] = {T(0.0), T(0.0), T(0.0)};
  detail::add_cross(b.w, by, rate);
  detail::add_cross(b.w, rate, b.c);
  detail::add_cross(b.c + 3, by, b.c);
  for (int i = 0; i < 3; ++i) b.d[i] += by[i];
  for (int j = 0; j < b.count; ++j) {
    Freedom& f = freedoms_[b.first + std::size_t(j)];
    if (f.kind == Kind::slide) continue;
    detail::add_cross(f.s + 3, by, f.s);
    f.kind = Kind::general;
  }
}

template <StateScalar T>
void TreeDynamicsOf<T>::move(JointMotion const& m, double sign, T const* x, T const* u, Body& b) {
  if (m.kind == JointMotion::Kind::ball) {
    Mat<T, 3, 3> const turned = rotation_matrix<T>(Quaternion<T>(x[0], x[1], x[2], x[3]));
    T before[9], spin[3] = {T(0.0), T(0.0), T(0.0)};
    for (int i = 0; i < 9; ++i) before[i] = b.axes[i];
    Mat<T, 3, 3> const back = turned.transpose();
    detail::set_product(before, sign > 0.0 ? turned.data() : back.data(), 3, b.axes);
    T const* const axes = sign > 0.0 ? b.axes : before;  // of frame b
    for (int k = 0; k < 3; ++k) {
      Freedom& f = add_freedom(Kind::turn, b);
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
    Freedom& f = add_freedom(slide ? Kind::slide : Kind::general, b);
    for (int i = 0; i < 3; ++i) {
      f.s[i] = n[i] * part;
      if (!slide) f.s[3 + i] = n[i];
    }
    if (slide) return;
  } else {
    Freedom& f = add_freedom(Kind::turn, b);
    for (int i = 0; i < 3; ++i) f.s[3 + i] = n[i];
  }
  for (int i = 0; i < 3; ++i) by[i] = n[i] * u[0];
  detail::add_cross(b.w, by, b.c + 3);
  for (int i = 0; i < 3; ++i) b.w[i] += by[i];
  turn(m.axis, x[0] * sign, b.axes);
}

/// axes turned by an angle about one of themselves.
template <StateScalar T>
void TreeDynamicsOf<T>::turn(int axis, T const& angle, T* axes) {
  using std::cos, std::sin;
  T const c = cos(angle), s = sin(angle);
  T *const i = axes + 3 * ((axis + 1) % 3), *const j = axes + 3 * ((axis + 2) % 3);
  for (int k = 0; k < 3; ++k) {
    T const from_i = i[k], from_j = j[k];
    i[k] = from_i * c + from_j * s;
    j[k] = from_j * c - from_i * s;
  }
}

/// The body's own inertia in world axes, A Θ Aᵀ; p is zero.
template <StateScalar T>
void TreeDynamicsOf<T>::set_inertia(Link const& link, Body& b) {
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

/// U = I S.
template <StateScalar T>
void TreeDynamicsOf<T>::set_column(Freedom& f, detail::ArticulatedInertia<T> const& inertia) {
  for (T& x : f.u) x = T(0.0);
  if (f.kind != Kind::turn) inertia.add_by_acceleration(f.s, f.u);
  if (f.kind != Kind::slide) inertia.add_by_angular(f.s + 3, f.u);
}

/// The freedoms of a body out of its inertia and its force. False where one moves no inertia.
template <StateScalar T>
bool TreeDynamicsOf<T>::eliminate(Body& b, bool carried) {
  b.inertia.add_by_acceleration(b.c, b.p);
  b.inertia.add_by_angular(b.c + 3, b.p);
  Freedom* const f = freedoms_.data() + b.first;
  double whole[6] = {};  // D of each freedom while the others are held
  if (b.count > 1)
    for (int k = 0; k < b.count; ++k) {
      set_column(f[k], b.inertia);
      whole[k] = value_of(along(f[k], f[k].u));
    }
  for (int k = b.count; k-- > 0;) {
    set_column(f[k], b.inertia);
    T const d = along(f[k], f[k].u);
    if (!(value_of(d) > 1e-14 * whole[k])) return false;
    f[k].inverse = 1.0 / d;
    f[k].w = -along(f[k], b.p);
    if (k == 0 && !carried) break;
    b.inertia.remove(f[k].u, f[k].inverse);
    T const given = f[k].inverse * f[k].w;
    for (int i = 0; i < 6; ++i) b.p[i] += f[k].u[i] * given;
  }
  return true;
}

template <StateScalar T>
Index TreeDynamicsOf<T>::solve(Vec3 const& gravity, VecXOf<T>& out) {
  for (std::size_t i = links_.size(); i-- > 0;) {
    Body& b = bodies_[i];
    Index const parent = links_[i].parent;
    if (!eliminate(b, parent >= 0)) return Index(i);
    if (parent < 0) continue;
    Body& p = bodies_[std::size_t(parent)];
    p.inertia.add_carried(b.inertia, b.d);
    for (int k = 0; k < 6; ++k) p.p[k] += b.p[k];
    detail::add_cross(b.d, b.p, p.p + 3);
  }
  for (int k = 0; k < 3; ++k) ground_.x[k] = T(-gravity[k]);  // a frame that falls with the weight
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Body& b = bodies_[i];
    Body const& p = links_[i].parent < 0 ? ground_ : bodies_[std::size_t(links_[i].parent)];
    for (int k = 0; k < 6; ++k) b.x[k] = p.x[k];
    detail::add_cross(p.x + 3, b.d, b.x);
    for (int k = 0; k < b.count; ++k) {
      Freedom const& f = freedoms_[b.first + std::size_t(k)];
      T const u = f.inverse * (f.w - detail::dot(f.u, b.x, 6));
      out[f.speed] = u;
      for (int j = f.kind == Kind::turn ? 3 : 0; j < (f.kind == Kind::slide ? 3 : 6); ++j) b.x[j] += f.s[j] * u;
    }
    for (int k = 0; k < 6; ++k) b.x[k] += b.c[k];
  }
  return -1;
}

}  // namespace polybody
