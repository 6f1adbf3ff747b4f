#pragma once
/// \file
/// Loops over all bodies of one type in a model. The loops depend on the type of the body, but not on the type of the
/// model. A program therefore compiles them once for all models. With `extern template struct BodyKernels<MyBody,
/// double>;` another object file must contain the loops (see polybody/compiled.hpp).

#include <polybody/bodies/shared/element_batches.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/layout.hpp>
#include <polybody/system/model_operations.hpp>
#include <polybody/system/pool_batches.hpp>

namespace polybody {

namespace detail {

/// Workspace for all bodies of one type: arrays for each body, and the pose of each body whose points share a pose.
template <class B, StateScalar T>
struct BodyData {
  Sequence<typename PoseOf<B, T>::Type> poses;
  Sequence<ThreadScratch<B, T>> scratch;
  PoolBatches batches;   ///< elements in SIMD vectors; for doubles and comparable elements only
  bool divides = false;  ///< true if threads share the elements of at least one body
};

/// Number of used entries of the array of Jacobians, and number of columns of the widest marker Jacobian (at least 12).
struct MarkerArena {
  Index taken = 0, widest = 12;
};

/// Arguments of M a − f: state, accelerations a (nv) and gravity g (3) in world axes [m/s²].
template <StateScalar T>
struct BodyResidual {
  At<T> at;
  VecXOf<T> const& a;
  Vec3 g;
};

}  // namespace detail

/// Loops over the bodies of type B, for the scalar T. Energies, masses and tangents exist for doubles only.
template <class B, StateScalar T>
struct BodyKernels {
  using Pool = detail::BodyPool<B>;         ///< bodies of this type, in a model
  using Entry = detail::BodyTableEntry<B>;  ///< one body with its positions in the vectors
  using Kept = detail::BodyData<B, T>;      ///< workspace
  using Vector = VecXOf<T>;                 ///< vector with one T per coordinate, velocity or constraint equation

  /// Positions of a body in the vectors of its model, and the serial number of this model.
  struct Places {
    Index q0, v0, row;      ///< indices of the first coordinate, velocity and own constraint equation
    std::uint64_t made_in;  ///< serial number of the model
  };
  /// Adds a body to the pool.
  [[gnu::cold]] static void add(Pool& pool, B const& body, std::string const& name, Places const& at);
  /// Kinematics of a marker at a point, with the axes of the body. The Jacobian is stored in `jacobian`.
  static MarkerKinematics<double> publish_point(B const& body, typename B::Point const& point,
                                                std::span<double const> q, std::span<double const> v,
                                                Sequence<double>& jacobian);
  /// Axes (3×3) at a marker's point in the reference state, in world axes.
  static Mat3 reference_axes(Pool const& pool, Marker<B> const& marker);
  /// Adds a marker to the pool. Returns the size of its Jacobian.
  /// \param axes (3×3) axes of the marker relative to those of the body at its point \param published number of the
  /// marker in the model
  static Index add_marker(Pool& pool, Marker<B> const& marker, Mat3 const& axes, Index published);

  /// Appends the sizes, positions and names of the bodies to `out`.
  [[gnu::cold]] static void describe(Pool const& pool, ModelLayout& out);
  /// Allocates the workspace `kept`, and assigns columns and storage for the Jacobian to each marker. `arena` is
  /// updated.
  [[gnu::cold]] static void place_markers(Pool const& pool, Kept& kept, detail::MarkerArena& arena, Data<T>& data);
  static Index own_size(Pool const& pool);  ///< number of entries for Φ and G of the bodies' own equations
  /// Appends a constraint block for the own equations of each body, with Φ and G stored from `next` on. Returns the end
  /// of this storage. \param owner position of the first body in the layout
  [[gnu::cold]] static T* place_rows(Pool const& pool, Index owner, T* next, Data<T>& data);
  /// Increases `forces` and `tangents` to the numbers of entries that threads need for all elements of one body. If
  /// threads share the bodies of the pool, `tangents` is increased to the number for all bodies.
  static void count_shared(Pool const& pool, std::size_t& forces, std::size_t& tangents);

  /// Evaluates frame, Jacobian and bias of every marker.
  static void evaluate_marker(Pool const& pool, Kept& kept, At<T> at, Data<T>& data);
  /// Evaluates Φ and G of the bodies' own equations and stores them from `next` on. Returns the end of this storage.
  static T* measure_own_rows(Pool const& pool, At<T> at, T* next);
  static void own_gamma(Pool const& pool, At<T> at, Vector& out);  ///< writes γ of own equations to `out`
  /// out = q ⊞ δ. If `places` is not null, the vectors are reduced, and `places` points to the position of the first
  /// body. Returns `places` past the last body.
  static ReducedPosition const* plus(Pool const& pool, ReducedPosition const* places, Vector const& q,
                                     Vector const& delta, Vector& out);
  static ReducedPosition const* local_rate(Pool const& pool, ReducedPosition const* places, Vector const& delta,
                                           Vector const& v, Vector& out);  ///< out = δ˙ if q ⊞ δ moves with v
  /// r += M a − f for the arguments u.
  static void add_forces(Pool const& pool, Kept& kept, detail::BodyResidual<T> const& u, Data<T>& data, Vector& r);

  /// `rate` = q˙ = d/dε (q ⊞ ε v) at ε = 0. For a body with as many coordinates as velocities, q˙ = v. For other bodies
  /// q˙ is computed with dual numbers in `workspace` (2 nq + nv).
  static ReducedPosition const* coordinate_rates(Pool const& pool, ReducedPosition const* places, VecX const& q,
                                                 VecX const& v, VecXOf<Dual<1>>& workspace, VecX& rate);
  /// Writes the velocities v of a rigid motion with velocity v0 (3) of the body-fixed point at the world's origin [m/s]
  /// and angular velocity `omega` (3) [rad/s], in world axes.
  static void rigid_velocities(Pool const& pool, VecX const& q, Vec3 const& v0, Vec3 const& omega, VecX& v);
  static void masses(Pool const& pool, Kept& kept, At<double> at, BlockSink& sink);  ///< writes M, element by element
  static void tangents(Pool const& pool, Kept& kept, At<double> at, TangentCoefficients const& c, Data<double>& data,
                       BlockSink& sink);  ///< writes cm M + cd D + ck K
  /// Writes ck ∂(Gᵀλ)/∂q of the bodies' own equations, with the state and the stiffness coefficient ck of x.
  static void own_stiffness(Pool const& pool, VecX const& lambda, detail::StiffnessAt const& x, BlockSink& sink);
  /// Writes ck ∂(Jᵀw)/∂q of each marker for its wrench w in data.loads, with the state and the stiffness coefficient
  /// ck of x.
  static void load_stiffness(Pool const& pool, Kept& kept, detail::StiffnessAt const& x, Data<double>& data,
                             BlockSink& sink);
  static void add_energy(Pool const& pool, At<double> at, Vec3 const& g, Energy& sum);  ///< [J]
  /// Power that damping dissipates in the bodies [W], −½ v·(f(q, v) − f(q, −v)). In f(q, v), elastic forces do not
  /// depend on v and inertial forces are even in v; only damping forces are odd. \param backwards −v
  static double dissipated(Pool const& pool, Kept& kept, At<double> at, VecX const& backwards);

 private:
  static constexpr int n = B::element_columns;
  /// Least number of bodies per thread.
  static constexpr Index least_bodies = n == Eigen::Dynamic ? 8 : HasRigidLayout<B> ? 1024 : 32;
  /// True if threads share the bodies of the pool, which then have one element each.
  static bool shares_bodies(Pool const& pool) { return detail::has_single_elements(pool, 2 * least_bodies); }
  static constexpr bool in_batches = ComparableElements<B> && !TimeVaryingBody<B> && std::same_as<T, double>;
  /// r += M a − f of the elements of one body.
  static void add_forces_of(Entry const& e, detail::ThreadScratch<B, T>& kept, detail::BodyResidual<T> const& u,
                            Data<T>& data, Vector& r);
  static void tangents_of(Entry const& e, detail::ThreadScratch<B, T>& kept, At<double> at,
                          TangentCoefficients const& c, Data<double>& data, BlockSink& sink);
  /// Adds x, which is M a − f of element i without gravity, to r, and subtracts the gravity forces.
  template <class Scratch>
  static void add_force(Entry const& e, Index i, detail::BodyResidual<T> const& u, T const* x, Scratch& scratch,
                        Vector& r);
  static std::span<T const> coordinates(Entry const& e, Vector const& q) {
    return {q.data() + e.q0, std::size_t(e.body.coordinates())};
  }
  static std::span<T const> velocities(Entry const& e, Vector const& v) {
    return {v.data() + e.v0, std::size_t(e.body.velocities())};
  }
  /// Calls f(entry, position) for each body. Vectors are reduced if `places` is not null. Bodies that have joint
  /// coordinates in reduced vectors are then skipped. Returns `places` past the last body.
  template <class F>
  static ReducedPosition const* for_each_place(Pool const& pool, ReducedPosition const* places, F&& f) {
    for (Entry const& e : pool.entries) {
      ReducedPosition const full{ReducedPosition::Kind::as_it_is, e.q0, e.v0, e.body.coordinates(),
                                 e.body.velocities()};
      ReducedPosition const& p = places ? *places++ : full;
      if (p.kind != ReducedPosition::Kind::carried) f(e, p);
    }
    return places;
  }
};

template <class B, StateScalar T>
void BodyKernels<B, T>::add(Pool& pool, B const& body, std::string const& name, Places const& at) {
  pool.entries.push_back({body, name, at.q0, at.v0, at.row, at.made_in});
}
template <class B, StateScalar T>
Mat3 BodyKernels<B, T>::reference_axes(Pool const& pool, Marker<B> const& marker) {
  B const& body = pool.entries[std::size_t(marker.body)].body;
  Sequence<double> q(std::size_t(body.coordinates())), v(std::size_t(body.velocities()), 0.0), jacobian;
  body.reference(q);
  return publish_point(body, marker.point, q, v, jacobian).frame.A;
}
template <class B, StateScalar T>
MarkerKinematics<double> BodyKernels<B, T>::publish_point(B const& body, typename B::Point const& point,
                                                          std::span<double const> q, std::span<double const> v,
                                                          Sequence<double>& jacobian) {
  MarkerKinematics<double> out;
  out.columns = point_columns(body, point);
  jacobian.resize(std::size_t(6 * out.columns));
  out.jacobian = jacobian.data();
  body.template evaluate_marker<double>(point, identity(), q, v, out);
  return out;
}
template <class B, StateScalar T>
Index BodyKernels<B, T>::add_marker(Pool& pool, Marker<B> const& marker, Mat3 const& axes, Index published) {
  pool.markers.push_back({marker.body, marker.point, axes, published});
  return 6 * point_columns(pool.entries[std::size_t(marker.body)].body, marker.point);
}
template <class B, StateScalar T>
void BodyKernels<B, T>::describe(Pool const& pool, ModelLayout& out) {
  Index own = 0, index = 0;
  if constexpr (HasOwnEquations<B>) own = B::own_equations;
  for (auto const& m : pool.markers) {
    out.owners[std::size_t(m.published)] = Index(out.bodies.size()) + m.body;
    out.observes[std::size_t(m.published)] = B::observes;
    if constexpr (requires { B::observes_at(m.point); })
      out.observes[std::size_t(m.published)] = B::observes_at(m.point);
  }
  for (Entry const& e : pool.entries) {
    out.bodies.push_back({e.name, e.q0, e.body.coordinates(), e.v0, e.body.velocities(), e.row, own,
                          B::world == World::plane, B::constant_mass, &detail::type_tag<B>, index++, &e.body, nullptr,
                          units_of<B>(), e.made_in, HasRigidLayout<B>, TimeVaryingBody<B>});
    if constexpr (requires(B const& bar) { bar.constants().EA* bar.element_length(); }) {
      double const l = e.body.element_length(), EA = e.body.constants().EA, EI = e.body.constants().EI;
      out.bodies.back().stretch_ratio = EI > 0.0 ? EA * l * l / EI : 0.0;
    }
    if constexpr (requires { e.body.unit_warning(); }) out.bodies.back().unit_warning = e.body.unit_warning();
  }
  if constexpr (WithoutGeometricStiffening<B>)
    for (std::size_t i = out.bodies.size() - pool.entries.size(); i < out.bodies.size(); ++i)
      out.bodies[i].axial_share = [](void const* body, std::span<double const> q, std::span<double const> v,
                                     std::span<double const> a, Vec3 const& g, std::span<PlacedWrench const> loads) {
        return static_cast<B const*>(body)->axial_share(q, v, a, g, loads);
      };
}
template <class B, StateScalar T>
void BodyKernels<B, T>::place_markers(Pool const& pool, Kept& kept, detail::MarkerArena& arena, Data<T>& data) {
  kept.poses.resize(pool.entries.size());
  kept.scratch.reserve(pool.entries.size());
  for (Entry const& e : pool.entries) kept.scratch.emplace_back(e.body);
  if constexpr (in_batches) kept.batches = detail::batches_of(pool);
  for (Entry const& e : pool.entries) kept.divides = kept.divides || e.body.elements() >= 2 * data.least_elements;
  for (auto const& m : pool.markers) {
    Entry const& e = pool.entries[std::size_t(m.body)];
    MarkerKinematics<T>& p = data.markers[std::size_t(m.published)];
    p.first = e.v0 + e.body.first_column(m.point);
    p.columns = point_columns(e.body, m.point);
    p.jacobian = data.jacobians.data() + arena.taken;
    arena.taken += 6 * p.columns;
    arena.widest = std::max(arena.widest, p.columns);
  }
}

template <class B, StateScalar T>
Index BodyKernels<B, T>::own_size(Pool const& pool) {
  if constexpr (HasOwnEquations<B>)
    return Index(pool.entries.size()) * B::own_equations * (1 + n);
  else
    return 0;
}
template <class B, StateScalar T>
T* BodyKernels<B, T>::place_rows(Pool const& pool, Index owner, T* next, Data<T>& data) {
  if constexpr (HasOwnEquations<B>)
    for (Entry const& e : pool.entries) {
      constexpr int m = B::own_equations;
      data.rows.push_back({.source = ConstraintSource::body,
                           .row = e.row,
                           .rows = m,
                           .owner = owner++,
                           .a = {.first = e.v0, .columns = n, .map = next + m},
                           .g = next});
      next += m * (1 + n);
    }
  return next;
}

template <class B, StateScalar T>
void BodyKernels<B, T>::count_shared(Pool const& pool, std::size_t& forces, std::size_t& tangents) {
  for (Entry const& e : pool.entries) {
    std::size_t const columns = std::size_t(element_columns(e.body)), elements = std::size_t(e.body.elements());
    if (elements < std::size_t(2 * Data<T>::least_elements)) continue;
    forces = std::max(forces, columns * elements);
    tangents = std::max(tangents, columns * columns * elements);
  }
  if constexpr (n != Eigen::Dynamic && !in_batches)
    if (shares_bodies(pool)) tangents = std::max(tangents, std::size_t(n * n) * pool.entries.size());
}

template <class B, StateScalar T>
void BodyKernels<B, T>::evaluate_marker(Pool const& pool, Kept& kept, At<T> at, Data<T>& data) {
  if constexpr (HasSharedPose<B, T>)
    share(data.workers, Index(kept.poses.size()), data.least_markers, [&](Index begin, Index end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        Entry const& e = pool.entries[i];
        e.body.template pose<T>(coordinates(e, at.q), velocities(e, at.v), kept.poses[i]);
      }
    });
  share(data.workers, Index(pool.markers.size()), data.least_markers, [&](Index begin, Index end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      auto const& p = pool.markers[i];
      if (!data.linear_rows && !data.read[std::size_t(p.published)]) continue;
      MarkerKinematics<T>& out = data.markers[std::size_t(p.published)];
      Entry const& e = pool.entries[std::size_t(p.body)];
      if constexpr (HasSharedPose<B, T>)
        e.body.evaluate_marker(p.point, p.axes, kept.poses[std::size_t(p.body)], out);
      else
        e.body.template evaluate_marker<T>(p.point, p.axes, coordinates(e, at.q), velocities(e, at.v), out);
    }
  });
}

template <class B, StateScalar T>
T* BodyKernels<B, T>::measure_own_rows(Pool const& pool, At<T> at, T* next) {
  if constexpr (HasOwnEquations<B>)
    for (Entry const& e : pool.entries) {
      constexpr int m = B::own_equations;
      Vec<T, m> own;
      Mat<T, m, n> map;
      e.body.template own_constraint<T>(coordinates(e, at.q), own);
      e.body.template own_jacobian<T>(coordinates(e, at.q), map);
      for (int i = 0; i < m; ++i) *next++ = own[i];
      for (int i = 0; i < m * n; ++i) *next++ = map.data()[i];
    }
  return next;
}
template <class B, StateScalar T>
void BodyKernels<B, T>::own_gamma(Pool const& pool, At<T> at, Vector& out) {
  if constexpr (HasOwnEquations<B>)
    for (Entry const& e : pool.entries) {
      Vec<T, B::own_equations> own;
      e.body.template own_gamma<T>(coordinates(e, at.q), velocities(e, at.v), own);
      for (int i = 0; i < B::own_equations; ++i) out[e.row + i] = own[i];
    }
}

template <class B, StateScalar T>
ReducedPosition const* BodyKernels<B, T>::plus(Pool const& pool, ReducedPosition const* places, Vector const& q,
                                               Vector const& delta, Vector& out) {
  return for_each_place(pool, places, [&](Entry const& e, ReducedPosition const& p) {
    auto const qe = detail::body_part(q, p.q, p.coordinates), de = detail::body_part(delta, p.v, p.velocities);
    auto const to = detail::body_part_of(out, p.q, p.coordinates);
    if (p.kind == ReducedPosition::Kind::as_it_is)
      e.body.template plus<T>(qe, de, to);
    else
      for (std::size_t i = 0; i < qe.size(); ++i) to[i] = qe[i] + de[i];
  });
}
template <class B, StateScalar T>
ReducedPosition const* BodyKernels<B, T>::local_rate(Pool const& pool, ReducedPosition const* places,
                                                     Vector const& delta, Vector const& v, Vector& out) {
  return for_each_place(pool, places, [&](Entry const& e, ReducedPosition const& p) {
    auto const de = detail::body_part(delta, p.v, p.velocities), ve = detail::body_part(v, p.v, p.velocities);
    auto const to = detail::body_part_of(out, p.v, p.velocities);
    if (p.kind == ReducedPosition::Kind::as_it_is)
      e.body.template local_rate<T>(de, ve, to);
    else
      for (std::size_t i = 0; i < ve.size(); ++i) to[i] = ve[i];
  });
}

template <class B, StateScalar T>
template <class Scratch>
void BodyKernels<B, T>::add_force(Entry const& e, Index i, detail::BodyResidual<T> const& u, T const* x,
                                  Scratch& scratch, Vector& r) {
  T* const rows = r.data() + e.v0 + e.body.first_column(i);
  int size = n;
  if constexpr (n == Eigen::Dynamic) size = int(scratch.weight.size());
  for (int k = 0; k < size; ++k) rows[k] += x[k];
  if (u.g[0] == 0.0 && u.g[1] == 0.0 && u.g[2] == 0.0) return;
  at_time(e.body, u.at.t).template gravity<T>(i, coordinates(e, u.at.q), u.g, scratch.weight);
  for (int k = 0; k < size; ++k) rows[k] -= scratch.weight[k];
}

template <class B, StateScalar T>
void BodyKernels<B, T>::add_forces_of(Entry const& e, detail::ThreadScratch<B, T>& kept,
                                      detail::BodyResidual<T> const& u, Data<T>& data, Vector& r) {
  BodyMotion<T> const motion{coordinates(e, u.at.q), velocities(e, u.at.v), velocities(e, u.a)};
  auto const& body = at_time(e.body, u.at.t);
  if constexpr (HasBodyResidual<B, T>) return body.add_residual(motion, u.g, r.data() + e.v0);
  auto&& scratch = kept.force_scratch(body);
  if constexpr (n != Eigen::Dynamic)
    if (Index const elements = body.elements(); data.workers && elements >= 2 * data.least_elements) {
      T* const slots = data.element_forces.data();
      data.workers->over(elements, data.least_elements, [&](Index begin, Index end) {
        for_each_residual<B, T>(body, {begin, end}, motion,
                                [&](Index i, Vec<T, n> const& x) { std::copy_n(x.data(), n, slots + n * i); });
      });
      for (Index i = 0; i < elements; ++i) add_force(e, i, u, slots + n * i, scratch, r);
      return;
    }
  for_each_residual<B, T>(body, {0, body.elements()}, motion, scratch,
                          [&](Index i, auto const& x) { add_force(e, i, u, x.data(), scratch, r); });
}

template <class B, StateScalar T>
void BodyKernels<B, T>::add_forces(Pool const& pool, Kept& kept, detail::BodyResidual<T> const& u, Data<T>& data,
                                   Vector& r) {
  // Bodies write to different entries of r, so threads can share the bodies, unless they already share elements.
  Workers* const workers = kept.divides ? nullptr : data.workers;
  if constexpr (in_batches) {
    share(kept.batches.alone ? workers : nullptr, Index(kept.batches.filled.size()), data.least_batches,
          [&](Index begin, Index end) {
            std::array<Vec<double, n>, std::size_t(simd_size)> each;
            for (Index k = begin; k < end; ++k) {
              auto const& batch = kept.batches.filled[std::size_t(k)];
              ForceScratch<B, T> scratch(pool.entries[std::size_t(batch[0].entry)].body);
              detail::residuals_of_batch(pool.entries[std::size_t(batch[0].entry)].body,
                                         detail::motion_of(pool, batch, u.at.q.data(), u.at.v.data(), u.a.data()),
                                         each);
              for (std::size_t l = 0; l < batch.size(); ++l)
                add_force(pool.entries[std::size_t(batch[l].entry)], batch[l].element, u, each[l].data(), scratch, r);
            }
          });
    for (auto const& [entry, element] : kept.batches.singles) {
      Entry const& e = pool.entries[std::size_t(entry)];
      ForceScratch<B, T> scratch(e.body);
      detail::residual_of_one<B, T>(e.body, element,
                                    {coordinates(e, u.at.q), velocities(e, u.at.v), velocities(e, u.a)}, scratch);
      add_force(e, element, u, scratch.x.data(), scratch, r);
    }
    for (Index const b : kept.batches.bodies)
      add_forces_of(pool.entries[std::size_t(b)], kept.scratch[std::size_t(b)], u, data, r);
  } else {
    share(workers, Index(pool.entries.size()), least_bodies, [&](Index begin, Index end) {
      for (std::size_t b = std::size_t(begin); b < std::size_t(end); ++b)
        add_forces_of(pool.entries[b], kept.scratch[b], u, data, r);
    });
  }
}

}  // namespace polybody
