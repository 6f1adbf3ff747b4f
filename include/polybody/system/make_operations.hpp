#pragma once
/// \file
/// Function table and layout of a model. Only this header erases the type of a model. Each function runs the loops of
/// the model's types (body_kernels.hpp, joint_kernels.hpp, force_kernels.hpp) one after another.

#include <polybody/math/sequence.hpp>
#include <polybody/system/force_kernels.hpp>
#include <polybody/system/model.hpp>
#include <polybody/system/secant_operations.hpp>

namespace polybody::detail {

// Part of `Data` that depends on the types of a model, and allocation of the arrays of `Data`.

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

namespace polybody {

namespace detail {

/// Functions of a model's table for scalar T. Arguments can be unused, because a list of joints or forces may be empty.
template <class M, StateScalar T>
struct ModelLoops;
template <class... Bs, class... Js, class... Fs, StateScalar T>
struct ModelLoops<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;
  using Typed = TypedData<M, T>;
  using Vector = VecXOf<T>;
  static M const& model_of(void const* m) { return *static_cast<M const*>(m); }
  template <class B>
  static BodyPool<B> const& bodies(void const* m) {
    return bodies_of<B>(model_of(m));
  }
  template <class J>
  static Sequence<JointEntry<J>> const& joints(void const* m) {
    return joints_of<J>(model_of(m));
  }
  template <class F>
  static Sequence<ForceEntry<F>> const& forces(void const* m) {
    return forces_of<F>(model_of(m));
  }
  template <class B>
  static BodyData<B, T>& of_bodies(Data<T> const& data) {
    return std::get<BodyData<B, T>>(Typed::of(data).bodies);
  }
  template <class J>
  static JointData<J, T>& of_joints(Data<T> const& data) {
    return std::get<JointData<J, T>>(Typed::of(data).joints);
  }

  static void evaluate_marker(void const* m, At<T> at, Data<T>& data) {
    (BodyKernels<Bs, T>::evaluate_marker(bodies<Bs>(m), of_bodies<Bs>(data), at, data), ...);
  }
  /// Evaluates constraint functions of all joints, forces of compliant joints, and constraint equations of bodies and
  /// linear joints.
  static void evaluate_constraints(void const* m, At<T> at, Data<T>& data) {
    T* next = Typed::of(data).own_equations.data();
    ((next = BodyKernels<Bs, T>::measure_own_rows(bodies<Bs>(m), at, next)), ...);
    measure_linear_rows(model_of(m).linear_rows(), at.q, data, next);
    (JointKernels<Js, T>::measure(joints<Js>(m), of_joints<Js>(data), at.t, data), ...);
  }
  static void measure_gamma(void const* m, At<T> at, Data<T> const& data, Vector& out) {
    (BodyKernels<Bs, T>::own_gamma(bodies<Bs>(m), at, out), ...);
    (JointKernels<Js, T>::gamma(joints<Js>(m), at.t, data, out), ...);
  }
  static void element_forces(void const* m, At<T> at, Vector const& a, double load_factor, Data<T>& data, Vector& r) {
    BodyResidual<T> const u{at, a, scaled<double>(model_of(m).gravity().g, load_factor)};
    (BodyKernels<Bs, T>::add_forces(bodies<Bs>(m), of_bodies<Bs>(data), u, data, r), ...);
  }
  static void push_forces([[maybe_unused]] void const* m, [[maybe_unused]] double t, Data<T>& data) {
    [[maybe_unused]] AppliedWrench<T>* next = data.actions.data();
    ((next = ForceKernels<Fs, T>::push(forces<Fs>(m), t, data, next)), ...);
  }
  static void plus(void const* m, ReducedPosition const* places, Vector const& q, Vector const& delta, Vector& out) {
    ((places = BodyKernels<Bs, T>::plus(bodies<Bs>(m), places, q, delta, out)), ...);
  }
  static void local_rate(void const* m, ReducedPosition const* places, Vector const& delta, Vector const& v,
                         Vector& out) {
    ((places = BodyKernels<Bs, T>::local_rate(bodies<Bs>(m), places, delta, v, out)), ...);
  }
  static void share_loops(void const* m, Data<T>& data, Workers& threads) {
    data.workers = &threads;
    std::size_t of_forces = 0, of_tangents = 0;
    (BodyKernels<Bs, T>::count_shared(bodies<Bs>(m), of_forces, of_tangents), ...);
    data.element_forces.resize(of_forces);
    data.element_tangents.resize(of_tangents);
    data.opposite.resize(std::size_t(threads.size()));
    for (auto& part : data.opposite) part.actions.reserve(data.markers.size());
  }

  static void masses(void const* m, At<double> at, Data<double>& data, BlockSink& sink) {
    (BodyKernels<Bs, double>::masses(bodies<Bs>(m), of_bodies<Bs>(data), at, sink), ...);
    (ForceKernels<Fs, double>::masses(forces<Fs>(m), data.first_state, sink), ...);
  }
  static void element_tangents(void const* m, At<double> at, TangentCoefficients const& c, Data<double>& data,
                               BlockSink& sink) {
    (BodyKernels<Bs, double>::tangents(bodies<Bs>(m), of_bodies<Bs>(data), at, c, data, sink), ...);
  }
  static void compliant_tangents([[maybe_unused]] void const* m, TangentCoefficients const& c, Data<double>& data,
                                 BlockSink& sink) {
    (JointKernels<Js, double>::slopes(joints<Js>(m), of_joints<Js>(data), c, data, sink), ...);
  }
  static void force_tangents([[maybe_unused]] void const* m, [[maybe_unused]] double t,
                             [[maybe_unused]] double load_factor, TangentCoefficients const& c, Data<double>& data,
                             BlockSink& sink) {
    (ForceKernels<Fs, double>::tangents(forces<Fs>(m), t, load_factor, c, data, sink), ...);
  }
  static void joint_stiffness(void const* m, At<double> at, VecX const& lambda, TangentCoefficients const& c,
                              Data<double>& data, BlockSink& sink) {
    StiffnessAt const x{at, c};
    (BodyKernels<Bs, double>::own_stiffness(bodies<Bs>(m), lambda, x, sink), ...);
    (JointKernels<Js, double>::stiffness(joints<Js>(m), of_joints<Js>(data), lambda, x, data, sink), ...);
  }
  static void load_stiffness(void const* m, At<double> at, TangentCoefficients const& c, Data<double>& data,
                             BlockSink& sink) {
    StiffnessAt const x{at, c};
    (BodyKernels<Bs, double>::load_stiffness(bodies<Bs>(m), of_bodies<Bs>(data), x, data, sink), ...);
  }
  static void coordinate_rates(void const* m, ReducedPosition const* places, VecX const& q, VecX const& v,
                               VecXOf<Dual<1>>& workspace, VecX& rate) {
    ((places = BodyKernels<Bs, double>::coordinate_rates(bodies<Bs>(m), places, q, v, workspace, rate)), ...);
  }
  static void rigid_velocities(void const* m, VecX const& q, Vec3 const& v0, Vec3 const& omega, VecX& v) {
    (BodyKernels<Bs, double>::rigid_velocities(bodies<Bs>(m), q, v0, omega, v), ...);
  }
  static Energy energy(void const* m, At<double> at, Data<double> const& data) {
    Energy sum;
    (BodyKernels<Bs, double>::add_energy(bodies<Bs>(m), at, model_of(m).gravity().g, sum), ...);
    ((sum.joints += JointKernels<Js, double>::energy(joints<Js>(m), of_joints<Js>(data))), ...);
    ((sum.forces += ForceKernels<Fs, double>::energy(forces<Fs>(m), at.t, data)), ...);
    return sum;
  }
  /// Powers in a state. Constraint equations of bodies (Euler parameters) and of linear joints do no work and are
  /// omitted.
  static Powers powers(void const* m, At<double> at, VecX const& backwards, VecX const& lambda,
                       [[maybe_unused]] double load_factor, Data<double> const& data) {
    Powers p;
    ((p.dissipated += BodyKernels<Bs, double>::dissipated(bodies<Bs>(m), of_bodies<Bs>(data), at, backwards)), ...);
    (JointKernels<Js, double>::add_powers(joints<Js>(m), of_joints<Js>(data), lambda, data, p), ...);
    (ForceKernels<Fs, double>::add_powers(forces<Fs>(m), at.t, load_factor, data, p), ...);
    return p;
  }
};

}  // namespace detail

/// Function table of a model type with the capabilities `wanted`.
template <class... Bs, class... Js, class... Fs, StateScalar T, Capabilities wanted>
struct OperationsOf<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T, wanted> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;  ///< type of the model
  using Loops = detail::ModelLoops<M, T>;                        ///< functions of the table

  /// Makes the table at compile time. Functions of capabilities that are not in `wanted` are null.
  static constexpr ModelOperations<T> make() {
    ModelOperations<T> out{.evaluate_marker = &Loops::evaluate_marker,
                           .evaluate_constraints = &Loops::evaluate_constraints,
                           .measure_gamma = &Loops::measure_gamma,
                           .element_forces = &Loops::element_forces,
                           .push_forces = &Loops::push_forces,
                           .plus = &Loops::plus,
                           .local_rate = &Loops::local_rate,
                           .share_loops = &Loops::share_loops};
    if constexpr (std::same_as<T, double>) add_for_numbers(out);
    return out;
  }
  static constexpr ModelOperations<T> table = make();  ///< function table that `System` requires
  /// Allocates the data of a model.
  static Data<T> make_data(M const& model) { return detail::DataMaker<M, T>::make(model); }

 private:
  static constexpr void add_for_numbers(ModelOperations<double>& out) {
    out.masses = &Loops::masses;
    out.energy = &Loops::energy;
    if constexpr (contains(wanted, Capabilities::tangent)) {
      out.element_tangents = &Loops::element_tangents;
      out.force_tangents = &Loops::force_tangents;
    }
    if constexpr (contains(wanted, Capabilities::tangent) || contains(wanted, Capabilities::compliance))
      out.compliant_tangents = &Loops::compliant_tangents;
    if constexpr (contains(wanted, Capabilities::second_order)) {
      out.joint_stiffness = &Loops::joint_stiffness;
      out.load_stiffness = &Loops::load_stiffness;
    }
    if constexpr (contains(wanted, Capabilities::coordinate_rates)) out.coordinate_rates = &Loops::coordinate_rates;
    if constexpr (contains(wanted, Capabilities::energy)) out.powers = &Loops::powers;
    if constexpr (contains(wanted, Capabilities::secants)) out.secants = &detail::TypedSecants<M>::table;
    if constexpr (contains(wanted, Capabilities::rigid_velocities)) out.rigid_velocities = &Loops::rigid_velocities;
  }
};

/// Layout of `model`: sizes, positions and names. It contains pointers into `model`, which must outlive the layout.
template <class... Bs, class... Js, class... Fs>
ModelLayout layout_of(Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>> const& model) {
  ModelLayout out = detail::counts_of(model);
  (BodyKernels<Bs, double>::describe(detail::bodies_of<Bs>(model), out), ...);
  (JointKernels<Js, double>::describe(detail::joints_of<Js>(model), model.linear_rows(), out), ...);
  (ForceKernels<Fs, double>::describe(detail::forces_of<Fs>(model), out), ...);
  return out;
}

}  // namespace polybody
