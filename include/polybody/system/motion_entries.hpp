#pragma once
/// \file
/// A model's entries of motion: bodies publish their markers, joints measure their gaps, coordinates move.

#include <new>

#include <polybody/system/typed_data.hpp>

namespace polybody {

/// ġ = Ga Va + Gb Vb + Φ_t of a gap between two frames.
template <int m, StateScalar T>
Vec<T, m> gap_rate(Gap<m, T> const& gap, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 6> const va = twist(a), vb = twist(b);
  Vec<T, m> rate;
  for (int i = 0; i < m; ++i) {
    T by_a = gap.Ga(i, 0) * va[0], by_b = gap.Gb(i, 0) * vb[0];
    for (int j = 1; j < 6; ++j) {
      by_a += gap.Ga(i, j) * va[j];
      by_b += gap.Gb(i, j) * vb[j];
    }
    rate[i] = by_a + by_b + gap.rate[i];
  }
  return rate;
}

}  // namespace polybody

namespace polybody::detail {

template <class M, StateScalar T>
struct MotionEntries {
  using Typed = TypedData<M, T>;
  using Vector = VecXOf<T>;
  static M const& model_of(void const* m) { return *static_cast<M const*>(m); }

  /// Every marker's frame, Jacobian and bias.
  static void publish(void const* m, At<T> at, Data<T>& data) {
    for_each_pool_beside(model_of(m).body_pools(), Typed::of(data).poses,
                         [&](auto const& pool, auto& poses) { publish_pool(pool, poses, at, data); });
  }

  /// Every joint's gap, what compliant joints answer, and the rows that bodies own or that are linear.
  static void measure_gaps(void const* m, At<T> at, Data<T>& data) {
    M const& model = model_of(m);
    T* next = Typed::of(data).own_rows.data();
    model.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      if constexpr (OwnsRows<B>) next = measure_own_rows(e, at, next);
    });
    for (LinearRows const& rows : model.linear_rows()) {
      if (data.linear_rows) measure_linear_rows(rows, at.q, next);
      next += rows.rows() * (1 + rows.a.map.cols() + rows.b.map.cols());
    }
    Typed& typed = Typed::of(data);
    for_each_pool_beside(model.joint_pools(), typed.gaps, [&](auto const& pool, auto& gaps) {
      using J = typename std::decay_t<decltype(pool)>::value_type::JointType;
      if constexpr (!LinearInCoordinates<typename J::PolicyType>)
        measure_pool(pool, gaps, std::get<M::template joint_type<J>()>(typed.answers), at.t, data);
    });
  }

  static void measure_gamma(void const* m, At<T> at, Data<T> const& data, Vector& out) {
    M const& model = model_of(m);
    model.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      if constexpr (OwnsRows<B>) {
        Vec<T, B::own_rows> own;
        e.body.template own_gamma<T>(coordinates(e, at.q), speeds(e, at.v), own);
        for (int i = 0; i < B::own_rows; ++i) out[e.row + i] = own[i];
      }
    });
    model.for_each_joint([&](auto const& e) {
      using J = std::decay_t<decltype(e.joint)>;
      using P = typename J::PolicyType;
      if constexpr (AddsRows<P> && !LinearInCoordinates<P>) {
        Vec<T, J::rows> const gamma = e.joint.geometry.template gamma<T>(data.markers[std::size_t(e.a)].frame,
                                                                         data.markers[std::size_t(e.b)].frame, at.t);
        for (int i = 0; i < J::rows; ++i) out[e.row + i] = gamma[i];
      }
    });
  }

  static void plus(void const* m, NarrowPlace const* places, Vector const& q, Vector const& delta, Vector& out) {
    for_each_place(model_of(m), places, [&](auto const& e, NarrowPlace const& p) {
      auto const qe = body_part(q, p.q, p.coordinates), de = body_part(delta, p.v, p.speeds);
      auto const to = body_part_of(out, p.q, p.coordinates);
      if (p.kind == NarrowPlace::Kind::as_it_is)
        e.body.template plus<T>(qe, de, to);
      else
        for (std::size_t i = 0; i < qe.size(); ++i) to[i] = qe[i] + de[i];
    });
  }
  static void local_rate(void const* m, NarrowPlace const* places, Vector const& delta, Vector const& v, Vector& out) {
    for_each_place(model_of(m), places, [&](auto const& e, NarrowPlace const& p) {
      auto const de = body_part(delta, p.v, p.speeds), ve = body_part(v, p.v, p.speeds);
      auto const to = body_part_of(out, p.v, p.speeds);
      if (p.kind == NarrowPlace::Kind::as_it_is)
        e.body.template local_rate<T>(de, ve, to);
      else
        for (std::size_t i = 0; i < ve.size(); ++i) to[i] = ve[i];
    });
  }

  /// q˙ = d/dε (q ⊞ ε v) at ε = 0: v itself where a body has as many coordinates as speeds, else by dual numbers in
  /// `room` (2 nq + nv).
  static void coordinate_rates(void const* m, NarrowPlace const* places, Vector const& q, Vector const& v,
                               VecXOf<Dual<1>>& room, Vector& rate) {
    using D = Dual<1>;
    D* const delta = room.data() + q.size();
    D* const out = delta + v.size();
    for_each_place(model_of(m), places, [&](auto const& e, NarrowPlace const& p) {
      Index const n = p.coordinates, k = p.speeds;
      if (n == k) {
        for (Index i = 0; i < n; ++i) rate[p.q + i] = v[p.v + i];
        return;
      }
      for (Index i = 0; i < n; ++i) room[p.q + i] = D(q[p.q + i]);
      for (Index i = 0; i < k; ++i) {
        delta[p.v + i] = D(0.0);
        delta[p.v + i].d[0] = v[p.v + i];
      }
      e.body.template plus<D>(std::span<D const>(room.data() + p.q, std::size_t(n)),
                              std::span<D const>(delta + p.v, std::size_t(k)), std::span<D>(out + p.q, std::size_t(n)));
      for (Index i = 0; i < n; ++i) rate[p.q + i] = out[p.q + i].d[0];
    });
  }

  static void rigid_speeds(void const* m, Vector const& q, Vec3 const& v0, Vec3 const& omega, Vector& v) {
    model_of(m).for_each_body([&](auto const& e) {
      e.body.rigid_velocity(coordinates(e, q), v0, omega, body_part_of(v, e.v0, e.body.speeds()));
    });
  }

  template <class Entry>
  static auto coordinates(Entry const& e, Vector const& q) {
    return body_part(q, e.q0, e.body.coordinates());
  }
  template <class Entry>
  static auto speeds(Entry const& e, Vector const& v) {
    return body_part(v, e.v0, e.body.speeds());
  }

 private:
  template <class Pool, class Poses>
  static void publish_pool(Pool const& pool, Poses& poses, At<T> at, Data<T>& data) {
    using B = std::decay_t<decltype(pool.entries.front().body)>;
    if constexpr (SharesPose<B, T>)
      share(data.workers, Index(poses.size()), data.least_markers, [&](Index begin, Index end) {
        for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
          auto const& e = pool.entries[i];
          e.body.template pose<T>(coordinates(e, at.q), speeds(e, at.v), poses[i]);
        }
      });
    share(data.workers, Index(pool.markers.size()), data.least_markers, [&](Index begin, Index end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        auto const& p = pool.markers[i];
        if (!data.linear_rows && !data.read[std::size_t(p.published)]) continue;
        Published<T>& out = data.markers[std::size_t(p.published)];
        if constexpr (SharesPose<B, T>) {
          pool.entries[std::size_t(p.body)].body.publish(p.point, p.axes, poses[std::size_t(p.body)], out);
        } else {
          auto const& e = pool.entries[std::size_t(p.body)];
          e.body.template publish<T>(p.point, p.axes, coordinates(e, at.q), speeds(e, at.v), out);
        }
      }
    });
  }

  template <class Pool, class Gaps, class Answers>
  static void measure_pool(Pool const& pool, Gaps& gaps, Answers& answers, double t, Data<T>& data) {
    using J = typename Pool::value_type::JointType;
    share(data.workers, Index(pool.size()), data.least_markers, [&](Index begin, Index end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        auto const& e = pool[i];
        Published<T> const &a = data.markers[std::size_t(e.a)], &b = data.markers[std::size_t(e.b)];
        using G = Gap<J::rows, T>;  // made where it stands: assigned, it would be copied
        static_assert(std::is_trivially_destructible_v<G>);
        ::new (static_cast<void*>(&gaps[i])) G(e.joint.measure().template gap<T>(a.frame, b.frame, t));
        if constexpr (!AddsRows<typename J::PolicyType>)
          answers[i] = e.joint.policy.template multiplier<J::rows, T>(gaps[i].g, gap_rate(gaps[i], a.frame, b.frame));
      }
    });
  }

  template <class Entry>
  static T* measure_own_rows(Entry const& e, At<T> at, T* next) {
    using B = std::decay_t<decltype(e.body)>;
    constexpr int m = B::own_rows, n = B::element_columns;
    Vec<T, m> own;
    Mat<T, m, n> map;
    e.body.template own_gap<T>(coordinates(e, at.q), own);
    e.body.template own_map<T>(coordinates(e, at.q), map);
    for (int i = 0; i < m; ++i) *next++ = own[i];
    for (int i = 0; i < m * n; ++i) *next++ = map.data()[i];
    return next;
  }
  /// g = C_a e_a + C_b e_b − c.
  static void measure_linear_rows(LinearRows const& rows, Vector const& q, T* g) {
    int const m = int(rows.rows());
    for (int i = 0; i < m; ++i) g[i] = T(-rows.constant[i]);
    T const* map = g + m;
    for (LinearSide const* const side : {&rows.a, &rows.b}) {
      add_mapped<0>(map, side->map.cols(), q.data() + side->q0, m, g);
      map += side->map.size();
    }
  }

  template <class F>
  static void for_each_place(M const& model, NarrowPlace const* places, F&& f) {
    model.for_each_body([&](auto const& e) {
      NarrowPlace const whole{NarrowPlace::Kind::as_it_is, e.q0, e.v0, e.body.coordinates(), e.body.speeds()};
      NarrowPlace const& p = places ? *places++ : whole;
      if (p.kind != NarrowPlace::Kind::carried) f(e, p);
    });
  }
};

}  // namespace polybody::detail
