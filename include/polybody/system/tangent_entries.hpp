#pragma once
/// \file
/// A model's entries of the tangent: bodies, compliant joints and force elements, block by block into a sink.

#include <polybody/system/force_entries.hpp>
#include <polybody/system/pulled_blocks.hpp>

namespace polybody::detail {

/// Adds −scale · w of a force element's wrenches to the loads of its markers.
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

template <class M>
struct TangentEntries {
  using Motion = MotionEntries<M, double>;

  static void element_tangents(void const* m, At<double> at, TangentCoefficients const& c, Data<double>& data,
                               BlockSink& sink) {
    for_each_body_with_scratch(Motion::model_of(m), data,
                               [&](auto const& e, auto& kept) { body_tangents(e, kept, at, c, data, sink); });
  }

  /// K and D of compliant joints, by the slope of what they answer.
  static void compliant_tangents(void const* model, TangentCoefficients const& c, Data<double>& data, BlockSink& sink) {
    for_each_gap(Motion::model_of(model), data, [&](auto const& e, auto const& gap) {
      using J = std::decay_t<decltype(e.joint)>;
      if constexpr (!AddsRows<typename J::PolicyType>) {
        constexpr int m = J::rows;
        Published<double> const &a = data.markers[std::size_t(e.a)], &b = data.markers[std::size_t(e.b)];
        auto const slope =
            e.joint.policy.template slope<m>(c.stiffness, c.damping, gap.g, gap_rate(gap, a.frame, b.frame));
        double const* const maps[2] = {gap.Ga.data(), gap.Gb.data()};
        if constexpr (requires { slope.toDenseMatrix(); })
          add_pulled_slope<m, true>({&a, &b}, maps, slope.diagonal().data(), data.scratch, sink);
        else
          add_pulled_slope<m, false>({&a, &b}, maps, slope.data(), data.scratch, sink);
      }
    });
  }

  static void force_tangents(void const* m, double t, double load_factor, TangentCoefficients const& c,
                             Data<double>& data, BlockSink& sink) {
    Motion::model_of(m).for_each_force([&](auto const& e) {
      using F = std::decay_t<decltype(e.force)>;
      double const scale = F::is_load ? load_factor : 1.0;
      if constexpr (ForceGroup<F>)
        group_tangent(e, t, scale, c, data, sink);
      else
        force_tangent(e, t, scale, c, data, sink);
    });
  }

  /// ck ∂(Gᵀλ)/∂q of joints and of bodies' own rows; adds Gᵀλ to the loads.
  static void joint_stiffness(void const* model, At<double> at, VecX const& lambda, double ck, Data<double>& data,
                              BlockSink& sink) {
    M const& of = Motion::model_of(model);
    of.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      if constexpr (OwnsRows<B>) {
        Mat<double, B::element_columns, B::element_columns> k;
        Vec<double, B::own_rows> const l(lambda.data() + e.row);
        e.body.own_stiffness(Motion::coordinates(e, at.q), l, k);
        k *= ck;
        sink.add(e.v0, e.v0, k);
      }
    });
    auto& answers = TypedData<M, double>::of(data).answers;
    for_each_pool_beside(of.joint_pools(), TypedData<M, double>::of(data).gaps, [&](auto const& pool, auto& gaps) {
      using J = typename std::decay_t<decltype(pool)>::value_type::JointType;
      if constexpr (!LinearInCoordinates<typename J::PolicyType>)
        for (std::size_t i = 0; i < pool.size(); ++i) {
          auto const& e = pool[i];
          double const* const l = AddsRows<typename J::PolicyType>
                                      ? lambda.data() + e.row
                                      : std::get<M::template joint_type<J>()>(answers)[i].data();
          stiffness_of_joint(e, gaps[i], l, {at, ck}, data, sink);
        }
    });
  }

  /// ck ∂(Jᵀw)/∂q for the wrenches w in data.loads, marker by marker.
  static void load_stiffness(void const* m, At<double> at, double ck, Data<double>& data, BlockSink& sink) {
    for_each_pool_beside(Motion::model_of(m).body_pools(), TypedData<M, double>::of(data).scratch,
                         [&](auto const& pool, auto& kept) {
                           for (auto const& p : pool.markers)
                             stiffness_of_load(pool, kept[std::size_t(p.body)], p, {at, ck}, data, sink);
                         });
  }

 private:
  /// Where and by which factor second-order terms are taken.
  struct Stiffness {
    At<double> at;
    double ck;
  };

  template <class Entry, class Kept>
  static void body_tangents(Entry const& e, Kept& kept, At<double> at, TangentCoefficients const& c, Data<double>& data,
                            BlockSink& sink) {
    using B = std::decay_t<decltype(e.body)>;
    constexpr int n = B::element_columns;
    auto&& scratch = kept.tangent_scratch(e.body);
    BodyMotion<> const motion{Motion::coordinates(e, at.q), Motion::speeds(e, at.v)};
    ElementCoefficients const coefficients{c.mass, c.damping, c.stiffness};
    auto const add = [&](Index i, auto const& k) {
      Index const first = e.v0 + e.body.first_column(i);
      sink.add(first, first, k);
    };
    Index const elements = e.body.elements();
    if constexpr (n != Eigen::Dynamic)
      if (data.workers && elements >= 2 * data.least_elements) {
        double* const slots = data.element_tangents.data();
        data.workers->over(elements, data.least_elements, [&](Index begin, Index end) {
          for_each_element_tangent<B>(
              e.body, {begin, end}, motion, coefficients,
              [&](Index i, Mat<double, n, n> const& k) { std::copy_n(k.data(), n * n, slots + n * n * i); });
        });
        for (Index i = 0; i < elements; ++i) add(i, BlockView(slots + n * n * i, n, n, 1, n));
        return;
      }
    for_each_element_tangent<B>(e.body, {0, elements}, motion, coefficients, scratch, add);
  }

  template <class F>
  static void force_tangent(ForceEntry<F> const& e, double t, double scale, TangentCoefficients const& c,
                            Data<double>& data, BlockSink& sink) {
    constexpr int n = F::markers;
    auto const frames = frames_of(e, data);
    std::array<Published<double> const*, std::size_t(n)> markers;
    for (int k = 0; k < n; ++k) markers[std::size_t(k)] = &data.markers[std::size_t(e.markers[k])];
    Mat<double, 6 * n, 6 * n> s = wrench_gradient(e.force, frames, t, c.stiffness, c.damping);
    s *= -scale;
    add_pulled_pairs<n>(markers, s.data(), c.full || couples_bodies<F>(), data.scratch, sink);
    if (c.full) add_loads(e.force.template wrenches<double>(frames, t), e.markers, scale, data);
  }

  /// What each marker of a group feels of its own motion alone, block by block, zero where nothing acts; with stand-ins
  /// by a law's `own_stiffness` where it has one. Statics and linearisation, which ask for all second-order terms and
  /// no mass, get the exact gradient with what couples the pairs, all that may ever act.
  template <class F>
  static void group_tangent(ForceEntry<F> const& e, double t, double scale, TangentCoefficients const& c,
                            Data<double>& data, BlockSink& sink) {
    auto const places = [&](std::array<Index, 2> const& pair) {
      return std::array<Index, 2>{e.markers[std::size_t(pair[0])], e.markers[std::size_t(pair[1])]};
    };
    if (c.full && c.mass == 0.0) {
      e.force.for_each_candidate([&](Index i, Index j, auto const& law) {
        auto const at = places({i, j});
        std::array<Published<double> const*, 2> const markers = {&data.markers[std::size_t(at[0])],
                                                                 &data.markers[std::size_t(at[1])]};
        std::array<Frame<double>, 2> const frames = {markers[0]->frame, markers[1]->frame};
        Mat<double, 12, 12> s = wrench_gradient(law, frames, t, c.stiffness, c.damping);
        s *= -scale;
        add_pulled_pairs<2>(markers, s.data(), true, data.scratch, sink);
        add_loads(law.template wrenches<double>(frames, t), at, scale, data);
      });
      return;
    }
    auto& own = data.own_stiffness;
    for (std::size_t k = 0; k < e.markers.size(); ++k) std::fill_n(own[k].data(), 36, 0.0);
    for_each_action(e, data, [&](auto const& law, auto const& markers, auto const& frames) {
      std::size_t const i = std::size_t(markers[0]), j = std::size_t(markers[1]);
      if (c.full) add_loads(law.template wrenches<double>(frames, t), places(markers), scale, data);
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
      add_pulled_pairs<1>({&p}, s, true, data.scratch, sink);
    }
  }

  template <class J, class G>
  static void stiffness_of_joint(JointEntry<J> const& e, G const& gap, double const* multipliers, Stiffness const& x,
                                 Data<double>& data, BlockSink& sink) {
    constexpr int m = J::rows;
    Published<double> const &a = data.markers[std::size_t(e.a)], &b = data.markers[std::size_t(e.b)];
    Vec<double, m> l;
    for (int i = 0; i < m; ++i) l[i] = multipliers[i];
    Mat<double, 12, 12> s = wrench_gradient(e.joint.measure(), a.frame, b.frame, x.at.t, l);
    for (int i = 0; i < 144; ++i) s.data()[i] *= x.ck;
    std::array<Wrench<double>, 2> on_markers;
    for (auto const& [map, w] : {std::pair(gap.Ga.data(), &on_markers[0]), std::pair(gap.Gb.data(), &on_markers[1])}) {
      double fm[6];
      wrench_of<m>(map, multipliers, fm);
      for (int i = 0; i < 3; ++i) {
        w->f[i] = fm[i];
        w->m[i] = fm[3 + i];
      }
    }
    add_loads(on_markers, {e.a, e.b}, -1.0, data);
    add_pulled_pairs<2>({&a, &b}, s.data(), true, data.scratch, sink);
  }

  template <class B, class Kept>
  static void stiffness_of_load(BodyPool<B> const& pool, Kept& kept, MarkerEntry<B> const& p, Stiffness const& x,
                                Data<double>& data, BlockSink& sink) {
    auto const& e = pool.entries[std::size_t(p.body)];
    Published<double> const& marker = data.markers[std::size_t(p.published)];
    Wrench<double> const& w = data.loads[std::size_t(p.published)];
    bool acts = false;
    for (int i = 0; i < 3; ++i) acts = acts || w.f[i] != 0.0 || w.m[i] != 0.0;
    if (!acts) return sink.skip(marker.first, marker.first, marker.columns, marker.columns);
    auto const q = Motion::coordinates(e, x.at.q);
    if constexpr (B::point_columns == Eigen::Dynamic) {
      MatX& k = kept.point_scratch();
      e.body.load_stiffness(p.point, q, w, k);
      auto of_marker = k.topLeftCorner(marker.columns, marker.columns);
      of_marker *= x.ck;
      sink.add(marker.first, marker.first, of_marker);
    } else {
      Mat<double, B::point_columns, B::point_columns> k;
      e.body.load_stiffness(p.point, q, w, k);
      k *= x.ck;
      sink.add(marker.first, marker.first, k);
    }
  }
};

}  // namespace polybody::detail
