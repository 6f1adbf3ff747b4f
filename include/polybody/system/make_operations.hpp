#pragma once
/// \file
/// Implementation of `ModelOperations` for the types of a model (`OperationsOf`), and the layout of a model
/// (`layout_of`). Each function runs the loops over bodies, joints or forces of one type (body_kernels.hpp,
/// joint_kernels.hpp, force_kernels.hpp) for one type after another.

#include <polybody/math/sequence.hpp>
#include <polybody/system/force_kernels.hpp>
#include <polybody/system/make_islands.hpp>
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

/// Functions of a model for scalar T. The protected functions belong to groups of capabilities. Some arguments are
/// unused if a list of joints or forces is empty.
template <class M, StateScalar T>
class ModelLoops;
template <class... Bs, class... Js, class... Fs, StateScalar T>
class ModelLoops<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T> : public ModelOperations<T> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;
  using Typed = TypedData<M, T>;

 public:
  using Vector = VecXOf<T>;
  explicit ModelLoops(M const& model) : model_(model) {}

  bool has_energy() const final { return std::same_as<T, double>; }
  void evaluate_marker(At<T> at, Data<T>& data) const final {
    (BodyKernels<Bs, T>::evaluate_marker(bodies<Bs>(), of_bodies<Bs>(data), at, data), ...);
  }
  /// Evaluates constraint functions of all joints, forces of compliant joints, and constraint equations of bodies and
  /// linear joints.
  void evaluate_constraints(At<T> at, Data<T>& data) const final {
    T* next = Typed::of(data).own_equations.data();
    ((next = BodyKernels<Bs, T>::measure_own_rows(bodies<Bs>(), at, next)), ...);
    measure_linear_rows(model_.linear_rows(), at.q, data, next);
    (JointKernels<Js, T>::measure(joints<Js>(), of_joints<Js>(data), at.t, data), ...);
  }
  void measure_gamma(At<T> at, Data<T> const& data, Vector& out) const final {
    (BodyKernels<Bs, T>::own_gamma(bodies<Bs>(), at, out), ...);
    (JointKernels<Js, T>::gamma(joints<Js>(), at.t, data, out), ...);
  }
  void element_forces(At<T> at, Vector const& a, double load_factor, Data<T>& data, Vector& r) const final {
    BodyResidual<T> const u{at, a, scaled<double>(model_.gravity().g, load_factor)};
    (BodyKernels<Bs, T>::add_forces(bodies<Bs>(), of_bodies<Bs>(data), u, data, r), ...);
  }
  void push_forces([[maybe_unused]] double t, Data<T>& data) const final {
    [[maybe_unused]] AppliedWrench<T>* next = data.actions.data();
    ((next = ForceKernels<Fs, T>::push(forces<Fs>(), t, data, next)), ...);
  }
  void plus(ReducedPosition const* places, Vector const& q, Vector const& delta, Vector& out) const final {
    ((places = BodyKernels<Bs, T>::plus(bodies<Bs>(), places, q, delta, out)), ...);
  }
  void local_rate(ReducedPosition const* places, Vector const& delta, Vector const& v, Vector& out) const final {
    ((places = BodyKernels<Bs, T>::local_rate(bodies<Bs>(), places, delta, v, out)), ...);
  }
  void share_loops(Data<T>& data, Workers& threads) const final {
    data.workers = &threads;
    std::size_t of_forces = 0, of_tangents = 0;
    (BodyKernels<Bs, T>::count_shared(bodies<Bs>(), of_forces, of_tangents), ...);
    data.element_forces.resize(of_forces);
    data.element_tangents.resize(of_tangents);
    data.opposite.resize(std::size_t(threads.size()));
    for (auto& part : data.opposite) part.actions.reserve(data.markers.size());
  }
  void masses(At<T> at, Data<T>& data, BlockSink& sink) const final {
    if constexpr (std::same_as<T, double>) {
      (BodyKernels<Bs, T>::masses(bodies<Bs>(), of_bodies<Bs>(data), at, sink), ...);
      (ForceKernels<Fs, T>::masses(forces<Fs>(), data.first_state, sink), ...);
    } else {
      this->missing("masses");
    }
  }
  Energy energy(At<T> at, Data<T> const& data) const final {
    if constexpr (std::same_as<T, double>) {
      Energy sum;
      (BodyKernels<Bs, T>::add_energy(bodies<Bs>(), at, model_.gravity().g, sum), ...);
      ((sum.joints += JointKernels<Js, T>::energy(joints<Js>(), of_joints<Js>(data))), ...);
      ((sum.forces += ForceKernels<Fs, T>::energy(forces<Fs>(), at.t, data)), ...);
      return sum;
    } else {
      this->missing("energies");
    }
  }

 protected:
  void add_element_tangents(At<T> at, TangentCoefficients const& c, Data<T>& data, BlockSink& sink) const {
    (BodyKernels<Bs, T>::tangents(bodies<Bs>(), of_bodies<Bs>(data), at, c, data, sink), ...);
  }
  void add_compliant_tangents(TangentCoefficients const& c, Data<T>& data, BlockSink& sink) const {
    (JointKernels<Js, T>::slopes(joints<Js>(), of_joints<Js>(data), c, data, sink), ...);
  }
  void add_force_tangents([[maybe_unused]] double t, [[maybe_unused]] double load_factor, TangentCoefficients const& c,
                          Data<T>& data, BlockSink& sink) const {
    (ForceKernels<Fs, T>::tangents(forces<Fs>(), t, load_factor, c, data, sink), ...);
  }
  void add_joint_stiffness(At<T> at, VecX const& lambda, TangentCoefficients const& c, Data<T>& data,
                           BlockSink& sink) const {
    StiffnessAt const x{at, c};
    (BodyKernels<Bs, T>::own_stiffness(bodies<Bs>(), lambda, x, sink), ...);
    (JointKernels<Js, T>::stiffness(joints<Js>(), of_joints<Js>(data), lambda, x, data, sink), ...);
  }
  void add_load_stiffness(At<T> at, TangentCoefficients const& c, Data<T>& data, BlockSink& sink) const {
    StiffnessAt const x{at, c};
    (BodyKernels<Bs, T>::load_stiffness(bodies<Bs>(), of_bodies<Bs>(data), x, data, sink), ...);
  }
  void write_coordinate_rates(ReducedPosition const* places, VecX const& q, VecX const& v, VecXOf<Dual<1>>& workspace,
                              VecX& rate) const {
    ((places = BodyKernels<Bs, T>::coordinate_rates(bodies<Bs>(), places, q, v, workspace, rate)), ...);
  }
  void write_rigid_velocities(VecX const& q, Vec3 const& v0, Vec3 const& omega, VecX& v) const {
    (BodyKernels<Bs, T>::rigid_velocities(bodies<Bs>(), q, v0, omega, v), ...);
  }
  /// Sums the powers in a state. Constraint equations of bodies (Euler parameters) and of linear joints are omitted,
  /// because their forces do no work.
  Powers sum_of_powers(At<T> at, VecX const& backwards, VecX const& lambda, [[maybe_unused]] double load_factor,
                       Data<T> const& data) const {
    Powers p;
    ((p.dissipated += BodyKernels<Bs, T>::dissipated(bodies<Bs>(), of_bodies<Bs>(data), at, backwards)), ...);
    (JointKernels<Js, T>::add_powers(joints<Js>(), of_joints<Js>(data), lambda, data, p), ...);
    (ForceKernels<Fs, T>::add_powers(forces<Fs>(), at.t, load_factor, lambda, data, p), ...);
    return p;
  }

  M const& model_;

 private:
  template <class B>
  BodyPool<B> const& bodies() const {
    return bodies_of<B>(model_);
  }
  template <class J>
  Sequence<JointEntry<J>> const& joints() const {
    return joints_of<J>(model_);
  }
  template <class F>
  Sequence<ForceEntry<F>> const& forces() const {
    return forces_of<F>(model_);
  }
  template <class B>
  static BodyData<B, T>& of_bodies(Data<T> const& data) {
    return std::get<BodyData<B, T>>(Typed::of(data).bodies);
  }
  template <class J>
  static JointData<J, T>& of_joints(Data<T> const& data) {
    return std::get<JointData<J, T>>(Typed::of(data).joints);
  }
};

}  // namespace detail

/// Functions of a model type with the capabilities `wanted`. Functions of other capabilities are not compiled.
template <class... Bs, class... Js, class... Fs, StateScalar T, Capabilities wanted>
class OperationsOf<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T, wanted> final
    : public detail::ModelLoops<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;
  using Loops = detail::ModelLoops<M, T>;
  using Vector = VecXOf<T>;
  static constexpr bool has(Capabilities groups) { return std::same_as<T, double> && contains(wanted, groups); }

 public:
  using Loops::Loops;
  /// Allocates the data of a model.
  static Data<T> make_data(M const& model) { return detail::DataMaker<M, T>::make(model); }

  bool provides(Capabilities groups) const override { return has(groups); }
  void element_tangents(At<T> at, TangentCoefficients const& c, Data<T>& data, BlockSink& sink) const override {
    if constexpr (has(Capabilities::tangent))
      this->add_element_tangents(at, c, data, sink);
    else
      Loops::element_tangents(at, c, data, sink);
  }
  void compliant_tangents(TangentCoefficients const& c, Data<T>& data, BlockSink& sink) const override {
    if constexpr (has(Capabilities::tangent) || has(Capabilities::compliance))
      this->add_compliant_tangents(c, data, sink);
    else
      Loops::compliant_tangents(c, data, sink);
  }
  void force_tangents(double t, double load_factor, TangentCoefficients const& c, Data<T>& data,
                      BlockSink& sink) const override {
    if constexpr (has(Capabilities::tangent))
      this->add_force_tangents(t, load_factor, c, data, sink);
    else
      Loops::force_tangents(t, load_factor, c, data, sink);
  }
  void joint_stiffness(At<T> at, Vector const& lambda, TangentCoefficients const& c, Data<T>& data,
                       BlockSink& sink) const override {
    if constexpr (has(Capabilities::second_order))
      this->add_joint_stiffness(at, lambda, c, data, sink);
    else
      Loops::joint_stiffness(at, lambda, c, data, sink);
  }
  void load_stiffness(At<T> at, TangentCoefficients const& c, Data<T>& data, BlockSink& sink) const override {
    if constexpr (has(Capabilities::second_order))
      this->add_load_stiffness(at, c, data, sink);
    else
      Loops::load_stiffness(at, c, data, sink);
  }
  void coordinate_rates(ReducedPosition const* places, Vector const& q, Vector const& v, VecXOf<Dual<1>>& workspace,
                        Vector& rate) const override {
    if constexpr (has(Capabilities::coordinate_rates))
      this->write_coordinate_rates(places, q, v, workspace, rate);
    else
      Loops::coordinate_rates(places, q, v, workspace, rate);
  }
  Powers powers(At<T> at, VecX const& backwards, VecX const& lambda, double load_factor,
                Data<T> const& data) const override {
    if constexpr (has(Capabilities::energy))
      return this->sum_of_powers(at, backwards, lambda, load_factor, data);
    else
      return Loops::powers(at, backwards, lambda, load_factor, data);
  }
  void rigid_velocities(Vector const& q, Vec3 const& v0, Vec3 const& omega, Vector& v) const override {
    if constexpr (has(Capabilities::rigid_velocities))
      this->write_rigid_velocities(q, v0, omega, v);
    else
      Loops::rigid_velocities(q, v0, omega, v);
  }
  Sequence<ModelIsland> islands() const override {
    return detail::make_islands<has(Capabilities::tangent), wanted>(this->model_);
  }
  std::shared_ptr<SecantOperations> make_secants(Data<T> const& data) const override {
    if constexpr (has(Capabilities::secants))
      return std::make_shared<detail::TypedSecants<M>>(this->model_, data);
    else
      return Loops::make_secants(data);
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
