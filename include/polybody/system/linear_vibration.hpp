#pragma once
/// \file
/// Waist 3 without a model: M q̈ + D(t) q̇ + K(t) q = f(t), so that every integrator of the library solves a linear
/// problem.
///
/// Not in polybody.hpp: few programs need it.

#include <polybody/bodies/step_means.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// f(t) into `f` (n).
template <class L>
concept LoadHistory = requires(L const load, double t, VecX f) { load(t, f); };
/// … which changes damping and stiffness (n×n) in time, too: adds to them.
template <class L>
concept ChangesMatrices = requires(L const load, double t, MatX d, MatX k) { load.add_matrices(t, d, k); };

template <LoadHistory Load>
struct LinearVibration {
  static constexpr bool constant_mass = true;
  static constexpr bool may_have_rows = false;
  static constexpr bool has_groups = false;

  MatX mass, damping, stiffness;  ///< (n×n)
  Load load;
  std::string name;  ///< in messages

  Index size() const { return mass.rows(); }

  /// As a model sees it, it is one body with as many coordinates as speeds.
  struct Body : AddingCoordinates {
    Index size;
    Index coordinates() const { return size; }
    Index speeds() const { return size; }
  };
  struct Entry {
    Body body;
    Index q0 = 0, v0 = 0;
  };
  template <class F>
  void for_each_body(F&& f) const {
    f(Entry{{{}, size()}});
  }
};

template <class Load>
class System<LinearVibration<Load>> {
 public:
  using ModelType = LinearVibration<Load>;

  /// The model must outlive the system.
  explicit System(ModelType const& model)
      : model_(&model),
        f_(VecX::Zero(model.size())),
        q_(f_),
        v_(f_),
        damping_(model.damping),
        stiffness_(model.stiffness),
        tangent_(model.mass) {}

  ModelType const& model() const { return *model_; }
  Index coordinates() const { return model_->size(); }
  Index speeds() const { return model_->size(); }
  Index rows() const { return 0; }
  std::vector<Index> const& velocity_rows() const { return no_rows_; }
  Index size() const { return model_->size(); }
  double time() const { return t_; }

  void evaluate(VecX const& q, VecX const& v, double t) {
    q_ = q;
    v_ = v;
    t_ = t;
    model_->load(t, f_);
    if constexpr (ChangesMatrices<Load>) {
      damping_ = model_->damping;
      stiffness_ = model_->stiffness;
      model_->load.add_matrices(t, damping_, stiffness_);
    }
  }
  /// r = M a + D v + K q − f.
  void residual(VecX const& a, VecX const&, VecX& r) const {
    r.noalias() = model_->mass * a;
    r.noalias() += damping_ * v_;
    r.noalias() += stiffness_ * q_;
    r -= f_;
  }
  template <TangentSink Sink>
  void tangent(TangentCoefficients const& c, SecondOrder, VecX const&, Sink& sink) {
    tangent_ = c.mass * model_->mass + c.damping * damping_ + c.stiffness * stiffness_;
    sink.add(0, 0, tangent_);
  }

  void violation(VecX&) const {}
  void violation_rate(VecX&) const {}
  void acceleration_bias(VecX&) const {}
  void rows_times(VecX const&, VecX&) const {}
  void plus(VecX const& q, VecX const& delta, VecX& out) const { out = q + delta; }
  void local_rate(VecX const&, VecX const& v, VecX& out) const { out = v; }

  std::string name_of(Index i) const { return "coordinate " + std::to_string(i) + " of \"" + model_->name + "\""; }
  void require_finite_force(VecX const& x) const {
    if (Index const i = detail::first_not_finite(x); i >= 0) detail::throw_force_not_finite(name_of(i), t_);
  }
  void require_finite_rows(VecX const&) const {}

  Index equations() const { return size(); }
  Index equation_speeds() const { return size(); }
  std::string name_of_equation(Index i) const { return name_of(i); }
  struct Held {};
  static constexpr bool solves_as_it_is = true;
  static constexpr bool solves_by_bodies = false;
  void hold(Held&) const {}
  void spread(Held&, VecX const& rhs, VecX& out) const { out = rhs; }
  void gather(Held&, VecX const& solution, VecX& out) const { out = solution; }

 private:
  ModelType const* model_;
  std::vector<Index> no_rows_;
  VecX f_, q_, v_;
  MatX damping_, stiffness_, tangent_;
  double t_ = 0.0;
};

}  // namespace polybody
