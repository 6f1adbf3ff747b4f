#pragma once
/// \file
/// Part of `Data` that depends on the types of a model, and allocation of the arrays of `Data`.

#include <polybody/math/sequence.hpp>
#include <polybody/system/force_kernels.hpp>
#include <polybody/system/model.hpp>

namespace polybody::detail {

/// Pools of a model by the type of their entries.
template <class B, class M>
BodyPool<B> const& bodies_of(M const& model) {
  return std::get<BodyPool<B>>(model.body_pools());
}
template <class J, class M>
Sequence<JointEntry<J>> const& joints_of(M const& model) {
  return std::get<Sequence<JointEntry<J>>>(model.joint_pools());
}
template <class F, class M>
Sequence<ForceEntry<F>> const& forces_of(M const& model) {
  return std::get<Sequence<ForceEntry<F>>>(model.force_pools());
}

/// Workspace that depends on the types of a model's bodies and joints.
template <class M, StateScalar T>
struct TypedData;
template <class... Bs, class... Js, class... Fs, StateScalar T>
struct TypedData<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T> {
  std::tuple<BodyData<Bs, T>...> bodies;
  std::tuple<JointData<Js, T>...> joints;
  Sequence<T> own_equations;  ///< arena of the constraint equations of bodies and of linear joints

  static TypedData& of(Data<T> const& data) { return *static_cast<TypedData*>(data.kept.get()); }
};

/// Allocates memory for `markers` markers and sets the frames of ground markers.
template <StateScalar T>
void place_ground(Sequence<GroundMarker> const& ground, Index markers, Index jacobian_size, Data<T>& data) {
  data.markers.resize(std::size_t(markers));
  data.loads.resize(data.markers.size());
  data.read.assign(data.markers.size(), 0);
  data.jacobians.assign(std::size_t(jacobian_size), T(0.0));
  for (GroundMarker const& g : ground) {
    Frame<T>& f = data.markers[std::size_t(g.published)].frame;
    for (int i = 0; i < 3; ++i) {
      f.r[i] = T(g.placement.origin[i]);
      for (int j = 0; j < 3; ++j) f.A(i, j) = T(g.placement.axes(i, j));
    }
  }
}

/// Number of entries in the constraint functions and maps of all linear joints.
template <class = void>
Index size_of(Sequence<LinearConstraints> const& all) {
  Index size = 0;
  for (LinearConstraints const& rows : all) size += rows.rows() * (1 + rows.a.map.cols() + rows.b.map.cols());
  return size;
}

/// Appends the constraint blocks of all linear joints, with constraint functions and maps stored from `next` on. The
/// loops over the joints set the owners later.
template <StateScalar T>
void place_linear_rows(Sequence<LinearConstraints> const& all, T* next, Data<T>& data) {
  for (LinearConstraints const& rows : all) {
    Index const m = rows.rows();
    ConstraintBlock<T> block{.source = ConstraintSource::linear,
                             .row = rows.row,
                             .rows = int(m),
                             .positions = int(rows.positions),
                             .g = next};
    next += m;
    for (auto const& [side, end] : {std::pair(&rows.a, &block.a), std::pair(&rows.b, &block.b)}) {
      *end = {.first = side->v0, .columns = side->map.cols(), .map = next};
      for (Index i = 0; i < side->map.size(); ++i) *next++ = T(side->map.data()[i]);
    }
    data.rows.push_back(block);
  }
}

/// Evaluates g = C_a e_a + C_b e_b − c of all linear joints, with constraint functions and maps stored from `next` on.
template <StateScalar T>
void measure_linear_rows(Sequence<LinearConstraints> const& all, VecXOf<T> const& q, Data<T> const& data, T* next) {
  if (!data.linear_rows) return;
  for (LinearConstraints const& rows : all) {
    int const m = int(rows.rows());
    for (int i = 0; i < m; ++i) next[i] = T(-rows.constant[i]);
    T const* map = next + m;
    for (LinearSide const* const side : {&rows.a, &rows.b}) {
      add_mapped<0>(map, side->map.cols(), q.data() + side->q0, m, next);
      map += side->map.size();
    }
    next += m * (1 + rows.a.map.cols() + rows.b.map.cols());
  }
}

/// Allocation of the data of a model.
template <class M, StateScalar T>
struct DataMaker;
template <class... Bs, class... Js, class... Fs, StateScalar T>
struct DataMaker<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;
  using Typed = TypedData<M, T>;

  [[gnu::cold]] static Data<T> make(M const& model) {
    auto const typed = std::make_shared<Typed>();
    Data<T> data;
    place_ground(model.ground_markers(), model.markers(), model.jacobian_size(), data);
    MarkerArena arena;
    (BodyKernels<Bs, T>::place_markers(bodies_of<Bs>(model), std::get<BodyData<Bs, T>>(typed->bodies), arena, data),
     ...);
    data.scratch.resize(std::size_t(arena.widest * (arena.widest + 18)));
    place_rows(model, *typed, data);
    data.states.assign(std::size_t(model.states()), T(0.0));
    data.rates = data.states;
    data.first_state = model.velocities() - model.states();
    Index owner = 0;
    ((ForceKernels<Fs, T>::place(forces_of<Fs>(model), owner, data), owner += Index(forces_of<Fs>(model).size())), ...);
    data.kept = typed;
    return data;
  }

 private:
  /// Appends the constraint blocks of bodies, then of linear joints, then of joints between frames.
  [[gnu::cold]] static void place_rows(M const& model, Typed& typed, Data<T>& data) {
    Index size = size_of(model.linear_rows());
    ((size += BodyKernels<Bs, T>::own_size(bodies_of<Bs>(model))), ...);
    typed.own_equations.assign(std::size_t(size), T(0.0));
    T* next = typed.own_equations.data();
    Index owner = 0;
    ((next = BodyKernels<Bs, T>::place_rows(bodies_of<Bs>(model), owner, next, data),
      owner += Index(bodies_of<Bs>(model).entries.size())),
     ...);
    [[maybe_unused]] Index const first_linear = Index(data.rows.size());
    place_linear_rows(model.linear_rows(), next, data);
    owner = 0;
    ((JointKernels<Js, T>::place(joints_of<Js>(model), std::get<JointData<Js, T>>(typed.joints), owner, first_linear,
                                 data),
      owner += Index(joints_of<Js>(model).size())),
     ...);
  }
};

/// Layout of a model with sizes and properties, but without its bodies, joints and forces.
template <class M>
ModelLayout counts_of(M const& model) {
  return {.serial = model.serial(),
          .ancestors = model.ancestors(),
          .watch = model.watch(),
          .coordinates = model.coordinates(),
          .velocities = model.velocities(),
          .rows = model.rows(),
          .states = model.states(),
          .nonholonomic_equations = model.nonholonomic_equations(),
          .owners = Sequence<Index>(std::size_t(model.markers()), -1),
          .observes = Sequence<MarkerKind>(std::size_t(model.markers()), MarkerKind::frame),
          .gravity = model.gravity().g,
          .constant_mass = M::constant_mass,
          .has_groups = M::has_groups};
}

}  // namespace polybody::detail
