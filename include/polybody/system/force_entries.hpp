#pragma once
/// \file
/// A model's entries of forces: what elements of bodies and force elements push.

#include <polybody/bodies/shared/element_batches.hpp>
#include <polybody/system/motion_entries.hpp>

namespace polybody::detail {

template <class F, StateScalar T>
auto frames_of(ForceEntry<F> const& e, Data<T> const& data) {
  std::array<Frame<T>, F::markers> frames;
  for (int k = 0; k < F::markers; ++k) frames[k] = data.markers[std::size_t(e.markers[k])].frame;
  return frames;
}

/// Calls visit(force, markers, frames) for the force elements of an entry: itself, or the pairs of a group that may act
/// now. Markers are places among the entry's.
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
    visit(e.force, all, frames_of(e, data));
  }
}

template <class M, StateScalar T>
struct ForceEntries {
  using Motion = MotionEntries<M, T>;
  using Vector = VecXOf<T>;

  /// r += M a − f of all bodies.
  static void element_forces(void const* m, At<T> at, Vector const& a, double load_factor, Data<T>& data, Vector& r) {
    M const& model = Motion::model_of(m);
    Unbalance const u{at, a, model.gravity().g * load_factor};
    for_each_body_with_scratch(model, data, [&](auto const& e, auto& kept) { body_forces(e, kept, u, data, r); });
  }

  static void push_forces(void const* m, double t, Data<T>& data) {
    Action<T>* first = data.actions.data();
    Motion::model_of(m).for_each_force([&](auto const& e) {
      Action<T>* const actions = first;
      first += e.markers.size();
      for (Action<T>* p = actions; p != first; ++p)
        for (T& w : p->w) w = T(0.0);
      for_each_action(e, data, [&](auto const& force, auto const& markers, auto const& frames) {
        auto const wrenches = force.template wrenches<T>(frames, t);
        for (std::size_t k = 0; k < markers.size(); ++k)
          for (int i = 0; i < 3; ++i) {
            actions[markers[k]].w[i] += wrenches[k].f[i];
            actions[markers[k]].w[3 + i] += wrenches[k].m[i];
          }
      });
    });
  }

  static void masses(void const* m, At<T> at, Data<T>& data, BlockSink& sink) {
    for_each_body_with_scratch(Motion::model_of(m), data, [&](auto const& e, auto& kept) {
      auto&& scratch = kept.tangent_scratch(e.body);
      auto const q = Motion::coordinates(e, at.q);
      bool const alike = are_alike(e.body);
      for (Index i = 0; i < e.body.elements(); ++i) {
        if (i == 0 || !alike) e.body.mass(i, q, scratch.m);
        Index const first = e.v0 + e.body.first_column(i);
        sink.add(first, first, scratch.m);
      }
    });
  }

 private:
  /// What M a − f is asked for.
  struct Unbalance {
    At<T> at;
    Vector const& a;
    Vec3 g;
  };

  template <class Entry, class Kept>
  static void body_forces(Entry const& e, Kept& kept, Unbalance const& u, Data<T>& data, Vector& r) {
    using B = std::decay_t<decltype(e.body)>;
    constexpr int n = B::element_columns;
    bool const falls = u.g[0] != 0.0 || u.g[1] != 0.0 || u.g[2] != 0.0;
    auto&& scratch = kept.force_scratch(e.body);
    BodyMotion<T> const motion{Motion::coordinates(e, u.at.q), Motion::speeds(e, u.at.v), Motion::speeds(e, u.a)};
    auto const add = [&](Index i, auto const& x) {
      T* const rows = r.data() + e.v0 + e.body.first_column(i);
      int size = n;
      if constexpr (n == Eigen::Dynamic) size = int(x.size());
      for (int k = 0; k < size; ++k) rows[k] += x[k];
      if (falls) {
        e.body.template gravity<T>(i, motion.q, u.g, scratch.weight);
        for (int k = 0; k < size; ++k) rows[k] -= scratch.weight[k];
      }
    };
    Index const elements = e.body.elements();
    if constexpr (n != Eigen::Dynamic)
      if (data.workers && elements >= 2 * data.least_elements) {
        T* const slots = data.element_forces.data();
        data.workers->over(elements, data.least_elements, [&](Index begin, Index end) {
          for_each_unbalance<B, T>(e.body, {begin, end}, motion,
                                   [&](Index i, Vec<T, n> const& x) { std::copy_n(x.data(), n, slots + n * i); });
        });
        for (Index i = 0; i < elements; ++i) add(i, slots + n * i);
        return;
      }
    for_each_unbalance<B, T>(e.body, {0, elements}, motion, scratch, add);
  }
};

}  // namespace polybody::detail
