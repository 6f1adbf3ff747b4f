#pragma once
/// \file
/// Approximate factorisations of the matrix of a linearised step, or of its transpose.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <polybody/elimination/reduced_coordinates.hpp>
#include <polybody/gradients/increment_tangent.hpp>
#include <polybody/integrators/alpha_method.hpp>
#include <polybody/math/compiler.hpp>
#include <polybody/system/active_contact_pairs.hpp>

namespace polybody {

// Choice of the approximate factorisation for the derivatives of steps, by its measured cost.

/// Approximate factorisations of the matrix of a linearised step.
enum class ApproximateFactors {
  of_step,  ///< factorisation from the solution of the step itself, without further cost
  of_end,   ///< factorisation of the tangent at the end of the step
  exact,    ///< like `of_end`, with the terms that Newton's method omits, such as second-order terms
  turned,   ///< like `exact`, with the derivative of ⊞ in addition (gradients/increment_tangent.hpp)
};

/// Chooses the kind of factorisation with the lowest cost. The cost is the number of passes through the equations, plus
/// the cost of the factorisation. The candidates are tried one after another until one pass per group of directions is
/// sufficient. The trial is repeated every hundred steps.
class PreconditionerChoice {
 public:
  /// Kind of factorisation with its cost.
  struct Candidate {
    ApproximateFactors factors;  ///< kind of factorisation
    double cost;                 ///< cost of the factorisation [passes with their solutions]
  };

  /// \param candidates at least one, the cheapest first
  [[gnu::cold]] explicit PreconditionerChoice(std::vector<Candidate> candidates)
      : candidates_(std::move(candidates)), taken_(candidates_.size(), never) {}

  /// Begins another step. Returns its kind of factorisation.
  ApproximateFactors next() {
    if (step_ > 0) taken_[now_] = passes_ + candidates_[now_].cost + also_;
    bool const least = passes_ == directions_;  // one pass for each group
    if (step_ == 0 || step_ == period) {
      now_ = 0;
      step_ = 0;
      taken_.assign(candidates_.size(), never);
    } else if (tries_) {
      tries_ = !least && now_ + 1 < candidates_.size();
      now_ = tries_ ? now_ + 1 : std::size_t(std::min_element(taken_.begin(), taken_.end()) - taken_.begin());
    }
    if (step_++ == 0) tries_ = true;
    passes_ = directions_ = 0;
    also_ = 0.0;
    return now();
  }
  /// Kind of factorisation of the current step.
  ApproximateFactors now() const { return candidates_[now_].factors; }
  /// Adds the cost of another kind, which is factorised in the same step because the chosen kind is not sufficient.
  void make(ApproximateFactors others) {
    for (Candidate const& c : candidates_)
      if (c.factors == others) also_ += c.cost;
  }
  /// Adds the passes through the equations of one group of directions of the step.
  void add(int passes) {
    passes_ += passes;
    ++directions_;
  }

 private:
  static constexpr int period = 100;  // steps
  static constexpr double never = std::numeric_limits<double>::infinity();

  std::vector<Candidate> candidates_;
  std::vector<double> taken_;  // by candidates: cost of a step [passes]
  std::size_t now_ = 0;
  double also_ = 0.0;  // cost of other factorisations in the step [passes]
  bool tries_ = true;
  int step_ = 0, passes_ = 0, directions_ = 0;
};

// Ends of a step of the generalised-α family, and the derivatives of the equations of the step with respect to a
// parameter.

/// Derivatives of the equations at the end of a step with respect to a parameter, at constant unknowns. For
/// nonholonomic constraints Φ̇ replaces Φ.
struct EquationDerivative {
  VecX balance;        ///< (nv) ∂r/∂p
  VecX rows;           ///< (rows) ∂Φ/∂p
  double scale = 1.0;  ///< change of the parameter that may change a and λ by their own size [unit of p]
};

/// Ends of a step of length h: states before and after the step, and the algorithmic accelerations there.
struct StepEnds {
  State const& before;     ///< state at the start of the step, with corrected velocities
  State const& after;      ///< state at the end of the step
  VecX const& own_before;  ///< (nv) algorithmic accelerations a₀ at the start
  VecX const& own_after;   ///< (nv) algorithmic accelerations a₁ at the end
  double h;                ///< length of the step [s]

  /// Increment δ (nv) of the step with `method`: q₁ = q₀ ⊞ δ.
  VecX increment(AlphaMethod const& method) const {
    return h * before.v + h * h * ((0.5 - method.beta) * own_before + method.beta * own_after);
  }
  /// Coordinates, velocities, time, accelerations and multipliers at the end of the step.
  StepPosition end() const { return {{after.q, after.v, after.t}, after.a, after.lambda}; }
};

/// Direction of differentiation of a step.
struct StepDirection {
  EquationDerivative by;  ///< derivatives of the equations at the end of the step
  State* dx = nullptr;    ///< derivative of the state before the step, converted in place to that after the step
  double dh = 0.0;        ///< derivative of the step length [s / unit of p]; `by` includes that of the end time
};

namespace detail {
/// Prepares the system for the evaluation of its tangent with second-order terms. If joints are eliminated, the
/// residual is also evaluated, because the matrix depends on the reactions of these joints in the last reduced
/// residual. \param r (nv) workspace
template <class = void>
void evaluate_for_tangent(System& system, StepPosition const& x, VecX& r) {
  system.evaluate(x.at.q, x.at.v, x.at.t);
  if (!system.step_coordinates()) return;
  r.resize(system.velocities());
  system.residual(x.a, x.lambda, r);
}
}  // namespace detail

/// Receiver that passes blocks on with rows and columns exchanged.
template <BlockReceiver S>
class TransposedSink {
 public:
  explicit TransposedSink(S& target) : target_(target) {}  ///< passes blocks to `target`
  /// Adds block b at (row, col) of the matrix, hence at (col, row) of the transposed matrix.
  void add(Index row, Index col, BlockView const& b) { target_.add(col, row, b.transposed()); }
  /// Adds zeros at (row, col), `rows` × `cols`.
  void skip(Index row, Index col, Index rows, Index cols)
    requires ZeroSkippingReceiver<S>
  {
    target_.skip(col, row, cols, rows);
  }

 private:
  S& target_;
};

/// The matrix of a linearised step, or its transpose.
enum class Derivative { direct, transposed };

/// Approximate factorisations for successive steps, of the kind with the lowest cost (`PreconditionerChoice`). The
/// structure of each kind is analysed at its first use.
template <LinearSolver Solver, Derivative derivative>
class StepFactorisations {
 public:
  using OfStep = TangentSolver<StepSolver<Solver>>;  ///< solver of the step itself

  /// The system must outlive this object. \param candidates kinds of factorisation; `turned` is only used if the model
  /// has rotations and its joints eliminate no unknowns
  [[gnu::cold]] StepFactorisations(System& system, AlphaMethod const& method,
                                   std::vector<PreconditionerChoice::Candidate> candidates)
      : system_(&system), method_(method), turned_(system), choice_(of_use(std::move(candidates))) {}

  /// Chooses and computes the factorisation of this step. \param near factorisation from the solution of the step
  /// itself; may be null. \throws SingularMatrix in a singular configuration.
  void set(StepEnds const& step, OfStep* near = nullptr) {
    kind_ = choice_.next();
    near_ = near;
    if (kind_ != ApproximateFactors::of_step || !near) factor(step, std::max(kind_, ApproximateFactors::of_end));
  }
  /// Computes the most accurate factorisation. \throws SingularMatrix in a singular configuration.
  void set_nearest(StepEnds const& step) {
    choice_.make(nearest());
    factor(step, nearest());
  }
  /// True if the factorisation is of the most accurate kind.
  bool are_nearest() const { return kind_ == nearest(); }
  /// True if the factorised matrix contains the terms that Newton's method omits.
  bool are_exact() const { return kind_ >= ApproximateFactors::exact; }
  /// Solves for x with the right-hand side `rhs`; both have the order of the unknowns of the step.
  void solve(VecX const& rhs, VecX& x) {
    if (kind_ == ApproximateFactors::of_step) return near_->solve(rhs, x);
    if (kind_ != ApproximateFactors::turned) return factors_->solve(rhs, x);
    if constexpr (derivative == Derivative::transposed) {
      turned_rhs_ = rhs;
      turned_.transpose_to_increments(turned_rhs_);
      factors_->solve(turned_rhs_, x);
    } else {
      factors_->solve(rhs, x);
      turned_.to_increments(x);
    }
  }
  /// Adds the passes of one group of directions to the cost of the step.
  void took(int passes) { choice_.add(passes); }

 private:
  using Factors = TangentSolver<StepSolver<UnsymmetricSolver<Solver>>>;

  std::vector<PreconditionerChoice::Candidate> of_use(std::vector<PreconditionerChoice::Candidate> all) const {
    if (!turned_.any()) std::erase_if(all, [](auto const& c) { return c.factors == ApproximateFactors::turned; });
    return all;
  }
  ApproximateFactors nearest() const { return turned_.any() ? ApproximateFactors::turned : ApproximateFactors::exact; }

  static SecondOrder second_order(ApproximateFactors kind) {
    return kind == ApproximateFactors::of_end ? SecondOrder::omitted : SecondOrder::included;
  }

  /// Tangent coefficients for a factorisation of the `kind`. They refer to the contact pairs that have blocks in its
  /// matrix.
  TangentCoefficients coefficients(ApproximateFactors kind, double mass, double damping, double stiffness) {
    return {.mass = mass,
            .damping = damping,
            .stiffness = stiffness,
            .exact = kind >= ApproximateFactors::exact,
            .pairs = &own_[std::size_t(kind)].pairs};
  }
  /// Writes the matrix for a kind of factorisation, for the last evaluation of the system.
  void write(ApproximateFactors kind, TangentCoefficients const& k, VecX const& lambda, BlockSink& sink) {
    auto const write_into = [&](auto& receiver) {
      k.pairs->begin();
      system_->tangent(k, second_order(kind), lambda, receiver);
      if (kind != ApproximateFactors::turned) return;
      k.pairs->begin();
      turned_.write(*system_, k, receiver);
    };
    if constexpr (derivative == Derivative::transposed) {
      TransposedSink<BlockSink> transposed(sink);
      write_into(transposed);
    } else {
      write_into(sink);
    }
  }
  /// Analyses the structure of the matrix for a kind of factorisation, with its stored contact pairs.
  [[gnu::cold]] void lay_out(ApproximateFactors kind, VecX const& lambda) {
    TangentCoefficients const k = coefficients(kind, 1.0, 1.0, 1.0);
    own_[std::size_t(kind)].factors.emplace().analyse(*system_, 1,
                                                      [&](BlockSink& sink) { write(kind, k, lambda, sink); });
  }
  void factor(StepEnds const& step, ApproximateFactors kind) {
    StepPosition const end = step.end();
    if (kind == ApproximateFactors::turned) turned_.set(*system_, step.increment(method_));
    Own& own = own_[std::size_t(kind)];
    for (bool again = true; again;) {
      detail::evaluate_for_tangent(*system_, end, balance_);
      if (!own.factors) lay_out(kind, end.lambda);
      std::size_t const reordered = own.factors->reorderings();
      Index const bad = factor(kind, step.h, end);
      bool const lacks = own.pairs.lacks();
      again = lacks || (bad >= 0 && own.factors->reorderings() != reordered);
      if (bad >= 0 && !again)
        throw SingularMatrix("derivative.singular",
                             {"The equations of the linearised step to t = ", ErrorTime{end.at.t},
                              " s are singular at ", ErrorObject{name_of_equation(*system_, bad)},
                              ". Avoid the singular configuration, or take a smaller step."});
      if (!lacks) continue;
      own.pairs.hold();
      lay_out(kind, end.lambda);
    }
    factors_ = &*own.factors;
    kind_ = kind;
  }
  Index factor(ApproximateFactors kind, double h, StepPosition const& end) {
    TangentCoefficients const k = coefficients(kind, method_.mass(), method_.gamma * h, method_.beta * h * h);
    Factors& factors = *own_[std::size_t(kind)].factors;
    if (derivative == Derivative::direct && kind != ApproximateFactors::turned) {
      k.pairs->begin();
      return factors.factor_tangent(*system_, end, k, second_order(kind));
    }
    return factors.factor([&](BlockSink& sink) { write(kind, k, end.lambda, sink); });
  }

  /// Factorisation of one kind, with the contact pairs that have blocks in its matrix.
  struct Own {
    std::optional<Factors> factors;
    ActiveContactPairs pairs;
  };

  System* system_;
  AlphaMethod method_;
  IncrementTangent turned_;
  PreconditionerChoice choice_;
  ApproximateFactors kind_ = ApproximateFactors::of_step;
  std::array<Own, 4> own_;      // by kind
  Factors* factors_ = nullptr;  // current factorisation
  OfStep* near_ = nullptr;
  VecX balance_, turned_rhs_;
};

}  // namespace polybody
