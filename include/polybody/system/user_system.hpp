#pragma once
/// \file
/// System from equations of a user, without bodies and joints, for every integrator and solver of the library.
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
///
/// Not in polybody.hpp: few programs need it.

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
/// Equations with the tangent −(ck ∂f/∂q + cd ∂f/∂v) (n×n) for implicit steps. Without this tangent, central
/// differences are used.
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
struct UserOperations {
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
  static UserOperations const& of(void const* self) { return *static_cast<UserOperations const*>(self); }

  static void evaluate_constraints(void const* self, At<double> at, Data<double>&) {
    if constexpr (HasConstraintEquations<E>) {
      of(self).mechanics.violation(at.q, at.t, of(self).phi);
      of(self).mechanics.jacobian(at.q, at.t, of(self).g);
      of(self).mechanics.rate(at.q, at.t, of(self).rate);
    }
  }
  static void measure_gamma(void const* self, At<double> at, Data<double> const&, VecX& out) {
    if constexpr (HasConstraintEquations<E>) {
      of(self).v_n = at.v.head(of(self).n);
      of(self).mechanics.gamma(at.q, of(self).v_n, at.t, out);
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
  static void element_forces(void const* self, At<double> at, VecX const& a, double, Data<double>&, VecX& r) {
    UserOperations const& s = of(self);
    s.find_mass(at.q);
    s.find_force(at.q, at.v, at.t, s.f);
    s.ma.noalias() = s.m * a;
    r += s.ma;
    r -= s.f;
  }
  static void masses(void const* self, At<double> at, Data<double>&, BlockSink& sink) {
    of(self).find_mass(at.q);
    sink.add(0, 0, of(self).m);
  }
  static void element_tangents(void const* self, At<double> at, TangentCoefficients const& c, Data<double>&,
                               BlockSink& sink) {
    UserOperations const& s = of(self);
    s.find_mass(at.q);
    if constexpr (UserMechanics<E> && HasForceTangent<E>) {
      s.mechanics.tangent(at.q, at.v, at.t, c.stiffness, c.damping, s.k_n);
      s.k = s.k_n;
    } else {
      s.k.setZero();
      s.differences(at, c.stiffness, at.q, 0, s.n);
      s.differences(at, c.damping, at.v, 0, s.n);
      s.differences(at, c.states, at.v, s.n, s.states);
    }
    s.k += c.mass * s.m;
    sink.add(0, 0, s.k);
  }
  /// k −= factor ∂(f, h)/∂x for `count` entries of x, which is q or v. Central differences with relative step 1e-6.
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
  static void plus(void const*, ReducedPosition const*, VecX const& q, VecX const& delta, VecX& out) {
    out = q + delta.head(q.size());
  }
  static void local_rate(void const* self, ReducedPosition const*, VecX const&, VecX const& v, VecX& out) {
    out.head(of(self).n) = v.head(of(self).n);
  }
  static void coordinate_rates(void const*, ReducedPosition const*, VecX const&, VecX const& v, VecXOf<Dual<1>>&,
                               VecX& rate) {
    rate = v.head(rate.size());
  }

  static constexpr ModelOperations<double> entries() {
    return {.evaluate_marker = [](void const*, At<double>, Data<double>&) {},
            .evaluate_constraints = &evaluate_constraints,
            .measure_gamma = &measure_gamma,
            .element_forces = &element_forces,
            .push_forces = [](void const*, double, Data<double>&) {},
            .plus = &plus,
            .local_rate = &local_rate,
            .share_loops = [](void const*, Data<double>&, Workers&) {},
            .masses = &masses,
            .element_tangents = &element_tangents,
            .compliant_tangents = [](void const*, TangentCoefficients const&, Data<double>&, BlockSink&) {},
            .force_tangents = [](void const*, double, double, TangentCoefficients const&, Data<double>&, BlockSink&) {},
            .joint_stiffness = [](void const*, At<double>, VecX const&, TangentCoefficients const&, Data<double>&,
                                  BlockSink&) {},
            .load_stiffness = [](void const*, At<double>, TangentCoefficients const&, Data<double>&, BlockSink&) {},
            .coordinate_rates = &coordinate_rates};
  }
};

}  // namespace detail

/// Makes a system from the equations `mechanics`, which it stores. The second-order terms ∂(Gᵀλ)/∂q of constraint
/// equations are omitted. Implicit steps of other systems may use these terms if they do not converge otherwise. \param
/// name name in messages \param constant_mass true if M does not depend on q
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
  data.kept = self;
  return System(self.get(), detail::UserOperations<E>::entries(), std::move(layout), std::move(data), {});
}

}  // namespace polybody
