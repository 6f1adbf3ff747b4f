#pragma once
/// \file
/// The parts of a `JointTree`: its bodies, where they are, and how a frame runs through the motions of a joint.

#include <string>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/joint_motion.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/vector_algebra.hpp>

namespace polybody {

/// A joint of one turn x in constants: in the parent's axes n, and in space the quaternion from the parent's axes to
/// the body's, still cos(x/2) + turning sin(x/2).
struct JointTurn {
  bool only = false;                                      ///< the joint is of this kind
  Vec<double, 3> axis{0, 0, 0};                           ///< n, unit vector in the parent's axes
  Vec<double, 4> still{1, 0, 0, 0}, turning{0, 0, 0, 0};  ///< quaternions of the turn, (w, x, y, z)
};

/// A body of a tree: how its pose is written, and the joint that carries it.
struct TreeBody {
  std::string name;                              ///< its name in messages
  RigidLayout layout = RigidLayout::quaternion;  ///< how its coordinates are written
  Index q0 = 0, v0 = 0;                          ///< in whole vectors
  Index row = -1;                                ///< first of the joint's rows; −1: a root, which nothing carries
  Index parent = -1;                             ///< in the tree; −1: the ground
  Placement from = {};                           ///< the joint's frame in the parent's axes
  Placement to = {};                             ///< the joint's frame in the body's own axes
  bool from_turned = true, to_turned = true;     ///< axes of these that are not the body's
  JointMotions motions = {};                     ///< from frame a to frame b
  Index from_end = -1, to_end = -1;              ///< in the tree's floating ends, for frames on bodies that deform
  Index deformations = 0;                        ///< coordinates of the body behind those of its frame
  JointTurn turn = {};                           ///< of a joint of one turn between rigid bodies
  bool backwards = false;                        ///< frame b is the parent's
  double angle = 0.0;            ///< in the plane: its turn relative to the parent in the reference [rad]
  bool by_newton_euler = false;  ///< nothing but weight and its inertia moves it where nothing acts
  double mass = 0.0;             ///< [kg]
  Mat3 inertia = Mat3::Zero();   ///< about the centre of mass, in the body's own axes
  Index qn = 0, vn = 0;          ///< in narrow vectors

  /// Whether a joint carries it; else it is a root.
  bool carried() const { return row >= 0; }
};

/// Where a body of a tree is and how it may move.
template <class T>
struct TreeFrameOf {
  Vec<T, 3> r{0, 0, 0}, v{0, 0, 0}, w{0, 0, 0}, arm{0, 0, 0};  ///< origin [m], ṙ [m/s], ω [rad/s], D [m]; world axes
  Mat<T, 3, 3> A = identity<T>();                              ///< its axes (3×3) in world axes
  Vec<T, 4> rotation{1, 0, 0, 0};                              ///< unit quaternion of A; in space only
  T angle = 0.0;                                               ///< of the plane: the turn of A [rad]
  int velocities = 0;                                          ///< how many its joint has: columns of S
  Mat<T, 6, 6> s = detail::zeros<Mat<T, 6, 6>>();              ///< S = [S_r; S_ω] by columns
  Mat<T, 6, 6> inverse = detail::zeros<Mat<T, 6, 6>>();        ///< (SᵀS)⁻¹
  Vec<T, 6> bias = detail::zeros<Vec<T, 6>>();                 ///< [b_r; b_ω]

  T* column(int k) { return s.data() + 6 * k; }              ///< column k of S
  T const* column(int k) const { return s.data() + 6 * k; }  ///< column k of S
};
using TreeFrame = TreeFrameOf<double>;  ///< in doubles

/// Scratch of a tree.
template <class T>
struct TreeStateOf {
  Sequence<TreeFrameOf<T>> frames;  ///< of each body
  Sequence<Vec<T, 6>> twists;       ///< scratch: a twist, wrench or rate of each body
  Sequence<Vec<T, 6>> held;         ///< as of the last `reduce_forces`: the wrench [f; m] about its frame's origin with
                                    ///< which a body and all that it carries are out of balance, which its joint holds
  Sequence<Vec<T, 6>> columns;      ///< of the floating ends: what each deformation moves of the carried body
  Sequence<T> q, v, jacobian;       ///< scratch of the floating ends
};
using TreeState = TreeStateOf<double>;  ///< in doubles

/// a → a⁻¹ for the leading n×n of a positive definite matrix, by Gauss–Jordan elimination.
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

/// The same of any matrix a, by pivoting. −1, or the column of the n that has no pivot beside entries of this size.
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

/// The matrix m of doubles in the scalar T: itself where that is double.
template <class T, class M>
decltype(auto) in_scalar(M const& m) {
  if constexpr (std::same_as<T, double>)
    return (m);
  else
    return m.template cast<T>().eval();
}
/// s n.
template <class T>
Vec<T, 3> times(Vec<T, 3> const& n, T const& s) {
  return {n[0] * s, n[1] * s, n[2] * s};
}

/// A · (the turn by an angle about axis k of the frame itself).
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
/// That turn itself.
template <class T>
Mat<T, 3, 3> turn_about(int k, T angle) {
  Mat<T, 3, 3> m = identity<T>();
  turn_columns<T>(k, angle, m);
  return m;
}

/// The first of one or two turns that make R: R = turn(axis) or turn(axis) turn(other).
template <class T>
double first_turn(int axis, Mat<T, 3, 3> const& r, bool followed, JointMotions const& motions, int k) {
  int const i = (axis + 1) % 3, j = (axis + 2) % 3;
  if (!followed) return std::atan2(r(j, i), r(i, i));
  // the second axis, as the first turn leaves it
  return motions.list[std::size_t(k + 1)].axis == i ? std::atan2(r(j, i), r(i, i)) : std::atan2(-r(i, j), r(j, j));
}

/// A frame on its way through the motions of a joint, with what its own acceleration has beyond u̇.
template <class T>
struct RunnerOf {
  using Vec3 = Vec<T, 3>;
  using Mat3 = Mat<T, 3, 3>;

  Vec3 r, v, a;
  Mat3 A;
  Vec3 w, alpha;

  /// To a point of the same rigid piece, `along` away.
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

}  // namespace detail

}  // namespace polybody
