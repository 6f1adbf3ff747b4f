#pragma once
/// \file
/// System from equations of a user, without bodies and joints, for the integrators and solvers of the library.
/// `EnergyMomentum` and `EnergyDecaying` do not support such a system.
///   struct Oscillator {
///     Index velocities() const { return 1; }
///     void mass(VecX const& q, MatX& m) const { m(0, 0) = 2.0; }
///     void force(VecX const& q, VecX const& v, double t, VecX& f) const { f[0] = -50.0 * q[0]; }
///   };
///   System system = system_of(Oscillator{});
/// First-order equations ż = h(z, t), alone or together with equations of motion:
///   struct VanDerPol {
///     Index states() const { return 2; }
///     void rates(VecX const& z, double t, VecX& h) const { h << z[1], (1.0 - z[0] * z[0]) * z[1] - z[0]; }
///   };

#include <polybody/system/system.hpp>

namespace polybody {

/// First-order equations ż = h(z, t). `rates` overwrites h (n).
template <class E>
concept UserFirstOrderEquations = requires(E const e, VecX const& z, double t, VecX& h) {
  { e.states() } -> std::convertible_to<Index>;
  e.rates(z, t, h);
};
/// Equations of motion M(q) v̇ = f(q, v, z, t), q̇ = v with first-order equations ż = h(q, v, z, t). The functions
/// overwrite the mass matrix (n×n), the force (n) and the rates.
template <class E>
concept UserMechanicsWithStates = requires(E const e, VecX const& x, double t, MatX& m, VecX& f) {
  { e.velocities() } -> std::convertible_to<Index>;
  { e.states() } -> std::convertible_to<Index>;
  e.mass(x, m);
  e.force(x, x, x, t, f);
  e.rates(x, x, x, t, f);
};
/// Equations of motion M(q) v̇ = f(q, v, t), q̇ = v. The functions overwrite the mass matrix (n×n) and the force (n).
template <class E>
concept UserMechanics = requires(E const e, VecX const& x, double t, MatX& m, VecX& f) {
  { e.velocities() } -> std::convertible_to<Index>;
  e.mass(x, m);
  e.force(x, x, t, f);
};
/// Equations that `system_of` accepts.
template <class E>
concept UserEquations = UserMechanics<E> || UserMechanicsWithStates<E> || UserFirstOrderEquations<E>;
/// Equations with the tangent −(ck ∂f/∂q + cd ∂f/∂v) (n×n) for implicit steps, with given ck, cd. Central differences
/// replace a missing tangent, and the tangent of equations with first-order states.
template <class E>
concept HasForceTangent = requires(E const e, VecX const& x, double t, MatX& k) { e.tangent(x, x, t, 1.0, 1.0, k); };
/// Equations with constraint equations Φ(q, t) = 0, with G = ∂Φ/∂q, Φ_t, and γ in Φ̈ = G v̇ + γ.
template <class E>
concept HasConstraintEquations = requires(E const e, VecX const& x, double t, MatX& g, VecX& phi) {
  { e.rows() } -> std::convertible_to<Index>;
  e.violation(x, t, phi);
  e.jacobian(x, t, g);
  e.rate(x, t, phi);
  e.gamma(x, x, t, phi);
};

namespace detail {

template <UserEquations E>
struct UserOperations final : ModelOperations<double> {
  E mechanics;
  Index n = 0, states = 0;  ///< number of velocities without first-order states; number of these states
  mutable MatX m, k, m_n;   ///< matrices of all unknowns; m_n, k_n: of the velocities only
  mutable VecX f, ma;
  mutable VecX v_n, z, f_n, h;  ///< parts of v and f
  mutable MatX g, k_n;
  mutable VecX phi, rate, x_near, f_near;

  explicit UserOperations(E e) : mechanics(std::move(e)) {
    if constexpr (requires { mechanics.velocities(); }) n = mechanics.velocities();
    if constexpr (requires { mechanics.states(); }) states = mechanics.states();
    m.setIdentity(n + states, n + states);
    k = m;
    m_n = k_n = MatX::Zero(n, n);
    f.setZero(n + states);
    ma = f_near = f;
    v_n = f_n = VecX::Zero(n);
    z = h = VecX::Zero(states);
    if constexpr (HasConstraintEquations<E>) {
      g.setZero(mechanics.rows(), n);
      phi.setZero(mechanics.rows());
      rate = phi;
    }
  }

  bool provides(Capabilities groups) const override {
    return contains(Capabilities::implicit_step | Capabilities::coordinate_rates, groups);
  }
  void evaluate_marker(At<double>, Data<double>&) const override {}
  void push_forces(double, Data<double>&) const override {}
  void share_loops(Data<double>&, Workers&) const override {}
  void compliant_tangents(TangentCoefficients const&, Data<double>&, BlockSink&) const override {}
  void force_tangents(double, double, TangentCoefficients const&, Data<double>&, BlockSink&) const override {}
  void joint_stiffness(At<double>, VecX const&, TangentCoefficients const&, Data<double>&, BlockSink&) const override {}
  void load_stiffness(At<double>, TangentCoefficients const&, Data<double>&, BlockSink&) const override {}
  void evaluate_constraints(At<double> at, Data<double>&) const override {
    if constexpr (HasConstraintEquations<E>) {
      mechanics.violation(at.q, at.t, phi);
      mechanics.jacobian(at.q, at.t, g);
      mechanics.rate(at.q, at.t, rate);
    }
  }
  void measure_gamma(At<double> at, Data<double> const&, VecX& out) const override {
    if constexpr (HasConstraintEquations<E>) {
      v_n = at.v.head(n);
      mechanics.gamma(at.q, v_n, at.t, out);
    }
  }
  /// Evaluates M. The diagonal entries of first-order states are one.
  void find_mass(VecX const& q) const {
    if constexpr (!UserFirstOrderEquations<E>) {
      mechanics.mass(q, m_n);
      m.topLeftCorner(n, n) = m_n;
    }
  }
  void find_force(VecX const& q, VecX const& v, double t, VecX& out) const {
    if constexpr (UserMechanicsWithStates<E>) {
      v_n = v.head(n);
      z = v.tail(states);
      mechanics.force(q, v_n, z, t, f_n);
      mechanics.rates(q, v_n, z, t, h);
      out << f_n, h;
    } else if constexpr (UserFirstOrderEquations<E>) {
      mechanics.rates(v, t, out);
    } else {
      mechanics.force(q, v, t, out);
    }
  }
  void element_forces(At<double> at, VecX const& a, double, Data<double>&, VecX& r) const override {
    find_mass(at.q);
    find_force(at.q, at.v, at.t, f);
    ma.noalias() = m * a;
    r += ma;
    r -= f;
  }
  void masses(At<double> at, Data<double>&, BlockSink& sink) const override {
    find_mass(at.q);
    sink.add(0, 0, m);
  }
  void element_tangents(At<double> at, TangentCoefficients const& c, Data<double>&, BlockSink& sink) const override {
    find_mass(at.q);
    if constexpr (UserMechanics<E> && HasForceTangent<E>) {
      mechanics.tangent(at.q, at.v, at.t, c.stiffness, c.damping, k_n);
      k = k_n;
    } else {
      k.setZero();
      differences(at, c.stiffness, at.q, 0, n);
      differences(at, c.damping, at.v, 0, n);
      differences(at, c.states, at.v, n, states);
    }
    k += c.mass * m;
    sink.add(0, 0, k);
  }
  /// k −= factor ∂(f, h)/∂x for `count` entries of x from entry `first` on; x is q or v. Uses central differences with
  /// the step 1e-6 (1 + |xⱼ|) for entry j.
  void differences(At<double> at, double factor, VecX const& x, Index first, Index count) const {
    if (factor == 0.0) return;
    x_near = x;
    bool const by_q = &x == &at.q;
    for (Index j = first; j < first + count; ++j) {
      double const step = 1e-6 * (1.0 + std::abs(x[j]));
      for (double const side : {-step, step}) {
        x_near[j] = x[j] + side;
        find_force(by_q ? x_near : at.q, by_q ? at.v : x_near, at.t, f_near);
        k.col(j) -= factor / (2.0 * side) * f_near;
      }
      x_near[j] = x[j];
    }
  }
  void plus(ReducedPosition const*, VecX const& q, VecX const& delta, VecX& out) const override {
    out = q + delta.head(q.size());
  }
  void local_rate(ReducedPosition const*, VecX const&, VecX const& v, VecX& out) const override {
    out.head(n) = v.head(n);
  }
  void coordinate_rates(ReducedPosition const*, VecX const&, VecX const& v, VecXOf<Dual<1>>&,
                        VecX& out) const override {
    out = v.head(out.size());
  }
};

}  // namespace detail

/// Makes a system from the equations `mechanics`, which it stores. The second-order terms ∂(Gᵀλ)/∂q of constraint
/// equations are omitted. Implicit steps of other systems may use these terms if Newton's method does not converge
/// without them. \param name name in messages \param constant_mass true if M does not depend on q
template <UserEquations E>
System system_of(E mechanics, std::string name = "system", bool constant_mass = false) {
  auto self = std::make_shared<detail::UserOperations<E>>(std::move(mechanics));
  Index const n = self->n, states = self->states, rows = self->phi.size();
  ModelLayout layout{.coordinates = n,
                     .velocities = n + states,
                     .rows = rows,
                     .states = states,
                     .constant_mass = constant_mass || UserFirstOrderEquations<E>};
  layout.bodies.push_back({name, 0, n, 0, n + states});
  Data<double> data;
  if (rows > 0) {
    layout.joints.push_back({name, -1, -1, 0, rows});
    data.rows.push_back({.source = ConstraintSource::body,
                         .row = 0,
                         .rows = int(rows),
                         .a = {.columns = n, .map = self->g.data()},
                         .g = self->phi.data(),
                         .rate = self->rate.data()});
  }
  return System(std::move(self), std::move(layout), std::move(data), {});
}

}  // namespace polybody
