#pragma once
/// \file
/// Evaluation of a model over an energy-conserving step from q₀ to q₁, with secant slopes instead of derivatives. The
/// changes of every potential and constraint function are then exact to round-off [Gonzalez 1996, 1999]:
///   f·Δq = −ΔV minus the dissipated energy,   Ḡ Δq = ΔΦ.

#include <polybody/math/secant.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/force_kernels.hpp>
#include <polybody/system/model.hpp>
#include <polybody/system/secant_support.hpp>
#include <polybody/system/step_secants.hpp>

namespace polybody::detail {

/// Calls f(pool, vector) for each pool of a model and the corresponding element of the tuple `vectors`.
template <class Pools, class Vectors, class F>
void for_each_pool_with(Pools const& pools, Vectors& vectors, F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (f(std::get<I>(pools), std::get<I>(vectors)), ...);
  }(std::make_index_sequence<std::tuple_size_v<Pools>>{});
}

/// Position and axes of a marker (r, then A column by column) at both ends of a step, and their secant slopes with
/// respect to the coordinates of the marker's columns.
struct MarkerSecant {
  std::array<double, 12> from = {}, to = {};
  double* slopes = nullptr;  ///< 12×columns
  Index first = 0, columns = 0;
};

template <int m>
struct ConstraintSecant {
  Vec<double, m> from, to;
  double* rows_a = nullptr;  ///< Ḡ with respect to the columns of marker a, m×columns
  double* rows_b = nullptr;  ///< Ḡ with respect to the columns of marker b, m×columns
};

template <class B>
struct SecantScratch {
  Sequence<Secant<B::point_columns>> q, rest, jacobian;
};

template <class BodyPools, class JointPools>
struct NearbySecants;
template <class... Bs, class... Js>
struct NearbySecants<std::tuple<BodyPool<Bs>...>, std::tuple<Sequence<JointEntry<Js>>...>> {
  using Scratch = std::tuple<SecantScratch<Bs>...>;
  using Constraints = std::tuple<Sequence<ConstraintSecant<Js::rows>>...>;
};

/// Frame of a marker. Its twelve numbers are the variables `first`, `first` + 1, … of the `Secant` type S.
template <class S>
Frame<S> frame_of(MarkerSecant const& m, int first) {
  Frame<S> f;
  for (int i = 0; i < 3; ++i) {
    f.r[i] = S::variable(m.from[std::size_t(i)], m.to[std::size_t(i)], first + i);
    for (int j = 0; j < 3; ++j) {
      int const k = 3 + 3 * i + j;
      f.A(j, i) = S::variable(m.from[std::size_t(k)], m.to[std::size_t(k)], first + k);
    }
  }
  return f;
}

/// Slope with respect to a column of a marker, from the slopes `by_frame` (12) with respect to position and axes.
inline double pulled(MarkerSecant const& m, double const* by_frame, Index column) {
  double sum = 0.0;
  for (int j = 0; j < 12; ++j) sum += by_frame[j] * m.slopes[12 * column + j];
  return sum;
}

template <class M>
class TypedSecants final : public SecantOperations {
  static_assert(HasSecants<M>,
                "This model does not support EnergyMomentum. system_for<EnergyMomentum>(model) reports the reason.");

 public:
  TypedSecants(M const& model, Data<double> const& data)
      : model_(model),
        markers_(std::size_t(model.markers())),
        middle_(VecX::Zero(model.coordinates())),
        still_(VecX::Zero(model.velocities())) {
    Index marker_size = 0, row_entries = 0, widest = 1;
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      MarkerKinematics<double> const& p = data.markers[i];
      markers_[i].first = p.first;
      markers_[i].columns = p.columns;
      marker_size += 12 * p.columns;
      widest = std::max(widest, p.columns);
    }
    slopes_.resize(std::size_t(marker_size));
    double* next = slopes_.data();
    for (MarkerSecant& m : markers_) {
      m.slopes = next;
      next += 12 * m.columns;
    }
    for (GroundMarker const& g : model.ground_markers()) {
      MarkerSecant& m = markers_[std::size_t(g.published)];
      for (std::size_t j = 0; j < 12; ++j)
        m.from[j] = j < 3 ? g.placement.origin[Index(j)] : g.placement.axes(Index(j % 3), Index(j / 3 - 1));
      m.to = m.from;
    }
    for_each_pool_with(model.joint_pools(), constraints_, [&](auto const& pool, auto& constraints) {
      constraints.resize(pool.size());
      for (auto const& e : pool)
        row_entries += std::decay_t<decltype(e.joint)>::rows * (marker(e.a).columns + marker(e.b).columns);
    });
    rows_.resize(std::size_t(row_entries));
    next = rows_.data();
    for_each_pool_with(model.joint_pools(), constraints_, [&](auto const& pool, auto& constraints) {
      for (std::size_t i = 0; i < pool.size(); ++i) {
        constexpr Index m = std::decay_t<decltype(pool[i].joint)>::rows;
        constraints[i].rows_a = next;
        constraints[i].rows_b = next + m * marker(pool[i].a).columns;
        next = constraints[i].rows_b + m * marker(pool[i].b).columns;
      }
    });
    for_each_pool_with(model.body_pools(), bodies_, [](auto const& pool, auto& scratch) {
      using B = std::decay_t<decltype(pool.entries.front().body)>;
      Index size = 0;
      for (auto const& e : pool.entries) size = std::max(size, e.body.coordinates());
      scratch.q.resize(std::size_t(size));
      scratch.rest.resize(std::size_t(size));
      scratch.jacobian.resize(std::size_t(6 * B::point_columns));
    });
    scratch_.resize(std::size_t(widest * widest));
  }
  TypedSecants(TypedSecants const&) = delete;  // markers and constraints point into the arenas
  TypedSecants& operator=(TypedSecants const&) = delete;

  /// Writes q0 + y to q1; the frames of q1 are turned by the Cayley vectors in y.
  void move(VecX const& q0, VecX const& y, VecX& q1) const override {
    model_.for_each_body([&](auto const& e) { step_end(e.body, part_of(q0, e), velocities_of(y, e), part_of(q1, e)); });
  }
  VecX const& middle() const override { return middle_; }

  /// Sets the step, and evaluates markers and constraint functions. Constraint functions of time are evaluated at the
  /// end of the step. Loads are evaluated at the midpoint of the step, like the data of the system.
  void evaluate(SecantStep const& step) override {
    step_ = step;
    means_ = {1.0 / step.h, step.decay};
    model_.for_each_body(
        [&](auto const& e) { step_middle(e.body, part_of(*step.q0, e), part_of(*step.q1, e), part_of(middle_, e)); });
    for_each_pool_with(model_.body_pools(), bodies_,
                       [&](auto const& pool, auto& scratch) { evaluate_marker(pool, scratch); });
    for_each_pool_with(model_.joint_pools(), constraints_, [&](auto const& pool, auto& constraints) {
      for (std::size_t i = 0; i < pool.size(); ++i) evaluate_constraints(pool[i], step.t + step.h, constraints[i]);
    });
  }

  /// r = M a − f + Ḡᵀλ over the step (nv).
  void residual(Data<double> const& data, VecX const& a, VecX const& lambda, VecX& r) override {
    r.setZero();
    model_.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      Vec<double, B::element_columns> inertia, force, weight;
      for (Index i = 0; i < e.body.elements(); ++i) {
        e.body.template inertia<double>(i, part_of(middle_, e), velocities_of(a, e), inertia);
        if constexpr (HasFrameSteps<B>)
          e.body.discrete_force(i, frame_step(e), force);
        else
          e.body.discrete_force(i, part_of(*step_.q0, e), part_of(*step_.q1, e), means_, force);
        e.body.template gravity<double>(i, part_of(middle_, e), model_.gravity().g, weight);
        double* const rows = r.data() + e.v0 + e.body.first_column(i);
        for (int k = 0; k < B::element_columns; ++k) rows[k] += inertia[k] - force[k] - weight[k];
      }
    });
    for_each_joint([&](auto const& e, auto const& secant) {
      constexpr int m = std::decay_t<decltype(e.joint)>::rows;
      Vec<double, m> const l = multiplier(e, secant, lambda);
      add_rows<m>(marker(e.a), secant.rows_a, l, r);
      add_rows<m>(marker(e.b), secant.rows_b, l, r);
    });
    model_.for_each_force([&](auto const& e) {
      add_force(data, e, r);
      if constexpr (HasStates<std::decay_t<decltype(e.force)>>) {
        auto const rates =
            e.force.template rates<double>(frames_at(e.markers, data), states_in(e, data), middle_time());
        for (std::size_t s = 0; s < rates.size(); ++s) {
          Index const i = data.first_state + e.state + Index(s);
          r[i] += a[i] - rates[s];
        }
      }
    });
  }

  /// Φ(q₁).
  void violation(VecX& phi) const override {
    for_each_joint([&](auto const& e, auto const& secant) {
      if (e.row >= 0) phi.segment(e.row, secant.to.size()) = secant.to;
    });
  }

  /// Adds [M + s K̄, Ḡᵀ; Ḡ, 0] to `sink`. K̄ is a symmetric approximation of −∂f/∂q₁ without the change of Ḡ, and Ḡ
  /// approximates ∂Φ/∂q₁. The relative errors of K̄ and Ḡ are about the fraction of a revolution that a body makes in
  /// the step. Newton's method therefore contracts.
  void tangent(double s, BlockSink& sink) override {
    Index const row0 = model_.velocities();
    model_.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      Mat<double, B::element_columns, B::element_columns> k, mass;
      for (Index i = 0; i < e.body.elements(); ++i) {
        if constexpr (HasFrameSteps<B>)
          e.body.discrete_tangent(i, frame_step(e), part_of(middle_, e), velocities_of(still_, e), s, k);
        else
          e.body.discrete_tangent(i, part_of(*step_.q0, e), part_of(*step_.q1, e), means_, s, k);
        e.body.mass(i, part_of(middle_, e), mass);
        k += mass;
        sink.add(e.v0 + e.body.first_column(i), e.v0 + e.body.first_column(i), k);
      }
    });
    for_each_joint([&](auto const& e, auto const& secant) {
      using J = std::decay_t<decltype(e.joint)>;
      constexpr int m = J::rows;
      using Rows = Eigen::Map<Mat<double, m, Eigen::Dynamic> const>;
      MarkerSecant const& a = marker(e.a);
      MarkerSecant const& b = marker(e.b);
      Rows const ga(secant.rows_a, m, a.columns), gb(secant.rows_b, m, b.columns);
      if constexpr (ConstrainingPolicy<typename J::PolicyType>) {
        for (auto const& [p, g] : {std::pair<MarkerSecant const&, Rows const&>(a, ga), {b, gb}})
          if (p.columns > 0) {
            sink.add(p.first, row0 + e.row, g.transpose());
            sink.add(row0 + e.row, p.first, g);
          }
      } else {
        Vec<double, m> const change = secant.to - secant.from, mean = 0.5 * (secant.from + secant.to);
        Mat<double, m, m> const slope = e.joint.policy.template slope<m>(s * (0.5 + means_.decay), s * means_.rate,
                                                                         mean, (change * means_.rate).eval());
        add_pair(a, ga, slope, a, ga, sink);
        add_pair(a, ga, slope, b, gb, sink);
        add_pair(b, gb, slope, a, ga, sink);
        add_pair(b, gb, slope, b, gb, sink);
      }
    });
    std::apply(
        [&](auto const&... pool) {
          (ForceKernels<decltype(pool.front().force), double>::masses(pool, row0 - model_.states(), sink), ...);
        },
        model_.force_pools());
  }

 private:
  template <class Entry>
  static std::span<double const> part_of(VecX const& x, Entry const& e) {
    return {x.data() + e.q0, std::size_t(e.body.coordinates())};
  }
  template <class Entry>
  static std::span<double> part_of(VecX& x, Entry const& e) {
    return {x.data() + e.q0, std::size_t(e.body.coordinates())};
  }
  template <class Entry>
  static std::span<double const> velocities_of(VecX const& x, Entry const& e) {
    return {x.data() + e.v0, std::size_t(e.body.velocities())};
  }
  template <class Entry>
  FrameStep frame_step(Entry const& e) const {
    return {part_of(*step_.q0, e),
            part_of(*step_.q1, e),
            velocities_of(*step_.v0, e),
            velocities_of(*step_.a, e),
            step_.h,
            step_.decay};
  }
  MarkerSecant const& marker(Index i) const { return markers_[std::size_t(i)]; }
  template <class F>
  void for_each_joint(F&& f) const {
    for_each_pool_with(model_.joint_pools(), constraints_, [&](auto const& pool, auto const& constraints) {
      for (std::size_t i = 0; i < pool.size(); ++i) f(pool[i], constraints[i]);
    });
  }

  template <class S>
  void set_marker(Index published, FrameSecant<S> const& frame) {
    MarkerSecant& m = markers_[std::size_t(published)];
    for (int j = 0; j < 12; ++j) {
      S const& x = j < 3 ? frame.r[j] : frame.R(j % 3, j / 3 - 1);
      m.from[std::size_t(j)] = x.a;
      m.to[std::size_t(j)] = x.b;
      for (int c = 0; c < int(x.d.size()); ++c) m.slopes[12 * c + j] = x.d[c];
    }
  }

  template <class Pool, class Scratch>
  void evaluate_marker(Pool const& pool, Scratch& scratch) {
    using B = std::decay_t<decltype(pool.entries.front().body)>;
    constexpr int n = B::point_columns;
    using S = Secant<n>;
    for (auto const& p : pool.markers) {
      auto const& e = pool.entries[std::size_t(p.body)];
      if constexpr (HasFrameSteps<B>) {
        set_marker(p.published, e.body.template discrete_marker<S>(p.point, p.axes, frame_step(e)));
      } else {
        Index const first = e.body.first_column(p.point);
        for (int i = 0; i < n; ++i)
          scratch.q[std::size_t(first + i)] =
              S::variable((*step_.q0)[e.q0 + first + i], (*step_.q1)[e.q0 + first + i], i);
        MarkerKinematics<S> out;
        out.jacobian = scratch.jacobian.data();
        e.body.template evaluate_marker<S>(p.point, p.axes, std::span<S const>(scratch.q),
                                           std::span<S const>(scratch.rest), out);
        set_marker<S>(p.published, {out.frame.r, out.frame.A});
      }
    }
  }

  template <class Entry, int m, class S = Secant<24>>  // a template, to be compiled only if it is used
  void evaluate_constraints(Entry const& e, double t, ConstraintSecant<m>& out) const {
    MarkerSecant const& a = marker(e.a);
    MarkerSecant const& b = marker(e.b);
    Vec<S, m> const g = constraint_function<S>(e.joint.measure(), frame_of<S>(a, 0), frame_of<S>(b, 12), t).g;
    for (int i = 0; i < m; ++i) {
      out.from[i] = g[i].a;
      out.to[i] = g[i].b;
      for (Index c = 0; c < a.columns; ++c) out.rows_a[m * c + i] = pulled(a, g[i].d.data(), c);
      for (Index c = 0; c < b.columns; ++c) out.rows_b[m * c + i] = pulled(b, g[i].d.data() + 12, c);
    }
  }

  template <class Entry, int m>
  Vec<double, m> multiplier(Entry const& e, ConstraintSecant<m> const& secant,
                            [[maybe_unused]] VecX const& lambda) const {
    if constexpr (ConstrainingPolicy<typename std::decay_t<decltype(e.joint)>::PolicyType>) {
      return lambda.template segment<m>(e.row);
    } else {
      Vec<double, m> const change = secant.to - secant.from;
      return e.joint.policy.template multiplier<m, double>(
          (0.5 * (secant.from + secant.to) + means_.decay * change).eval(), (means_.rate * change).eval());
    }
  }

  template <int m>
  static void add_rows(MarkerSecant const& p, double const* rows, Vec<double, m> const& lambda, VecX& r) {
    for (Index c = 0; c < p.columns; ++c)
      for (int i = 0; i < m; ++i) r[p.first + c] += rows[m * c + i] * lambda[i];
  }

  /// sink += Gaᵀ S Gb.
  template <class Rows, int m>
  void add_pair(MarkerSecant const& a, Rows const& ga, Mat<double, m, m> const& slope, MarkerSecant const& b,
                Rows const& gb, BlockSink& sink) {
    if (a.columns == 0 || b.columns == 0) return;
    Eigen::Map<MatX> k(scratch_.data(), a.columns, b.columns);
    for (Index c = 0; c < b.columns; ++c) {
      Vec<double, m> const scaled = slope * gb.col(c);
      for (Index r = 0; r < a.columns; ++r) k(r, c) = ga.col(r).dot(scaled);
    }
    sink.add(a.first, b.first, k);
  }

  /// Subtracts the generalised forces of force element e from r. For an element with a potential, these are the
  /// negative discrete gradient of the potential plus the velocity-dependent forces at the midpoint of the step. For
  /// other elements, these are all forces at the midpoint.
  template <class Entry>
  void add_force(Data<double> const& data, Entry const& e, VecX& r) const {
    using F = std::decay_t<decltype(e.force)>;
    constexpr int n = F::markers;
    auto frames = frames_at(e.markers, data);
    std::array<Wrench<double>, std::size_t(n)> wrenches;
    for_each_action(e, data, [&](auto const& law, auto const&, auto const&) {
      wrenches = law.template wrenches<double>(frames, middle_time());
    });
    if constexpr (HasSecantPotential<F>) {
      for (auto& f : frames) f.v = f.w = Vec3::Zero();
      auto const at_rest = e.force.template wrenches<double>(frames, middle_time());
      std::array<Frame<Secant<12 * n>>, std::size_t(n)> moving;
      for (int k = 0; k < n; ++k) {
        moving[std::size_t(k)] = frame_of<Secant<12 * n>>(marker(e.markers[std::size_t(k)]), 12 * k);
        wrenches[std::size_t(k)].f -= at_rest[std::size_t(k)].f;
        wrenches[std::size_t(k)].m -= at_rest[std::size_t(k)].m;
      }
      Secant<12 * n> const potential = e.force.potential(moving, middle_time());
      for (int k = 0; k < n; ++k) {
        MarkerSecant const& p = marker(e.markers[std::size_t(k)]);
        for (Index c = 0; c < p.columns; ++c) r[p.first + c] += pulled(p, potential.d.data() + 12 * k, c);
      }
    }
    for (int k = 0; k < n; ++k) {
      Wrench<double> const& x = wrenches[std::size_t(k)];
      double const w[6] = {x.f[0], x.f[1], x.f[2], x.m[0], x.m[1], x.m[2]};
      add_pulled(data.markers[std::size_t(e.markers[std::size_t(k)])], w, -1.0, r.data());
    }
  }

  double middle_time() const { return step_.t + 0.5 * step_.h; }

  M const& model_;
  SecantStep step_;
  DiscreteDerivative means_;
  Sequence<MarkerSecant> markers_;
  using Workspaces = NearbySecants<typename M::BodyPools, typename M::JointPools>;
  typename Workspaces::Scratch bodies_;
  typename Workspaces::Constraints constraints_;
  Sequence<double> slopes_, rows_, scratch_;  ///< arenas of markers and constraint functions; workspace for one block
  VecX middle_, still_;                       ///< coordinates in the middle of the step; zero velocities
};

}  // namespace polybody::detail
