#pragma once
/// \file
/// Free rotations of rigid bodies in explicit steps. Half steps of the angular velocity Ω (body axes) by v̇ do not
/// conserve the energy of a rotation: Ω˙ contains the product J⁻¹(Ω × J Ω), with the inertia tensor J. The methods of
/// this file integrate this product separately. Forces change Ω by h J⁻¹ m. Between these changes a body rotates
/// freely,
///   q₁ = q₀ ⊞ θ,   Π₁ = exp(−θ̃) Π₀,   θ = ½h J⁻¹(Π₀ + Π₁),   Π = J Ω in body axes [Simo & Wong 1991].
/// |Π|, the angular momentum in world axes and the energy ½ ΩᵀJΩ are conserved, because (Π₁ − Π₀)·θ = 0. A rotation
/// about a principal axis is exact. The step is of order two and reversible in time.
/// Theory: Eq. 6.38.

#include <cmath>
#include <limits>

#include <polybody/integrators/integrator.hpp>
#include <polybody/integrators/unknown_kinds.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/so3.hpp>

namespace polybody::detail {

/// Rigid bodies with the generalised velocities (ṙ, Ω), and their inertia tensors J. The functions change only the
/// entries of Ω of these bodies. A template, because programs that do not use it then compile faster.
template <class = void>
class FreeRotations {
 public:
  /// Reads J from the mass matrix. Bodies with a singular J or a variable mass are omitted. If policies eliminate
  /// coordinates of the model, all bodies are omitted.
  [[gnu::cold]] explicit FreeRotations(System& system) {
    if (system.step_coordinates()) return;
    UnknownPlaces const places = full_places(system.layout());
    Sequence<Body> all;
    Sink sink{all, Sequence<Index>(std::size_t(system.velocities()), -1)};
    for (BodyLayout const& b : system.layout().bodies) {
      if (!b.constant_mass || b.changes || b.planar || b.coordinates != 7 || b.velocities != 6) continue;
      if (places.of_q[std::size_t(b.q0 + 3)].kind != UnknownKind::rotation ||
          places.of_v[std::size_t(b.v0 + 3)].kind != UnknownKind::rotation)
        continue;
      for (Index i = 3; i < 6; ++i) sink.body_of[std::size_t(b.v0 + i)] = Index(all.size());
      all.push_back({.v = b.v0 + 3});
    }
    if (all.empty()) return;
    system.masses(sink);
    for (Body& b : all) {
      double const size = b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2);
      if (!(b.inertia.determinant() > 1e-14 * size * size * size)) continue;
      b.inverse = b.inertia.inverse();
      bodies_.push_back(b);
    }
  }

  bool empty() const { return bodies_.empty(); }  ///< true if no body of the model rotates by this method

  /// Adds J⁻¹(Ω × J Ω) to Ω˙ in a. The result is J⁻¹ m, with the moment m of the forces.
  void add_gyroscopic(VecX const& v, VecX& a) const {
    for (Body const& b : bodies_) put(b, at(b, a) + gyroscopic(b, at(b, v)), a);
  }
  /// Subtracts J⁻¹(Ω × J Ω) from J⁻¹ m in a, with the moment m of the forces. The result is Ω˙.
  void subtract_gyroscopic(VecX const& v, VecX& a) const {
    for (Body const& b : bodies_) put(b, at(b, a) - gyroscopic(b, at(b, v)), a);
  }
  /// Replaces h Ω in `moved` (velocities times h) by the rotation vectors θ. \throws NewtonConvergenceFailure if θ does
  /// not converge or exceeds 3 rad in the step to t [s].
  void find_rotations(System const& system, double t, VecX& moved) const {
    for (Body const& b : bodies_) {
      Vec3 const turn = at(b, moved);
      Vec3 theta = turn;
      if (!solve(b, turn, theta)) refuse(system, b, turn, t);
      put(b, theta, moved);
    }
  }
  /// Replaces Ω in `v` by its value after the rotation by θ, which `moved` contains.
  void carry(VecX const& moved, VecX& v) const {
    for (Body const& b : bodies_)
      put(b, product<double, 1>(b.inverse, carried(at(b, moved), product<double, 1>(b.inertia, at(b, v)))), v);
  }

 private:
  static constexpr double farthest = 3.0;  ///< largest rotation in a step [rad]; from π on θ is not unique
  struct Body {
    Index v = 0;  ///< index of the first entry of Ω in v
    Mat3 inertia = Mat3::Zero(), inverse = Mat3::Zero();
  };
  /// Collects the inertia tensors J from the mass matrix M.
  struct Sink {
    Sequence<Body>& bodies;
    Sequence<Index> body_of;  ///< body of each velocity; −1 for none
    void add(Index row, Index col, BlockView const& m) {
      for (Index j = 0; j < m.cols; ++j)
        for (Index i = 0; i < m.rows; ++i) {
          if (row + i >= Index(body_of.size()) || col + j >= Index(body_of.size())) continue;
          Index const k = body_of[std::size_t(row + i)];
          if (k < 0 || k != body_of[std::size_t(col + j)]) continue;
          Body& b = bodies[std::size_t(k)];
          b.inertia(row + i - b.v, col + j - b.v) += m(i, j);
        }
    }
  };

  static Vec3 at(Body const& b, VecX const& x) { return {x[b.v], x[b.v + 1], x[b.v + 2]}; }
  static void put(Body const& b, Vec3 const& value, VecX& x) {
    for (Index i = 0; i < 3; ++i) x[b.v + i] = value[i];
  }
  static Vec3 gyroscopic(Body const& b, Vec3 const& spin) {
    return product<double, 1>(b.inverse, cross<double>(spin, product<double, 1>(b.inertia, spin)));
  }
  /// exp(−θ̃) Π.
  static Vec3 carried(Vec3 const& theta, Vec3 const& momentum) {
    return product<double, 1>(exp_so3<double>(Vec3(-theta)), momentum);
  }
  /// Solves θ − ½ J⁻¹(Π + exp(−θ̃) Π) = 0 with Π = J `turn` for θ by Newton's method, with
  ///   d(exp(−θ̃) Π) = (exp(−θ̃) Π) × Jr(θ) dθ.
  static bool solve(Body const& b, Vec3 const& turn, Vec3& theta) {
    Vec3 const before = product<double, 1>(b.inertia, turn);
    double last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 30; ++k) {
      Vec3 const after = carried(theta, before);
      Vec3 const open = theta - 0.5 * (turn + product<double, 1>(b.inverse, after));
      Mat3 const slope = product<double, 3>(b.inverse, skew_product<double, 3>(after, right_jacobian<double>(theta)));
      Mat3 const matrix = Mat3::Identity() - 0.5 * slope;
      Vec3 const correction = matrix.inverse() * open;
      double const size = std::sqrt(squared_norm<double>(correction));
      if (!(size <= 10.0)) return false;
      theta -= correction;
      double const angle = std::sqrt(squared_norm<double>(theta));
      bool const ends = size <= 1e-12 * angle && !(size < 0.1 * last);
      if (size <= 1e-15 * angle || ends) return angle <= farthest;
      last = size;
    }
    return false;
  }
  [[noreturn, gnu::cold]] static void refuse(System const& system, Body const& b, Vec3 const& turn, double t) {
    throw NewtonConvergenceFailure(
        "rotation.not_converged",
        {"The rotation of ", ErrorObject{system.name_of(b.v)}, " in the step to t = ", ErrorTime{t},
         " s does not converge, or exceeds ", farthest, " rad: the angular velocity times the step is ",
         ErrorValue{std::sqrt(squared_norm<double>(turn))}, " rad. Take a smaller step."});
  }

  Sequence<Body> bodies_;
};

/// Memory of an explicit step with free rotations.
template <class Solver>
struct RotatingStep : ExplicitStep<Solver> {
  FreeRotations<> rotations;
  VecX applied;  ///< v̇ at the start of a step, with J⁻¹ m in place of Ω˙

  explicit RotatingStep(System& s) : ExplicitStep<Solver>(s), rotations(s), applied(this->v) {}

  /// Computes `applied` at x.
  void find_applied(State const& x) {
    applied = x.a;
    rotations.add_gyroscopic(x.v, applied);
  }
  /// Computes q = q₀ ⊞ dq in the step to t [s]. On entry, v contains the velocities before the free rotations, and dq
  /// is h v. On return, v contains the velocities after the free rotations, and dq contains the rotation vectors θ.
  void move(System& system, State const& x, double t) {
    rotations.find_rotations(system, t, this->dq);
    system.plus(x.q, this->dq, this->q);
    rotations.carry(this->dq, this->v);
  }
};

}  // namespace polybody::detail
