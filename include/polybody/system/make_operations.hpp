#pragma once
/// \file
/// Function table and layout of a model. Only this header erases the type of a model. Each function runs the loops of
/// the model's types (body_kernels.hpp, joint_kernels.hpp, force_kernels.hpp) one after another.

#include <polybody/math/sequence.hpp>
#include <polybody/system/secant_operations.hpp>
#include <polybody/system/typed_data.hpp>

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
