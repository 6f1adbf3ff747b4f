#pragma once
/// \file
/// Loops over all joints of one type in a model. The loops depend on the type of the joint, but not on the type of the
/// model (compare body_kernels.hpp).
/// Theory: Eqs. 4.4, 4.5, 4.18, 5.3 to 5.6.

#include <new>

#include <polybody/joints/joint.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/time_functions.hpp>
#include <polybody/system/body_tangents.hpp>
#include <polybody/system/linear_constraints.hpp>
#include <polybody/system/projected_stiffness.hpp>

namespace polybody {

/// Rate ġ = Ga Va + Gb Vb + Φ_t of a constraint function between two frames a and b with the twists Va and Vb.
template <int m, StateScalar T>
Vec<T, m> constraint_rate(ConstraintTerms<m, T> const& terms, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 6> const va = twist(a), vb = twist(b);
  Vec<T, m> rate;
  for (int i = 0; i < m; ++i) {
    T by_a = terms.Ga(i, 0) * va[0], by_b = terms.Gb(i, 0) * vb[0];
    for (int j = 1; j < 6; ++j) {
      by_a += terms.Ga(i, j) * va[j];
      by_b += terms.Gb(i, j) * vb[j];
    }
    rate[i] = by_a + by_b + terms.rate[i];
  }
  return rate;
}

namespace detail {

/// Workspace for all joints of one type: constraint terms of each joint, and λ(g, ġ) of each compliant joint.
template <class J, StateScalar T>
struct JointData {
  Sequence<ConstraintTerms<J::rows, T>> terms;
  Sequence<Vec<T, J::rows>> answers;
};

/// Appends the breakpoints of a function of time to `all`. Steps end at breakpoints.
template <class Law>
void add_breakpoints(Law const& law, Sequence<double>& all) {
  if constexpr (HasBreakpoints<Law>)
    for (double const t : law.breakpoints()) all.push_back(t);
}

/// Adds −scale · w of each wrench w to the load of its marker.
template <std::size_t n>
void add_loads(std::array<Wrench<double>, n> const& w, std::array<Index, n> const& markers, double scale,
               Data<double>& data) {
  for (std::size_t k = 0; k < n; ++k) {
    Wrench<double>& to = data.loads[std::size_t(markers[k])];
    for (int i = 0; i < 3; ++i) {
      to.f[i] -= scale * w[k].f[i];
      to.m[i] -= scale * w[k].m[i];
    }
  }
}

template <class L>
inline constexpr bool law_has_potential = requires(L const& law) { law.potential(0.0); };
/// True if every law of a bushing has a potential. Other policies always have a potential.
template <class P>
constexpr bool has_potential() {
  if constexpr (requires(P const& p) { std::get<0>(p.laws); })
    return []<class... Laws>(std::tuple<Laws...> const*) {
      return (law_has_potential<Laws> && ...);
    }(static_cast<decltype(P::laws) const*>(nullptr));
  else
    return true;
}

/// λ(g, 0) of those laws of a bushing that have no potential; zero for other laws and policies. \param rest λ(g, 0) of
/// all laws
template <class P, int m>
Vec<double, m> rest_without_potential(P const& policy, Vec<double, m> rest) {
  if constexpr (requires { std::get<0>(policy.laws); })
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      auto const clear = [&](std::size_t k, auto const& law) {
        if constexpr (requires { law.potential(0.0); }) rest[Index(k)] = 0.0;
      };
      (clear(i, std::get<i>(policy.laws)), ...);
    }(std::make_index_sequence<std::size_t(m)>{});
  else
    for (int i = 0; i < m; ++i) rest[i] = 0.0;
  return rest;
}

/// ∂ġ/∂(poses) (m×12) of ġ = G V at constant velocities of the bodies. Row i is Vᵀ ∂(Gᵀeᵢ)/∂(poses) +
/// (G ∂V/∂(poses))ᵢ. A dependence of Φ_t on the poses is neglected.
template <class G>
Mat<double, constraint_equations<G>(), 12> rates_by_poses(G const& geometry,
                                                          ConstraintTerms<constraint_equations<G>()> const& terms,
                                                          std::array<MarkerKinematics<double> const*, 2> const& markers,
                                                          double t) {
  constexpr int m = constraint_equations<G>();
  Frame<double> const &a = markers[0]->frame, &b = markers[1]->frame;
  Vec<double, 6> const twists[2] = {twist(a), twist(b)};
  auto rates = zeros<Mat<double, m, 12>>();
  for (int i = 0; i < m; ++i) {
    auto one = zeros<Vec<double, m>>();
    one[i] = 1.0;
    Mat<double, 12, 12> const h = wrench_gradient(geometry, a, b, t, one);
    for (int k = 0; k < 12; ++k)
      for (int j = 0; j < 12; ++j) rates(i, k) += twists[j / 6][j % 6] * h(j, k);
  }
  add_rates_of_pose<m>(*markers[0], terms.Ga.data(), rates.data());
  add_rates_of_pose<m>(*markers[1], terms.Gb.data(), rates.data() + 6 * m);
  return rates;
}
/// s += ck Gᵀ ∂λ/∂ġ ∂ġ/∂(poses) of a compliant joint.
template <class J>
void add_rate_slopes(J const& joint, ConstraintTerms<J::rows, double> const& terms,
                     std::array<MarkerKinematics<double> const*, 2> const& markers, StiffnessAt const& x,
                     Mat<double, 12, 12>& s) {
  constexpr int m = J::rows;
  Mat<double, m, 12> const rates = rates_by_poses(joint.measure(), terms, markers, x.at.t);
  Mat<double, m, m> const slope = joint.policy.template slope<m>(
      0.0, x.c.stiffness, terms.g, constraint_rate(terms, markers[0]->frame, markers[1]->frame));
  for (int k = 0; k < 12; ++k)
    for (int i = 0; i < m; ++i) {
      double answer = 0.0;
      for (int l = 0; l < m; ++l) answer += slope(i, l) * rates(l, k);
      for (int j = 0; j < 12; ++j) s(j, k) += (j < 6 ? terms.Ga(i, j) : terms.Gb(i, j - 6)) * answer;
    }
}
/// Adds ck/cd ∂ġ/∂(poses) to G in the n nonholonomic equations, which are the last equations of the joint. \param row
/// index of the first of these equations in the matrix
template <int n, int m>
void add_velocity_rows(Mat<double, m, 12> const& rates, std::array<MarkerKinematics<double> const*, 2> const& markers,
                       StiffnessAt const& x, Index row, Sequence<double>& scratch, BlockSink& sink) {
  double part[12 * n];  // entry i of row k at 12 k + i
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < 12; ++i) part[12 * k + i] = x.c.stiffness / x.c.damping * rates(m - n + k, i);
  for (int end = 0; end < 2; ++end) {
    MarkerKinematics<double> const& p = *markers[std::size_t(end)];
    if (p.columns > 0) sink.add(row, p.first, pulled<n>(p, part + 6 * end, 1, 12, scratch).transposed());
  }
}

}  // namespace detail

/// Loops over the joints of type J, for the scalar T. Energies and tangents exist for doubles only. Linear joints have
/// no constraint terms; the model stores their equations (linear_constraints.hpp).
template <class J, StateScalar T>
struct JointKernels {
  using P = typename J::PolicyType;                          ///< policy that enforces the equations
  using Pool = Sequence<detail::JointEntry<J>>;              ///< joints of this type, in a model
  using Kept = detail::JointData<J, T>;                      ///< workspace
  static constexpr bool linear = LinearPolicy<P>;            ///< true if the equations are linear in q
  static constexpr bool compliant = !ConstrainingPolicy<P>;  ///< true if forces enforce the equations

  /// Appends sizes, positions and names of the joints to `out`.
  [[gnu::cold]] static void describe(Pool const& pool, Sequence<LinearConstraints> const& linear_rows,
                                     ModelLayout& out);
  /// Allocates constraint terms and appends a constraint block for each joint. For linear joints, whose blocks already
  /// exist from `first_linear` on, only the owner is set. \param owner position of the first joint in the layout
  [[gnu::cold]] static void place(Pool const& pool, Kept& kept, Index owner, Index first_linear, Data<T>& data);

  /// Evaluates the constraint terms of every joint, and λ(g, ġ) of compliant joints.
  static void measure(Pool const& pool, Kept& kept, double t, Data<T>& data);
  /// Writes γ without the bias accelerations of the markers to `out` (rows).
  static void gamma(Pool const& pool, double t, Data<T> const& data, VecXOf<T>& out);

  /// Writes the tangent ck K + cd D of compliant joints, from the derivatives of λ(g, ġ) and the coefficients c.
  static void slopes(Pool const& pool, Kept const& kept, TangentCoefficients const& c, Data<double>& data,
                     BlockSink& sink);
  /// Writes ck ∂(Gᵀλ)/∂q at the state of x, with the stiffness coefficient ck of x, and adds Gᵀλ to data.loads.
  static void stiffness(Pool const& pool, Kept const& kept, VecX const& lambda, detail::StiffnessAt const& x,
                        Data<double>& data, BlockSink& sink);
  /// Energy stored in compliant joints [J].
  static double energy(Pool const& pool, Kept const& kept);
  /// Adds the powers of the joints [W]. The forces −Gᵀλ on the bodies have the power −λ·G v, with ġ = G v + Φ_t.
  ///   Constraint equations:  ġ = 0, so −λ·G v = λ·Φ_t, the power of the drive; zero without a drive.
  ///   Compliant joints:      −λ·G v = λ·Φ_t − λ(g, 0)·ġ − (λ − λ(g, 0))·ġ: power of the drive, less the rate of the
  ///   stored energy, less the dissipated power. For laws without a potential, −λ(g, 0)·ġ is a power of loads.
  static void add_powers(Pool const& pool, Kept const& kept, VecX const& lambda, Data<double> const& data, Powers& p);
};

template <class J, StateScalar T>
void JointKernels<J, T>::describe(Pool const& pool, Sequence<LinearConstraints> const& linear_rows, ModelLayout& out) {
  Index index = 0;
  for (auto const& e : pool) {
    LinearConstraints const* const rows = e.linear < 0 ? nullptr : &linear_rows[std::size_t(e.linear)];
    out.joints.push_back({e.name, e.a, e.b, e.row, e.rows, EliminatingPolicy<P>, &detail::type_tag<J>, index++, rows,
                          !compliant || detail::has_potential<P>(), e.made_in});
    detail::add_breakpoints(e.joint.geometry, out.breakpoints);
    JointLayout& place = out.joints.back();
    place.joint = &e.joint;
    if constexpr (compliant) {
      place.lossless = false;
      if constexpr (requires { e.joint.policy.is_lossless(); }) place.lossless = e.joint.policy.is_lossless();
    }
    if constexpr (requires(double t) { Motion(e.joint.geometry.law(t)); }) {
      place.law = [](void const* joint, double t) { return Motion(static_cast<J const*>(joint)->geometry.law(t)); };
      if constexpr (requires { J::Geometry::period; }) place.period = J::Geometry::period;
    }
  }
}

template <class J, StateScalar T>
void JointKernels<J, T>::place(Pool const& pool, Kept& kept, Index owner, Index first_linear, Data<T>& data) {
  kept.terms.resize(pool.size());
  kept.answers.resize(pool.size());
  for (std::size_t i = 0; i < pool.size(); ++i, ++owner) {
    auto const& e = pool[i];
    if constexpr (linear) {
      data.rows[std::size_t(first_linear + e.linear)].owner = owner;
    } else {
      data.read[std::size_t(e.a)] = data.read[std::size_t(e.b)] = 1;
      ConstraintTerms<J::rows, T>& terms = kept.terms[i];
      ConstraintBlock<T> block{.source = compliant ? ConstraintSource::compliant : ConstraintSource::joint,
                               .opposite = has_opposite_ends<typename J::Measured>(),
                               .row = e.row,
                               .rows = J::rows,
                               .owner = owner,
                               .a = {e.a, 0, 6, terms.Ga.data()},
                               .b = {e.b, 0, 6, terms.Gb.data()},
                               .g = terms.g.data(),
                               .rate = terms.rate.data()};
      if constexpr (compliant) block.answer = kept.answers[i].data();
      data.rows.push_back(block);
    }
  }
}

template <class J, StateScalar T>
void JointKernels<J, T>::measure(Pool const& pool, Kept& kept, double t, Data<T>& data) {
  if constexpr (!linear)
    share(data.workers, Index(pool.size()), data.least_markers, [&](Index begin, Index end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        auto const& e = pool[i];
        Frame<T> const &a = data.markers[std::size_t(e.a)].frame, &b = data.markers[std::size_t(e.b)].frame;
        using G = ConstraintTerms<J::rows, T>;  // constructed in place, because assignment copies it
        static_assert(std::is_trivially_destructible_v<G>);
        ::new (static_cast<void*>(&kept.terms[i])) G(constraint_function<T>(e.joint.measure(), a, b, t));
        if constexpr (compliant)
          kept.answers[i] =
              e.joint.policy.template multiplier<J::rows, T>(kept.terms[i].g, constraint_rate(kept.terms[i], a, b));
      }
    });
}

template <class J, StateScalar T>
void JointKernels<J, T>::gamma(Pool const& pool, double t, Data<T> const& data, VecXOf<T>& out) {
  if constexpr (!linear && !compliant)
    for (auto const& e : pool) {
      Vec<T, J::rows> const gamma = constraint_gamma<T>(e.joint.geometry, data.markers[std::size_t(e.a)].frame,
                                                        data.markers[std::size_t(e.b)].frame, t);
      for (int i = 0; i < J::rows; ++i) out[e.row + i] = gamma[i];
    }
}

template <class J, StateScalar T>
void JointKernels<J, T>::slopes(Pool const& pool, Kept const& kept, TangentCoefficients const& c, Data<double>& data,
                                BlockSink& sink) {
  if constexpr (!linear && compliant)
    for (std::size_t i = 0; i < pool.size(); ++i) {
      constexpr int m = J::rows;
      auto const& e = pool[i];
      ConstraintTerms<m, double> const& terms = kept.terms[i];
      MarkerKinematics<double> const &a = data.markers[std::size_t(e.a)], &b = data.markers[std::size_t(e.b)];
      auto const slope =
          e.joint.policy.template slope<m>(c.stiffness, c.damping, terms.g, constraint_rate(terms, a.frame, b.frame));
      double const* const maps[2] = {terms.Ga.data(), terms.Gb.data()};
      if constexpr (requires { slope.toDenseMatrix(); })
        detail::add_pulled_slope<m, true>({&a, &b}, maps, slope.diagonal().data(), data.scratch, sink);
      else
        detail::add_pulled_slope<m, false>({&a, &b}, maps, slope.data(), data.scratch, sink);
    }
}

template <class J, StateScalar T>
void JointKernels<J, T>::stiffness(Pool const& pool, Kept const& kept, VecX const& lambda, detail::StiffnessAt const& x,
                                   Data<double>& data, BlockSink& sink) {
  if constexpr (!linear)
    for (std::size_t i = 0; i < pool.size(); ++i) {
      constexpr int m = J::rows;
      auto const& e = pool[i];
      ConstraintTerms<m, double> const& terms = kept.terms[i];
      double const* const multipliers = compliant ? kept.answers[i].data() : lambda.data() + e.row;
      MarkerKinematics<double> const &a = data.markers[std::size_t(e.a)], &b = data.markers[std::size_t(e.b)];
      Vec<double, m> l;
      for (int k = 0; k < m; ++k) l[k] = multipliers[k];
      Mat<double, 12, 12> s = wrench_gradient(e.joint.measure(), a.frame, b.frame, x.at.t, l);
      for (int k = 0; k < 144; ++k) s.data()[k] *= x.c.stiffness;
      if constexpr (constexpr int n = nonholonomic_equations<typename J::Geometry>(); compliant || n > 0)
        if (x.c.exact) {
          if constexpr (compliant)
            detail::add_rate_slopes(e.joint, terms, {&a, &b}, x, s);
          else if (x.c.damping != 0.0)
            detail::add_velocity_rows<n>(detail::rates_by_poses(e.joint.measure(), terms, {&a, &b}, x.at.t), {&a, &b},
                                         x, data.unknown_of_row(e.row + m - n), data.scratch, sink);
        }
      std::array<Wrench<double>, 2> on_markers;
      double const* const maps[2] = {terms.Ga.data(), terms.Gb.data()};
      for (std::size_t end = 0; end < 2; ++end) {
        double fm[6];
        detail::wrench_of<m>(maps[end], multipliers, fm);
        for (int k = 0; k < 3; ++k) {
          on_markers[end].f[k] = fm[k];
          on_markers[end].m[k] = fm[3 + k];
        }
      }
      detail::add_loads(on_markers, {e.a, e.b}, -1.0, data);
      detail::add_pulled_pairs<2>({&a, &b}, s.data(), true, data.scratch, sink);
    }
}

template <class J, StateScalar T>
double JointKernels<J, T>::energy(Pool const& pool, Kept const& kept) {
  double sum = 0.0;
  if constexpr (!linear && compliant)
    for (std::size_t i = 0; i < pool.size(); ++i)
      sum += pool[i].joint.policy.template potential<J::rows>(kept.terms[i].g);
  return sum;
}

template <class J, StateScalar T>
void JointKernels<J, T>::add_powers(Pool const& pool, Kept const& kept, VecX const& lambda, Data<double> const& data,
                                    Powers& p) {
  if constexpr (!linear)
    for (std::size_t i = 0; i < pool.size(); ++i) {
      constexpr int m = J::rows;
      auto const& e = pool[i];
      ConstraintTerms<m, double> const& terms = kept.terms[i];
      Vec<double, m> const rate =
          constraint_rate(terms, data.markers[std::size_t(e.a)].frame, data.markers[std::size_t(e.b)].frame);
      if constexpr (compliant) {
        Vec<double, m> const zero = Vec<double, m>::Zero();
        Vec<double, m> const l = e.joint.policy.template multiplier<m, double>(terms.g, rate);
        Vec<double, m> const rest = e.joint.policy.template multiplier<m, double>(terms.g, zero);
        Vec<double, m> const lossless = detail::rest_without_potential(e.joint.policy, rest);
        for (int k = 0; k < m; ++k) {
          p.drives += l[k] * terms.rate[k];
          p.loads -= lossless[k] * rate[k];
          p.dissipated += (l[k] - rest[k]) * rate[k];
        }
      } else {
        for (int k = 0; k < m; ++k) p.drives -= lambda[e.row + k] * (rate[k] - terms.rate[k]);
      }
    }
}

}  // namespace polybody
