#pragma once
/// \file
/// Loops over all force elements of one type in a model. The loops depend on the type of the force, but not on the type
/// of the model (compare body_kernels.hpp).

#include <concepts>

#include <polybody/system/active_contact_pairs.hpp>
#include <polybody/system/force_gradients.hpp>
#include <polybody/system/group_pairs.hpp>

namespace polybody {

namespace detail {

/// Calls use(law) with the force element of an entry, or with its adapter at the multipliers that it follows.
template <class F, StateScalar T, class Use>
void with_law(ForceEntry<F> const& e, T const* multipliers, Use&& use) {
  if constexpr (FollowsReaction<F>) {
    Vec<T, F::multipliers> lambda;
    for (int i = 0; i < F::multipliers; ++i) lambda[i] = multipliers[e.row + i];
    use(AtMultipliers<F, T>{e.force, lambda});
  } else {
    use(e.force);
  }
}

/// Calls visit(force, markers, at) for an entry's force element at its present states, or for each pair of a group that
/// may interact in the present positions. `markers` are marker indices within the entry, `at` marker indices in the
/// model. \param multipliers λ of the model, read only for elements that follow a reaction
template <class F, StateScalar T, class Visit>
void for_each_action(ForceEntry<F> const& e, Data<T> const& data, T const* multipliers, Visit&& visit) {
  if constexpr (ForceGroup<F>) {
    for_each_pair_of(e, data, [&](Index i, Index j, auto const& law) {
      visit(law, std::array{i, j}, std::array{e.markers[std::size_t(i)], e.markers[std::size_t(j)]});
    });
  } else {
    std::array<Index, F::markers> all;
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = Index(k);
    with_law(e, multipliers, [&]<class L>(L const& law) {
      if constexpr (HasStates<F>) {
        auto const z = states_in(e, data);
        visit(AtStates<L, T>{law, z}, all, e.markers);
      } else {
        visit(law, all, e.markers);
      }
    });
  }
}
/// Overload for the multipliers of the last evaluation.
template <class F, StateScalar T, class Visit>
void for_each_action(ForceEntry<F> const& e, Data<T> const& data, Visit&& visit) {
  for_each_action(e, data, data.multipliers.data(), visit);
}

template <std::size_t n>
double power_of(std::array<Wrench<double>, n> const& w, std::array<Frame<double>, n> const& frames) {
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k)
    for (int i = 0; i < 3; ++i) sum += w[k].f[i] * frames[k].v[i] + w[k].m[i] * frames[k].w[i];
  return sum;
}

// The following functions evaluate one force element, or one pair of a group under its law. These functions do not
// depend on the group, so groups with the same law use the same compiled functions.

/// Evaluates the wrenches and adds them to `to`.
template <class L, StateScalar T>
void add_wrenches(L const& law, std::array<Index, L::markers> const& at, double t, Data<T> const& data,
                  std::array<AppliedWrench<T>*, L::markers> const& to) {
  std::array<Wrench<T>, L::markers> const w = law.template wrenches<T>(frames_at(at, data), t);
  for (std::size_t k = 0; k < w.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      to[k]->w[i] += w[k].f[i];
      to[k]->w[3 + i] += w[k].m[i];
    }
}

/// True if all wrenches of F have a potential. For a group, true if all its laws have a potential.
template <class F>
constexpr bool stores() {
  if constexpr (HasStates<F>)
    return HasStatePotential<F>;
  else if constexpr (ForceGroup<F>)
    return requires { requires F::all_laws_store; };
  else
    return HasPotential<F>;
}
template <class L>
double potential_of(L const& law, std::array<Index, L::markers> const& at, double t, Data<double> const& data) {
  if constexpr (HasPotential<L>)
    return law.potential(frames_at(at, data), t);
  else
    return 0.0;
}

/// Adds the power of the wrenches to p. If the law has a potential, the wrenches at zero velocity change the stored
/// energy. The remaining part of the wrenches and the states of the element dissipate energy. The potential is assumed
/// to depend on frames and states only. If the law has no potential, its power is counted as power of loads.
template <class L>
void add_power(L const& law, std::array<Index, L::markers> const& at, double t, double scale, Data<double> const& data,
               Powers& p) {
  auto const frames = frames_at(at, data);
  double const power = power_of(law.template wrenches<double>(frames, t), frames);
  if constexpr (HasPotential<L>) {
    auto at_rest = frames;
    for (Frame<double>& f : at_rest) f.v = f.w = Vec3::Zero();
    p.dissipated += scale * (power_of(law.template wrenches<double>(at_rest, t), frames) - power);
    if constexpr (requires { law.dissipation(frames, t); }) p.dissipated += scale * law.dissipation(frames, t);
  } else {
    p.loads += scale * power;
  }
}

}  // namespace detail

/// Loops over the force elements of type F, for the scalar T. Energies and tangents exist for doubles only.
template <class F, StateScalar T>
struct ForceKernels {
  using Entry = detail::ForceEntry<F>;  ///< a force element with its markers
  using Pool = Sequence<Entry>;         ///< force elements of this type in a model

  /// Appends positions and names of the force elements to `out`.
  [[gnu::cold]] static void describe(Pool const& pool, ModelLayout& out);
  /// Appends an applied wrench for each marker and enlarges the workspace. \param owner position of the first force in
  /// the layout
  [[gnu::cold]] static void place(Pool const& pool, Index owner, Data<T>& data);
  /// Writes all wrenches from `next` on, and the rates of the states. Returns the end of the wrenches.
  static AppliedWrench<T>* push(Pool const& pool, double t, Data<T>& data, AppliedWrench<T>* next);

  /// Writes the unit mass of each first-order state. \param first index of the first state of the model
  static void masses(Pool const& pool, Index first, BlockSink& sink);
  /// Writes ck K + cd D of all elements at t [s]. Loads are multiplied by `load_factor`.
  static void tangents(Pool const& pool, double t, double load_factor, TangentCoefficients const& c, Data<double>& data,
                       BlockSink& sink);
  /// Stored energy of all elements with a potential [J].
  static double energy(Pool const& pool, double t, Data<double> const& data);
  /// Adds the powers of all elements at the multipliers `lambda` [W]. Loads are multiplied by `load_factor`.
  static void add_powers(Pool const& pool, double t, double load_factor, VecX const& lambda, Data<double> const& data,
                         Powers& p);

 private:
  /// Evaluates the wrenches of a group in several threads. Each thread evaluates a part of the many markers. Wrenches
  /// on contact partners are stored for each part and then added in the order of a single thread, so that the sums are
  /// bitwise identical.
  static void add_forces_in_parts(Entry const& e, double t, Data<T>& data, AppliedWrench<T>* actions);
  /// Writes the stiffness of each marker of a group with respect to its own motion; zero without interaction. If
  /// `surrogate_friction` is true, a law's approximate `own_stiffness` replaces the exact stiffness.
  static void group_tangent(Entry const& e, detail::GradientAt const& x, Data<double>& data, BlockSink& sink);
  /// Writes the exact tangent of a group, with blocks for all pairs that can ever interact, or for the selected
  /// `TangentCoefficients::pairs`. Blocks of pairs without interaction are zero.
  static void coupled_tangent(Entry const& e, detail::GradientAt const& x, Data<double>& data, BlockSink& sink);
};

template <class F, StateScalar T>
void ForceKernels<F, T>::describe(Pool const& pool, ModelLayout& out) {
  Index index = 0;
  for (Entry const& e : pool) {
    out.forces.push_back(
        {e.name, &detail::type_tag<F>, index++, &e.force, {e.markers.begin(), e.markers.end()}, F::is_load});
    if constexpr (HasStates<F>) {
      out.forces.back().v0 = out.body_velocities() + e.state;
      out.forces.back().states = F::states;
    }
    out.forces.back().stores = detail::stores<F>();
    if constexpr (FollowsReaction<F>) out.forces.back().row = e.row;
    out.forces.back().made_in = e.made_in;
    out.forces.back().stores_in_part = ForceGroup<F> && !detail::stores<F>();
    if constexpr (requires { e.force.is_lossless(); }) out.forces.back().lossless = e.force.is_lossless();
    if constexpr (requires(Frame<double> const(&f)[2]) { e.force.passes(f, f); })
      out.forces.back().passes = [](void const* force, Frame<double> const(&from)[2], Frame<double> const(&to)[2]) {
        return static_cast<F const*>(force)->passes(from, to);
      };
    if constexpr (HasStatePotential<F>)
      out.forces.back().dissipation = [](ForceLayout const& of, double time, Data<double> const& data) {
        std::array<Index, F::markers> at;
        std::copy_n(of.markers.begin(), at.size(), at.begin());
        std::array<double, F::states> z;
        std::copy_n(data.states.begin() + (of.v0 - data.first_state), z.size(), z.begin());
        F const& law = *static_cast<F const*>(of.force);
        if constexpr (FollowsReaction<F>) {
          Vec<double, F::multipliers> lambda;
          for (int i = 0; i < F::multipliers; ++i) lambda[i] = data.multipliers[std::size_t(of.row + i)];
          return double(law.dissipation(detail::frames_at(at, data), lambda, z, time));
        } else {
          return double(law.dissipation(detail::frames_at(at, data), z, time));
        }
      };
    if constexpr (requires { e.force.law; }) detail::add_breakpoints(e.force.law, out.breakpoints);
  }
}

template <class F, StateScalar T>
void ForceKernels<F, T>::place(Pool const& pool, Index owner, Data<T>& data) {
  for (Entry const& e : pool) {
    for (Index const k : e.markers) {
      data.read[std::size_t(k)] = 1;
      AppliedWrench<T> action;
      action.source = owner;
      action.marker = k;
      data.actions.push_back(action);
    }
    if constexpr (HasStates<F>) {
      for (Index const k : e.markers)
        data.scratch.resize(
            std::max(data.scratch.size(), std::size_t(F::states * data.markers[std::size_t(k)].columns)));
    }
    if constexpr (FollowsReaction<F>) {
      data.multipliers.resize(std::max(data.multipliers.size(), std::size_t(e.row + F::multipliers)));
      for (Index const k : e.markers)
        data.scratch.resize(
            std::max(data.scratch.size(), std::size_t(F::multipliers * data.markers[std::size_t(k)].columns)));
    }
    data.own_stiffness.resize(std::max(data.own_stiffness.size(), e.markers.size()));
    if constexpr (SearchingForceGroup<F>)
      if (!e.markers.empty()) data.found_pairs.push_back({e.markers[0], std::make_shared<typename F::Search>()});
    ++owner;
  }
}

template <class F, StateScalar T>
AppliedWrench<T>* ForceKernels<F, T>::push(Pool const& pool, double t, Data<T>& data, AppliedWrench<T>* next) {
  for (Entry const& e : pool) {
    AppliedWrench<T>* const actions = next;
    next += e.markers.size();
    for (AppliedWrench<T>* p = actions; p != next; ++p)
      for (T& w : p->w) w = T(0.0);
    if constexpr (PartitionedForceGroup<F> && std::same_as<T, double>)
      if (data.workers && e.force.many() >= 2 * data.least_pairs) {
        add_forces_in_parts(e, t, data, actions);
        continue;
      }
    detail::for_each_action(e, data, [&](auto const& law, auto const& markers, auto const& at) {
      std::array<AppliedWrench<T>*, std::tuple_size_v<std::decay_t<decltype(at)>>> to;
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = actions + markers[k];
      detail::add_wrenches(law, at, t, data, to);
    });
    if constexpr (HasStates<F>)
      detail::with_law(e, data.multipliers.data(), [&](auto const& law) {
        auto const rates = law.template rates<T>(detail::frames_at(e.markers, data), detail::states_in(e, data), t);
        std::copy(rates.begin(), rates.end(), data.rates.begin() + e.state);
      });
  }
  return next;
}

template <class F, StateScalar T>
void ForceKernels<F, T>::add_forces_in_parts(Entry const& e, double t, Data<T>& data, AppliedWrench<T>* actions) {
  if constexpr (PartitionedForceGroup<F> && std::same_as<T, double>) {
    Index const many = e.force.many(), parts = data.workers->size();
    detail::PairFrames<F, T> const frame(e, data);
    data.workers->over(4 * parts, 4, [&](Index begin, Index end) {
      for (Index p = begin / 4; p < end / 4; ++p) {
        Sequence<AppliedWrench<T>>& aside = data.opposite[std::size_t(p)].actions;
        aside.clear();
        e.force.for_each_pair(
            frame,
            [&](Index i, Index j, auto const& law) {
              aside.push_back({.marker = j});
              detail::add_wrenches(law, std::array{e.markers[std::size_t(i)], e.markers[std::size_t(j)]}, t, data,
                                   std::array{actions + i, &aside.back()});
            },
            many * p / parts, many * (p + 1) / parts);
      }
    });
    for (auto const& part : data.opposite)
      for (AppliedWrench<T> const& aside : part.actions)
        for (int k = 0; k < 6; ++k) actions[aside.marker].w[k] += aside.w[k];
  }
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
  detail::GradientAt const x{t, F::is_load ? load_factor : 1.0, c};
  for (Entry const& e : pool)
    if constexpr (!ForceGroup<F>) {
      detail::with_law(e, data.multipliers.data(), [&](auto const& law) {
        if constexpr (HasStates<F>)
          detail::add_gradient_with_states(e, law, x, data, sink);
        else
          detail::add_gradient(law, e.markers, x, data, sink);
      });
      if constexpr (FollowsReaction<F>) detail::add_multiplier_columns(e, x, data, sink);
    } else if (c.exact || (c.full && c.mass == 0.0))  // the second condition: statics and linearisation
      coupled_tangent(e, x, data, sink);
    else
      group_tangent(e, x, data, sink);
}

template <class F, StateScalar T>
double ForceKernels<F, T>::energy(Pool const& pool, double t, Data<double> const& data) {
  double sum = 0.0;
  for (Entry const& e : pool)
    detail::for_each_action(
        e, data, [&](auto const& law, auto const&, auto const& at) { sum += detail::potential_of(law, at, t, data); });
  return sum;
}

template <class F, StateScalar T>
void ForceKernels<F, T>::add_powers(Pool const& pool, double t, double load_factor, VecX const& lambda,
                                    Data<double> const& data, Powers& p) {
  double const scale = F::is_load ? load_factor : 1.0;
  for (Entry const& e : pool)
    detail::for_each_action(e, data, lambda.data(), [&](auto const& law, auto const&, auto const& at) {
      detail::add_power(law, at, t, scale, data, p);
    });
}

template <class F, StateScalar T>
void ForceKernels<F, T>::group_tangent(Entry const& e, detail::GradientAt const& x, Data<double>& data,
                                       BlockSink& sink) {
  if constexpr (ForceGroup<F>) {
    auto& own = data.own_stiffness;
    for (std::size_t k = 0; k < e.markers.size(); ++k) std::fill_n(own[k].data(), 36, 0.0);
    TangentCoefficients c = x.c;
    if constexpr (!SearchingForceGroup<F>) c.coupling = nullptr;
    detail::GradientAt const of_pair{x.t, x.scale, c};
    detail::for_each_action(e, data, [&](auto const& law, auto const& markers, auto const& at) {
      detail::add_own_stiffness(law, at, of_pair, data, {&own[std::size_t(markers[0])], &own[std::size_t(markers[1])]});
    });
    for (std::size_t k = 0; k < e.markers.size(); ++k) {
      MarkerKinematics<double> const& p = data.markers[std::size_t(e.markers[k])];
      double* const s = own[k].data();
      bool const acts = std::any_of(s, s + 36, [](double entry) { return entry != 0.0; });
      if (p.columns > 0 && !acts) {
        sink.skip(p.first, p.first, p.columns, p.columns);
        continue;
      }
      for (int i = 0; i < 36; ++i) s[i] *= x.scale;
      detail::add_pulled_pairs<1>({&p}, s, true, data.scratch, sink);
    }
  }
}

template <class F, StateScalar T>
void ForceKernels<F, T>::coupled_tangent(Entry const& e, detail::GradientAt const& x, Data<double>& data,
                                         BlockSink& sink) {
  if constexpr (ForceGroup<F>) {
    detail::PairFrames<F, T> const frame(e, data);
    Index few = 0;
    if constexpr (requires { e.force.partners(); }) few = e.force.partners();
    ActiveContactPairs::Group* const active = x.c.pairs ? &x.c.pairs->group(few) : nullptr;
    std::size_t pair = 0;
    e.force.for_each_candidate([&](Index i, Index j, auto const& law) {
      bool touches = true;
      if constexpr (requires { law.may_touch(frame(i), frame(j)); }) touches = law.may_touch(frame(i), frame(j));
      if (active && !x.c.pairs->note(*active, pair++, touches)) return;
      std::array const at{e.markers[std::size_t(i)], e.markers[std::size_t(j)]};
      if (touches)
        detail::add_gradient(law, at, x, data, sink);
      else
        detail::skip_pulled_pairs<2>({&data.markers[std::size_t(at[0])], &data.markers[std::size_t(at[1])]}, sink);
    });
  }
}

}  // namespace polybody
