#pragma once
/// \file
/// Warning of compliant joints that are too stiff for the step of an explicit integrator.
/// Theory: Eqs. 6.37, 11.37.

#include <polybody/integrators/integrator.hpp>

namespace polybody {
namespace detail {

/// Accelerations a due to compliant joints alone in a state: M a + Gᵀμ = w, G a = 0. The forces w = Σ Jᵀ S J y belong
/// to a motion y, with the Jacobian J of each joint and its derivative S = ck ∂λ/∂g + cd ∂λ/∂ġ for given ck, cd.
template <class Solver>
class CompliantMotion {
 public:
  /// `forward` must be factorised, and `system` evaluated, at the same state.
  CompliantMotion(System& system, ForwardDynamics<Solver>& forward)
      : system_(system),
        forward_(forward),
        y_(VecX::Zero(system.velocities())),
        w_(y_),
        other_(y_),
        mu_(VecX::Zero(system.rows())) {}

  struct Found {
    double omega2 = 0.0;  ///< ω² due to the stiffness k [1/s²]
    double rate = 0.0;    ///< decay rate due to the damping c [1/s]
    std::string joint;    ///< joint with the largest contribution
  };

  /// Power iteration for the largest yᵀ(ck k + cd c) y/yᵀM y. The result is a lower bound, which increases from
  /// iteration to iteration.
  Found largest(double ck, double cd) {
    for (Index i = 0; i < w_.size(); ++i) w_[i] = std::fmod(0.6180339887498949 * double(i + 1), 1.0) - 0.5;
    Found found;
    double before = 0.0, mass = 0.0;
    for (int pass = 0; pass < 200; ++pass) {
      forward_.response(system_, w_, y_, mu_);
      mass = y_.dot(w_);
      if (!(mass > 0.0)) return found;
      double const now = pull(ck, cd, w_, found.joint) / mass;
      if (!(now > 0.0) || (pass > 10 && now <= before * (1.0 + 1e-5))) break;
      before = now;
      w_ /= w_.norm();
    }
    std::string unused;
    found.omega2 = pull(1.0, 0.0, other_, unused) / mass;
    found.rate = pull(0.0, 1.0, other_, unused) / mass;
    return found;
  }

 private:
  /// Products of the joints' tangent blocks with y; blocks are added joint by joint.
  struct JointProducts {
    System const& system;
    VecX const& y;
    VecX& out;
    double sum = 0.0, largest = 0.0, part = 0.0;
    std::size_t block = 0;  ///< index of the joint's block among the rows of the data
    int left = 0;           ///< number of tangent blocks of this joint that are still to be added
    Index most = -1;

    void add(Index row, Index col, BlockView const& b) {
      if (left == 0) left = next_joint();
      for (Index i = 0; i < b.rows; ++i)
        for (Index j = 0; j < b.cols; ++j) {
          double const w = b(i, j) * y[col + j];
          out[row + i] += w;
          part += y[row + i] * w;
        }
      if (--left > 0) return;
      sum += part;
      if (part > largest) {
        largest = part;
        most = system.data().rows[block].owner;
      }
      ++block;
    }
    /// Returns the number of blocks of the next compliant joint.
    int next_joint() {
      part = 0.0;
      for (;; ++block) {
        ConstraintBlock<double> const& r = system.data().rows[block];
        if (r.source != ConstraintSource::compliant) continue;
        auto const& markers = system.data().markers;
        int const ends =
            int(markers[std::size_t(r.a.marker)].columns > 0) + int(markers[std::size_t(r.b.marker)].columns > 0);
        if (ends > 0) return ends * ends;
      }
    }
  };
  /// Computes out = Σ Jᵀ S J y. Returns yᵀ out; `most` becomes the name of the joint with the largest contribution to
  /// yᵀ out.
  double pull(double ck, double cd, VecX& out, std::string& most) {
    out.setZero();
    JointProducts products{system_, y_, out};
    system_.tangent_of(TangentPart::compliant_joints, {.damping = cd, .stiffness = ck}, products);
    if (products.most >= 0) most = system_.layout().joints[std::size_t(products.most)].name;
    return products.sum;
  }

  System& system_;
  ForwardDynamics<Solver>& forward_;
  VecX y_, w_, other_, mu_;
};

}  // namespace detail

/// Warning text if a step h exceeds the stability limit of integrator I for the compliant joints at x; otherwise empty.
/// ω² = k J M⁻¹ Jᵀ and d = c J M⁻¹ Jᵀ are Rayleigh quotients of a joint with the Jacobian J, thus lower bounds of the
/// model's largest values. A step with a warning is unstable; springs and elastic bodies may require a still smaller
/// step.
template <HasStabilityLimit I, class Solver>
std::string warn_of_step(System& system, ForwardDynamics<Solver>& forward, State const& x, double h) {
  bool const compliant = std::any_of(system.data().rows.begin(), system.data().rows.end(),
                                     [](auto const& block) { return block.source == ConstraintSource::compliant; });
  if (!compliant) return "";
  forward.hold(system, x.q, x.v, x.t);
  detail::CompliantMotion<Solver> motion(system, forward);
  std::string warning;
  double least = h;
  for (bool const by_damping : {false, true}) {
    auto const found = motion.largest(by_damping ? 0.0 : 1.0, by_damping ? 1.0 : 0.0);
    double const omega = std::sqrt(std::max(found.omega2, 0.0)), rate = std::max(found.rate, 0.0);
    if (omega == 0.0 && rate == 0.0) continue;
    double const limit = I::stable_step(omega, rate);
    if (!(limit < least)) continue;
    least = limit;
    warning = sentence_of({"The joint \"", found.joint, "\" is too ", (by_damping ? "strongly damped" : "stiff"),
                           " for ", I::name, ": k h²/m is ", found.omega2 * h * h, " and c h/m is ", rate * h,
                           " (stiffness k, damping c, step h, moved mass m), but the limits are ",
                           found.omega2 * limit * limit, " and ", rate * limit, ". Take steps of at most ", limit,
                           " s, a softer joint, or an implicit integrator."});
  }
  return warning;
}

}  // namespace polybody
