#pragma once
/// \file
/// Maps between reduced velocities u and full velocities v = T u, for models with policies that eliminate unknowns. T
/// is the matrix of joint trees (`JointTree`) and of linear joints (`LinearElimination`). Steps use doubles;
/// derivatives of steps use the same maps with dual numbers or with a tape.
/// Theory: Eq. 5.10.

#include <polybody/elimination/reduction.hpp>
#include <polybody/system/coordinates.hpp>

namespace polybody {

// Joint coordinates of a `JointTree`: computation from full coordinates, increments (⊞) and rates. A carried body has
// the coordinates of its joint's motions, followed by those of its deformation.

namespace detail {

/// Calls f(motion, q, v) for each joint motion with the reduced indices of its first coordinate and velocity.
template <class T, class F>
void for_each_motion(JointTreeOf<T> const& tree, F&& f) {
  for (TreeBody const& body : tree.bodies) {
    Index q = body.qn, v = body.vn;
    for (JointMotion const& m : body.motions) {
      f(m, q, v);
      q += m.coordinates();
      v += m.velocities();
    }
  }
}
/// Calls f(q, v) for each deformation of the carried bodies with the reduced indices of its coordinate and velocity.
template <class T, class F>
void for_each_deformation(JointTreeOf<T> const& tree, F&& f) {
  for (TreeBody const& body : tree.bodies)
    for (Index k = 0; k < body.deformations && body.carried(); ++k)
      f(body.qn + body.motions.coordinates() + k, body.vn + body.motions.velocities() + k);
}

/// Positions (3) and axes (3×3) of frames a and b of a joint in world axes; in the plane also the angle of b relative
/// to a [rad].
template <class T>
struct JointFrames {
  Vec<T, 3> ra, rb;
  Mat<T, 3, 3> a, b;
  T angle;
};
template <class T>
JointFrames<T> joint_frames(JointTreeOf<T> const& tree, TreeBody const& body, VecXOf<T> const& q, VecXOf<T> const& v,
                            TreeStateOf<T>& s, std::size_t i) {
  TreeFrameOf<T> const &f = s.frames[i], &p = tree.parent_of(body, s);
  auto const point = [](TreeFrameOf<T> const& at, Vec<T, 3> const& u) {
    Vec<T, 3> r = product<T, 1>(at.A, u);
    for (int k = 0; k < 3; ++k) r[k] += at.r[k];
    return r;
  };
  JointFrames<T> j{point(p, body.from.origin), point(f, body.to.origin), product<T>(p.A, body.from.axes),
                   product<T>(f.A, body.to.axes), f.angle - p.angle - body.angle};
  auto const bent = [&](Index e, Vec<T, 3>& r, Mat<T, 3, 3>& axes) {
    FloatingEndOf<T> const& end = tree.ends[std::size_t(e)];
    MarkerKinematics<T> const m = place_end<T>(end, q.data() + end.q0, v.data() + end.v0, s);
    r = m.frame.r;
    axes = m.frame.A;
    return end.layout == RigidLayout::plane ? bent_by<T>(end, axes, q[end.q0 + 2]) : T(0.0);
  };
  if (body.from_end >= 0) j.angle -= bent(body.from_end, j.ra, j.a);
  if (body.to_end >= 0) j.angle += bent(body.to_end, j.rb, j.b);
  if (body.backwards) {
    std::swap(j.ra, j.rb);
    std::swap(j.a, j.b);
    j.angle = -j.angle;
  }
  return j;
}

}  // namespace detail

/// Computes the joint coordinates qn from the full coordinates q. \param v full velocities
template <class T>
void read_coordinates(JointTreeOf<T> const& tree, VecXOf<T> const& q, VecXOf<T> const& v, TreeStateOf<T>& s,
                      VecXOf<T>& qn) {
  for (std::size_t i = 0; i < tree.bodies.size(); ++i) detail::read_frame<T>(tree.bodies[i], q, v, s.frames[i]);
  for (std::size_t i = 0; i < tree.bodies.size(); ++i) {
    TreeBody const& body = tree.bodies[i];
    if (!body.carried()) continue;
    detail::JointFrames<T> const j = detail::joint_frames<T>(tree, body, q, v, s, i);
    Vec<T, 3> const d = transposed_product<T, 3, 1>(j.a, difference<T>(j.rb, j.ra));
    Mat<T, 3, 3> turned = transposed_product<T>(j.a, j.b);
    T* x = qn.data() + body.qn;
    for (int k = 0; k < body.motions.count; ++k) {
      JointMotion const& m = body.motions.list[std::size_t(k)];
      switch (m.kind) {
        case JointMotion::Kind::slide:
          *x = d[m.axis];
          break;
        case JointMotion::Kind::turn:
          *x = body.layout == RigidLayout::plane
                   ? j.angle * j.a(2, m.axis)
                   : detail::first_turn<T>(m.axis, turned, k + 1 < body.motions.count, body.motions, k);
          turned = product<T>(detail::turn_about<T>(m.axis, -*x), turned);
          break;
        case JointMotion::Kind::screw: {  // the translation determines the number of full turns
          double const rest = detail::first_turn<T>(m.axis, turned, false, body.motions, k),
                       full = 2.0 * std::numbers::pi;
          *x = rest + full * std::round((d[m.axis] / m.pitch - rest) / full);
          break;
        }
        case JointMotion::Kind::ball: {
          Quaternion<T> const p4 = quaternion_of(turned);
          for (int l = 0; l < 4; ++l) x[l] = p4[l];
        }
      }
      x += m.coordinates();
    }
  }
}

/// out = q ⊞ δ for the joint coordinates.
template <class T>
void plus(JointTreeOf<T> const& tree, VecXOf<T> const& q, VecXOf<T> const& delta, VecXOf<T>& out) {
  detail::for_each_deformation(tree, [&](Index qn, Index vn) { out[qn] = q[qn] + delta[vn]; });
  detail::for_each_motion(tree, [&](JointMotion const& m, Index qn, Index vn) {
    if (m.kind != JointMotion::Kind::ball) {
      out[qn] = q[qn] + delta[vn];
      return;
    }
    set_quaternion_plus<T>(q.data() + qn, delta.data() + vn, out.data() + qn);
  });
}
/// out = rate of δ in q ⊞ δ, while the joint coordinates move with velocities v.
template <class T>
void local_rate(JointTreeOf<T> const& tree, VecXOf<T> const& delta, VecXOf<T> const& v, VecXOf<T>& out) {
  detail::for_each_deformation(tree, [&](Index, Index vn) { out[vn] = v[vn]; });
  detail::for_each_motion(tree, [&](JointMotion const& m, Index, Index vn) {
    if (m.kind != JointMotion::Kind::ball) {
      out[vn] = v[vn];
      return;
    }
    Vec<T, 3> const rate = product<T, 1>(right_jacobian_inverse<T>({delta[vn], delta[vn + 1], delta[vn + 2]}),
                                         Vec<T, 3>(v[vn], v[vn + 1], v[vn + 2]));
    for (int i = 0; i < 3; ++i) out[vn + i] = rate[i];
  });
}

/// `rate` = q˙ of the joint coordinates; for a spherical motion ½ q ∘ (0, Ω), with its three velocities Ω.
template <class T>
void coordinate_rates(JointTreeOf<T> const& tree, VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T>& rate) {
  detail::for_each_deformation(tree, [&](Index qn, Index vn) { rate[qn] = v[vn]; });
  detail::for_each_motion(tree, [&](JointMotion const& m, Index qn, Index vn) {
    if (m.kind != JointMotion::Kind::ball) {
      rate[qn] = v[vn];
      return;
    }
    Quaternion<T> const moved =
        quaternion_product<T>({q[qn], q[qn + 1], q[qn + 2], q[qn + 3]}, {0.0, v[vn], v[vn + 1], v[vn + 2]});
    for (int i = 0; i < 4; ++i) rate[qn + i] = 0.5 * moved[i];
  });
}

namespace detail {

// Multipliers of an eliminated joint from its reaction wrench.

/// Adds to λ (m entries) the correction δ that minimises ‖Gᵀδ + `residual`‖. \param map G of the carried body, m×6 by
/// columns, about the marker \param residual residual wrench [f; m] of the body about its centre of mass \param arm
/// vector from the centre of mass to the marker
template <class T>
void add_multipliers_that_hold(int m, T const* map, Vec<T, 6> residual, Vec<T, 3> const& arm, T* lambda) {
  for (int k = 0; k < 3; ++k)
    residual[3 + k] -= arm[(k + 1) % 3] * residual[(k + 2) % 3] - arm[(k + 2) % 3] * residual[(k + 1) % 3];
  auto gram = zeros<Mat<T, 6, 6>>();
  for (int k = m; k < 6; ++k) gram(k, k) = 1.0;
  T right[6] = {};
  for (int k = 0; k < m; ++k) {
    for (int l = 0; l < 6; ++l) right[k] -= map[m * l + k] * residual[l];
    for (int j = 0; j < m; ++j) {
      T sum = 0.0;
      for (int l = 0; l < 6; ++l) sum += map[m * l + k] * map[m * l + j];
      gram(k, j) = sum;
    }
  }
  invert_leading(gram, m);
  for (int k = 0; k < m; ++k) {
    T sum = 0.0;
    for (int j = 0; j < m; ++j) sum += gram(k, j) * right[j];
    lambda[k] += sum;
  }
}

/// Maps v = T u, v̇ = T u̇ + b and multiplication by Tᵀ, in the state of the last `expand`. \tparam Solution solution
/// method of the equations of joint coordinates; void if there are only linear joints \tparam T scalar
template <class Solution, StateScalar T = double>
class CoordinateMaps : public StepCoordinates<T> {
  using Vector = VecXOf<T>;

 public:
  /// \throws InvalidInput if joints with joint coordinates close a loop. \throws InconsistentInitialConditions if
  /// linear joints contradict each other.
  template <class M>
  explicit CoordinateMaps(M const& model)
      : reduction_(model),
        state_(reduction_.tree().state()),
        q_(model.reference_state().q.template cast<T>()),
        v_(Vector::Constant(model.velocities(), T(0.0))),
        a_(v_),
        last_r_(v_),
        reduced_(Vector::Constant(reduction_.velocities(), T(0.0))) {}

  /// Layout of reduced vectors. `ReducedCoordinates` adds the linear equations of a time step.
  ReducedLayout reduced_layout() const {
    ReducedLayout n{.coordinates = reduction_.coordinates(),
                    .velocities = reduction_.velocities(),
                    .rows = reduction_.rows(),
                    .nonholonomic_equations = reduction_.nonholonomic_equations(),
                    .places = reduction_.places(),
                    .remaining_equations = reduction_.remaining_equations(),
                    .keeps_mass_constant = !has_tree};
    for (Index i = 0; i < n.velocities; ++i) n.full_velocity.push_back(reduction_.full_velocity(i));
    if constexpr (has_tree)
      for_each_motion(reduction_.tree(), [&](JointMotion const& m, Index q, Index v) {
        if (m.kind != JointMotion::Kind::slide) n.turns.push_back({q, v, m.coordinates(), m.velocities()});
      });
    return n;
  }

  void expand(Vector const& q, Vector const& v, Vector& full_q, Vector& full_v) override {
    place(q, v);
    full_q = q_;
    full_v = v_;
  }
  void expand_rates(Vector const& u, bool bias, Vector& out) override {
    reduction_.expand_velocities(u, out);
    reduction_.linear().expand_rates(out);
    if constexpr (has_tree) reduction_.tree().expand_rates(state_, u, bias, out);
  }
  void reduce(Vector& r, Vector& out) override {
    last_r_ = r;
    reduction_.linear().reduce_forces(r);
    if constexpr (has_tree) reduction_.tree().reduce_forces(state_, r, out);
    reduction_.reduce_velocities(r, out);
  }
  void recover_multipliers(Data<T> const& data, Vector& lambda) override {
    reduction_.linear().multipliers(last_r_, lambda);
    if constexpr (has_tree) {
      a_ = last_r_;
      reduction_.tree().reduce_forces(state_, a_, reduced_);
      for (ConstraintBlock<T> const& block : data.rows)
        if (block.source == ConstraintSource::joint && reduction_.carried_by(block.row) >= 0) {
          std::size_t const i = std::size_t(reduction_.carried_by(block.row));
          ConstraintSide<T> const& end = reduction_.tree().bodies[i].backwards ? block.a : block.b;
          Vec<T, 3> const& at = data.markers[std::size_t(end.marker)].frame.r;
          add_multipliers_that_hold(block.rows, end.map, state_.residuals[i], difference<T>(at, state_.frames[i].r),
                                    lambda.data() + block.row);
        }
    }
  }
  void plus(Vector const& q, Vector const& delta, Vector& sum) const override {
    if constexpr (has_tree) polybody::plus(reduction_.tree(), q, delta, sum);
  }
  void local_rate(Vector const& delta, Vector const& v, Vector& rate) const override {
    if constexpr (has_tree) polybody::local_rate(reduction_.tree(), delta, v, rate);
  }

 protected:
  static constexpr bool has_tree = !std::is_void_v<Solution>;

  /// Computes q_, v_ and the state of the tree from reduced coordinates and velocities.
  void place(Vector const& q, Vector const& v) {
    reduction_.expand_coordinates(q, q_);
    reduction_.expand_velocities(v, v_);
    reduction_.linear().expand_coordinates(q_);
    reduction_.linear().expand_rates(v_);
    if constexpr (has_tree) reduction_.tree().expand_state(q, v, q_, v_, state_);
  }

  ReductionOf<T> reduction_;
  TreeStateOf<T> state_;
  Vector q_, v_, a_;  // full vectors
  Vector last_r_;     // full residual of the last `reduce`
  Vector reduced_;
};

}  // namespace detail

}  // namespace polybody
