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
  auto const over = [&](auto const& pool, auto& poses) {
    using B = std::decay_t<decltype(pool.entries.front().body)>;
    auto const coordinates = [&](auto const& e) { return detail::body_part(q, e.q0, e.body.coordinates()); };
    auto const speeds = [&](auto const& e) { return detail::body_part(v, e.v0, e.body.speeds()); };
    if constexpr (SharesPose<B, T>)
      share(data.workers, Index(poses.size()), data.least_markers, [&](Index begin, Index end) {
        for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
          pool.entries[i].body.template pose<T>(coordinates(pool.entries[i]), speeds(pool.entries[i]), poses[i]);
      });
    share(data.workers, Index(pool.markers.size()), data.least_markers, [&](Index begin, Index end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        auto const& m = pool.markers[i];
        if (!data.linear_rows && !data.read[std::size_t(m.published)]) continue;
        auto const& e = pool.entries[std::size_t(m.body)];
        Published<T>& out = data.markers[std::size_t(m.published)];
        if constexpr (SharesPose<B, T>)
          e.body.publish(m.point, m.axes, poses[std::size_t(m.body)], out);
        else
          e.body.template publish<T>(m.point, m.axes, coordinates(e), speeds(e), out);
      }
    });
  };
  detail::for_each_pool_beside(model.body_pools(), data.poses, over);
}

/// Every joint's gap at time t from the published frames.
template <class M, StateScalar T>
void enforce(M const& model, double t, Data<M, T>& data) {
  auto const over = [&](auto const& pool, auto& gaps) {
    using J = std::decay_t<decltype(pool.front().joint)>;
    if constexpr (!LinearInCoordinates<typename J::PolicyType>)
      share(data.workers, Index(pool.size()), data.least_markers, [&](Index begin, Index end) {
        for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
          auto const& e = pool[i];
          using Gap = std::decay_t<decltype(gaps[i])>;  // made where it stands: assigned, it would be copied
          static_assert(std::is_trivially_destructible_v<Gap>);
          ::new (static_cast<void*>(&gaps[i])) Gap(e.joint.measure().template gap<T>(
              data.markers[std::size_t(e.a)].frame, data.markers[std::size_t(e.b)].frame, t));
        }
      });
  };
  detail::for_each_pool_beside(model.joint_pools(), data.gaps, over);
}

/// ġ = Ga Va + Gb Vb + Φ_t of a gap between published markers.
template <int m, StateScalar T>
Vec<T, m> gap_rate(Gap<m, T> const& gap, Published<T> const& a, Published<T> const& b) {
  return gap.Ga * twist(a.frame) + gap.Gb * twist(b.frame) + gap.rate;
}

}  // namespace polybody
