#pragma once
/// \file
/// What a model does with all its force elements of one type: loops that know the type of the force and not that of the
/// model (compare body_kernels.hpp).

#include <polybody/forces/force_states.hpp>
#include <polybody/system/joint_kernels.hpp>

namespace polybody {

namespace detail {

template <class F, StateScalar T>
auto frames_of(ForceEntry<F> const& e, Data<T> const& data) {
  std::array<Frame<T>, F::markers> frames;
  for (int k = 0; k < F::markers; ++k) frames[k] = data.markers[std::size_t(e.markers[k])].frame;
  return frames;
}

template <HasStates F, StateScalar T>
std::array<T, F::states> states_of(ForceEntry<F> const& e, Data<T> const& data) {
  std::array<T, F::states> z;
  for (std::size_t s = 0; s < z.size(); ++s) z[s] = data.states[std::size_t(e.state) + s];
  return z;
}

/// Calls visit(force, markers, frames) for the force elements of an entry: itself, at its states as they are, or the
/// pairs of a group that may act now. Markers are places among the entry's.
template <class F, StateScalar T, class Visit>
void for_each_action(ForceEntry<F> const& e, Data<T> const& data, Visit&& visit) {
  if constexpr (ForceGroup<F>) {
    auto const frame = [&](Index k) -> Frame<T> const& {
      return data.markers[std::size_t(e.markers[std::size_t(k)])].frame;
    };
    e.force.for_each_pair(frame, [&](Index i, Index j, auto const& law) {
      visit(law, std::array<Index, 2>{i, j}, std::array<Frame<T>, 2>{frame(i), frame(j)});
    });
  } else {
    std::array<Index, F::markers> all;
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = Index(k);
    if constexpr (HasStates<F>) {
      auto const z = states_of(e, data);
      visit(AtStates<F, T>{e.force, z}, all, frames_of(e, data));
    } else {
      visit(e.force, all, frames_of(e, data));
    }
  }
}

template <std::size_t n>
double power_of(std::array<Wrench<double>, n> const& w, std::array<Frame<double>, n> const& frames) {
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k)
    for (int i = 0; i < 3; ++i) sum += w[k].f[i] * frames[k].v[i] + w[k].m[i] * frames[k].w[i];
  return sum;
}

}  // namespace detail

/// The loops over the force elements of type F, for scalar T; those of energies and tangents are for numbers.
template <class F, StateScalar T>
struct ForceKernels {
  using Entry = detail::ForceEntry<F>;
  using Pool = std::vector<Entry>;

  /// Places and names.
  static void describe(Pool const& pool, ModelLayout& out);
  /// An action for each marker, and room; `owner` is the first force's place.
  static void place(Pool const& pool, Index owner, Data<T>& data);
  /// Wrenches of all, from action `next` on, and the rates of their states; returns the end of the actions.
  static Action<T>* push(Pool const& pool, double t, Data<T>& data, Action<T>* next);

  /// The identity, for the rates of their states, which begin at speed `first`.
  static void masses(Pool const& pool, Index first, BlockSink& sink);
  static void tangents(Pool const& pool, double t, double load_factor, TangentCoefficients const& c, Data<double>& data,
                       BlockSink& sink);
  static double energy(Pool const& pool, double t, Data<double> const& data);
  /// With a potential, what wrenches are at rest is stored, and what motion adds is lost. A potential is taken for a
  /// function of the frames alone.
  static void add_powers(Pool const& pool, double t, double load_factor, Data<double> const& data, Powers& p);

 private:
  static void tangent(Entry const& e, double t, double scale, TangentCoefficients const& c, Data<double>& data,
                      BlockSink& sink);
  static void tangent_with_states(Entry const& e, double t, double scale, TangentCoefficients const& c,
                                  Data<double>& data, BlockSink& sink);
  /// What each marker of a group feels of its own motion alone, block by block, zero where nothing acts; with stand-ins
  /// by a law's `own_stiffness` where it has one.
  static void group_tangent(Entry const& e, double t, double scale, TangentCoefficients const& c, Data<double>& data,
                            BlockSink& sink);
  /// The exact gradient with what couples the pairs, all that may ever act: statics and linearisation, which ask for
  /// all second-order terms and no mass.
  static void whole_group_tangent(Entry const& e, double t, double scale, TangentCoefficients const& c,
                                  Data<double>& data, BlockSink& sink);
  static std::array<Index, 2> places(Entry const& e, std::array<Index, 2> const& pair) {
    return {e.markers[std::size_t(pair[0])], e.markers[std::size_t(pair[1])]};
  }
};

template <class F, StateScalar T>
void ForceKernels<F, T>::describe(Pool const& pool, ModelLayout& out) {
  Index index = 0;
  for (Entry const& e : pool) {
    out.forces.push_back(
        {e.name, &detail::type_tag<F>, index++, &e.force, {e.markers.begin(), e.markers.end()}, F::is_load});
    if constexpr (HasStates<F>) {
      out.forces.back().v0 = out.body_speeds() + e.state;
      out.forces.back().states = F::states;
    }
    if constexpr (requires { e.force.law; }) detail::add_corners(e.force.law, out.corners);
  }
}

template <class F, StateScalar T>
void ForceKernels<F, T>::place(Pool const& pool, Index owner, Data<T>& data) {
  for (Entry const& e : pool) {
    for (Index const k : e.markers) {
      data.read[std::size_t(k)] = 1;
      data.actions.push_back({.source = owner, .marker = k});
    }
    if constexpr (HasStates<F>) {
      for (Index const k : e.markers)
        data.scratch.resize(
            std::max(data.scratch.size(), std::size_t(F::states * data.markers[std::size_t(k)].columns)));
    }
    data.own_stiffness.resize(std::max(data.own_stiffness.size(), e.markers.size()));
    ++owner;
  }
}

template <class F, StateScalar T>
Action<T>* ForceKernels<F, T>::push(Pool const& pool, double t, Data<T>& data, Action<T>* next) {
  for (Entry const& e : pool) {
    Action<T>* const actions = next;
    next += e.markers.size();
    for (Action<T>* p = actions; p != next; ++p)
      for (T& w : p->w) w = T(0.0);
    detail::for_each_action(e, data, [&](auto const& force, auto const& markers, auto const& frames) {
      auto const wrenches = force.template wrenches<T>(frames, t);
      for (std::size_t k = 0; k < markers.size(); ++k)
        for (int i = 0; i < 3; ++i) {
          actions[markers[k]].w[i] += wrenches[k].f[i];
          actions[markers[k]].w[3 + i] += wrenches[k].m[i];
        }
    });
    if constexpr (HasStates<F>) {
      auto const rates = e.force.template rates<T>(detail::frames_of(e, data), detail::states_of(e, data), t);
      std::copy(rates.begin(), rates.end(), data.rates.begin() + e.state);
    }
  }
  return next;
}

template <class F, StateScalar T>
void ForceKernels<F, T>::masses(Pool const& pool, Index first, BlockSink& sink) {
  if constexpr (HasStates<F>) {
    Mat<double, F::states, F::states> const one = Mat<double, F::states, F::states>::Identity();
    for (Entry const& e : pool) sink.add(first + e.state, first + e.state, one);
  }
}

template <class F, StateScalar T>
void ForceKernels<F, T>::tangents(Pool const& pool, double t, double load_factor, TangentCoefficients const& c,
                                  Data<double>& data, BlockSink& sink) {
  double const scale = F::is_load ? load_factor : 1.0;
  for (Entry const& e : pool)
    if constexpr (HasStates<F>)
      tangent_with_states(e, t, scale, c, data, sink);
    else if constexpr (!ForceGroup<F>)
      tangent(e, t, scale, c, data, sink);
    else if (c.full && c.mass == 0.0)
      whole_group_tangent(e, t, scale, c, data, sink);
    else
      group_tangent(e, t, scale, c, data, sink);
}

template <class F, StateScalar T>
double ForceKernels<F, T>::energy(Pool const& pool, double t, Data<double> const& data) {
  double sum = 0.0;
  for (Entry const& e : pool)
    detail::for_each_action(e, data, [&](auto const& force, auto const&, auto const& frames) {
      if constexpr (HasPotential<std::decay_t<decltype(force)>>) sum += force.potential(frames, t);
    });
  return sum;
}

template <class F, StateScalar T>
void ForceKernels<F, T>::add_powers(Pool const& pool, double t, double load_factor, Data<double> const& data,
                                    Powers& p) {
  double const scale = F::is_load ? load_factor : 1.0;
  for (Entry const& e : pool)
    detail::for_each_action(e, data, [&](auto const& force, auto const&, auto const& frames) {
      double const power = detail::power_of(force.template wrenches<double>(frames, t), frames);
      if constexpr (HasPotential<std::decay_t<decltype(force)>>) {
        auto at_rest = frames;
        for (Frame<double>& f : at_rest) f.v = f.w = Vec3::Zero();
        p.dissipated += scale * (detail::power_of(force.template wrenches<double>(at_rest, t), frames) - power);
      } else {
        p.loads += scale * power;
      }
    });
}

template <class F, StateScalar T>
void ForceKernels<F, T>::tangent(Entry const& e, double t, double scale, TangentCoefficients const& c,
                                 Data<double>& data, BlockSink& sink) {
  if constexpr (!ForceGroup<F> && !HasStates<F>) {
    constexpr int n = F::markers;
    auto const frames = detail::frames_of(e, data);
    std::array<Published<double> const*, std::size_t(n)> markers;
    for (int k = 0; k < n; ++k) markers[std::size_t(k)] = &data.markers[std::size_t(e.markers[k])];
    Mat<double, 6 * n, 6 * n> s = wrench_gradient(e.force, frames, t, c.stiffness, c.damping);
    for (Index i = 0; i < s.size(); ++i) s.data()[i] *= -scale;
    detail::add_pulled_pairs<n>(markers, s.data(), c.full || couples_bodies<F>(), data.scratch, sink);
    if (c.full) detail::add_loads(e.force.template wrenches<double>(frames, t), e.markers, scale, data);
  }
}

/// With w the wrenches, h the rates and x the frames: blocks −Jᵀ ∂w/∂x J, −Jᵀ ∂w/∂z, −∂h/∂x J and cm − ∂h/∂z, all by
/// their coefficients.
template <class F, StateScalar T>
void ForceKernels<F, T>::tangent_with_states(Entry const& e, double t, double scale, TangentCoefficients const& c,
                                             Data<double>& data, BlockSink& sink) {
  if constexpr (HasStates<F>) {
    constexpr int n = F::markers, m = F::states, first = 6 * n, size = first + m;
    auto const frames = detail::frames_of(e, data);
    auto const z = detail::states_of(e, data);
    Mat<double, size, size> s = gradient_with_states(e.force, frames, z, t, {c.stiffness, c.damping, c.states});
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) s(i, j) *= i < first ? -scale : -1.0;
    for (int i = first; i < size; ++i) s(i, i) += c.mass;
    double const* const entries = s.data();
    Index const at = data.first_state + e.state;
    auto const marker = [&](int k) -> Published<double> const& {
      return data.markers[std::size_t(e.markers[std::size_t(k)])];
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        detail::add_pulled_pair(marker(i), marker(j), entries + 6 * i + 6 * size * j, size, data.scratch, sink);
    for (int k = 0; k < n; ++k) {
      Published<double> const& p = marker(k);
      if (p.columns == 0) continue;
      sink.add(p.first, at, detail::pulled<m>(p, entries + 6 * k + size * first, 1, size, data.scratch));
      sink.add(at, p.first, detail::pulled<m>(p, entries + first + 6 * size * k, size, 1, data.scratch).transposed());
    }
    sink.add(at, at, BlockView(entries + (size + 1) * first, m, m, 1, size));
    if (c.full)
      detail::add_loads(AtStates<F, double>{e.force, z}.template wrenches<double>(frames, t), e.markers, scale, data);
  }
}

template <class F, StateScalar T>
void ForceKernels<F, T>::whole_group_tangent(Entry const& e, double t, double scale, TangentCoefficients const& c,
                                             Data<double>& data, BlockSink& sink) {
  if constexpr (ForceGroup<F>)
    e.force.for_each_candidate([&](Index i, Index j, auto const& law) {
      auto const at = places(e, {i, j});
      std::array<Published<double> const*, 2> const markers = {&data.markers[std::size_t(at[0])],
                                                               &data.markers[std::size_t(at[1])]};
      std::array<Frame<double>, 2> const frames = {markers[0]->frame, markers[1]->frame};
      Mat<double, 12, 12> s = wrench_gradient(law, frames, t, c.stiffness, c.damping);
      for (Index k = 0; k < 144; ++k) s.data()[k] *= -scale;
      detail::add_pulled_pairs<2>(markers, s.data(), true, data.scratch, sink);
      detail::add_loads(law.template wrenches<double>(frames, t), at, scale, data);
    });
}

template <class F, StateScalar T>
void ForceKernels<F, T>::group_tangent(Entry const& e, double t, double scale, TangentCoefficients const& c,
                                       Data<double>& data, BlockSink& sink) {
  if constexpr (ForceGroup<F>) {
    auto& own = data.own_stiffness;
    for (std::size_t k = 0; k < e.markers.size(); ++k) std::fill_n(own[k].data(), 36, 0.0);
    detail::for_each_action(e, data, [&](auto const& law, auto const& markers, auto const& frames) {
      std::size_t const i = std::size_t(markers[0]), j = std::size_t(markers[1]);
      if (c.full) detail::add_loads(law.template wrenches<double>(frames, t), places(e, markers), scale, data);
      if constexpr (HasOwnStiffness<std::decay_t<decltype(law)>>)
        if (c.stand_ins) return law.own_stiffness(frames, c.stiffness, c.damping, own[i], own[j]);
      Mat<double, 12, 12> const s = wrench_gradient(law, frames, t, c.stiffness, c.damping);
      for (int col = 0; col < 6; ++col)
        for (int row = 0; row < 6; ++row) {
          own[i](row, col) -= s(row, col);
          own[j](row, col) -= s(6 + row, 6 + col);
        }
    });
    for (std::size_t k = 0; k < e.markers.size(); ++k) {
      Published<double> const& p = data.markers[std::size_t(e.markers[k])];
      double* const s = own[k].data();
      bool const acts = std::any_of(s, s + 36, [](double x) { return x != 0.0; });
      if (p.columns > 0 && !acts) {
        sink.skip(p.first, p.first, p.columns, p.columns);
        continue;
      }
      for (int i = 0; i < 36; ++i) s[i] *= scale;
      detail::add_pulled_pairs<1>({&p}, s, true, data.scratch, sink);
    }
  }
}

}  // namespace polybody
