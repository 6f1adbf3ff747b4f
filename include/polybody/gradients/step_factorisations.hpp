#pragma once
/// \file
/// Approximate factorisations of the matrix of a linearised step, or of its transpose.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <array>
#include <optional>

#include <polybody/gradients/increment_tangent.hpp>
#include <polybody/gradients/preconditioner_choice.hpp>
#include <polybody/gradients/step_ends.hpp>
#include <polybody/system/active_contact_pairs.hpp>

namespace polybody {

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
  /// has rotations
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

  /// Tangent coefficients for a kind of factorisation, with the active contact pairs of this kind.
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
