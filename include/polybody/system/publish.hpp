#pragma once
/// \file
/// First half of an evaluation: bodies publish their markers, joints enforce their gaps.

#include <new>
#include <type_traits>

#include <polybody/system/data.hpp>

namespace polybody {

/// Every marker's frame, Jacobian and bias from the coordinates (nq) and speeds (nv).
template <class M, StateScalar T>
void publish(M const& model, VecXOf<T> const& q, VecXOf<T> const& v, Data<M, T>& data) {
  auto const over = [&](auto const& pool) {
    using B = std::decay_t<decltype(pool.entries.front().body)>;
    auto const coordinates = [&](auto const& e) { return detail::body_part(q, e.q0, e.body.coordinates()); };
    auto const speeds = [&](auto const& e) { return detail::body_part(v, e.v0, e.body.speeds()); };
    if constexpr (SharesPose<B, T>) {
      typename B::template Pose<T> pose{};
      Index of = -1;  // markers of one body mostly follow each other
      for (auto const& m : pool.markers) {
        auto const& e = pool.entries[std::size_t(m.body)];
        if (of != m.body) pose = e.body.template pose<T>(coordinates(e), speeds(e));
        of = m.body;
        e.body.publish(m.point, m.axes, pose, data.markers[std::size_t(m.published)]);
      }
    } else {
      for (auto const& m : pool.markers) {
        auto const& e = pool.entries[std::size_t(m.body)];
        e.body.template publish<T>(m.point, m.axes, coordinates(e), speeds(e), data.markers[std::size_t(m.published)]);
      }
    }
  };
  std::apply([&](auto const&... pool) { (over(pool), ...); }, model.body_pools());
}

/// Every joint's gap at time t from the published frames.
template <class M, StateScalar T>
void enforce(M const& model, double t, Data<M, T>& data) {
  for_each_gap(model, data, [&](auto const& e, auto& gap) {
    using Gap = std::decay_t<decltype(gap)>;  // made where it stands: assigned, it would be copied
    static_assert(std::is_trivially_destructible_v<Gap>);
    ::new (static_cast<void*>(&gap)) Gap(e.joint.geometry.template gap<T>(
        data.markers[std::size_t(e.a)].frame, data.markers[std::size_t(e.b)].frame, t));
  });
}

/// ġ = Ga Va + Gb Vb + Φ_t of a gap between published markers.
template <int m, StateScalar T>
Vec<T, m> gap_rate(Gap<m, T> const& gap, Published<T> const& a, Published<T> const& b) {
  return gap.Ga * twist(a.frame) + gap.Gb * twist(b.frame) + gap.rate;
}

}  // namespace polybody
