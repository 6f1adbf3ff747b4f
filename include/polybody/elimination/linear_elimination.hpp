#pragma once
/// \file
/// Elimination of dependent coordinates, e_d = Σ f_k e_k + c_d, with linear constraint equations C e = c, once before a
/// run [thesis §3.5.4]. The dependent coordinates of earlier rows are eliminated from row k of C: row'_k = row_k − Σ_j
/// m_kj row'_j. The coordinate of the entry p_k of row'_k with the largest magnitude becomes the next dependent
/// coordinate. The multipliers follow from the balance Cᵀλ = −r of the dependent coordinates with the same factors
/// m_kj:
///   p_k λ'_k = −r_dk − Σ_{j<k} row'_j,dk λ'_j,   λ_j = λ'_j − Σ_{k>j} m_kj λ_k.
/// The index dk denotes the dependent coordinate of row k.
/// Theory: Eqs. 5.14 to 5.16.

#include <polybody/math/errors.hpp>
#include <polybody/math/index_map.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/linear_constraints.hpp>

namespace polybody {

/// Dependent coordinates as linear functions of independent coordinates, q_d = c + Σ f q_i, from the equations of
/// linear joints. \tparam T scalar type of the vectors; factors are doubles
template <class T = double>
class LinearEliminationOf {
 public:
  /// Independent coordinate and its factor f.
  struct Term {
    Index q, v;     ///< indices among coordinates and generalised velocities
    double factor;  ///< f [unit of dependent coordinate per unit of independent coordinate]
  };
  /// Dependent coordinate with its constant and its terms.
  struct Dependent {
    Index q, v;            ///< indices among coordinates and generalised velocities
    double constant;       ///< c [unit of the coordinate]
    Sequence<Term> terms;  ///< Σ f q_i
  };

  LinearEliminationOf() = default;
  /// Eliminates coordinates with the equations of `joints`. Redundant equations are omitted. \throws
  /// InconsistentInitialConditions if equations contradict each other by more than 1e-8 [unit of the equation].
  explicit LinearEliminationOf(Sequence<LinearConstraints> const& joints) {
    for (LinearConstraints const& rows : joints)
      for (Index i = 0; i < rows.rows(); ++i) take(rows, i);
    for (std::size_t k = pivots_.size(); k-- > 0;) solve_for(k);
  }

  /// True if no coordinate is dependent.
  bool empty() const { return dependents_.empty(); }
  /// Dependent coordinates with their terms.
  Sequence<Dependent> const& dependents() const { return dependents_; }
  /// Indices of redundant equations.
  Sequence<Index> const& redundant() const { return redundant_; }

  /// Computes the dependent coordinates from the independent coordinates: q_d = c + Σ f q_i.
  void expand_coordinates(VecXOf<T>& q) const {
    for (Dependent const& d : dependents_) {
      T sum(d.constant);
      for (Term const& t : d.terms) sum += t.factor * q[t.q];
      q[d.q] = sum;
    }
  }
  /// Computes the dependent velocities or accelerations, v_d = Σ f v_i, from the independent velocities or
  /// accelerations.
  void expand_rates(VecXOf<T>& v) const {
    for (Dependent const& d : dependents_) {
      T sum(0.0);
      for (Term const& t : d.terms) sum += t.factor * v[t.v];
      v[d.v] = sum;
    }
  }
  /// Adds the generalised forces of dependent coordinates, in r (nv), to those of independent coordinates: r_i += f
  /// r_d.
  void reduce_forces(VecXOf<T>& r) const {
    for (Dependent const& d : dependents_)
      for (Term const& t : d.terms) r[t.v] += t.factor * r[d.v];
  }
  /// Computes the multipliers λ (rows) of the linear equations. r (nv) is the residual without the forces of these
  /// equations. Multipliers of redundant equations are zero.
  void multipliers(VecXOf<T> const& r, VecXOf<T>& lambda) const {
    for (Index const i : redundant_) lambda[i] = T(0.0);
    for (std::size_t k = 0; k < pivots_.size(); ++k) {
      Pivot const& p = pivots_[k];
      T sum = -r[p.v];
      for (auto const& [j, entry] : p.above) sum -= entry * lambda[pivots_[j].row];
      lambda[p.row] = sum / *p.entries.find(p.v);
    }
    for (std::size_t k = pivots_.size(); k-- > 0;)
      for (auto const& [j, m] : pivots_[k].multiples) lambda[pivots_[j].row] -= m * lambda[pivots_[k].row];
  }

 private:
  /// Equation after elimination, with the factors of the elimination.
  struct Pivot {
    Index row;                                                ///< index of the equation in the model
    Index v = -1;                                             ///< velocity index of its dependent coordinate
    IndexMap<double> entries;                                 ///< coefficients by velocity index
    double constant;                                          ///< right-hand side [unit of the equation]
    Sequence<std::pair<std::size_t, double>> multiples = {};  ///< j and m_kj
    Sequence<std::pair<std::size_t, double>> above = {};      ///< j and row'_j,dk of earlier equations
  };

  void take(LinearConstraints const& joint, Index i) {
    Pivot p{.row = joint.row + i, .entries = {}, .constant = joint.constant[i]};
    double scale = 0.0;
    for (LinearSide const* const side : {&joint.a, &joint.b})
      for (Index j = 0; j < side->map.cols(); ++j)
        if (double const c = side->map(i, j); c != 0.0) {
          p.entries[side->v0 + j] += c;
          coordinate_[side->v0 + j] = side->q0 + j;
          scale = std::max(scale, std::abs(c));
        }
    eliminate(p);
    double largest = 0.0;
    for (auto const& [v, entry] : p.entries)
      if (std::abs(entry) >= largest * (1.0 - 1e-12)) {
        largest = std::max(largest, std::abs(entry));
        p.v = v;
      }
    if (largest <= 1e-10 * scale) {
      if (std::abs(p.constant) > 1e-8)
        throw InconsistentInitialConditions(
            "ancf_linear.contradiction",
            {"\"", ErrorObject{joint.name}, "\": the linear constraint equations contradict those of other joints by ",
             ErrorValue{std::abs(p.constant)}, ". Place the bodies so that the loop closes, or omit a joint."});
      redundant_.push_back(p.row);
      return;
    }
    for (std::size_t j = 0; j < pivots_.size(); ++j)
      if (double const* const found = pivots_[j].entries.find(p.v)) p.above.emplace_back(j, *found);
    pivot_of_[p.v] = pivots_.size();
    pivots_.push_back(std::move(p));
  }

  /// Eliminates all previous dependent coordinates from a row, the earliest first. Each elimination can introduce only
  /// later dependent coordinates.
  void eliminate(Pivot& p) const {
    for (;;) {
      std::size_t first = pivots_.size();
      for (auto const& [v, entry] : p.entries)
        if (std::size_t const* const found = pivot_of_.find(v)) first = std::min(first, *found);
      if (first == pivots_.size()) return;
      Pivot const& by = pivots_[first];
      double const m = *p.entries.find(by.v) / *by.entries.find(by.v);
      p.multiples.emplace_back(first, m);
      p.constant -= m * by.constant;
      for (auto const& [v, entry] : by.entries) {
        double& e = p.entries[v];
        e -= m * entry;
        if (v == by.v || std::abs(e) <= 1e-14 * std::abs(m * entry)) p.entries.erase(v);
      }
    }
  }

  /// Expresses e_d of pivot k by independent coordinates. All later pivots must already be solved.
  void solve_for(std::size_t k) {
    Pivot const& p = pivots_[k];
    double const pivot = *p.entries.find(p.v);
    IndexMap<double> factors;
    double constant = p.constant / pivot;
    for (auto const& [v, entry] : p.entries) {
      if (v == p.v) continue;
      std::size_t const* const later = solved_.find(v);
      if (!later) {
        factors[v] -= entry / pivot;
        continue;
      }
      Dependent const& d = dependents_[*later];
      constant -= entry / pivot * d.constant;
      for (Term const& t : d.terms) factors[t.v] -= entry / pivot * t.factor;
    }
    Dependent d{*coordinate_.find(p.v), p.v, constant, {}};
    for (auto const& [v, factor] : factors)
      if (factor != 0.0) d.terms.push_back({*coordinate_.find(v), v, factor});
    solved_[p.v] = dependents_.size();
    dependents_.push_back(std::move(d));
  }

  Sequence<Pivot> pivots_;
  Sequence<Dependent> dependents_;
  Sequence<Index> redundant_;
  IndexMap<Index> coordinate_;  // coordinate index for each velocity index
  IndexMap<std::size_t> pivot_of_, solved_;
};

using LinearElimination = LinearEliminationOf<>;  ///< elimination with vectors of doubles

}  // namespace polybody
