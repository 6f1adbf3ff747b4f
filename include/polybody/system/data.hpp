#pragma once
/// \file
/// Scratch of a model: everything that is computed from a state. The model itself stays const.

#include <polybody/math/workers.hpp>
#include <polybody/system/model.hpp>

namespace polybody {

namespace detail {
/// Calls f(pool, vector) for the pools of a model and what stands beside them.
template <class Pools, class Vectors, class F>
void for_each_pool_beside(Pools const& pools, Vectors& vectors, F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (f(std::get<I>(pools), std::get<I>(vectors)), ...);
  }(std::make_index_sequence<std::tuple_size_v<Pools>>{});
}
}  // namespace detail

template <class M, StateScalar T = double>
struct Data {
  std::vector<Published<T>> markers;    ///< waist 1, one for each marker
  std::vector<T> jacobians;             ///< arena of the dense Jacobians
  typename M::template Poses<T> poses;  ///< of the bodies
  typename M::template Scratch<T> scratch_of_bodies;
  typename M::template Gaps<T> gaps;  ///< waist 2, one for each joint
  std::vector<Wrench<double>> loads;  ///< per marker: what the tangent's second-order terms need

  std::vector<Mat<double, 6, 6>> own_stiffness;  ///< per marker of the largest force group
  std::vector<double> scratch;                   ///< for pulled blocks: n×18 and n×n of the widest marker

  bool linear_rows = true;  ///< else rows of linear joints are left out, and markers that these alone read
  std::vector<char> read;   ///< per marker: by anything but linear joints

  Workers* workers = nullptr;            ///< threads that share the loops; none by default
  std::vector<T> element_forces;         ///< with workers: of all elements of a body, before they are added in order
  std::vector<double> element_tangents;  ///< the same

  explicit Data(M const& model)
      : markers(std::size_t(model.markers())),
        jacobians(std::size_t(model.jacobian_size()), T(0.0)),
        loads(std::size_t(model.markers())) {
    Index offset = 0, widest = 12;
    auto const place = [&](auto const& pool) {
      for (auto const& m : pool.markers) {
        auto const& e = pool.entries[std::size_t(m.body)];
        Published<T>& p = markers[std::size_t(m.published)];
        p.first = e.v0 + e.body.first_column(m.point);
        p.columns = point_columns(e.body, m.point);
        p.jacobian = jacobians.data() + offset;
        offset += 6 * p.columns;
        widest = std::max(widest, p.columns);
      }
    };
    std::apply([&](auto const&... pool) { (place(pool), ...); }, model.body_pools());
    for (detail::GroundMarker const& g : model.ground_markers()) {
      Frame<T>& f = markers[std::size_t(g.published)].frame;
      f.r = g.placement.origin.template cast<T>();
      f.A = g.placement.axes.template cast<T>();
    }
    scratch.resize(std::size_t(widest * (widest + 18)));
    read.assign(markers.size(), 0);
    model.for_each_joint([&](auto const& e) {
      if constexpr (!LinearInCoordinates<typename std::decay_t<decltype(e.joint)>::PolicyType>)
        read[std::size_t(e.a)] = read[std::size_t(e.b)] = 1;
    });
    model.for_each_force([&](auto const& e) {
      for (Index const k : e.markers) read[std::size_t(k)] = 1;
    });
    model.for_each_force(
        [&](auto const& e) { own_stiffness.resize(std::max(own_stiffness.size(), e.markers.size())); });
    detail::for_each_pool_beside(model.body_pools(), poses,
                                 [](auto const& pool, auto& x) { x.resize(pool.entries.size()); });
    detail::for_each_pool_beside(model.body_pools(), scratch_of_bodies, [](auto const& pool, auto& x) {
      for (auto const& e : pool.entries) x.emplace_back(e.body);
    });
    detail::for_each_pool_beside(model.joint_pools(), gaps, [](auto const& pool, auto& x) { x.resize(pool.size()); });
  }
  /// From now on the threads share the loops over elements, markers and joints; what is computed stays the same to the
  /// last bit.
  void share_with(M const& model, Workers& threads) {
    workers = &threads;
    std::size_t forces = 0, tangents = 0;
    model.for_each_body([&](auto const& e) {
      std::size_t const n = std::size_t(element_columns(e.body)), elements = std::size_t(e.body.elements());
      if (elements < std::size_t(2 * least_elements)) return;
      forces = std::max(forces, n * elements);
      tangents = std::max(tangents, n * n * elements);
    });
    element_forces.resize(forces);
    element_tangents.resize(tangents);
  }
  static constexpr Index least_elements = 32;  ///< that are worth a thread
  static constexpr Index least_markers = 128;

  Data(Data const&) = delete;  // the markers point into the arena
  Data& operator=(Data const&) = delete;
  Data(Data&&) = default;  // moving a vector keeps its buffer
  Data& operator=(Data&&) = default;
};

/// Calls f(body entry, its scratch) for every body.
template <class M, class D, class F>
void for_each_body_with_scratch(M const& model, D& data, F&& f) {
  detail::for_each_pool_beside(model.body_pools(), data.scratch_of_bodies, [&](auto const& pool, auto& scratch) {
    for (std::size_t i = 0; i < pool.entries.size(); ++i) f(pool.entries[i], scratch[i]);
  });
}

/// Calls f(joint entry, gap) for every joint that has a gap: all but linear ones.
template <class M, class D, class F>
void for_each_gap(M const& model, D& data, F&& f) {
  detail::for_each_pool_beside(model.joint_pools(), data.gaps, [&](auto const& pool, auto& gaps) {
    using J = std::decay_t<decltype(pool.front().joint)>;
    if constexpr (!LinearInCoordinates<typename J::PolicyType>)
      for (std::size_t i = 0; i < pool.size(); ++i) f(pool[i], gaps[i]);
  });
}

}  // namespace polybody
