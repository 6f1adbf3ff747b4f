#pragma once
/// \file
/// Factors near the derivative of a step's equations by its unknowns, or near the transposed one.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <array>
#include <optional>

#include <polybody/gradients/increment_tangent.hpp>
#include <polybody/gradients/preconditioner_choice.hpp>
#include <polybody/gradients/step_ends.hpp>
#include <polybody/system/active_contact_pairs.hpp>

namespace polybody {

/// Passes blocks on with rows and columns exchanged.
template <BlockReceiver S>
class TransposedSink {
 public:
  explicit TransposedSink(S& target) : target_(target) {}  ///< to `target`
  /// Block b at (row, col) of the matrix, (col, row) of the transposed one.
  void add(Index row, Index col, BlockView const& b) { target_.add(col, row, b.transposed()); }
  /// Zeros at (row, col), `rows` × `cols`.
  void skip(Index row, Index col, Index rows, Index cols)
    requires ZeroSkippingReceiver<S>
  {
    target_.skip(col, row, cols, rows);
  }

 private:
  S& target_;
};

/// Which derivative.
enum class Derivative { direct, transposed };

/// The factors of a step, of the kind that has taken the fewest passes; those of each kind are laid out when they are
/// first asked for.
template <LinearSolver Solver, Derivative derivative>
class StepFactorisations {
 public:
  using OfStep = TangentSolver<StepSolver<Solver>>;  ///< by which a step is solved

  /// The system must outlive it. \param candidates among which to choose, of `turned` only where unknowns turn
  [[gnu::cold]] StepFactorisations(System& system, AlphaMethod const& method,
                                   std::vector<PreconditionerChoice::Candidate> candidates)
      : system_(&system), method_(method), turned_(system), choice_(of_use(std::move(candidates))) {}

  /// From now on they are of this step. \param near those of the step itself, or none. \throws SingularMatrix at
  /// a singular position.
  void set(StepEnds const& step, OfStep* near = nullptr) {
    kind_ = choice_.next();
    near_ = near;
    if (kind_ != ApproximateFactors::of_step || !near) factor(step, std::max(kind_, ApproximateFactors::of_end));
  }
  /// Takes the nearest ones that there are. \throws SingularMatrix likewise.
  void set_nearest(StepEnds const& step) {
    choice_.make(nearest());
    factor(step, nearest());
  }
  /// They are the nearest ones.
  bool are_nearest() const { return kind_ == nearest(); }
  /// They are of the tangent with all terms that steps leave out.
  bool are_exact() const { return kind_ >= ApproximateFactors::exact; }
  /// x for the right-hand side `rhs`, both by the unknowns of the step.
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
  /// Solutions of the step took so many passes, for directions that went together.
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

  /// The coefficients of a kind, with the pairs of force groups that act.
  TangentCoefficients coefficients(ApproximateFactors kind, double mass, double damping, double stiffness) {
    return {.mass = mass,
            .damping = damping,
            .stiffness = stiffness,
            .exact = kind >= ApproximateFactors::exact,
            .pairs = &own_[std::size_t(kind)].pairs};
  }
  /// Writes the tangent of a kind where the system was evaluated last.
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
  /// Lays the factors of a kind out, for the pairs that are held.
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
                             {"The derivative of the step to t = ", ErrorTime{end.at.t}, " s has no pivot at ",
                              ErrorObject{name_of_equation(*system_, bad)}, "."});
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

  /// Factors of a kind, and the pairs whose blocks they have.
  struct Own {
    std::optional<Factors> factors;
    ActiveContactPairs pairs;
  };

  System* system_;
  AlphaMethod method_;
  IncrementTangent turned_;
  PreconditionerChoice choice_;
  ApproximateFactors kind_ = ApproximateFactors::of_step;
  std::array<Own, 4> own_;      // by their kind
  Factors* factors_ = nullptr;  // one of these
  OfStep* near_ = nullptr;
  VecX balance_, turned_rhs_;
};

}  // namespace polybody
