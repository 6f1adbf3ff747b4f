#pragma once
/// \file
/// A system from equations that a user writes down, without bodies and joints: every integrator and solver of the
/// library takes it.
///   struct Oscillator {
///     Index speeds() const { return 1; }
///     void mass(VecX const& q, MatX& m) const { m(0, 0) = 2.0; }
///     void force(VecX const& q, VecX const& v, double t, VecX& f) const { f[0] = -50.0 * q[0]; }
///   };
///   System system = system_of(Oscillator{});
///
/// Not in polybody.hpp: few programs need it.

#include <polybody/system/system.hpp>

namespace polybody {

/// M(q) v̇ = f(q, v, t) with q̇ = v: mass matrix (n×n) and force (n), both to be written over.
template <class E>
concept UserMechanics = requires(E const e, VecX const& x, double t, MatX& m, VecX& f) {
  { e.speeds() } -> std::convertible_to<Index>;
  e.mass(x, m);
  e.force(x, x, t, f);
};
/// It gives −(ck ∂f/∂q + cd ∂f/∂v) (n×n), which implicit steps ask for; else it comes from central differences.
template <class E>
concept OffersForceTangent = requires(E const e, VecX const& x, double t, MatX& k) { e.tangent(x, x, t, 1.0, 1.0, k); };
/// It has rows Φ(q, t) = 0 with G = ∂Φ/∂q, Φ_t, and γ in Φ̈ = G v̇ + γ.
template <class E>
concept OffersRows = requires(E const e, VecX const& x, double t, MatX& g, VecX& phi) {
  { e.rows() } -> std::convertible_to<Index>;
  e.violation(x, t, phi);
  e.jacobian(x, t, g);
  e.rate(x, t, phi);
  e.gamma(x, x, t, phi);
};

namespace detail {

template <UserMechanics E>
struct UserEntries {
  E mechanics;
  mutable MatX m, k;
  mutable VecX f, ma;
  mutable MatX g;
  mutable VecX phi, rate, q_near, f_near;

  explicit UserEntries(E e) : mechanics(std::move(e)) {
    Index const n = mechanics.speeds();
    m.setZero(n, n);
    k = m;
    f.setZero(n);
    ma = q_near = f_near = f;
    if constexpr (OffersRows<E>) {
      g.setZero(mechanics.rows(), n);
      phi.setZero(mechanics.rows());
      rate = phi;
    }
  }
  static UserEntries const& of(void const* self) { return *static_cast<UserEntries const*>(self); }

  static void measure_gaps(void const* self, At<double> at, Data<double>&) {
    if constexpr (OffersRows<E>) {
      of(self).mechanics.violation(at.q, at.t, of(self).phi);
      of(self).mechanics.jacobian(at.q, at.t, of(self).g);
      of(self).mechanics.rate(at.q, at.t, of(self).rate);
    }
  }
  static void measure_gamma(void const* self, At<double> at, Data<double> const&, VecX& out) {
    if constexpr (OffersRows<E>) of(self).mechanics.gamma(at.q, at.v, at.t, out);
  }
  static void element_forces(void const* self, At<double> at, VecX const& a, double, Data<double>&, VecX& r) {
    of(self).mechanics.mass(at.q, of(self).m);
    of(self).mechanics.force(at.q, at.v, at.t, of(self).f);
    of(self).ma.noalias() = of(self).m * a;
    r += of(self).ma;
    r -= of(self).f;
  }
  static void masses(void const* self, At<double> at, Data<double>&, BlockSink& sink) {
    of(self).mechanics.mass(at.q, of(self).m);
    sink.add(0, 0, of(self).m);
  }
  static void element_tangents(void const* self, At<double> at, TangentCoefficients const& c, Data<double>&,
                               BlockSink& sink) {
    UserEntries const& s = of(self);
    s.mechanics.mass(at.q, s.m);
    if constexpr (OffersForceTangent<E>)
      s.mechanics.tangent(at.q, at.v, at.t, c.stiffness, c.damping, s.k);
    else
      s.differences(at, c);
    s.k += c.mass * s.m;
    sink.add(0, 0, s.k);
  }
  /// k = −(ck ∂f/∂q + cd ∂f/∂v), of second order in the step of 1e-6.
  void differences(At<double> at, TangentCoefficients const& c) const {
    k.setZero();
    for (bool const by_speed : {false, true}) {
      double const factor = by_speed ? c.damping : c.stiffness;
      VecX const& x = by_speed ? at.v : at.q;
      q_near = x;
      for (Index j = 0; j < x.size() && factor != 0.0; ++j) {
        double const h = 1e-6 * (1.0 + std::abs(x[j]));
        for (double const side : {-h, h}) {
          q_near[j] = x[j] + side;
          mechanics.force(by_speed ? at.q : q_near, by_speed ? q_near : at.v, at.t, f_near);
          k.col(j) -= factor / (2.0 * side) * f_near;
        }
        q_near[j] = x[j];
      }
    }
  }
  static void plus(void const*, NarrowPlace const*, VecX const& q, VecX const& delta, VecX& out) { out = q + delta; }
  static void local_rate(void const*, NarrowPlace const*, VecX const&, VecX const& v, VecX& out) { out = v; }
  static void coordinate_rates(void const*, NarrowPlace const*, VecX const&, VecX const& v, VecXOf<Dual<1>>&,
                               VecX& rate) {
    rate = v;
  }

  static constexpr ModelEntries<double> entries() {
    return {.publish = [](void const*, At<double>, Data<double>&) {},
            .measure_gaps = &measure_gaps,
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
            .joint_stiffness = [](void const*, At<double>, VecX const&, double, Data<double>&, BlockSink&) {},
            .load_stiffness = [](void const*, At<double>, double, Data<double>&, BlockSink&) {},
            .coordinate_rates = &coordinate_rates};
  }
};

}  // namespace detail

/// The system of these equations, which it keeps. `name` is what messages call it. The second-order terms of its rows,
/// which some implicit steps ask for when they stall, are left out.
template <UserMechanics E>
System system_of(E mechanics, std::string name = "system", bool constant_mass = false) {
  auto self = std::make_shared<detail::UserEntries<E>>(std::move(mechanics));
  Index const n = self->f.size(), rows = self->phi.size();
  ModelLayout layout{.coordinates = n, .speeds = n, .rows = rows, .constant_mass = constant_mass};
  layout.bodies.push_back({name, 0, n, 0, n});
  Data<double> data;
  if (rows > 0) {
    layout.joints.push_back({name, -1, -1, 0, rows});
    data.rows.push_back({.source = RowSource::body,
                         .row = 0,
                         .rows = int(rows),
                         .a = {.columns = n, .map = self->g.data()},
                         .g = self->phi.data(),
                         .rate = self->rate.data()});
  }
  data.kept = self;
  return System(self.get(), detail::UserEntries<E>::entries(), std::move(layout), std::move(data), {});
}

}  // namespace polybody
