#pragma once
/// \file
/// Waist 3 for models of which policies eliminate unknowns: the equations of the coordinates that are left,
///   Tᵀ(M(T u̇ + b) − f) + (G T)ᵀλ = 0,   v = T u,  v̇ = T u̇ + b,
/// with T of joint trees (`JointTree`) and of linear joints (`LinearElimination`). Bodies, joints and forces do not
/// notice. A linear system of equations may have other unknowns than a time step: `spread` and `gather` go between
/// them.

#include <polybody/system/dense_reduction.hpp>
#include <polybody/system/mapped_sink.hpp>
#include <polybody/system/reduction.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// A model as a time step sees it, without what its policies eliminate.
template <class M>
struct Reduced {
  static constexpr bool may_have_rows = M::may_have_rows;
  static constexpr bool has_groups = M::has_groups;
  static constexpr bool constant_mass = M::constant_mass && std::is_void_v<typename M::Solution>;
  static constexpr bool solved_by_bodies = std::is_same_v<typename M::Solution, recursive::ArticulatedBody>;
};

/// What a time step is about: the model itself where no policy eliminates anything.
template <class M>
using SteppedModel = std::conditional_t<M::eliminates, Reduced<M>, M>;

template <class M>
class System<Reduced<M>> {
 public:
  using ModelType = M;
  /// The dense system TᵀKT is solved, else the sparse one of all bodies with the tree's rows.
  static constexpr bool solves_densely = std::is_same_v<typename M::Solution, recursive::Reduced>;
  /// The tree itself is the solver: the tangent is written as it is for the whole model.
  static constexpr bool solves_by_bodies = Reduced<M>::solved_by_bodies;
  /// The equations have the unknowns of a time step.
  static constexpr bool solves_as_it_is = solves_densely || solves_by_bodies || std::is_void_v<typename M::Solution>;
  static_assert(!solves_by_bodies || M::all_rigid,
                "recursive::ArticulatedBody is for models of rigid bodies. Take recursive::Augmented.");

  /// \throws InvalidInput, InconsistentStart as `Reduction`.
  explicit System(M const& model)
      : whole_(model),
        reduction_(model),
        state_(reduction_.tree().state()),
        q_(model.reference_state().q),
        v_(VecX::Zero(model.speeds())),
        a_(v_),
        r_(v_),
        bias_(v_),
        lambda_(VecX::Zero(model.rows())),
        phi_(lambda_),
        zero_(VecX::Zero(speeds())),
        unit_(zero_),
        narrow_(zero_) {
    if constexpr (solves_densely)
      prepare_dense();
    else if constexpr (!solves_by_bodies)
      map_equations();
  }

  M const& model() const { return whole_.model(); }
  System<M>& whole() { return whole_; }
  Reduction const& reduction() const { return reduction_; }
  Index coordinates() const { return reduction_.coordinates(); }
  Index speeds() const { return reduction_.speeds(); }
  Index rows() const { return reduction_.rows(); }
  Index size() const { return speeds() + rows(); }
  double time() const { return whole_.time(); }
  std::vector<Index> const& velocity_rows() const { return reduction_.velocity_rows(); }
  void use_threads(int threads) { whole_.use_threads(threads); }

  void evaluate(VecX const& q, VecX const& v, double t) {
    place(q, v);
    whole_.evaluate_without_linear_rows(q_, v_, t);
  }

  /// r = Tᵀ(M(T a + b) − f) + (G T)ᵀλ.
  void residual(VecX const& a, VecX const& lambda, VecX& r) {
    widen_rates(a, true, a_);
    reduction_.copy_rows_out(lambda, lambda_);
    whole_.residual(a_, lambda_, r_);
    pull(r_, r);
  }
  void violation(VecX& phi) const {
    whole_.violation(phi_);
    reduction_.copy_rows_in(phi_, phi);
  }
  void violation_rate(VecX& rate) const {
    whole_.violation_rate(phi_);
    reduction_.copy_rows_in(phi_, rate);
  }
  /// γ + G b.
  void acceleration_bias(VecX& gamma) const {
    whole_.acceleration_bias(lambda_);
    widen_rates(zero_, true, a_);
    whole_.rows_times(a_, phi_);
    phi_ += lambda_;
    reduction_.copy_rows_in(phi_, gamma);
  }
  /// out = G T b.
  void rows_times(VecX const& b, VecX& out) const {
    widen_rates(b, false, a_);
    whole_.rows_times(a_, phi_);
    reduction_.copy_rows_in(phi_, out);
  }

  /// out = q ⊞ delta.
  void plus(VecX const& q, VecX const& delta, VecX& out) const {
    reduction_.tree().plus(q, delta, out);
    for_each_uncarried([&](auto const& body, NarrowPlace const& p) {
      auto const qe = detail::body_part(q, p.q, p.coordinates), de = detail::body_part(delta, p.v, p.speeds);
      auto const to = detail::body_part_of(out, p.q, p.coordinates);
      if (p.kind == NarrowPlace::Kind::as_it_is)
        body.template plus<double>(qe, de, to);
      else
        for (std::size_t i = 0; i < qe.size(); ++i) to[i] = qe[i] + de[i];
    });
  }
  /// The rate of delta in q ⊞ delta when the model moves with speeds v.
  void local_rate(VecX const& delta, VecX const& v, VecX& out) const {
    reduction_.tree().local_rate(delta, v, out);
    for_each_uncarried([&](auto const& body, NarrowPlace const& p) {
      auto const de = detail::body_part(delta, p.v, p.speeds), ve = detail::body_part(v, p.v, p.speeds);
      auto const to = detail::body_part_of(out, p.v, p.speeds);
      if (p.kind == NarrowPlace::Kind::as_it_is)
        body.template local_rate<double>(de, ve, to);
      else
        for (std::size_t i = 0; i < ve.size(); ++i) to[i] = ve[i];
    });
  }

  /// Unknowns of a linear system of equations; those that stand for speeds come first.
  Index equations() const { return equation_speeds() + equation_rows(); }
  Index equation_speeds() const {
    if constexpr (solves_densely || solves_by_bodies) return speeds();
    return equation_speeds_;
  }
  Index equation_rows() const {
    if constexpr (solves_densely || solves_by_bodies) return rows();
    return equation_rows_;
  }
  /// The matrix of such a system at the state evaluated last, into `sink`.
  template <TangentSink Sink>
  void tangent(TangentCoefficients const& c, SecondOrder second, VecX const& lambda, Sink& sink) {
    reduction_.copy_rows_out(lambda, lambda_);
    if (second == SecondOrder::included) recover_multipliers(held_r_, lambda_);
    if constexpr (solves_densely) {
      write_dense(c, second, sink);
    } else if constexpr (solves_by_bodies) {
      whole_.tangent(c, second, lambda_, sink);
    } else {
      MappedSink<Sink> mapped(map_, mapped_, sink);
      whole_.tangent(c, second, lambda_, mapped);
    }
  }

  /// What `spread` and `gather` need of the state at which a tangent was written.
  using Held = TreeState;
  void hold(Held& held) const {
    if constexpr (!solves_as_it_is || solves_by_bodies) held = state_;
  }
  /// A right-hand side of a time step as one of the equations, and a solution of these as one of the step's unknowns.
  void spread(Held& held, VecX const& rhs, VecX& out) const {
    if constexpr (solves_as_it_is) {
      out = rhs;
    } else {
      narrow_ = rhs.head(speeds());
      a_.setZero();
      reduction_.copy_speeds_out(narrow_, a_);
      reduction_.tree().spread_forces(held, narrow_, a_);
      out.setZero();
      for (Index i = 0; i < a_.size(); ++i)
        if (Index const to = equation_of(i); to >= 0) out[to] = a_[i];
      for (Index i = 0; i < rows(); ++i) out[equation_of_row(i)] = rhs[speeds() + i];
    }
  }
  void gather(Held& held, VecX const& solution, VecX& out) const {
    if constexpr (solves_as_it_is) {
      out = solution;
    } else {
      a_.setZero();
      for (Index i = 0; i < a_.size(); ++i)
        if (Index const from = equation_of(i); from >= 0) a_[i] = solution[from];
      reduction_.copy_speeds_in(a_, narrow_);
      reduction_.tree().gather_rates(held, a_, false, narrow_);
      out.head(speeds()) = narrow_;
      for (Index i = 0; i < rows(); ++i) out[speeds() + i] = solution[equation_of_row(i)];
    }
  }

  /// The whole state of a narrow one, with what eliminated joints hold as multipliers.
  void widen(State const& narrow, State& x) {
    evaluate(narrow.q, narrow.v, narrow.t);
    x.q = q_;
    x.v = v_;
    widen_rates(narrow.a, true, x.a);
    reduction_.copy_rows_out(narrow.lambda, x.lambda);
    whole_.residual(x.a, x.lambda, r_);
    recover_multipliers(r_, x.lambda);
    x.t = narrow.t;
    x.memory = narrow.memory;
  }
  /// The narrow state next to a whole one: exact where this one keeps to the eliminated joints. The integrator starts
  /// afresh.
  State narrow(State const& x) {
    State out{VecX::Zero(coordinates()), VecX::Zero(speeds()), VecX::Zero(speeds()), VecX::Zero(rows()), x.t, {}};
    reduction_.copy_coordinates_in(x.q, out.q);
    reduction_.copy_speeds_in(x.v, out.v);
    reduction_.copy_speeds_in(x.a, out.a);
    reduction_.copy_rows_in(x.lambda, out.lambda);
    reduction_.tree().read_coordinates(x.q, x.v, state_, out.q);
    place(out.q, out.v);
    reduction_.tree().gather_rates(state_, x.v, false, out.v);
    place(out.q, out.v);
    reduction_.tree().gather_rates(state_, x.a, true, out.a);
    return out;
  }

  std::string name_of(Index i) const {
    return i < speeds() ? whole_.name_of(reduction_.whole_speed(i))
                        : whole_.name_of(whole_.speeds() + reduction_.rows_that_stay()[std::size_t(i - speeds())]);
  }
  /// Of an unknown of the equations.
  std::string name_of_equation(Index i) const {
    if constexpr (solves_densely || solves_by_bodies) return name_of(i);
    for (Index k = 0; k < whole_.size(); ++k)
      if (equation_of(k) == i) return whole_.name_of(k);
    return "unknown";
  }
  /// Adds the names of linear joints whose rows repeat others.
  void add_redundant(std::vector<std::string>& names) const {
    for (Index const row : reduction_.linear().redundant()) {
      std::string name = whole_.name_of(whole_.speeds() + row);
      if (names.empty() || names.back() != name) names.push_back(std::move(name));
    }
  }
  void require_finite_force(VecX const& x) const {
    if (Index const i = detail::first_not_finite(x); i >= 0) detail::throw_force_not_finite(name_of(i), time());
  }
  void require_finite_rows(VecX const& x) const {
    if (Index const i = detail::first_not_finite(x); i >= 0)
      detail::throw_motion_not_finite(name_of(speeds() + i), time());
  }

 private:
  /// Calls f(body, its place) for every body that no joint carries.
  template <class F>
  void for_each_uncarried(F&& f) const {
    std::size_t i = 0;
    model().for_each_body([&](auto const& e) {
      NarrowPlace const& p = reduction_.places()[i++];
      if (p.kind != NarrowPlace::Kind::carried) f(e.body, p);
    });
  }

  /// q_, v_ and the tree from narrow coordinates and speeds.
  void place(VecX const& q, VecX const& v) {
    reduction_.copy_coordinates_out(q, q_);
    reduction_.copy_speeds_out(v, v_);
    reduction_.linear().spread_coordinates(q_);
    reduction_.linear().spread_rates(v_);
    reduction_.tree().carry(q, v, q_, v_, state_);
  }
  /// T u, or T u + b.
  void widen_rates(VecX const& u, bool bias, VecX& out) const {
    reduction_.copy_speeds_out(u, out);
    reduction_.linear().spread_rates(out);
    reduction_.tree().spread_rates(state_, u, bias, out);
  }
  /// out = Tᵀ r; r is used up, and kept as it was for the multipliers.
  void pull(VecX& r, VecX& out) {
    held_r_ = r;
    reduction_.linear().pull(r);
    reduction_.tree().pull(state_, r, out);
    reduction_.copy_speeds_in(r, out);
  }

  /// Multipliers of eliminated joints from r = M a − f + Gᵀλ without them.
  void recover_multipliers(VecX const& r, VecX& lambda) {
    if (r.size() == 0) return;
    reduction_.linear().multipliers(r, lambda);
    if constexpr (!std::is_void_v<typename M::Solution>) {
      bias_ = r;
      reduction_.tree().pull(state_, bias_, narrow_);
      for_each_gap(model(), whole_.data(), [&](auto const& e, auto const& gap) {
        using P = typename std::decay_t<decltype(e.joint)>::PolicyType;
        if constexpr (MakesJointCoordinates<P>) {
          constexpr int m = std::decay_t<decltype(gap)>::rows;
          std::size_t const i = std::size_t(reduction_.carried_by(e.row));
          bool const backwards = reduction_.tree().bodies[i].backwards;
          auto const& map = backwards ? gap.Ga : gap.Gb;
          Vec6 w = state_.held[i];
          Vec3 const rho = whole_.data().markers[std::size_t(backwards ? e.a : e.b)].frame.r - state_.frames[i].r;
          w.template tail<3>() -= rho.cross(w.template head<3>());
          Mat<double, 6, 6> gram = Mat<double, 6, 6>::Identity();
          Vec6 right = Vec6::Zero();
          for (int k = 0; k < m; ++k) {
            right[k] = -map.row(k).dot(w);
            for (int j = 0; j < m; ++j) gram(k, j) = map.row(k).dot(map.row(j));
          }
          detail::invert_leading(gram, m);
          for (int k = 0; k < m; ++k) {
            double sum = 0.0;
            for (int j = 0; j < m; ++j) sum += gram(k, j) * right[j];
            lambda[e.row + k] = sum;
          }
        }
      });
    }
  }

  /// Where the whole unknowns stand in the equations: dependents of linear joints are spread, the rows of these left
  /// out.
  void map_equations() {
    Index const nv = whole_.speeds();
    std::vector<std::vector<UnknownMap::Target>> targets(std::size_t(whole_.size()));
    std::vector<bool> dependent(std::size_t(nv), false);
    for (auto const& d : reduction_.linear().dependents()) dependent[std::size_t(d.v)] = true;
    for (Index i = 0; i < nv; ++i)
      if (!dependent[std::size_t(i)]) targets[std::size_t(i)].push_back({equation_speeds_++, 1.0});
    for (auto const& d : reduction_.linear().dependents())
      for (auto const& t : d.terms)
        targets[std::size_t(d.v)].push_back({targets[std::size_t(t.v)][0].unknown, t.factor});
    std::vector<bool> linear(std::size_t(whole_.rows()), false);
    for (LinearRows const& rows : model().linear_rows())
      for (Index i = 0; i < rows.rows(); ++i) linear[std::size_t(rows.row + i)] = true;
    for (Index i = 0; i < whole_.rows(); ++i)
      if (!linear[std::size_t(i)]) targets[std::size_t(nv + i)].push_back({equation_speeds_ + equation_rows_++, 1.0});
    map_ = UnknownMap(std::move(targets));
    for (Index i = 0; i < whole_.size(); ++i) equation_of_.push_back(map_.run(i, 1));
  }
  /// Of a whole unknown, −1 for one that is spread or left out; and of a row that stays.
  Index equation_of(Index i) const { return equation_of_[std::size_t(i)]; }
  Index equation_of_row(Index i) const {
    return equation_of(whole_.speeds() + reduction_.rows_that_stay()[std::size_t(i)]);
  }

  void prepare_dense() {
    std::vector<Index> row_of(std::size_t(whole_.rows()), -1);
    for (Index i = 0; i < rows(); ++i) row_of[std::size_t(reduction_.rows_that_stay()[std::size_t(i)])] = i;
    dense_ = DenseReduction(whole_.speeds(), speeds(), rows(), std::move(row_of));
  }
  template <class Sink>
  void write_dense(TangentCoefficients const& c, SecondOrder second, Sink& sink) {
    unit_.setZero();
    for (Index j = 0; j < speeds(); ++j) {
      unit_[j] = 1.0;
      widen_rates(unit_, false, a_);
      dense_.set_column(j, a_);
      unit_[j] = 0.0;
    }
    dense_.begin();
    whole_.tangent(c, second, lambda_, dense_);
    dense_.write(sink);
  }

  System<M> whole_;
  Reduction reduction_;
  mutable TreeState state_;
  VecX q_, v_;                                // whole
  mutable VecX a_, r_, bias_, lambda_, phi_;  // scratch, whole
  VecX zero_, unit_;                          // narrow
  mutable VecX narrow_;
  VecX held_r_;  // r of the last residual, for multipliers
  Index equation_speeds_ = 0, equation_rows_ = 0;
  UnknownMap map_;
  std::vector<Index> equation_of_;
  MappedBlocks mapped_;
  DenseReduction dense_;
};

}  // namespace polybody
