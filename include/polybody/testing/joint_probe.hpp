#pragma once
/// \file
/// Constraint function of a joint geometry of any type between two frames, and the derivatives that the laws compare.
///
/// For tests; not included by polybody.hpp.

#include <functional>
#include <vector>

#include <polybody/joints/constraint_terms.hpp>
#include <polybody/testing/frames.hpp>

namespace polybody::laws {

/// Pose of frame b relative to frame a that satisfies the constraint equations, and the free directions of b in this
/// pose.
struct Mate {
  Vec3 d = Vec3::Zero();      ///< (3) r_b − r_a in a's axes [m]
  Mat3 R = Mat3::Identity();  ///< (3×3) AaᵀAb, direction cosines
  MatX free_directions;       ///< (6×dof) columns [velocity; angular velocity] of b relative to a, in a's axes
};

/// Two frames with their twists.
struct FramePair {
  Frame<double> a, b;                       ///< frames of the joint's markers
  MatX free_directions = MatX::Zero(6, 0);  ///< (6×dof) free directions of b, world axes

  VecX twists() const;                           ///< (12) [ṙ; ω] of a, then of b, world axes
  FramePair moved_by(VecX const& motion) const;  ///< frames after a motion (12): [δr; φ] of a, then of b, world axes
};

/// Constraint function g of m equations, its Jacobian G = [Ga Gb] and its derivatives.
struct SeenTerms {
  VecX g, rate;  ///< (m) g and Φ_t = ∂g/∂t
  MatX G;        ///< (m×12)
  MatX slope;    ///< (m×12) ∂g/∂(motions), by dual numbers
  MatX G_rate;   ///< (m×12) Ġ at constant twists and constant time, by dual numbers
};

/// Joint geometry with its type erased.
struct AnyGeometry {
  /// Numbers of constraint equations: all, the leading ones in world axes, and the nonholonomic ones at the end.
  Index rows = 0, world_rows = 0, nonholonomic_equations = 0;
  bool planar = false;         ///< true if the frames stay in the plane z = 0
  bool opposite_ends = false;  ///< true if the geometry declares Gb = −Ga
  ///@{
  /// Constraint function at a time [s]. `terms_by_duals` also computes `slope` and `G_rate`.
  std::function<SeenTerms(FramePair const&, double)> constraint_function, terms_by_duals;
  ///@}
  std::function<VecX(FramePair const&, double)> gamma;                  ///< γ (m) at a time [s]
  std::function<MatX(FramePair const&, double, VecX const&)> gradient;  ///< (12×12) ∂(Gᵀλ)/∂(motions)
  std::function<Mate(Numbers&, double)> mate;                           ///< pose of b relative to a at a time [s]
};

/// Erases the type of a case's joint geometry.
template <class Case>
AnyGeometry any_geometry() {
  using G = decltype(Case::geometry());
  using D = Dual<12>;
  static constexpr int m = G::rows;
  static auto const geometry = Case::geometry();
  auto const constraint_function = [](FramePair const& p, double t) {
    ConstraintTerms<m> const x = geometry.template constraint_function<double>(p.a, p.b, t);
    SeenTerms seen{x.g, x.rate, MatX(m, 12), {}, {}};
    seen.G << x.Ga, x.Gb;
    return seen;
  };
  auto const by_duals = [constraint_function](FramePair const& p, double t) {
    SeenTerms seen = constraint_function(p, t);
    seen.slope.resize(m, 12);
    seen.G_rate.resize(m, 12);
    auto const see = [&](Frame<D> const& a, Frame<D> const& b, auto&& keep) {
      ConstraintTerms<m, D> const x = geometry.template constraint_function<D>(a, b, t);
      for (Index i = 0; i < m; ++i) keep(i, x);
    };
    Vec<D, 6> of_a, of_b;
    for (int i = 0; i < 6; ++i) {
      of_a[i] = D::variable(0.0, i);
      of_b[i] = D::variable(0.0, i + 6);
    }
    see(moved<D>(p.a, of_a), moved<D>(p.b, of_b),
        [&](Index i, auto const& x) { seen.slope.row(i) = x.g[i].d.matrix().transpose(); });
    D const time = D::variable(0.0, 0);
    see(later<D>(p.a, time), later<D>(p.b, time), [&](Index i, auto const& x) {
      for (int j = 0; j < 6; ++j) {
        seen.G_rate(i, j) = x.Ga(i, j).d[0];
        seen.G_rate(i, j + 6) = x.Gb(i, j).d[0];
      }
    });
    return seen;
  };
  return {.rows = m,
          .world_rows = Case::world_rows,
          .nonholonomic_equations = nonholonomic_equations<G>(),
          .planar = Case::planar,
          .opposite_ends = has_opposite_ends<G>(),
          .constraint_function = constraint_function,
          .terms_by_duals = by_duals,
          .gamma = [](FramePair const& p, double t) { return VecX(geometry.template gamma<double>(p.a, p.b, t)); },
          .gradient = [](FramePair const& p, double t,
                         VecX const& lambda) { return MatX(wrench_gradient<G>(geometry, p.a, p.b, t, lambda)); },
          .mate = &Case::mate};
}

inline VecX FramePair::twists() const {
  VecX v(12);
  v << twist(a), twist(b);
  return v;
}

inline FramePair FramePair::moved_by(VecX const& motion) const {
  return {moved<double>(a, motion.head<6>()), moved<double>(b, motion.tail<6>())};
}

}  // namespace polybody::laws
