#pragma once
/// \file
/// The tangent of the residual and the rows, written block by block into a sink.

#include <utility>

#include <polybody/system/collect.hpp>

namespace polybody {

/// Coefficients of the tangent cm M + cd D + ck K, D = −∂f/∂v, K = −∂f/∂q.
struct TangentCoefficients {
  double mass = 0.0;
  double damping = 0.0;
  double stiffness = 0.0;
  bool stand_ins = true;  ///< force groups may put a cheap matrix in place of a slope (`own_stiffness`)
};

/// Terms ∂(Gᵀλ)/∂q and ∂(Jᵀw)/∂q: a time step may leave them out while Newton contracts; statics may not.
enum class SecondOrder { omitted, included };

/// Receives the tangent's blocks, always in the same order for the same model.
template <class S>
concept TangentSink = requires(S sink, Mat3 const block) { sink.add(Index(0), Index(0), block); };

/// … and may be told that the next one is zero, in place of `add`.
template <class S>
concept SkipsZeros = requires(S sink) { sink.skip(Index(0), Index(0), Index(0), Index(0)); };

namespace detail {

/// A block of zeros: what has its place in the tangent but does not act.
template <class Sink>
void add_zeros(Index row, Index col, Index rows, Index cols, std::vector<double>& scratch, Sink& sink) {
  if constexpr (SkipsZeros<Sink>) {
    sink.skip(row, col, rows, cols);
  } else {
    Eigen::Map<MatX> zeros(scratch.data(), rows, cols);
    zeros.setZero();
    sink.add(row, col, zeros);
  }
}

/// Calls f((rows · J)ᵀ) for m rows, n×m: of fixed size through a rigid marker, else in `scratch`.
template <int m, class F>
void pull_rows(Published<double> const& p, Mat<double, m, 6> const& rows, std::vector<double>& scratch, F&& f) {
  if (p.columns == 0) return;
  if (p.shape == JacobianShape::rigid) {
    // by rows, as sinks store a body before its joint
    Eigen::Matrix<double, 6, m, m == 1 ? Eigen::ColMajor : Eigen::RowMajor> out;
    p.pull_rigid(rows.transpose(), out);
    f(out);
  } else {
    Eigen::Map<Mat<double, Eigen::Dynamic, m>> out(scratch.data(), p.columns, m);
    p.pull(rows.transpose(), out);
    f(out);
  }
}

/// out = JaᵀS Jb of two rigid markers, J = [1, −ρ×A; 0, A] with ρ the marker's arm and A the body's axes; S is 6×6.
template <class Block>
void pull_rigid_pair(Published<double> const& a, Published<double> const& b, Block const& s, Mat<double, 6, 6>& out) {
  Mat<double, 6, 6> half, turned;
  a.pull_rigid(s, half);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) turned(j, i) = half(i, j);
  b.pull_rigid(turned, half);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) out(j, i) = half(i, j);
}

/// sink += Jiᵀ S_ij Jj for all pairs of N markers, or for i = j only; S is 6N×6N.
template <int n, class Sink>
void add_pulled_pairs(std::array<Published<double> const*, std::size_t(n)> const& markers,
                      Mat<double, 6 * n, 6 * n> const& s, bool couples, std::vector<double>& scratch, Sink& sink) {
  using Half = Eigen::Map<Mat<double, Eigen::Dynamic, 6>>;
  using Both = Eigen::Map<MatX>;
  for (int i = 0; i < n; ++i) {
    Published<double> const& a = *markers[std::size_t(i)];
    if (a.columns == 0) continue;
    for (int j = 0; j < n; ++j) {
      Published<double> const& b = *markers[std::size_t(j)];
      if (b.columns == 0 || (!couples && i != j)) continue;
      Mat<double, 6, 6> block = s.template block<6, 6>(6 * i, 6 * j);
      if (a.shape == JacobianShape::rigid && b.shape == JacobianShape::rigid) {
        pull_rigid_pair(a, b, block, block);
        sink.add(a.first, b.first, block);
        continue;
      }
      Half half(scratch.data(), a.columns, 6);
      a.pull(block, half);
      Both both(scratch.data() + 6 * a.columns, b.columns, a.columns);
      b.pull(half.transpose(), both);
      sink.add(a.first, b.first, both.transpose());
    }
  }
}

/// out (rows×cols) = a (rows×m) bᵀ, b cols×m, all by columns. In plain loops: a product of Eigen packs matrices of such
/// sizes first.
template <int m>
void times_transposed(double const* a, double const* b, Index rows, Index cols, double* out) {
  for (Index j = 0; j < cols; ++j)
    for (Index i = 0; i < rows; ++i) {
      double sum = a[i] * b[j];
      for (int k = 1; k < m; ++k) sum += a[i + rows * k] * b[j + cols * k];
      out[i + rows * j] = sum;
    }
}

/// sink += (Gi Ji)ᵀ k (Gj Jj) for the slope k (m×m, or diagonal) of a force in the m rows of a gap between two markers:
/// rows are pulled before k is multiplied, which takes m wrenches for each marker and not six for each pair.
template <int m, class Slope, class Sink>
void add_pulled_slope(Published<double> const& a, Published<double> const& b, Mat<double, m, 6> const& ga,
                      Mat<double, m, 6> const& gb, Slope const& slope, std::vector<double>& scratch, Sink& sink) {
  Published<double> const* const markers[2] = {&a, &b};
  Mat<double, m, 6> const* const maps[2] = {&ga, &gb};
  constexpr bool diagonal = requires { slope.toDenseMatrix(); };
  double* place = scratch.data();
  auto const take = [&](Index size) { return std::exchange(place, place + size); };
  double* const rows[2] = {take(m * a.columns), take(m * b.columns)};  // (Gi Ji)ᵀ, columns×m
  double* const bent = take(m * std::max(a.columns, b.columns));       // the same times kᵀ
  for (int i = 0; i < 2; ++i) {
    Index const n = markers[i]->columns;
    if (n == 0) continue;
    Eigen::Map<Mat<double, Eigen::Dynamic, m>> out(rows[i], n, m);
    markers[i]->pull(maps[i]->transpose(), out);
  }
  for (int j = 0; j < 2; ++j) {
    Index const nj = markers[j]->columns;
    if (nj == 0) continue;
    for (int k = 0; k < m; ++k)
      for (Index c = 0; c < nj; ++c) {
        double sum = 0.0;
        if constexpr (diagonal)
          sum = slope.diagonal()[k] * rows[j][c + nj * k];
        else
          for (int l = 0; l < m; ++l) sum += slope(k, l) * rows[j][c + nj * l];
        bent[c + nj * k] = sum;
      }
    for (int i = 0; i < 2; ++i) {
      Index const ni = markers[i]->columns;
      if (ni == 0) continue;
      if (ni == 6 && nj == 6) {
        Mat<double, 6, 6> block;
        times_transposed<m>(rows[i], bent, 6, 6, block.data());
        sink.add(markers[i]->first, markers[j]->first, block);
      } else {
        times_transposed<m>(rows[i], bent, ni, nj, place);
        sink.add(markers[i]->first, markers[j]->first, Eigen::Map<MatX>(place, ni, nj));
      }
    }
  }
}

}  // namespace detail

namespace detail {
/// What acts on the markers of a pair is told to `load`, times −scale.
template <class Law, class Load>
void load_pair(Law const& law, std::array<Index, 2> const& markers, std::array<Frame<double>, 2> const& frames,
               double t, double scale, Load&& load) {
  auto const wrenches = law.template wrenches<double>(frames, t);
  for (std::size_t k = 0; k < 2; ++k) {
    Vec6 w;
    w << wrenches[k].f, wrenches[k].m;
    load(markers[k], -scale * w);
  }
}

/// sink += what each marker of a group feels of its own motion alone, block by block, zero where nothing acts; with
/// stand-ins by a law's `own_stiffness` where it has one. For statics and linearisation, which ask for all second-order
/// terms and no mass, the exact gradient with what couples the pairs, all that may ever act.
template <class F, class M, class Sink, class Load>
void add_group_tangent(ForceEntry<F> const& e, double t, double scale, TangentCoefficients const& c, bool full,
                       Data<M, double>& data, Sink& sink, Load&& load) {
  if (full && c.mass == 0.0) {
    e.force.for_each_candidate([&](Index i, Index j, auto const& law) {
      std::array<Index, 2> const places = {e.markers[std::size_t(i)], e.markers[std::size_t(j)]};
      std::array<Published<double> const*, 2> const markers = {&data.markers[std::size_t(places[0])],
                                                               &data.markers[std::size_t(places[1])]};
      std::array<Frame<double>, 2> const frames = {markers[0]->frame, markers[1]->frame};
      add_pulled_pairs<2>(markers, -scale * wrench_gradient(law, frames, t, c.stiffness, c.damping), true, data.scratch,
                          sink);
      load_pair(law, places, frames, t, scale, load);
    });
    return;
  }
  auto& own = data.own_stiffness;
  std::fill_n(own.begin(), e.markers.size(), Mat<double, 6, 6>::Zero());
  for_each_action(e, data, [&](auto const& law, auto const& markers, auto const& frames) {
    std::size_t const i = std::size_t(markers[0]), j = std::size_t(markers[1]);
    if (full) load_pair(law, {e.markers[i], e.markers[j]}, frames, t, scale, load);
    if constexpr (HasOwnStiffness<std::decay_t<decltype(law)>>)
      if (c.stand_ins) return law.own_stiffness(frames, c.stiffness, c.damping, own[i], own[j]);
    auto const s = wrench_gradient(law, frames, t, c.stiffness, c.damping);
    own[i] -= s.template topLeftCorner<6, 6>();
    own[j] -= s.template bottomRightCorner<6, 6>();
  });
  for (std::size_t k = 0; k < e.markers.size(); ++k) {
    Published<double> const& p = data.markers[std::size_t(e.markers[k])];
    if (p.columns > 0 && own[k].isZero(0.0))
      add_zeros(p.first, p.first, p.columns, p.columns, data.scratch, sink);
    else
      add_pulled_pairs<1>({&p}, scale * own[k], true, data.scratch, sink);
  }
}
}  // namespace detail

/// sink += K and D of the force elements; `load(marker, wrench)` hears what acts where second-order terms are wanted.
template <class M, TangentSink Sink, class Load>
void add_force_tangents(M const& model, double t, double load_factor, TangentCoefficients const& c, bool full,
                        Data<M, double>& data, Sink& sink, Load&& load) {
  model.for_each_force([&](auto const& e) {
    using F = std::decay_t<decltype(e.force)>;
    double const scale = F::is_load ? load_factor : 1.0;
    if constexpr (ForceGroup<F>) {
      detail::add_group_tangent(e, t, scale, c, full, data, sink, load);
    } else {
      constexpr int n = F::markers;
      auto const frames = detail::frames_of(e, data);
      std::array<Published<double> const*, std::size_t(n)> markers;
      for (int k = 0; k < n; ++k) markers[std::size_t(k)] = &data.markers[std::size_t(e.markers[k])];
      Mat<double, 6 * n, 6 * n> const s = -scale * wrench_gradient(e.force, frames, t, c.stiffness, c.damping);
      detail::add_pulled_pairs<n>(markers, s, full || couples_bodies<F>(), data.scratch, sink);
      if (full) {
        auto const wrenches = e.force.template wrenches<double>(frames, t);
        for (int k = 0; k < n; ++k) {
          Vec6 w;
          w << wrenches[k].f, wrenches[k].m;
          load(e.markers[k], -scale * w);
        }
      }
    }
  });
}

/// sink += ck ∂(Jᵀw)/∂q for the wrenches w in `data.loads`, marker by marker.
template <class M, TangentSink Sink>
void add_load_stiffness(M const& model, VecX const& q, double ck, Data<M, double>& data, Sink& sink) {
  detail::for_each_pool_beside(model.body_pools(), data.scratch_of_bodies, [&](auto const& pool, auto& kept) {
    for (auto const& p : pool.markers) {
      auto const& e = pool.entries[std::size_t(p.body)];
      using B = std::decay_t<decltype(e.body)>;
      Published<double> const& at = data.markers[std::size_t(p.published)];
      Wrench<double> const& w = data.loads[std::size_t(p.published)];
      if (w.f.isZero(0.0) && w.m.isZero(0.0)) {
        detail::add_zeros(at.first, at.first, at.columns, at.columns, data.scratch, sink);
        continue;
      }
      auto const stiffness = [&](auto& k) {
        e.body.load_stiffness(p.point, detail::body_part(q, e.q0, e.body.coordinates()), w, k);
      };
      if constexpr (B::point_columns == Eigen::Dynamic) {
        MatX& k = kept[std::size_t(p.body)].point_scratch();
        stiffness(k);
        auto of_marker = k.topLeftCorner(at.columns, at.columns);
        of_marker *= ck;
        sink.add(at.first, at.first, of_marker);
      } else {
        Mat<double, B::point_columns, B::point_columns> k;
        stiffness(k);
        k *= ck;
        sink.add(at.first, at.first, k);
      }
    }
  });
}

/// Writes [cm M + cd D + ck K, Gᵀ; G, 0] into `sink`, rows of G from index nv on; K, D of bodies, force
/// elements and compliant joints. Needs `publish` and `enforce` at (q, v, t).
template <class M, TangentSink Sink>
void tangent(M const& model, VecX const& q, VecX const& v, VecX const& lambda, double t, double load_factor,
             TangentCoefficients const& c, SecondOrder second, Data<M, double>& data, Sink& sink) {
  bool const full = second == SecondOrder::included;
  if (full) std::fill(data.loads.begin(), data.loads.end(), Wrench<double>{});
  auto const load = [&](Index marker, Vec6 const& w) {
    data.loads[std::size_t(marker)].f += w.head<3>();
    data.loads[std::size_t(marker)].m += w.tail<3>();
  };
  for_each_body_with_scratch(model, data, [&](auto const& e, auto& kept) {
    using B = std::decay_t<decltype(e.body)>;
    auto&& scratch = kept.tangent_scratch(e.body);
    auto const qe = detail::body_part(q, e.q0, e.body.coordinates());
    auto const ve = detail::body_part(v, e.v0, e.body.speeds());
    constexpr int n = B::element_columns;
    auto const add = [&](Index i, auto const& k) {
      Index const first = e.v0 + e.body.first_column(i);
      sink.add(first, first, k);
    };
    Index const elements = e.body.elements();
    if constexpr (n != Eigen::Dynamic)
      if (data.workers && elements >= 2 * data.least_elements) {
        using Slot = Eigen::Map<Mat<double, n, n>>;
        double* const slots = data.element_tangents.data();
        data.workers->over(elements, data.least_elements, [&](Index begin, Index end) {
          for_each_element_tangent<B>(e.body, begin, end, qe, ve, c.mass, c.damping, c.stiffness,
                                      [&](Index i, Mat<double, n, n> const& k) { Slot(slots + n * n * i) = k; });
        });
        for (Index i = 0; i < elements; ++i) add(i, Slot(slots + n * n * i));
        return;
      }
    for_each_element_tangent<B>(e.body, 0, elements, qe, ve, c.mass, c.damping, c.stiffness, scratch, add);
  });
  Index const row0 = model.speeds();
  for_each_body_with_rows(model, q, v, [&](auto const& e, auto const& qe, auto const&) {
    using B = std::decay_t<decltype(e.body)>;
    constexpr int n = B::element_columns;
    Mat<double, B::own_rows, n> map;
    e.body.template own_map<double>(qe, map);
    sink.add(e.v0, row0 + e.row, map.transpose());
    sink.add(row0 + e.row, e.v0, map);
    if (!full) return;
    Mat<double, n, n> k;
    e.body.own_stiffness(qe, lambda.template segment<B::own_rows>(e.row).eval(), k);
    k *= c.stiffness;
    sink.add(e.v0, e.v0, k);
  });
  for_each_linear_side(model, data, [&](LinearSide const& side, LinearRows const& rows) {
    sink.add(side.v0, row0 + rows.row, side.map.transpose());
    sink.add(row0 + rows.row, side.v0, side.map);
  });
  for_each_gap(model, data, [&](auto const& e, auto const& gap) {
    constexpr int m = std::decay_t<decltype(gap)>::rows;
    using P = typename std::decay_t<decltype(e.joint)>::PolicyType;
    Published<double> const& a = data.markers[std::size_t(e.a)];
    Published<double> const& b = data.markers[std::size_t(e.b)];
    if constexpr (AddsRows<P>) {
      auto const add = [&](Published<double> const& p, Mat<double, m, 6> const& g) {
        detail::pull_rows<m>(p, g, data.scratch, [&](auto const& gt) {
          sink.add(p.first, row0 + e.row, gt);
          sink.add(row0 + e.row, p.first, gt.transpose());
        });
      };
      add(a, gap.Ga);
      add(b, gap.Gb);
    }
    if constexpr (AddsForce<P>) {
      auto const slope = e.joint.policy.template slope<m>(c.stiffness, c.damping, gap.g, gap_rate(gap, a, b));
      detail::add_pulled_slope<m>(a, b, gap.Ga, gap.Gb, slope, data.scratch, sink);
    }
    if (!full) return;
    Vec<double, m> const l = detail::multiplier(e, gap, data, lambda);
    Mat<double, 12, 12> const s = c.stiffness * wrench_gradient(e.joint.measure(), a.frame, b.frame, t, l);
    load(e.a, gap.Ga.transpose() * l);
    load(e.b, gap.Gb.transpose() * l);
    detail::add_pulled_pairs<2>({&a, &b}, s, true, data.scratch, sink);
  });
  add_force_tangents(model, t, load_factor, c, full, data, sink, load);
  if (full) add_load_stiffness(model, q, c.stiffness, data, sink);
}

}  // namespace polybody
