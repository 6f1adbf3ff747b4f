#pragma once
/// \file
/// Parts of a `JointTree`: its bodies, their frames, and the kinematics of a frame along the motions of a joint.

#include <string>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/joint_motion.hpp>
#include <polybody/math/quaternion.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/vector_algebra.hpp>

namespace polybody {

/// Constants of a joint with a single rotation by x. Its axis is n in the parent's axes. In space, the quaternion from
/// the parent's axes to those of the body is `still` cos(x/2) + `turning` sin(x/2).
struct JointTurn {
  bool only = false;                                      ///< true if the joint permits only this rotation
  Vec<double, 3> axis{0, 0, 0};                           ///< n, unit vector in the parent's axes
  Vec<double, 4> still{1, 0, 0, 0}, turning{0, 0, 0, 0};  ///< quaternions of the rotation, (w, x, y, z)
};

/// Body of a tree, or node of a chain with frames: layout of its pose, and the joint that carries it.
struct TreeBody {
  std::string name;                              ///< name in messages
  RigidLayout layout = RigidLayout::quaternion;  ///< layout of its coordinates
  Index q0 = 0, v0 = 0;                          ///< first coordinate and velocity in full vectors
  Index row = -1;                                ///< first constraint equation of its joint; −1: a root, without joint
  Index parent = -1;                             ///< index in the tree; −1: the ground, or none for a root
  Index chain = -1;                              ///< for a node: number of its chain; −1 for a body
  Placement from = {};                           ///< frame of the joint in the axes of the parent
  Placement to = {};                             ///< frame of the joint in the axes of the body
  bool from_turned = true, to_turned = true;     ///< true if frame `from` or `to` is rotated relative to its body
  JointMotions motions = {};                     ///< motions from frame a to frame b; `free_motions` of a free node
  Index from_end = -1, to_end = -1;              ///< indices of floating ends, for frames on flexible bodies; −1: none
  Index deformations = 0;                        ///< number of deformation coordinates, which follow those of the frame
  JointTurn turn = {};                           ///< constants of a single rotation between rigid bodies
  bool backwards = false;                        ///< true if frame b is on the parent
  double angle = 0.0;            ///< in the plane: rotation relative to the parent in the reference state [rad]
  bool by_newton_euler = false;  ///< true if the body has no own forces except weight and inertia
  double mass = 0.0;             ///< mass [kg]
  Mat3 inertia = Mat3::Zero();   ///< inertia about the centre of mass, in the axes of the body [kg m²]
  Index qn = 0, vn = 0;          ///< first coordinate and velocity in reduced vectors

  /// True if a joint carries the body; otherwise it is a root.
  bool carried() const { return row >= 0; }
};

/// Pose and twist of a body of a tree, and the motions that its joint permits.
template <class T>
struct TreeFrameOf {
  Vec<T, 3> r{0, 0, 0}, v{0, 0, 0}, w{0, 0, 0}, arm{0, 0, 0};  ///< origin [m], ṙ [m/s], ω [rad/s], D [m]; world axes
  Mat<T, 3, 3> A = identity<T>();                              ///< axes (3×3) in world axes
  Vec<T, 4> rotation{1, 0, 0, 0};                              ///< unit quaternion of A, in space only
  T angle = 0.0;                                               ///< rotation angle of A, in the plane only [rad]
  int velocities = 0;                                          ///< number of joint velocities: columns of S
  Mat<T, 6, 6> s = detail::zeros<Mat<T, 6, 6>>();              ///< S = [S_r; S_ω] by columns
  Mat<T, 6, 6> inverse = detail::zeros<Mat<T, 6, 6>>();        ///< (SᵀS)⁻¹
  Vec<T, 6> bias = detail::zeros<Vec<T, 6>>();                 ///< [b_r; b_ω]

  T* column(int k) { return s.data() + 6 * k; }              ///< column k of S
  T const* column(int k) const { return s.data() + 6 * k; }  ///< column k of S
};
using TreeFrame = TreeFrameOf<double>;  ///< frame in doubles

/// Workspace of a tree.
template <class T>
struct TreeStateOf {
  Sequence<TreeFrameOf<T>> frames;  ///< frame of each body
  Sequence<Vec<T, 6>> twists;       ///< workspace: a twist, wrench or rate of each body
  Sequence<Vec<T, 6>> residuals;    ///< result of the last `reduce_forces`: sum of [f; m] of each body and of all
                                    ///< bodies that it carries, about its origin; the joint transmits this sum
  Sequence<Vec<T, 6>> columns;      ///< for the floating ends: twist of the carried body per rate of each deformation
  Sequence<T> q, v, jacobian;       ///< workspace of the floating ends
};
using TreeState = TreeStateOf<double>;  ///< workspace in doubles

/// Inverts the leading n×n block of a positive definite matrix `a` in place, by Gauss–Jordan elimination.
template <class T>
void invert_leading(Mat<T, 6, 6>& a, int n) {
  for (int k = 0; k < n; ++k) {
    T const pivot = 1.0 / a(k, k);
    a(k, k) = 1.0;
    for (int j = 0; j < n; ++j) a(k, j) *= pivot;
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      T const f = a(i, k);
      a(i, k) = 0.0;
      for (int j = 0; j < n; ++j) a(i, j) -= f * a(k, j);
    }
  }
}

/// Inverts the leading n×n block of any matrix `a` in place, with pivoting. Returns −1 on success. Otherwise `a` is not
/// the inverse, and the result is the index of the first column without a pivot above 1e-14 `size`. \param size
/// magnitude of the entries
template <class T>
int invert_with_pivots(Mat<T, 6, 6>& a, int n, double size) {
  auto out = detail::zeros<Mat<T, 6, 6>>();
  for (int k = 0; k < 6; ++k) out(k, k) = 1.0;
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int r = k + 1; r < n; ++r)
      if (std::abs(a(r, k)) > std::abs(a(best, k))) best = r;
    if (!(std::abs(a(best, k)) > 1e-14 * size)) return k;
    T factors[6];
    for (int r = 0; r < n; ++r) factors[r] = a(r == best ? k : r, k);
    T const inverse = 1.0 / a(best, k);
    for (auto* const m : {&a, &out})
      for (int c = 0; c < n; ++c) {
        std::swap((*m)(k, c), (*m)(best, c));
        (*m)(k, c) *= inverse;
        for (int r = 0; r < n; ++r)
          if (r != k) (*m)(r, c) -= factors[r] * (*m)(k, c);
      }
  }
  a = out;
  return -1;
}

namespace detail {

/// Reads mass and inertia from the constant mass matrix of the body.
template <class B>
void read_masses(B const& body, TreeBody& out) {
  constexpr int n = B::element_columns;
  double q[7] = {};
  body.reference(std::span<double>(q, std::size_t(body.coordinates())));
  Mat<double, n, n> m;
  body.mass(0, std::span<double const>(q, std::size_t(body.coordinates())), m);
  out.mass = m(0, 0);
  constexpr int turns = n / 2;  // 3 of 6; 1 of 3
  for (int i = 0; i < turns; ++i)
    for (int j = 0; j < turns; ++j) out.inertia(3 - turns + i, 3 - turns + j) = m(n - turns + i, n - turns + j);
}

/// Matrix m of doubles, converted to scalar T. If T is double, returns m itself.
template <class T, class M>
decltype(auto) in_scalar(M const& m) {
  if constexpr (std::same_as<T, double>)
    return (m);
  else
    return m.template cast<T>().eval();
}
/// Product s n.
template <class T>
Vec<T, 3> times(Vec<T, 3> const& n, T const& s) {
  return {n[0] * s, n[1] * s, n[2] * s};
}

/// Multiplies A from the right by the rotation about axis k by `angle` [rad].
template <class T>
void turn_columns(int k, T angle, Mat<T, 3, 3>& a) {
  using std::cos, std::sin;
  int const i = (k + 1) % 3, j = (k + 2) % 3;
  T const c = cos(angle), s = sin(angle);
  for (int row = 0; row < 3; ++row) {
    T const x = a(row, i), y = a(row, j);
    a(row, i) = x * c + y * s;
    a(row, j) = y * c - x * s;
  }
}
/// Rotation matrix (3×3) of the rotation about axis k by `angle` [rad].
template <class T>
Mat<T, 3, 3> turn_about(int k, T angle) {
  Mat<T, 3, 3> m = identity<T>();
  turn_columns<T>(k, angle, m);
  return m;
}

/// Angle [rad] of the rotation turn(axis) in R = turn(axis), or in R = turn(axis) turn(other) if `followed` is true.
/// \param k index of the rotation in `motions`
template <class T>
double first_turn(int axis, Mat<T, 3, 3> const& r, bool followed, JointMotions const& motions, int k) {
  int const i = (axis + 1) % 3, j = (axis + 2) % 3;
  if (!followed) return std::atan2(r(j, i), r(i, i));
  // The direction of the second axis after the first rotation determines the angle.
  return motions.list[std::size_t(k + 1)].axis == i ? std::atan2(r(j, i), r(i, i)) : std::atan2(-r(i, j), r(j, j));
}

/// Frame that is moved along the motions of a joint in sequence, with its velocity, and its acceleration without the
/// terms in u̇.
template <class T>
struct RunnerOf {
  using Vec3 = Vec<T, 3>;
  using Mat3 = Mat<T, 3, 3>;

  Vec3 r, v, a;
  Mat3 A;
  Vec3 w, alpha;

  /// Moves the origin by the vector `along` to another point of the same rigid body.
  [[gnu::always_inline]] void go(Vec3 const& along) {
    Vec3 const rate = cross<T>(w, along), sideways = cross<T>(alpha, along), inwards = cross<T>(w, rate);
    for (int i = 0; i < 3; ++i) {
      r[i] += along[i];
      v[i] += rate[i];
      a[i] += sideways[i] + inwards[i];
    }
  }
  void slide(Vec3 const& n, T const& s, T const& rate) {
    go(times<T>(n, s));
    Vec3 const sideways = cross<T>(w, n);
    for (int i = 0; i < 3; ++i) {
      v[i] += rate * n[i];
      a[i] += 2.0 * rate * sideways[i];
    }
  }
  [[gnu::always_inline]] void turn(Vec3 const& spin) {
    Vec3 const sideways = cross<T>(w, spin);
    for (int i = 0; i < 3; ++i) {
      alpha[i] += sideways[i];
      w[i] += spin[i];
    }
  }
};

// Conversion between the full vectors of a model and the poses and twists of a tree's bodies.

/// Three entries of a full vector, from index `first` on.
template <class T>
Vec<T, 3> triple(VecXOf<T> const& x, Index first) {
  return {x[first], x[first + 1], x[first + 2]};
}
template <class T>
void set_pair(Vec<T, 3> const& a, Vec<T, 3> const& b, Vec<T, 6>& out) {
  for (int i = 0; i < 6; ++i) out[i] = i < 3 ? a[i] : b[i - 3];
}

/// [v; ω] of a body from a full vector of velocities or accelerations, in world axes.
template <class T>
[[gnu::always_inline]] inline Vec<T, 6> twist_of(TreeBody const& body, TreeFrameOf<T> const& f, VecXOf<T> const& x) {
  T const* const u = x.data() + body.v0;
  if (body.layout == RigidLayout::plane) return {u[0], u[1], 0.0, 0.0, 0.0, u[2]};
  Vec<T, 6> t;
  for (int i = 0; i < 3; ++i) {
    t[i] = u[i];
    t[3 + i] = f.A(i, 0) * u[3] + f.A(i, 1) * u[4] + f.A(i, 2) * u[5];
  }
  return t;
}
template <class T>
[[gnu::always_inline]] inline void put_twist(TreeBody const& body, TreeFrameOf<T> const& f, Vec<T, 6> const& t,
                                             VecXOf<T>& x) {
  T* const u = x.data() + body.v0;
  if (body.layout == RigidLayout::plane) {
    u[0] = t[0];
    u[1] = t[1];
    u[2] = t[5];
    return;
  }
  for (int i = 0; i < 3; ++i) {
    u[i] = t[i];
    u[3 + i] = f.A(0, i) * t[3] + f.A(1, i) * t[4] + f.A(2, i) * t[5];
  }
}

}  // namespace detail

/// Adds to t (6) the twist that a body has if it moves rigidly with its parent. \param parent twist (6) of the parent
/// \param arm vector from the parent's origin to the body's origin
template <class T>
void add_carried(Vec<T, 6> const& parent, Vec<T, 3> const& arm, Vec<T, 6>& t) {
  Vec<T, 3> const rate = cross<T>({parent[3], parent[4], parent[5]}, arm);
  for (int i = 0; i < 6; ++i) t[i] += parent[i];
  for (int i = 0; i < 3; ++i) t[i] += rate[i];
}
/// Adds the wrench w = [f; m] (6) of a body to the wrench `parent` (6) of its parent. \param arm vector from the
/// parent's origin to the body's origin
template <class T>
void add_back(Vec<T, 6> const& w, Vec<T, 3> const& arm, Vec<T, 6>& parent) {
  Vec<T, 3> const moment = cross<T>(arm, {w[0], w[1], w[2]});
  for (int i = 0; i < 6; ++i) parent[i] += w[i];
  for (int i = 0; i < 3; ++i) parent[3 + i] += moment[i];
}

namespace detail {

/// t += column · factor. `column` points to the first of six entries.
template <class T>
void add_column(T const* column, T factor, Vec<T, 6>& t) {
  for (int i = 0; i < 6; ++i) t[i] += column[i] * factor;
}
/// Dot product column · t. `column` points to the first of six entries.
template <class T>
T along_column(T const* column, Vec<T, 6> const& t) {
  T sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += column[i] * t[i];
  return sum;
}

/// Reads the frame of a body from full vectors. `write_frame` is the inverse operation.
template <class T>
void read_frame(TreeBody const& body, VecXOf<T> const& q, VecXOf<T> const& v, TreeFrameOf<T>& f) {
  if (body.layout == RigidLayout::plane) {
    f.r = {q[body.q0], q[body.q0 + 1], 0.0};
    f.angle = q[body.q0 + 2];
    f.A = turn_about<T>(2, f.angle);
  } else {
    f.r = triple<T>(q, body.q0);
    f.rotation = {q[body.q0 + 3], q[body.q0 + 4], q[body.q0 + 5], q[body.q0 + 6]};
    f.A = rotation_matrix<T>(f.rotation);
  }
  Vec<T, 6> const t = twist_of<T>(body, f, v);
  f.v = {t[0], t[1], t[2]};
  f.w = {t[3], t[4], t[5]};
}
template <class T>
void write_frame(TreeBody const& body, TreeFrameOf<T> const& f, VecXOf<T>& q, VecXOf<T>& v) {
  bool const plane = body.layout == RigidLayout::plane;
  for (int i = 0; i < 3; ++i) q[body.q0 + i] = plane && i == 2 ? f.angle : f.r[i];
  for (int i = 0; i < 4 && !plane; ++i) q[body.q0 + 3 + i] = f.rotation[i];
  put_twist<T>(body, f, {f.v[0], f.v[1], f.v[2], f.w[0], f.w[1], f.w[2]}, v);
}

}  // namespace detail
}  // namespace polybody
