#pragma once
/// \file
/// Tangent of an implicit step of a tree of rigid bodies under weight, eliminated one degree of freedom after the other
/// from the tips to the roots. The tangent is the derivative of Tᵀ(M(T u̇ + b) − f) if a change y of the degrees of
/// freedom changes coordinates by ck y, velocities by cd y and accelerations by cm y. The tangent is exact: it contains
/// inertia, Coriolis and centrifugal terms, and the geometric stiffness of rotating joints under tension. The
/// derivation follows the derivatives of inverse dynamics in [Carpentier & Mansard 2018].
///
/// Let δv and δa be the changes of [v; ω] and of its rate in the axes of a body, in which positions do not change. Let
/// v₀ and a₀ be the motion and the acceleration of the carrier of the body; an acceleration of the ground represents
/// weight. A degree of freedom with columns J and velocity u gives
///   δv = δv₀ + s_v y,                      s_v = cd J + ck v₀ ×ₘ J,
///   δa = δa₀ − (J u) ×ₘ δv + s_a y,        s_a = cm J + cd v ×ₘ J + ck a₀ ×ₘ J.
/// The force F that a body with its descendants requires changes by δF = A δa + B δv. A body alone has
///   A = I,   B = (·) ×* I v + v ×* I.
/// The equation of the degree of freedom is Jᵀ δF = given. The carrier must support δF + ck y J ×* F. The elimination
/// of y uses B′ = B − A (J u) ×ₘ and
///   D = Jᵀ h,   h = A s_a + B′ s_v,   r = h + ck J ×* F,
///   A₀ = A − r D⁻¹ JᵀA,   B₀ = B′ − r D⁻¹ JᵀB′.
/// The three columns of a ball joint are eliminated together. If the columns are fixed on the carrier, v and a replace
/// v₀ and a₀, v₀ replaces v, s_a has the additional term (J u) ×ₘ s_v, and D = Jᵀ r.
/// Theory: Eqs. 5.29 to 5.32.

#include <polybody/elimination/articulated_inertia.hpp>
#include <polybody/elimination/tree_recursion.hpp>
#include <polybody/system/model_operations.hpp>

namespace polybody::detail {

// Spatial algebra [Featherstone 2008, §2] of motions [v; ω] and forces [f; m] about one point, in world axes, on plain
// arrays of six numbers. Operations on pairs [A B] of matrices that map motions to forces, stored 6×12 by rows.

/// out += m ×ₘ s, the rate of a motion s that is constant in a frame with the motion m.
template <class T>
void add_motion_cross(T const* m, T const* s, T* out) {
  add_cross(m + 3, s, out);
  add_cross(m, s + 3, out);
  add_cross(m + 3, s + 3, out + 3);
}
/// out += m ×* f, the rate of a force f that is constant in a frame with the motion m.
template <class T>
void add_force_cross(T const* m, T const* f, T* out) {
  add_cross(m + 3, f, out);
  add_cross(m + 3, f + 3, out + 3);
  add_cross(m, f, out + 3);
}
/// out = X x: the motion x about a point displaced by d.
template <class T>
void carry_motion(T const* x, T const* d, T* out) {
  for (int i = 0; i < 6; ++i) out[i] = x[i];
  add_cross(x + 3, d, out);
}
/// out += Xᵀ f: a force f about a point displaced by d.
template <class T>
void add_carried_force(T const* f, T const* d, T* out) {
  for (int i = 0; i < 6; ++i) out[i] += f[i];
  add_cross(d, f, out + 3);
}

/// Pair [A B] of matrices; row i begins at m[12 i].
template <class T>
struct MatrixPair {
  T m[72];

  T* row(int i) { return m + 12 * i; }
  /// A = I, B = (·) ×* I v + v ×* I for a rigid body with the motion v and the `momentum` I v.
  void set_rigid(ArticulatedInertia<T> const& inertia, T const* v, T const* momentum);
  /// B −= A (w ×ₘ).
  void turn_back(T const* w) {
    for (int i = 0; i < 6; ++i) {
      T* const a = row(i);
      add_cross(w + 3, a, a + 6);
      add_cross(w, a, a + 9);
      add_cross(w + 3, a + 3, a + 9);
    }
  }
  /// out = A a + B v.
  void multiply(T const* a, T const* v, T* out) const {
    for (int i = 0; i < 6; ++i) out[i] = dot(m + 12 * i, a, 6) + dot(m + 12 * i + 6, v, 6);
  }
  /// out (12) = sᵀ [A B].
  void multiply_left(T const* s, T* out) const {
    for (int j = 0; j < 12; ++j) out[j] = s[0] * m[j];
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j < 12; ++j) out[j] += s[i] * m[12 * i + j];
  }
  /// [A B] −= r lᵀ.
  void subtract_product(T const* r, T const* l) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 12; ++j) m[12 * i + j] -= r[i] * l[j];
  }
  /// to += Xᵀ [A B] X. Overwrites this pair.
  void add_carried(T const* d, MatrixPair& to) {
    for (int i = 0; i < 6; ++i) {
      T* const a = row(i);
      add_cross(d, a, a + 3);
      add_cross(d, a + 6, a + 9);
    }
    for (int i = 0; i < 3; ++i) {
      T const d1 = d[(i + 1) % 3], d2 = d[(i + 2) % 3];
      T const *const next = m + 12 * ((i + 1) % 3), *const last = m + 12 * ((i + 2) % 3);
      for (int j = 0; j < 12; ++j) {
        to.m[12 * i + j] += m[12 * i + j];
        to.m[36 + 12 * i + j] += m[36 + 12 * i + j] + d1 * last[j] - d2 * next[j];
      }
    }
  }
};

/// With the mass m, its first moment h, its second moment Θ and the momentum [f; g], the columns of B for a change of v
/// and of ω are  [m ω̃; h̃ ω̃]  and  [−f̃ − ω̃ h̃; −g̃ + ω̃ Θ − ṽ h̃],  with ã b̃ = b aᵀ − (a·b) 1.
template <class T>
void MatrixPair<T>::set_rigid(ArticulatedInertia<T> const& inertia, T const* v, T const* momentum) {
  T const *const w = v + 3, *const first = inertia.first, mass = inertia.mass[0];
  T const h[3] = {first[5], first[6], first[1]}, wh = dot(w, h, 3), vh = dot(v, h, 3);
  for (int i = 0; i < 3; ++i) {
    T* const force = row(i);
    T* const moment = row(3 + i);
    for (int j = 0; j < 3; ++j) {
      force[j] = inertia.mass[symmetric_place[i][j]];
      force[3 + j] = first[3 * i + j];
      moment[j] = first[3 * j + i];
      moment[3 + j] = inertia.second[symmetric_place[i][j]];
      force[6 + j] = T(0.0);
      moment[6 + j] = w[i] * h[j];
      force[9 + j] = -h[i] * w[j];
      moment[9 + j] = -h[i] * v[j];
    }
    force[9 + i] += wh;
    moment[6 + i] -= wh;
    moment[9 + i] += vh;
  }
  for (int i = 0; i < 3; ++i) {  // cross products: ã has −a_k at (i, j) and a_j at (i, k)
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    row(i)[6 + j] -= mass * w[k];
    row(i)[6 + k] += mass * w[j];
    row(i)[9 + j] += momentum[k];
    row(i)[9 + k] -= momentum[j];
    row(3 + i)[9 + j] += momentum[3 + k];
    row(3 + i)[9 + k] -= momentum[3 + j];
    for (int c = 0; c < 3; ++c)
      row(3 + i)[9 + c] += w[j] * inertia.second[symmetric_place[k][c]] - w[k] * inertia.second[symmetric_place[j][c]];
  }
}

}  // namespace polybody::detail

namespace polybody {

/// Factorisation and solution of the tangent of a tree of rigid bodies. The scalar type T is always `double`. As a
/// template, the class is compiled only in programs with joint coordinates.
template <class T = double>
class TreeTangentSolverOf {
 public:
  TreeTangentSolverOf() = default;
  /// Allocates all memory.
  explicit TreeTangentSolverOf(Sequence<TreeBody> const& bodies)
      : walk_(bodies), nodes_(bodies.size()), columns_(walk_.directions.size()) {}

  /// Factorises the tangent at (q, v, a). Returns −1 on success, otherwise the velocity index of the degree of freedom
  /// without a pivot.
  Index factor(At<T> const& at, VecXOf<T> const& a, Vec3 const& gravity, TangentCoefficients const& c);
  /// Computes y for the generalised forces `given`.
  void solve(VecXOf<T> const& given, VecXOf<T>& y);

 private:
  using Walk = TreeRecursionOf<T>;
  using Direction = typename Walk::Direction;
  struct Column {
    T sv[6], sa[6], l[12], r[6], rate[6], inverse[3];  ///< s_v, s_a, Jᵀ[A B′], r, J u, row of D⁻¹
    T w;
  };
  struct Node {
    T v[6], a[6], force[6], c[6];
    detail::MatrixPair<T> pair;  ///< [A B]
  };

  void move(std::size_t i, VecXOf<T> const& v, VecXOf<T> const& a, TangentCoefficients const& k);
  void move_through(std::size_t first, bool before, Node& n, TangentCoefficients const& k);
  void set_inertia(std::size_t i);
  bool eliminate(std::size_t first, bool before, double ck, Node& n);
  bool invert(std::size_t first, int count, T const* d, T const* size);
  void collect(VecXOf<T> const& given);
  /// Entry k of D⁻¹ w, for one degree of freedom or for the three of a ball joint.
  T answer(std::size_t first, int k) const {
    T sum = T(0.0);
    for (int j = 0; j < walk_.directions[first].together; ++j)
      sum += columns_[first + std::size_t(k)].inverse[j] * columns_[first + std::size_t(j)].w;
    return sum;
  }

  Walk walk_;
  Sequence<Node> nodes_;
  Sequence<Column> columns_;
  Node ground_ = {};
};

template <class T>
Index TreeTangentSolverOf<T>::factor(At<T> const& at, VecXOf<T> const& a, Vec3 const& gravity,
                                     TangentCoefficients const& c) {
  walk_.place(at.q, at.v);
  for (int k = 0; k < 3; ++k) ground_.a[k] = -gravity[k];
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    move(i, at.v, a, c);
    set_inertia(i);
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    auto const& body = walk_.bodies[i];
    for (std::size_t k = body.first + std::size_t(body.count); k-- > body.first;)
      if (walk_.directions[k].together > 0 && !eliminate(k, walk_.links[i].backwards, c.stiffness, n))
        return walk_.directions[k].velocity;
    Index const parent = walk_.links[i].parent;
    if (parent < 0) continue;
    Node& p = nodes_[std::size_t(parent)];
    n.pair.add_carried(body.d, p.pair);
    detail::add_carried_force(n.force, body.d, p.force);
  }
  return -1;
}

/// Computes v and a of body i, and s_v and s_a of its degrees of freedom.
template <class T>
void TreeTangentSolverOf<T>::move(std::size_t i, VecXOf<T> const& v, VecXOf<T> const& a, TangentCoefficients const& k) {
  Node& n = nodes_[i];
  auto const& body = walk_.bodies[i];
  Index const parent = walk_.links[i].parent;
  Node const& p = parent < 0 ? ground_ : nodes_[std::size_t(parent)];
  detail::carry_motion(p.v, body.d, n.v);
  detail::carry_motion(p.a, body.d, n.a);
  std::size_t const end = body.first + std::size_t(body.count);
  for (std::size_t first = body.first; first < end; first += walk_.directions[first].together) {
    Column& c = columns_[first];
    T rate[6] = {}, faster[6] = {};
    for (std::size_t j = first; j < first + walk_.directions[first].together; ++j) {
      Direction const& f = walk_.directions[j];
      for (int l = 0; l < 6; ++l) {
        rate[l] += f.s[l] * v[f.velocity];
        faster[l] += f.s[l] * a[f.velocity];
      }
    }
    for (int l = 0; l < 6; ++l) {
      c.rate[l] = rate[l];
      c.r[l] = faster[l];  // J u̇, until the elimination
    }
    move_through(first, walk_.links[i].backwards, n, k);
  }
}

/// Adds the motion of one degree of freedom, or of the three of a ball joint, to v and a. \param before true if the
/// columns are fixed on the carrier
template <class T>
void TreeTangentSolverOf<T>::move_through(std::size_t first, bool before, Node& n, TangentCoefficients const& k) {
  Column const& c = columns_[first];
  T v[6], a[6];
  for (int l = 0; l < 6; ++l) {
    v[l] = n.v[l] + c.rate[l];
    a[l] = n.a[l] + c.r[l];
  }
  detail::add_motion_cross(n.v, c.rate, a);
  T const *const place_v = before ? v : n.v, *const place_a = before ? a : n.a, *const speed_v = before ? n.v : v;
  for (std::size_t j = first; j < first + walk_.directions[first].together; ++j) {
    T const* const s = walk_.directions[j].s;
    Column& to = columns_[j];
    T by_v[6] = {}, by_a[6] = {}, by_speed[6] = {};
    detail::add_motion_cross(place_v, s, by_v);
    detail::add_motion_cross(place_a, s, by_a);
    detail::add_motion_cross(speed_v, s, by_speed);
    for (int l = 0; l < 6; ++l) {
      to.sv[l] = k.damping * s[l] + k.stiffness * by_v[l];
      to.sa[l] = k.mass * s[l] + k.damping * by_speed[l] + k.stiffness * by_a[l];
    }
    if (before) detail::add_motion_cross(c.rate, to.sv, to.sa);
  }
  for (int l = 0; l < 6; ++l) {
    n.v[l] = v[l];
    n.a[l] = a[l];
  }
}

/// Sets A, B and F of the body without its descendants.
template <class T>
void TreeTangentSolverOf<T>::set_inertia(std::size_t i) {
  Node& n = nodes_[i];
  auto const& inertia = walk_.bodies[i].inertia;
  T momentum[6] = {};
  inertia.add_by_acceleration(n.v, momentum);
  inertia.add_by_angular(n.v + 3, momentum);
  for (int l = 0; l < 6; ++l) n.force[l] = T(0.0);
  inertia.add_by_acceleration(n.a, n.force);
  inertia.add_by_angular(n.a + 3, n.force);
  detail::add_force_cross(n.v, momentum, n.force);
  n.pair.set_rigid(inertia, n.v, momentum);
}

/// Eliminates one degree of freedom, or the three of a ball joint, from A and B. Returns false if a degree of freedom
/// has no pivot.
template <class T>
bool TreeTangentSolverOf<T>::eliminate(std::size_t first, bool before, double ck, Node& n) {
  int const count = walk_.directions[first].together;
  n.pair.turn_back(columns_[first].rate);  // [A B′] from here on
  T d[9] = {}, size[3] = {};
  for (int j = 0; j < count; ++j) {
    Column& c = columns_[first + std::size_t(j)];
    T const* const s = walk_.directions[first + std::size_t(j)].s;
    T h[6], bent[6] = {};
    n.pair.multiply(c.sa, c.sv, h);
    detail::add_force_cross(s, n.force, bent);
    for (int l = 0; l < 6; ++l) c.r[l] = h[l] + ck * bent[l];
    for (int i = 0; i < count; ++i) {
      T const* const row = walk_.directions[first + std::size_t(i)].s;
      d[count * i + j] = detail::dot(row, before ? c.r : h, 6);
      for (int l = 0; l < 6; ++l) size[i] += std::abs(row[l] * h[l]);
    }
    n.pair.multiply_left(s, c.l);
  }
  if (!invert(first, count, d, size)) return false;
  for (int j = 0; j < count; ++j) {
    Column const& by = columns_[first + std::size_t(j)];
    T part[12] = {};
    for (int k = 0; k < count; ++k)
      for (int l = 0; l < 12; ++l) part[l] += by.inverse[k] * columns_[first + std::size_t(k)].l[l];
    n.pair.subtract_product(by.r, part);
  }
  return true;
}

template <class T>
bool TreeTangentSolverOf<T>::invert(std::size_t first, int count, T const* d, T const* size) {
  if (count == 1) {
    columns_[first].inverse[0] = 1.0 / d[0];
    return std::abs(d[0]) > 1e-14 * size[0];
  }
  Mat<T, 6, 6> inverse;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) inverse(i, j) = d[count * i + j];
  if (invert_with_pivots(inverse, count, std::max(size[0], std::max(size[1], size[2]))) >= 0) return false;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) columns_[first + std::size_t(i)].inverse[j] = inverse(i, j);
  return true;
}

/// Computes w, the forces `given` on the degrees of freedom less the forces that the descendants transmit to them.
template <class T>
void TreeTangentSolverOf<T>::collect(VecXOf<T> const& given) {
  for (Node& n : nodes_)
    for (T& x : n.c) x = T(0.0);
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    auto const& body = walk_.bodies[i];
    for (std::size_t first = body.first + std::size_t(body.count); first-- > body.first;) {
      int const count = walk_.directions[first].together;
      for (int k = 0; k < count; ++k) {
        Direction const& f = walk_.directions[first + std::size_t(k)];
        columns_[first + std::size_t(k)].w = given[f.velocity] - Walk::along(f, n.c);
      }
      for (int k = 0; k < count; ++k) {
        T const part = answer(first, k);
        for (int l = 0; l < 6; ++l) n.c[l] += columns_[first + std::size_t(k)].r[l] * part;
      }
    }
    if (Index const parent = walk_.links[i].parent; parent >= 0)
      detail::add_carried_force(n.c, body.d, nodes_[std::size_t(parent)].c);
  }
}

template <class T>
void TreeTangentSolverOf<T>::solve(VecXOf<T> const& given, VecXOf<T>& y) {
  collect(given);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& n = nodes_[i];
    auto const& body = walk_.bodies[i];
    Index const parent = walk_.links[i].parent;
    static constexpr T none[6] = {};
    detail::carry_motion(parent < 0 ? none : nodes_[std::size_t(parent)].v, body.d, n.v);
    detail::carry_motion(parent < 0 ? none : nodes_[std::size_t(parent)].a, body.d, n.a);
    std::size_t const end = body.first + std::size_t(body.count);
    for (std::size_t first = body.first; first < end; first += walk_.directions[first].together) {
      int const count = walk_.directions[first].together;
      for (int k = 0; k < count; ++k) {
        Column& c = columns_[first + std::size_t(k)];
        c.w -= detail::dot(c.l, n.a, 6) + detail::dot(c.l + 6, n.v, 6);
      }
      for (int k = 0; k < count; ++k) {
        Column const& c = columns_[first + std::size_t(k)];
        T const part = answer(first, k);
        y[walk_.directions[first + std::size_t(k)].velocity] = part;
        for (int l = 0; l < 6; ++l) {
          n.v[l] += c.sv[l] * part;
          n.a[l] += c.sa[l] * part;
        }
      }
      T turned[6] = {};
      detail::add_motion_cross(columns_[first].rate, n.v, turned);
      for (int l = 0; l < 6; ++l) n.a[l] -= turned[l];
    }
  }
}

}  // namespace polybody
