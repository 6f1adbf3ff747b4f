#pragma once
/// \file
/// Separation of a model into its islands. Each island is a model of the same type, with copies of its bodies, joints
/// and force elements.

#include <polybody/system/island.hpp>
#include <polybody/system/model.hpp>

namespace polybody::detail {

/// Force group that can be restricted to some of its many markers.
template <class F>
concept SeparableGroup = ForceGroup<F> && requires(F group) {
  group.many();
  group.keep_many(Index(0));
};

/// Makes the islands of a model.
template <class M, Capabilities wanted>
class IslandMaker;
template <class... Bs, class... Js, class... Fs, Capabilities wanted>
class IslandMaker<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, wanted> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;
  using Operations = OperationsOf<M, double, wanted>;
  struct Part {
    explicit Part(Gravity const& gravity) : model(gravity), operations(model) {}
    M model;
    Operations operations;
    IslandPlaces places;
  };

 public:
  [[gnu::cold]] explicit IslandMaker(M const& model) : model_(model) {}

  /// Returns the islands, or nothing if there is only one.
  [[gnu::cold]] Sequence<ModelIsland> make() {
    connect();
    Sequence<ModelIsland> out;
    if (parts_.size() < 2) return out;
    (add_bodies<Bs>(), ...);
    (add_joints<Js>(), ...);
    (add_forces<Fs>(), ...);
    for (std::shared_ptr<Part> const& part : parts_) {
      sort_once(part->model.parts_.nonholonomic_equations);
      out.push_back({{part, &part->operations},
                     layout_of(part->model),
                     Operations::make_data(part->model),
                     std::move(part->places)});
    }
    return out;
  }

 private:
  template <class Entries, class F>
  static void for_each_of(Entries const& entries, F&& f) {
    for (auto const& e : entries) f(e);
  }

  /// Numbers the islands by their first bodies.
  [[gnu::cold]] void connect() {
    owner_.assign(std::size_t(model_.markers()), -1);
    ground_.assign(owner_.size(), nullptr);
    local_.assign(owner_.size(), -1);
    for (GroundMarker const& g : model_.ground_markers()) ground_[std::size_t(g.published)] = &g;
    Index first = 0;
    ((for_each_of(std::get<BodyPool<Bs>>(model_.body_pools()).markers,
                  [&](auto const& m) { owner_[std::size_t(m.published)] = first + m.body; }),
      first += Index(std::get<BodyPool<Bs>>(model_.body_pools()).entries.size())),
     ...);
    for (Index b = 0; b < first; ++b) parent_.push_back(b);
    model_.for_each_joint([&](auto const& e) { unite(e.a, e.b); });
    (for_each_of(std::get<Sequence<ForceEntry<Fs>>>(model_.force_pools()), [&](auto const& e) { unite_markers(e); }),
     ...);
    island_.assign(parent_.size(), 0);
    for (Index b = 0; b < first; ++b) {
      bool const is_first = root(b) == b;
      island_[std::size_t(b)] = is_first ? parts_.size() : island_[std::size_t(root(b))];
      if (is_first) parts_.push_back(std::make_shared<Part>(model_.gravity()));
    }
  }
  /// First body of the island of body b.
  Index root(Index b) {
    while (parent_[std::size_t(b)] != b) {
      parent_[std::size_t(b)] = parent_[std::size_t(parent_[std::size_t(b)])];
      b = parent_[std::size_t(b)];
    }
    return b;
  }
  void unite(Index marker_a, Index marker_b) {
    Index a = owner_[std::size_t(marker_a)], b = owner_[std::size_t(marker_b)];
    if (a < 0 || b < 0) return;
    a = root(a);
    b = root(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }
  template <class F>
  void unite_markers(ForceEntry<F> const& e) {
    if constexpr (SeparableGroup<F>) {
      e.force.for_each_candidate(
          [&](Index i, Index j, auto const&) { unite(e.markers[std::size_t(i)], e.markers[std::size_t(j)]); });
    } else {
      Index last = -1;  // the last marker that is not on the ground
      for (Index const m : e.markers) {
        if (owner_[std::size_t(m)] < 0) continue;
        if (last >= 0) unite(last, m);
        last = m;
      }
    }
  }

  /// Island of the first of the markers that is not on the ground; 0 if all are on the ground.
  template <class Markers>
  std::size_t island_of(Markers const& markers) const {
    for (Index const m : markers)
      if (Index const b = owner_[std::size_t(m)]; b >= 0) return island_[std::size_t(b)];
    return 0;
  }
  /// Index of a marker in its island. A marker on the ground is added to the island.
  Index marker_in(Part& part, Index m) {
    if (owner_[std::size_t(m)] >= 0) return local_[std::size_t(m)];
    part.model.parts_.ground.push_back({ground_[std::size_t(m)]->placement, part.model.parts_.markers});
    return part.model.parts_.markers++;
  }
  /// Adds `count` constraint equations, from equation `row` of the model on. Returns the first of them in the island.
  Index add_rows(Part& part, Index row, Index count) {
    ModelParts& to = part.model.parts_;
    Index const own = to.rows;
    part.places.rows.push_back({own, row, count});
    for (Index const i : model_.nonholonomic_equations())
      if (i >= row && i < row + count) to.nonholonomic_equations.push_back(own + i - row);
    to.rows += count;
    return own;
  }

  template <class B>
  [[gnu::cold]] void add_bodies() {
    BodyPool<B> const& pool = std::get<BodyPool<B>>(model_.body_pools());
    Sequence<Index> index;
    for (auto const& e : pool.entries) {
      Part& part = *parts_[island_[std::size_t(next_body_) + index.size()]];
      ModelParts& to = part.model.parts_;
      auto& entries = std::get<BodyPool<B>>(part.model.bodies_).entries;
      index.push_back(Index(entries.size()));
      Index row = -1;
      if constexpr (HasOwnEquations<B>) row = add_rows(part, e.row, B::own_equations);
      entries.push_back({e.body, e.name, to.coordinates, to.velocities, row, e.made_in});
      part.places.q.push_back({to.coordinates, e.q0, e.body.coordinates()});
      part.places.v.push_back({to.velocities, e.v0, e.body.velocities()});
      to.coordinates += e.body.coordinates();
      to.velocities += e.body.velocities();
      ++to.bodies;
    }
    for (auto const& m : pool.markers) {
      Part& part = *parts_[island_[std::size_t(next_body_ + m.body)]];
      ModelParts& to = part.model.parts_;
      std::get<BodyPool<B>>(part.model.bodies_)
          .markers.push_back({index[std::size_t(m.body)], m.point, m.axes, to.markers});
      local_[std::size_t(m.published)] = to.markers++;
      to.jacobian_size += 6 * point_columns(pool.entries[std::size_t(m.body)].body, m.point);
    }
    next_body_ += Index(pool.entries.size());
  }

  template <class J>
  [[gnu::cold]] void add_joints() {
    for (JointEntry<J> const& e : std::get<Sequence<JointEntry<J>>>(model_.joint_pools())) {
      Part& part = *parts_[island_of(std::array{e.a, e.b})];
      JointEntry<J> own = e;
      own.a = marker_in(part, e.a);
      own.b = marker_in(part, e.b);
      if (e.row >= 0) own.row = add_rows(part, e.row, e.rows);
      std::get<Sequence<JointEntry<J>>>(part.model.joints_).push_back(std::move(own));
    }
  }

  template <class F>
  [[gnu::cold]] void add_forces() {
    for (ForceEntry<F> const& e : std::get<Sequence<ForceEntry<F>>>(model_.force_pools())) {
      if constexpr (SeparableGroup<F>) {
        add_group(e);
        continue;
      }
      Part& part = *parts_[island_of(e.markers)];
      ForceEntry<F> own = e;
      for (Index& m : own.markers) m = marker_in(part, m);
      if constexpr (requires { own.state; }) {
        ModelParts& to = part.model.parts_;
        own.state = to.states;
        if constexpr (states_of<F>() > 0)
          part.places.v.push_back(
              {to.velocities + to.states, model_.velocities() - model_.states() + e.state, states_of<F>()});
        to.states += states_of<F>();
        for (IslandPlaces::Range const& r : part.places.rows)
          if (e.row >= r.model && e.row < r.model + r.count) own.row = r.own + e.row - r.model;
      }
      std::get<Sequence<ForceEntry<F>>>(part.model.forces_).push_back(std::move(own));
    }
  }
  /// Adds a group to each island of its many markers. If islands share the partners, the partners are on the ground.
  template <class F>
  [[gnu::cold]] void add_group(ForceEntry<F> const& e) {
    std::size_t const many = std::size_t(e.force.many());
    Sequence<Sequence<Index>> markers(parts_.size());
    for (std::size_t i = 0; i < many; ++i) markers[island_of(std::array{e.markers[i]})].push_back(e.markers[i]);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (markers[k].empty()) continue;
      ForceEntry<F> own{e.force, {}, e.name, e.made_in};
      own.force.keep_many(Index(markers[k].size()));
      markers[k].append(e.markers.begin() + many, e.markers.end());
      for (Index const m : markers[k]) own.markers.push_back(marker_in(*parts_[k], m));
      std::get<Sequence<ForceEntry<F>>>(parts_[k]->model.forces_).push_back(std::move(own));
    }
  }

  M const& model_;
  Sequence<Index> owner_;  ///< body of each marker, in the order of the layout; −1 for the ground
  Sequence<Index> local_;  ///< index of each marker in its island
  Sequence<GroundMarker const*> ground_;
  Sequence<Index> parent_;  ///< for each body: an earlier body of its island, or the body itself
  Sequence<std::size_t> island_;
  Sequence<std::shared_ptr<Part>> parts_;
  Index next_body_ = 0;
};

/// Islands of `model`; empty unless `possible` is true and the model has several islands. Joints that are linear in the
/// coordinates are not separated.
template <bool possible, Capabilities wanted, class M>
[[gnu::cold]] Sequence<ModelIsland> make_islands(M const& model) {
  if constexpr (possible)
    if (model.linear_rows().empty()) return IslandMaker<M, wanted>(model).make();
  return {};
}

}  // namespace polybody::detail
