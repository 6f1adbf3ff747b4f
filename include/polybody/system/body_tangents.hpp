#pragma once
/// \file
/// Definitions of the body kernels that exist for doubles only: rates, masses, tangents and energies (declared in
/// body_kernels.hpp).

#include <polybody/system/body_kernels.hpp>

namespace polybody {

template <class B, StateScalar T>
ReducedPosition const* BodyKernels<B, T>::coordinate_rates(Pool const& pool, ReducedPosition const* places,
                                                           VecX const& q, VecX const& v, VecXOf<Dual<1>>& workspace,
                                                           VecX& rate) {
  using D = Dual<1>;
  D* const delta = workspace.data() + q.size();
  D* const out = delta + v.size();
  return for_each_place(pool, places, [&](Entry const& e, ReducedPosition const& p) {
    Index const width = p.coordinates, k = p.velocities;
    if (width == k) {
      for (Index i = 0; i < width; ++i) rate[p.q + i] = v[p.v + i];
      return;
    }
    for (Index i = 0; i < width; ++i) workspace[p.q + i] = D(q[p.q + i]);
    for (Index i = 0; i < k; ++i) {
      delta[p.v + i] = D(0.0);
      delta[p.v + i].d[0] = v[p.v + i];
    }
    e.body.template plus<D>(std::span<D const>(workspace.data() + p.q, std::size_t(width)),
                            std::span<D const>(delta + p.v, std::size_t(k)),
                            std::span<D>(out + p.q, std::size_t(width)));
    for (Index i = 0; i < width; ++i) rate[p.q + i] = out[p.q + i].d[0];
  });
}

template <class B, StateScalar T>
void BodyKernels<B, T>::rigid_velocities(Pool const& pool, VecX const& q, Vec3 const& v0, Vec3 const& omega, VecX& v) {
  for (Entry const& e : pool.entries)
    e.body.rigid_velocity(coordinates(e, q), v0, omega, detail::body_part_of(v, e.v0, e.body.velocities()));
}

template <class B, StateScalar T>
void BodyKernels<B, T>::masses(Pool const& pool, Kept& kept, At<double> at, BlockSink& sink) {
  for (std::size_t b = 0; b < pool.entries.size(); ++b) {
    Entry const& e = pool.entries[b];
    auto const& body = at_time(e.body, at.t);
    auto&& scratch = kept.scratch[b].tangent_scratch(body);
    bool const alike = detail::are_alike(body);
    Index const columns = n == Eigen::Dynamic ? body.velocities() : Index(n);
    bool const known = B::constant_mass && !sink.wants(e.v0 + body.first_column(0), columns);
    for (Index i = 0; i < body.elements(); ++i) {
      if (known) {
        Index const first = e.v0 + body.first_column(i);
        sink.skip(first, first, columns, columns);
        continue;
      }
      if (i == 0 || !alike) body.mass(i, coordinates(e, at.q), scratch.m);
      Index const first = e.v0 + body.first_column(i);
      sink.add(first, first, scratch.m);
    }
  }
}

template <class B, StateScalar T>
void BodyKernels<B, T>::tangents_of(Entry const& e, detail::ThreadScratch<B, T>& kept, At<double> at,
                                    TangentCoefficients const& c, Data<double>& data, BlockSink& sink) {
  ElementCoefficients const coefficients{c.mass, c.damping, c.stiffness};
  auto const& body = at_time(e.body, at.t);
  auto&& scratch = kept.tangent_scratch(body);
  BodyMotion<> const motion{coordinates(e, at.q), velocities(e, at.v)};
  Index const elements = body.elements();
  auto const add = [&](Index i, BlockView const& k) {
    Index const first = e.v0 + body.first_column(i);
    sink.add(first, first, k);
  };
  if constexpr (n != Eigen::Dynamic)
    if (data.workers && elements >= 2 * data.least_elements) {
      double* const slots = data.element_tangents.data();
      data.workers->over(elements, data.least_elements, [&](Index begin, Index end) {
        for_each_element_tangent<B>(body, {begin, end}, motion, coefficients, [&](Index i, Mat<double, n, n> const& k) {
          std::copy_n(k.data(), n * n, slots + n * n * i);
        });
      });
      for (Index i = 0; i < elements; ++i) add(i, BlockView(slots + n * n * i, n, n, 1, n));
      return;
    }
  for_each_element_tangent<B>(body, {0, elements}, motion, coefficients, scratch,
                              [&](Index i, Mat<double, n, n> const& k) { add(i, k); });
}

template <class B, StateScalar T>
void BodyKernels<B, T>::tangents(Pool const& pool, Kept& kept, At<double> at, TangentCoefficients const& c,
                                 Data<double>& data, BlockSink& sink) {
  if constexpr (in_batches) {
    std::array<Mat<double, n, n>, std::size_t(simd_size)> each;
    for (auto const& batch : kept.batches.filled) {
      std::size_t const first = std::size_t(batch[0].entry);
      B const& body = pool.entries[first].body;
      Mat<double, n, n> m;
      body.mass(batch[0].element, coordinates(pool.entries[first], at.q), m);
      for (Index i = 0; i < m.size(); ++i) m.data()[i] *= c.mass;
      detail::tangents_of_batch(body, detail::motion_of(pool, batch, at.q.data(), at.v.data(), at.v.data()),
                                {c.mass, c.damping, c.stiffness}, m, each);
      for (std::size_t l = 0; l < batch.size(); ++l) {
        Entry const& e = pool.entries[std::size_t(batch[l].entry)];
        Index const column = e.v0 + e.body.first_column(batch[l].element);
        sink.add(column, column, each[l]);
      }
    }
    for (auto const& [entry, element] : kept.batches.singles) {
      Entry const& e = pool.entries[std::size_t(entry)];
      for_each_element_tangent<B>(e.body, {element, element + 1}, {coordinates(e, at.q), velocities(e, at.v)},
                                  {c.mass, c.damping, c.stiffness}, [&](Index i, Mat<double, n, n> const& k) {
                                    Index const first = e.v0 + e.body.first_column(i);
                                    sink.add(first, first, k);
                                  });
    }
    for (Index const b : kept.batches.bodies)
      tangents_of(pool.entries[std::size_t(b)], kept.scratch[std::size_t(b)], at, c, data, sink);
  } else if (data.workers && shares_bodies(pool)) {
    double* const slots = data.element_tangents.data();
    share(data.workers, Index(pool.entries.size()), least_bodies, [&](Index begin, Index end) {
      for (std::size_t b = std::size_t(begin); b < std::size_t(end); ++b) {
        Entry const& e = pool.entries[b];
        auto const& body = at_time(e.body, at.t);
        auto&& scratch = kept.scratch[b].tangent_scratch(body);
        for_each_element_tangent<B>(body, {0, 1}, {coordinates(e, at.q), velocities(e, at.v)},
                                    {c.mass, c.damping, c.stiffness}, scratch,
                                    [&]([[maybe_unused]] Index i, [[maybe_unused]] auto const& k) {
                                      if constexpr (n != Eigen::Dynamic)
                                        std::copy_n(k.data(), n * n, slots + n * n * b);
                                    });
      }
    });
    for (std::size_t b = 0; b < pool.entries.size(); ++b) {
      Entry const& e = pool.entries[b];
      Index const first = e.v0 + e.body.first_column(0);
      if constexpr (n == Eigen::Dynamic)
        sink.add(first, first, kept.scratch[b].tangent_scratch(e.body).k);  // stored by the loop above
      else
        sink.add(first, first, BlockView(slots + n * n * b, n, n, 1, n));
    }
  } else {
    for (std::size_t b = 0; b < pool.entries.size(); ++b)
      tangents_of(pool.entries[b], kept.scratch[b], at, c, data, sink);
  }
}

template <class B, StateScalar T>
void BodyKernels<B, T>::own_stiffness(Pool const& pool, VecX const& lambda, detail::StiffnessAt const& x,
                                      BlockSink& sink) {
  if constexpr (HasOwnEquations<B>)
    for (Entry const& e : pool.entries) {
      Mat<double, n, n> k;
      Vec<double, B::own_equations> const l(lambda.data() + e.row);
      e.body.own_stiffness(coordinates(e, x.at.q), l, k);
      k *= x.c.stiffness;
      sink.add(e.v0, e.v0, k);
    }
}

template <class B, StateScalar T>
void BodyKernels<B, T>::load_stiffness(Pool const& pool, Kept& kept, detail::StiffnessAt const& x, Data<double>& data,
                                       BlockSink& sink) {
  for (auto const& p : pool.markers) {
    Entry const& e = pool.entries[std::size_t(p.body)];
    MarkerKinematics<double> const& marker = data.markers[std::size_t(p.published)];
    Wrench<double> const& w = data.loads[std::size_t(p.published)];
    bool acts = false;
    for (int i = 0; i < 3; ++i) acts = acts || w.f[i] != 0.0 || w.m[i] != 0.0;
    if (!acts) {
      sink.skip(marker.first, marker.first, marker.columns, marker.columns);
      continue;
    }
    auto const q = coordinates(e, x.at.q);
    if constexpr (B::point_columns == Eigen::Dynamic) {
      MatX& k = kept.scratch[std::size_t(p.body)].point_scratch();
      e.body.load_stiffness(p.point, q, w, k);
      auto of_marker = k.topLeftCorner(marker.columns, marker.columns);
      of_marker *= x.c.stiffness;
      sink.add(marker.first, marker.first, of_marker);
    } else {
      Mat<double, B::point_columns, B::point_columns> k;
      e.body.load_stiffness(p.point, q, w, k);
      for (Index i = 0; i < k.size(); ++i) k.data()[i] *= x.c.stiffness;
      sink.add(marker.first, marker.first, k);
    }
  }
}

template <class B, StateScalar T>
void BodyKernels<B, T>::add_energy(Pool const& pool, At<double> at, Vec3 const& g, Energy& sum) {
  for (Entry const& e : pool.entries) {
    auto const q = coordinates(e, at.q), v = velocities(e, at.v);
    auto const& body = at_time(e.body, at.t);
    for (Index i = 0; i < body.elements(); ++i) {
      sum.kinetic += body.kinetic_energy(i, q, v);
      sum.strain += body.strain_energy(i, q);
      sum.gravity += body.gravity_energy(i, q, g);
    }
  }
}

template <class B, StateScalar T>
double BodyKernels<B, T>::dissipated(Pool const& pool, Kept& kept, At<double> at, VecX const& backwards) {
  double sum = 0.0;
  if constexpr (!HasRigidLayout<B>)
    for (std::size_t b = 0; b < pool.entries.size(); ++b) {
      Entry const& e = pool.entries[b];
      auto&& scratch = kept.scratch[b].force_scratch(e.body);
      auto const q = coordinates(e, at.q), v = velocities(e, at.v), back = velocities(e, backwards);
      for (Index i = 0; i < e.body.elements(); ++i) {
        e.body.template force<double>(i, q, v, scratch.force);
        e.body.template force<double>(i, q, back, scratch.x);
        double const* const speed = v.data() + e.body.first_column(i);
        for (Index k = 0; k < scratch.x.size(); ++k) sum += 0.5 * speed[k] * (scratch.x[k] - scratch.force[k]);
      }
    }
  return sum;
}

}  // namespace polybody
