#pragma once
/// \file
/// Second half of an evaluation: forces and rows are collected from bodies, joints and force elements.

#include <polybody/bodies/element_batches.hpp>
#include <polybody/system/publish.hpp>

namespace polybody {

namespace detail {

/// r[columns of the marker] += sign · Jᵀ w.
template <StateScalar T>
void add_pulled(Published<T> const& p, Vec<T, 6> const& w, double sign, VecXOf<T>& r) {
  switch (p.shape) {
    case JacobianShape::ground:
      return;
    case JacobianShape::rigid: {
      T const f[3] = {w[0] * sign, w[1] * sign, w[2] * sign};
      T const m[3] = {w[3] * sign + p.arm[1] * f[2] - p.arm[2] * f[1], w[4] * sign + p.arm[2] * f[0] - p.arm[0] * f[2],
                      w[5] * sign + p.arm[0] * f[1] - p.arm[1] * f[0]};
      for (int i = 0; i < 3; ++i) {
        r[p.first + i] += f[i];
        r[p.first + 3 + i] += p.body_axes(0, i) * m[0] + p.body_axes(1, i) * m[1] + p.body_axes(2, i) * m[2];
      }
      return;
    }
    case JacobianShape::dense:
      for (Index c = 0; c < p.columns; ++c) {
        T const* const j = p.jacobian + 6 * c;
        T sum = j[0] * w[0];
        for (int i = 1; i < 6; ++i) sum += j[i] * w[i];
        r[p.first + c] += sum * sign;
      }
  }
}

/// Gᵀ λ, entry by entry.
template <int m, StateScalar T>
Vec<T, 6> wrench_of(Mat<T, m, 6> const& g, Vec<T, m> const& lambda) {
  Vec<T, 6> w;
  for (int i = 0; i < 6; ++i) {
    T sum = g(0, i) * lambda[0];
    for (int r = 1; r < m; ++r) sum += g(r, i) * lambda[r];
    w[i] = sum;
  }
  return w;
}

template <class F, class M, StateScalar T>
auto frames_of(detail::ForceEntry<F> const& e, Data<M, T> const& data) {
  std::array<Frame<T>, F::markers> frames;
  for (int k = 0; k < F::markers; ++k) frames[k] = data.markers[std::size_t(e.markers[k])].frame;
  return frames;
}

/// Calls visit(force, markers, frames) for the force elements of an entry: itself, or the pairs of a group that may act
/// now. Markers are places among the entry's.
template <class F, class M, StateScalar T, class Visit>
void for_each_action(ForceEntry<F> const& e, Data<M, T> const& data, Visit&& visit) {
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

/// λ of a joint: the multipliers of its rows, or what its policy answers to the gap.
template <class J, int m, class M, StateScalar T>
Vec<T, m> multiplier(JointEntry<J> const& e, Gap<m, T> const& gap, Data<M, T> const& data, VecXOf<T> const& lambda) {
  if constexpr (AddsRows<typename J::PolicyType>)
    return lambda.template segment<m>(e.row);
  else
    return e.joint.policy.template multiplier<m, T>(
        gap.g, gap_rate(gap, data.markers[std::size_t(e.a)], data.markers[std::size_t(e.b)]));
}

}  // namespace detail

/// Calls f(body entry, coordinates, speeds) for every body that owns rows.
template <class M, StateScalar T, class F>
void for_each_body_with_rows(M const& model, VecXOf<T> const& q, VecXOf<T> const& v, F&& f) {
  model.for_each_body([&](auto const& e) {
    if constexpr (OwnsRows<std::decay_t<decltype(e.body)>>)
      f(e, detail::body_part(q, e.q0, e.body.coordinates()), detail::body_part(v, e.v0, e.body.speeds()));
  });
}

/// Calls f(side, rows) for both bodies of all linear joints, unless their rows are left out.
template <class M, StateScalar T, class F>
void for_each_linear_side(M const& model, Data<M, T> const& data, F&& f) {
  if (!data.linear_rows) return;
  for (LinearRows const& rows : model.linear_rows())
    for (LinearSide const* const side : {&rows.a, &rows.b})
      if (side->map.cols() > 0) f(*side, rows);
}

/// r = M a − f(q, v, t) + Gᵀλ (nv). Loads and gravity are scaled by `load_factor`.
/// Needs `publish` and `enforce` at (q, v, t).
template <class M, StateScalar T>
void residual(M const& model, VecXOf<T> const& q, VecXOf<T> const& v, VecXOf<T> const& a, VecXOf<T> const& lambda,
              double t, double load_factor, Data<M, T>& data, VecXOf<T>& r) {
  r.setZero();
  Vec3 const g = model.gravity().g * load_factor;
  bool const falls = !g.isZero(0.0);
  for_each_body_with_scratch(model, data, [&](auto const& e, auto& kept) {
    using B = std::decay_t<decltype(e.body)>;
    constexpr int n = B::element_columns;
    auto&& scratch = kept.force_scratch(e.body);
    auto const qe = detail::body_part(q, e.q0, e.body.coordinates());
    auto const ve = detail::body_part(v, e.v0, e.body.speeds());
    auto const ae = detail::body_part(a, e.v0, e.body.speeds());
    auto const add = [&](Index i, auto const& x) {
      T* const rows = r.data() + e.v0 + e.body.first_column(i);
      int const size = n == Eigen::Dynamic ? int(x.size()) : n;
      for (int k = 0; k < size; ++k) rows[k] += x[k];
      if (falls) {
        e.body.template gravity<T>(i, qe, g, scratch.weight);
        for (int k = 0; k < size; ++k) rows[k] -= scratch.weight[k];
      }
    };
    Index const elements = e.body.elements();
    if constexpr (n != Eigen::Dynamic)
      if (data.workers && elements >= 2 * data.least_elements) {
        using Slot = Eigen::Map<Vec<T, n>>;
        T* const slots = data.element_forces.data();
        data.workers->over(elements, data.least_elements, [&](Index begin, Index end) {
          for_each_unbalance<B, T>(e.body, begin, end, qe, ve, ae,
                                   [&](Index i, Vec<T, n> const& x) { Slot(slots + n * i) = x; });
        });
        for (Index i = 0; i < elements; ++i) add(i, Slot(slots + n * i));
        return;
      }
    for_each_unbalance<B, T>(e.body, 0, elements, qe, ve, ae, scratch, add);
  });
  for_each_body_with_rows(model, q, v, [&](auto const& e, auto const& qe, auto const&) {
    using B = std::decay_t<decltype(e.body)>;
    Mat<T, B::own_rows, B::element_columns> map;
    e.body.template own_map<T>(qe, map);
    r.template segment<B::element_columns>(e.v0) += map.transpose() * lambda.template segment<B::own_rows>(e.row);
  });
  for_each_linear_side(model, data, [&](LinearSide const& side, LinearRows const& rows) {
    for (Index j = 0; j < side.map.cols(); ++j)
      for (Index i = 0; i < side.map.rows(); ++i) r[side.v0 + j] += lambda[rows.row + i] * side.map(i, j);
  });
  for_each_gap(model, data, [&](auto const& e, auto const& gap) {
    constexpr int m = std::decay_t<decltype(gap)>::rows;
    Vec<T, m> const l = detail::multiplier(e, gap, data, lambda);
    detail::add_pulled<T>(data.markers[std::size_t(e.a)], detail::wrench_of<m>(gap.Ga, l), 1.0, r);
    detail::add_pulled<T>(data.markers[std::size_t(e.b)], detail::wrench_of<m>(gap.Gb, l), 1.0, r);
  });
  model.for_each_force([&](auto const& e) {
    using F = std::decay_t<decltype(e.force)>;
    double const scale = F::is_load ? load_factor : 1.0;
    detail::for_each_action(e, data, [&](auto const& force, auto const& markers, auto const& frames) {
      auto const wrenches = force.template wrenches<T>(frames, t);
      for (std::size_t k = 0; k < markers.size(); ++k) {
        Vec<T, 6> w;
        w << wrenches[k].f, wrenches[k].m;
        detail::add_pulled<T>(data.markers[std::size_t(e.markers[std::size_t(markers[k])])], w, -scale, r);
      }
    });
  });
}

/// Calls f(joint entry, gap, marker a, marker b) for every joint that adds rows.
template <class M, StateScalar T, class F>
void for_each_row_block(M const& model, Data<M, T> const& data, F&& f) {
  for_each_gap(model, data, [&](auto const& e, auto const& gap) {
    if constexpr (AddsRows<typename std::decay_t<decltype(e.joint)>::PolicyType>)
      f(e, gap, data.markers[std::size_t(e.a)], data.markers[std::size_t(e.b)]);
  });
}

namespace detail {
/// Adds C x of all linear joints to the rows, x by coordinates or by speeds.
template <class M, StateScalar T>
void add_linear_rows(M const& model, Data<M, T> const& data, VecXOf<T> const& x, Index LinearSide::* first,
                     VecXOf<T>& out) {
  for_each_linear_side(model, data, [&](LinearSide const& side, LinearRows const& rows) {
    for (Index j = 0; j < side.map.cols(); ++j)
      for (Index i = 0; i < side.map.rows(); ++i) out[rows.row + i] += x[side.*first + j] * side.map(i, j);
  });
}
/// … after setting them to −c, or to zero.
template <class M, StateScalar T>
void set_linear_rows(M const& model, double constant, VecXOf<T>& out) {
  for (LinearRows const& rows : model.linear_rows())
    for (Index i = 0; i < rows.rows(); ++i) out[rows.row + i] = T(-constant * rows.constant[i]);
}
}  // namespace detail

/// Φ (rows).
template <class M, StateScalar T>
void violation(M const& model, VecXOf<T> const& q, Data<M, T> const& data, VecXOf<T>& phi) {
  for_each_body_with_rows(model, q, q, [&](auto const& e, auto const& qe, auto const&) {
    Vec<T, std::decay_t<decltype(e.body)>::own_rows> own;
    e.body.template own_gap<T>(qe, own);
    phi.segment(e.row, own.size()) = own;
  });
  for_each_row_block(model, data, [&](auto const& e, auto const& gap, auto const&, auto const&) {
    phi.template segment<std::decay_t<decltype(gap)>::rows>(e.row) = gap.g;
  });
  detail::set_linear_rows(model, 1.0, phi);
  detail::add_linear_rows(model, data, q, &LinearSide::q0, phi);
}

/// Φ̇ = G v + Φ_t (rows).
template <class M, StateScalar T>
void violation_rate(M const& model, VecXOf<T> const& q, VecXOf<T> const& v, Data<M, T> const& data, VecXOf<T>& rate) {
  for_each_body_with_rows(model, q, v, [&](auto const& e, auto const& qe, auto const&) {
    using B = std::decay_t<decltype(e.body)>;
    Mat<T, B::own_rows, B::element_columns> map;
    e.body.template own_map<T>(qe, map);
    rate.template segment<B::own_rows>(e.row) = map * v.template segment<B::element_columns>(e.v0);
  });
  for_each_row_block(model, data, [&](auto const& e, auto const& gap, auto const& a, auto const& b) {
    rate.template segment<std::decay_t<decltype(gap)>::rows>(e.row) = gap_rate(gap, a, b);
  });
  detail::set_linear_rows(model, 0.0, rate);
  detail::add_linear_rows(model, data, v, &LinearSide::v0, rate);
}

/// γ (rows): Φ̈ = G v̇ + γ, with Φ_tt and the frames' biases.
template <class M, StateScalar T>
void acceleration_bias(M const& model, VecXOf<T> const& q, VecXOf<T> const& v, double t, Data<M, T> const& data,
                       VecXOf<T>& gamma) {
  for_each_body_with_rows(model, q, v, [&](auto const& e, auto const& qe, auto const& ve) {
    Vec<T, std::decay_t<decltype(e.body)>::own_rows> own;
    e.body.template own_gamma<T>(qe, ve, own);
    gamma.segment(e.row, own.size()) = own;
  });
  for_each_row_block(model, data, [&](auto const& e, auto const& gap, auto const& a, auto const& b) {
    gamma.template segment<std::decay_t<decltype(gap)>::rows>(e.row) =
        e.joint.geometry.template gamma<T>(a.frame, b.frame, t) + gap.Ga * a.bias + gap.Gb * b.bias;
  });
  detail::set_linear_rows(model, 0.0, gamma);
}

/// out = G b (rows), by the markers' Jacobians.
template <class M>
void rows_times(M const& model, VecX const& q, VecX const& b, Data<M, double> const& data, VecX& out) {
  out.setZero();
  for_each_body_with_rows(model, q, b, [&](auto const& e, auto const& qe, auto const&) {
    using B = std::decay_t<decltype(e.body)>;
    Mat<double, B::own_rows, B::element_columns> map;
    e.body.template own_map<double>(qe, map);
    out.template segment<B::own_rows>(e.row) = map * b.template segment<B::element_columns>(e.v0);
  });
  for_each_row_block(model, data, [&](auto const& e, auto const& gap, auto const& a, auto const& c) {
    constexpr int m = std::decay_t<decltype(gap)>::rows;
    auto rows = out.template segment<m>(e.row);
    rows += gap.Ga * a.push(b.data() + a.first);
    rows += gap.Gb * c.push(b.data() + c.first);
  });
  detail::add_linear_rows(model, data, b, &LinearSide::v0, out);
}

/// out = Gᵀ b (nv) for b by rows.
template <class M>
void rows_transposed_times(M const& model, VecX const& q, VecX const& b, Data<M, double> const& data, VecX& out) {
  out.setZero();
  for_each_body_with_rows(model, q, q, [&](auto const& e, auto const& qe, auto const&) {
    using B = std::decay_t<decltype(e.body)>;
    Mat<double, B::own_rows, B::element_columns> map;
    e.body.template own_map<double>(qe, map);
    out.template segment<B::element_columns>(e.v0) += map.transpose() * b.template segment<B::own_rows>(e.row);
  });
  for_each_row_block(model, data, [&](auto const& e, auto const& gap, auto const& a, auto const& c) {
    constexpr int m = std::decay_t<decltype(gap)>::rows;
    Vec<double, m> const part = b.template segment<m>(e.row);
    detail::add_pulled<double>(a, detail::wrench_of<m>(gap.Ga, part), 1.0, out);
    detail::add_pulled<double>(c, detail::wrench_of<m>(gap.Gb, part), 1.0, out);
  });
}

}  // namespace polybody
