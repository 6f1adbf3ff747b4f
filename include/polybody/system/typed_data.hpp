#pragma once
/// \file
/// What `Data` keeps of a model's own types, and how its arrays are laid out.

#include <polybody/system/entries.hpp>
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

/// Beside the pools of a model: a pose for each body whose points share one, scratch for each body, a gap for each
/// joint, an answer for each compliant joint.
template <class M, StateScalar T>
struct TypedData {
  typename M::template Poses<T> poses;
  typename M::template Scratch<T> scratch;
  typename M::template Gaps<T> gaps;
  typename M::template Answers<T> answers;
  std::vector<T> own_rows;  ///< arena of rows that bodies own, and of linear rows

  static TypedData& of(Data<T> const& data) { return *static_cast<TypedData*>(data.kept.get()); }
};

/// Lays out the data of a model.
template <class M, StateScalar T>
class DataMaker {
 public:
  static Data<T> make(M const& model) {
    DataMaker maker(model);
    maker.place_markers();
    maker.place_rows();
    maker.place_actions();
    return std::move(maker.data_);
  }

 private:
  using Typed = TypedData<M, T>;
  explicit DataMaker(M const& model) : model_(model), typed_(std::make_shared<Typed>()) {
    for_each_pool_beside(model.body_pools(), typed_->poses, [](auto const& p, auto& x) { x.resize(p.entries.size()); });
    for_each_pool_beside(model.body_pools(), typed_->scratch, [](auto const& pool, auto& x) {
      for (auto const& e : pool.entries) x.emplace_back(e.body);
    });
    for_each_pool_beside(model.joint_pools(), typed_->gaps, [](auto const& pool, auto& x) { x.resize(pool.size()); });
    for_each_pool_beside(model.joint_pools(), typed_->answers,
                         [](auto const& pool, auto& x) { x.resize(pool.size()); });
    data_.kept = typed_;
  }

  void place_markers() {
    data_.markers.resize(std::size_t(model_.markers()));
    data_.jacobians.assign(std::size_t(model_.jacobian_size()), T(0.0));
    data_.loads.resize(data_.markers.size());
    Index offset = 0, widest = 12;
    auto const place = [&](auto const& pool) {
      for (auto const& m : pool.markers) {
        auto const& e = pool.entries[std::size_t(m.body)];
        Published<T>& p = data_.markers[std::size_t(m.published)];
        p.first = e.v0 + e.body.first_column(m.point);
        p.columns = point_columns(e.body, m.point);
        p.jacobian = data_.jacobians.data() + offset;
        offset += 6 * p.columns;
        widest = std::max(widest, p.columns);
      }
    };
    std::apply([&](auto const&... pool) { (place(pool), ...); }, model_.body_pools());
    for (GroundMarker const& g : model_.ground_markers()) {
      Frame<T>& f = data_.markers[std::size_t(g.published)].frame;
      for (int i = 0; i < 3; ++i) {
        f.r[i] = T(g.placement.origin[i]);
        for (int j = 0; j < 3; ++j) f.A(i, j) = T(g.placement.axes(i, j));
      }
    }
    data_.scratch.resize(std::size_t(widest * (widest + 18)));
    data_.read.assign(data_.markers.size(), 0);
  }

  void place_rows() {
    Index body = 0, size = 0;
    model_.for_each_body([&](auto const& e) { size += own_size(e.body); });
    for (LinearRows const& rows : model_.linear_rows())
      size += rows.rows() * (1 + rows.a.map.cols() + rows.b.map.cols());
    typed_->own_rows.assign(std::size_t(size), T(0.0));
    T* next = typed_->own_rows.data();
    model_.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      if constexpr (OwnsRows<B>) {
        constexpr int m = B::own_rows, n = B::element_columns;
        data_.rows.push_back({.source = RowSource::body,
                              .row = e.row,
                              .rows = m,
                              .owner = body,
                              .a = {.first = e.v0, .columns = n, .map = next + m},
                              .g = next});
        next += m * (1 + n);
      }
      ++body;
    });
    Index const joint = place_linear_rows(next);
    place_joints(joint);
  }
  template <class B>
  static Index own_size(B const&) {
    if constexpr (OwnsRows<B>) return B::own_rows * (1 + B::element_columns);
    return 0;
  }
  /// Blocks of all linear joints; their owners are found when the joints are gone through.
  Index place_linear_rows(T* next) {
    for (LinearRows const& rows : model_.linear_rows()) {
      Index const m = rows.rows();
      RowBlock<T> block{
          .source = RowSource::linear, .row = rows.row, .rows = int(m), .positions = int(rows.positions), .g = next};
      next += m;
      for (auto const& [side, end] : {std::pair(&rows.a, &block.a), std::pair(&rows.b, &block.b)}) {
        *end = {.first = side->v0, .columns = side->map.cols(), .map = next};
        for (Index i = 0; i < side->map.size(); ++i) *next++ = T(side->map.data()[i]);
      }
      data_.rows.push_back(block);
    }
    return Index(data_.rows.size() - model_.linear_rows().size());
  }
  void place_joints(Index first_linear) {
    Index joint = 0;
    auto const place = [&](auto const& pool, auto& gaps, auto& answers) {
      using J = typename std::decay_t<decltype(pool)>::value_type::JointType;
      using P = typename J::PolicyType;
      for (std::size_t i = 0; i < pool.size(); ++i, ++joint) {
        auto const& e = pool[i];
        if constexpr (LinearInCoordinates<P>) {
          data_.rows[std::size_t(first_linear + e.linear)].owner = joint;
        } else {
          data_.read[std::size_t(e.a)] = data_.read[std::size_t(e.b)] = 1;
          auto& gap = gaps[i];
          RowBlock<T> block{.source = AddsRows<P> ? RowSource::joint : RowSource::compliant,
                            .row = e.row,
                            .rows = J::rows,
                            .owner = joint,
                            .a = {e.a, 0, 6, gap.Ga.data()},
                            .b = {e.b, 0, 6, gap.Gb.data()},
                            .g = gap.g.data(),
                            .rate = gap.rate.data()};
          if constexpr (!AddsRows<P>) block.answer = answers[i].data();
          data_.rows.push_back(block);
        }
      }
    };
    for_each_pool_beside(model_.joint_pools(), typed_->gaps, [&](auto const& pool, auto& gaps) {
      using J = typename std::decay_t<decltype(pool)>::value_type::JointType;
      place(pool, gaps, std::get<M::template joint_type<J>()>(typed_->answers));
    });
  }

  void place_actions() {
    Index force = 0;
    model_.for_each_force([&](auto const& e) {
      for (Index const k : e.markers) {
        data_.read[std::size_t(k)] = 1;
        data_.actions.push_back({.source = force, .marker = k});
      }
      data_.own_stiffness.resize(std::max(data_.own_stiffness.size(), e.markers.size()));
      ++force;
    });
  }

  M const& model_;
  std::shared_ptr<Typed> typed_;
  Data<T> data_;
};

}  // namespace detail

/// From now on the threads share the loops over elements, markers and joints; what is computed stays the same to the
/// last bit.
template <class M, StateScalar T>
void share_loops(M const& model, Data<T>& data, Workers& threads) {
  data.workers = &threads;
  std::size_t forces = 0, tangents = 0;
  model.for_each_body([&](auto const& e) {
    std::size_t const n = std::size_t(element_columns(e.body)), elements = std::size_t(e.body.elements());
    if (elements < std::size_t(2 * data.least_elements)) return;
    forces = std::max(forces, n * elements);
    tangents = std::max(tangents, n * n * elements);
  });
  data.element_forces.resize(forces);
  data.element_tangents.resize(tangents);
}

/// Calls f(body entry, its scratch) for every body.
template <class M, StateScalar T, class F>
void for_each_body_with_scratch(M const& model, Data<T>& data, F&& f) {
  detail::for_each_pool_beside(model.body_pools(), detail::TypedData<M, T>::of(data).scratch,
                               [&](auto const& pool, auto& scratch) {
                                 for (std::size_t i = 0; i < pool.entries.size(); ++i) f(pool.entries[i], scratch[i]);
                               });
}

/// Calls f(joint entry, gap) for every joint that has a gap: all but linear ones.
template <class M, StateScalar T, class F>
void for_each_gap(M const& model, Data<T> const& data, F&& f) {
  detail::for_each_pool_beside(model.joint_pools(), detail::TypedData<M, T>::of(data).gaps,
                               [&](auto const& pool, auto& gaps) {
                                 using J = typename std::decay_t<decltype(pool)>::value_type::JointType;
                                 if constexpr (!LinearInCoordinates<typename J::PolicyType>)
                                   for (std::size_t i = 0; i < pool.size(); ++i) f(pool[i], gaps[i]);
                               });
}

}  // namespace polybody
