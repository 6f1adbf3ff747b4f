#pragma once
/// \file
/// Derivatives of the wrenches of a force element, or of one pair of a force group, as blocks of the tangent.
/// Theory: Eqs. 3.3, 9.8, 9.44.

#include <polybody/forces/contact_tangent.hpp>
#include <polybody/forces/reaction_force.hpp>
#include <polybody/system/contact_coupling.hpp>
#include <polybody/system/joint_kernels.hpp>

namespace polybody::detail {

/// Frames of the markers with the indices `at`.
template <std::size_t n, StateScalar T>
std::array<Frame<T>, n> frames_at(std::array<Index, n> const& at, Data<T> const& data) {
  std::array<Frame<T>, n> frames;
  for (std::size_t k = 0; k < n; ++k) frames[k] = data.markers[std::size_t(at[k])].frame;
  return frames;
}

template <HasStates F, StateScalar T>
std::array<T, F::states> states_in(ForceEntry<F> const& e, Data<T> const& data) {
  std::array<T, F::states> z;
  for (std::size_t s = 0; s < z.size(); ++s) z[s] = data.states[std::size_t(e.state) + s];
  return z;
}

/// Arguments of a gradient: time [s], factor of the wrenches, and tangent coefficients.
struct GradientAt {
  double t, scale;
  TangentCoefficients const& c;
};

/// Adds −scale · (ck ∂w/∂pose + cd ∂w/∂twist) of the wrenches w of a law to `sink`, with ck, cd from x.c. Blocks that
/// couple the bodies are omitted if the law permits this and neither `c.full` nor `c.exact` is true. With `c.full`,
/// −scale · w is also added to data.loads.
template <class L>
void add_gradient(L const& law, std::array<Index, L::markers> const& at, GradientAt const& x, Data<double>& data,
                  BlockSink& sink) {
  constexpr int n = L::markers;
  std::array<MarkerKinematics<double> const*, std::size_t(n)> markers;
  for (std::size_t k = 0; k < at.size(); ++k) markers[k] = &data.markers[std::size_t(at[k])];
  auto const frames = frames_at(at, data);
  Mat<double, 6 * n, 6 * n> s = wrench_gradient(law, frames, x.t, x.c.stiffness, x.c.damping);
  if (x.c.exact && x.c.stiffness != 0.0) {
    Mat<double, 6 * n, 6 * n> const by_twist = wrench_gradient(law, frames, x.t, 0.0, x.c.stiffness);
    for (int k = 0; k < n; ++k)
      add_rates_of_pose<6 * n>(*markers[std::size_t(k)], by_twist.data() + 36 * n * k, s.data() + 36 * n * k);
  }
  for (Index i = 0; i < s.size(); ++i) s.data()[i] *= -x.scale;
  add_pulled_pairs<n>(markers, s.data(), x.c.full || x.c.exact || couples_bodies<L>(), data.scratch, sink);
  if (x.c.full) add_loads(law.template wrenches<double>(frames, x.t), at, x.scale, data);
}

/// Version for a force element with wrenches w and first-order states z, ż = h. With the poses p of the markers, it
/// adds the blocks −Jᵀ ∂w/∂p J, −Jᵀ ∂w/∂z, −∂h/∂p J and cm − ∂h/∂z, each with its coefficient.
/// \param law the force element of the entry, or its adapter for constant multipliers
template <HasStates F, HasStates L>
void add_gradient_with_states(ForceEntry<F> const& e, L const& law, GradientAt const& x, Data<double>& data,
                              BlockSink& sink) {
  constexpr int n = F::markers, m = F::states, first = 6 * n, size = first + m;
  auto const frames = frames_at(e.markers, data);
  auto const z = states_in(e, data);
  Mat<double, size, size> s = gradient_with_states(law, frames, z, x.t, {x.c.stiffness, x.c.damping, x.c.states});
  if (x.c.exact && x.c.stiffness != 0.0) {
    Mat<double, size, size> const by_twist = gradient_with_states(law, frames, z, x.t, {0.0, x.c.stiffness, 0.0});
    for (int k = 0; k < n; ++k)
      add_rates_of_pose<size>(data.markers[std::size_t(e.markers[std::size_t(k)])], by_twist.data() + 6 * size * k,
                              s.data() + 6 * size * k);
  }
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) s(i, j) *= i < first ? -x.scale : -1.0;
  for (int i = first; i < size; ++i) s(i, i) += x.c.mass;
  double const* const entries = s.data();
  Index const at = data.first_state + e.state;
  auto const marker = [&](int k) -> MarkerKinematics<double> const& {
    return data.markers[std::size_t(e.markers[std::size_t(k)])];
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      add_pulled_pair(marker(i), marker(j), entries + 6 * i + 6 * size * j, size, data.scratch, sink);
  for (int k = 0; k < n; ++k) {
    MarkerKinematics<double> const& p = marker(k);
    if (p.columns == 0) continue;
    sink.add(p.first, at, pulled<m>(p, entries + 6 * k + size * first, 1, size, data.scratch));
    sink.add(at, p.first, pulled<m>(p, entries + first + 6 * size * k, size, 1, data.scratch).transposed());
  }
  sink.add(at, at, BlockView(entries + (size + 1) * first, m, m, 1, size));
  if (x.c.full) add_loads(AtStates<L, double>{law, z}.template wrenches<double>(frames, x.t), e.markers, x.scale, data);
}

/// Adds the blocks −Jᵀ ∂w/∂λ and −∂h/∂λ of a force element that follows the multipliers λ of a joint, with its wrenches
/// w and state rates h, in the columns of λ.
template <FollowsReaction F>
void add_multiplier_columns(ForceEntry<F> const& e, GradientAt const& x, Data<double>& data, BlockSink& sink) {
  constexpr int n = 6 * F::markers, m = F::multipliers, s = states_of<F>();
  using D = Dual<m>;
  std::array<Frame<D>, F::markers> frames;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Frame<double> const& f = data.markers[std::size_t(e.markers[k])].frame;
    for (int i = 0; i < 3; ++i) {
      frames[k].r[i] = D(f.r[i]);
      frames[k].v[i] = D(f.v[i]);
      frames[k].w[i] = D(f.w[i]);
      for (int j = 0; j < 3; ++j) frames[k].A(i, j) = D(f.A(i, j));
    }
  }
  Vec<D, m> lambda;
  for (int i = 0; i < m; ++i) lambda[i] = seeded<m>(data.multipliers[std::size_t(e.row + i)], i, 1.0);
  std::array<D, std::size_t(s)> z;
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = D(data.states[std::size_t(e.state) + i]);
  Mat<double, n, m> w;
  copy_slopes(e.force.template wrenches<D>(frames, lambda, z, x.t), w);
  for (Index i = 0; i < w.size(); ++i) w.data()[i] *= -x.scale;
  Index const row = data.unknown_of_row(e.row), at = data.first_state + e.state;
  for (int k = 0; k < F::markers; ++k) {
    MarkerKinematics<double> const& p = data.markers[std::size_t(e.markers[std::size_t(k)])];
    if (p.columns > 0) sink.add(p.first, row, pulled<m>(p, w.data() + 6 * k, 1, n, data.scratch));
  }
  if constexpr (s > 0) {
    Mat<double, s, m> h;
    auto const rates = e.force.template rates<D>(frames, lambda, z, x.t);
    for (int i = 0; i < s; ++i)
      for (int j = 0; j < m; ++j) h(i, j) = -rates[std::size_t(i)].d[j];
    sink.add(at, row, BlockView(h.data(), s, m, 1, s));
    sink.skip(row, at, m, s);
  }
}

struct AnyRatio {
  Vec3 operator()(int slot, Vec3 const& v, double s) const;
};
/// Contact law with a stiffness of the pair, which contains the blocks that couple both markers.
template <class L>
concept HasPairStiffness = requires(L const law, std::array<Frame<double>, 2> const frames, PairStiffness const& to) {
  law.pair_stiffness(frames, 1.0, 1.0, to, AnyRatio{}, true);
};

/// Adds the stiffness of both markers of a pair to `to`, without x.scale, and the blocks that couple both markers to
/// `c.coupling`. Unless `c.surrogate_friction` is true, the stiffness is the derivative of the wrenches and the
/// remainder of the friction ratios.
template <HasPairStiffness L>
void add_pair_stiffness(L const& law, std::array<Index, 2> const& at, GradientAt const& x, Data<double>& data,
                        std::array<Mat<double, 6, 6>*, 2> const& to) {
  Mat<double, 6, 6> ab, ba;
  std::fill_n(ab.data(), 36, 0.0);
  std::fill_n(ba.data(), 36, 0.0);
  auto const frames = frames_at(at, data);
  auto const ratio = [&](int slot, Vec3 const& v, double s) {
    return x.c.coupling->ratios.ratio({at[0], at[1], slot}, v, s);
  };
  law.pair_stiffness(frames, x.c.stiffness, x.c.damping, {*to[0], *to[1], ab, ba}, ratio, !x.c.surrogate_friction);
  if (!x.c.surrogate_friction) {
    Mat<double, 12, 12> const s = wrench_gradient(law, frames, x.t, x.c.stiffness, x.c.damping);
    for (int col = 0; col < 6; ++col)
      for (int row = 0; row < 6; ++row) {
        (*to[0])(row, col) -= s(row, col);
        (*to[1])(row, col) -= s(6 + row, 6 + col);
        ab(row, col) += s(row, 6 + col);
        ba(row, col) += s(6 + row, col);
      }
  }
  if (std::all_of(ab.data(), ab.data() + 36, [](double entry) { return entry == 0.0; })) return;
  for (int i = 0; i < 36; ++i) {
    ab.data()[i] *= -x.scale;
    ba.data()[i] *= -x.scale;
  }
  BlockSink sink(*x.c.coupling);
  MarkerKinematics<double> const &a = data.markers[std::size_t(at[0])], &b = data.markers[std::size_t(at[1])];
  add_pulled_pair(a, b, ab.data(), 6, data.scratch, sink);
  add_pulled_pair(b, a, ba.data(), 6, data.scratch, sink);
}

/// Adds to `to[k]` the stiffness of marker k of a pair with respect to the motion of this marker, without x.scale. If
/// `c.surrogate_friction` is true, the law's approximate `own_stiffness` replaces the exact stiffness. With `c.full`,
/// −scale · w of the wrenches w is also added to data.loads. With `c.coupling`, `add_pair_stiffness` replaces both, if
/// the law has a stiffness of the pair.
template <class L>
void add_own_stiffness(L const& law, std::array<Index, 2> const& at, GradientAt const& x, Data<double>& data,
                       std::array<Mat<double, 6, 6>*, 2> const& to) {
  auto const frames = frames_at(at, data);
  if (x.c.full) add_loads(law.template wrenches<double>(frames, x.t), at, x.scale, data);
  if constexpr (HasPairStiffness<L>)
    if (x.c.coupling) return add_pair_stiffness(law, at, x, data, to);
  if constexpr (HasOwnStiffness<L>)
    if (x.c.surrogate_friction) return law.own_stiffness(frames, x.c.stiffness, x.c.damping, *to[0], *to[1]);
  Mat<double, 12, 12> const s = wrench_gradient(law, frames, x.t, x.c.stiffness, x.c.damping);
  for (int col = 0; col < 6; ++col)
    for (int row = 0; row < 6; ++row) {
      (*to[0])(row, col) -= s(row, col);
      (*to[1])(row, col) -= s(6 + row, 6 + col);
    }
}

}  // namespace polybody::detail
