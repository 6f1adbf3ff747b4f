#pragma once
/// \file
/// Waist 3: what an integrator or a solver sees of the mechanics,
///   M(q) v̇ = f(q, v, t) − Gᵀλ,   Φ(q, t) = 0,   q moves by ⊞.

#include <memory>

#include <polybody/system/tangent.hpp>

namespace polybody {

namespace detail {
/// The first entry that is NaN or infinite, or −1.
inline Index first_not_finite(VecX const& x) {
  for (Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i])) return i;
  return -1;
}
[[noreturn]] inline void throw_force_not_finite(std::string const& who, double t) {
  throw NonFinite("A force on " + who + " is not finite at t = " + number(t) +
                  " s. Look at the forces applied to it and at the state before.");
}
[[noreturn]] inline void throw_motion_not_finite(std::string const& who, double t) {
  throw NonFinite("The motion at " + who + " is not finite at t = " + number(t) +
                  " s. Look at the state before, or take a smaller step.");
}
/// Whose unknown it is, as messages say it.
struct Owner {
  char const* kind = nullptr;
  std::string const* name = nullptr;
  std::string text() const { return name ? kind + (" \"" + *name) + '"' : "unknown"; }
};
}  // namespace detail

/// A model with its scratch. `evaluate` sets the state at which everything else is asked.
template <class M>
class System {
 public:
  using ModelType = M;

  /// The model must outlive the system and must not change after.
  explicit System(M const& model)
      : model_(&model), data_(model), q_(VecX::Zero(model.coordinates())), v_(VecX::Zero(model.speeds())) {}

  M const& model() const { return *model_; }
  Index coordinates() const { return model_->coordinates(); }
  Index speeds() const { return model_->speeds(); }
  Index rows() const { return model_->rows(); }
  /// Rows without a position: Φ is zero there, Φ̇ and γ are not.
  std::vector<Index> const& velocity_rows() const { return model_->velocity_rows(); }
  Index size() const { return speeds() + rows(); }
  double time() const { return t_; }
  Data<M> const& data() const { return data_; }

  /// Scales gravity and loads; one except inside `equilibrium`.
  double load_factor = 1.0;

  void evaluate(VecX const& q, VecX const& v, double t) { evaluate(q, v, t, true); }
  /// … for one who eliminates linear joints: until the next evaluation their rows are left out, and so are markers that
  /// nothing else reads.
  void evaluate_without_linear_rows(VecX const& q, VecX const& v, double t) { evaluate(q, v, t, false); }

  /// From now on so many threads share the loops over elements, markers and joints, this one among them; the results
  /// are the same to the last bit. \throws InvalidInput for fewer than one.
  void use_threads(int threads) {
    workers_ = std::make_unique<Workers>(threads);
    data_.share_with(*model_, *workers_);
  }

  /// r = M a − f + Gᵀλ (nv).
  void residual(VecX const& a, VecX const& lambda, VecX& r) {
    polybody::residual(*model_, q_, v_, a, lambda, t_, load_factor, data_, r);
  }
  /// Φ (rows); zero for velocity rows.
  void violation(VecX& phi) const { polybody::violation(*model_, q_, data_, phi); }
  void violation_rate(VecX& rate) const { polybody::violation_rate(*model_, q_, v_, data_, rate); }
  void acceleration_bias(VecX& gamma) const { polybody::acceleration_bias(*model_, q_, v_, t_, data_, gamma); }
  /// out = G b (rows) for b by speeds.
  void rows_times(VecX const& b, VecX& out) const { polybody::rows_times(*model_, q_, b, data_, out); }
  /// [cm M + cd D + ck K, Gᵀ; G, 0] (size × size) into `sink`.
  template <TangentSink Sink>
  void tangent(TangentCoefficients const& c, SecondOrder second, VecX const& lambda, Sink& sink) {
    polybody::tangent(*model_, q_, v_, lambda, t_, load_factor, c, second, data_, sink);
  }
  /// cd D + ck K of the force elements alone, with second-order terms, into `sink`.
  template <TangentSink Sink>
  void force_tangents(TangentCoefficients const& c, Sink& sink) {
    std::fill(data_.loads.begin(), data_.loads.end(), Wrench<double>{});
    add_force_tangents(*model_, t_, load_factor, c, true, data_, sink, [&](Index marker, Vec6 const& w) {
      data_.loads[std::size_t(marker)].f += w.head<3>();
      data_.loads[std::size_t(marker)].m += w.tail<3>();
    });
    add_load_stiffness(*model_, q_, c.stiffness, data_, sink);
  }

  /// out = q ⊞ delta.
  void plus(VecX const& q, VecX const& delta, VecX& out) const {
    model_->for_each_body([&](auto const& e) {
      Index const n = e.body.coordinates(), m = e.body.speeds();
      e.body.template plus<double>(detail::body_part(q, e.q0, n), detail::body_part(delta, e.v0, m),
                                   detail::body_part_of(out, e.q0, n));
    });
  }
  /// The rate of delta in q ⊞ delta when the model moves with speeds v.
  void local_rate(VecX const& delta, VecX const& v, VecX& out) const {
    model_->for_each_body([&](auto const& e) {
      Index const m = e.body.speeds();
      e.body.template local_rate<double>(detail::body_part(delta, e.v0, m), detail::body_part(v, e.v0, m),
                                         detail::body_part_of(out, e.v0, m));
    });
  }

  /// Name of the body that owns speed i, or of the joint that owns row i − nv.
  std::string name_of(Index i) const {
    detail::Owner owner;
    Index const row = i - speeds();
    model_->for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      if (row < 0 && i >= e.v0 && i < e.v0 + e.body.speeds()) owner = {"body", &e.name};
      if constexpr (OwnsRows<B>)
        if (row >= 0 && row >= e.row && row < e.row + B::own_rows) owner = {"body", &e.name};
    });
    if (row >= 0)
      model_->for_each_joint([&](auto const& e) {
        if (e.row >= 0 && row >= e.row && row < e.row + e.rows) owner = {"joint", &e.name};
      });
    return owner.text();
  }

  /// \throws NonFinite naming body and time when an entry of x (by speeds) is NaN or infinite.
  void require_finite_force(VecX const& x) const {
    if (Index const i = detail::first_not_finite(x); i >= 0) detail::throw_force_not_finite(name_of(i), t_);
  }
  /// \throws NonFinite naming joint and time when an entry of x (by rows) is NaN or infinite.
  void require_finite_rows(VecX const& x) const {
    if (Index const i = detail::first_not_finite(x); i >= 0) detail::throw_motion_not_finite(name_of(speeds() + i), t_);
  }

  /// Unknowns of a linear system of equations; those that stand for speeds come first. Here they are those of a time
  /// step.
  Index equations() const { return size(); }
  Index equation_speeds() const { return speeds(); }
  std::string name_of_equation(Index i) const { return name_of(i); }
  /// What goes between the two (see reduced_system.hpp): nothing.
  struct Held {};
  static constexpr bool solves_as_it_is = true;
  static constexpr bool solves_by_bodies = false;
  void hold(Held&) const {}
  void spread(Held&, VecX const& rhs, VecX& out) const { out = rhs; }
  void gather(Held&, VecX const& solution, VecX& out) const { out = solution; }

 private:
  void evaluate(VecX const& q, VecX const& v, double t, bool linear_rows) {
    q_ = q;
    v_ = v;
    t_ = t;
    data_.linear_rows = linear_rows;
    publish(*model_, q_, v_, data_);
    enforce(*model_, t_, data_);
  }

  M const* model_;
  std::unique_ptr<Workers> workers_;
  Data<M> data_;
  VecX q_, v_;
  double t_ = 0.0;
};

/// What an integrator may ask of the mechanics.
template <class S>
concept MechanicalSystem = requires(S s, S const c, VecX const x, VecX out, double t) {
  { c.coordinates() } -> std::convertible_to<Index>;
  { c.speeds() } -> std::convertible_to<Index>;
  { c.rows() } -> std::convertible_to<Index>;
  s.evaluate(x, x, t);
  s.residual(x, x, out);
  c.violation(out);
  c.violation_rate(out);
  c.acceleration_bias(out);
  c.rows_times(x, out);
  c.plus(x, x, out);
  c.local_rate(x, x, out);
  { c.name_of(Index(0)) } -> std::convertible_to<std::string>;
};

}  // namespace polybody
