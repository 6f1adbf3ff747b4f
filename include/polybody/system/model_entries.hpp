#pragma once
/// \file
/// The table of a model's entries, and its layout: the only place where a model's type turns into functions and data.

#include <polybody/system/energy_entries.hpp>
#include <polybody/system/secant_entries.hpp>
#include <polybody/system/tangent_entries.hpp>

namespace polybody {

/// The entries of model type M for the groups `wanted`.
template <class... Bs, class... Js, class... Fs, StateScalar T, Entries wanted>
struct EntriesOf<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>, T, wanted> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;

  static constexpr ModelEntries<T> make() {
    using Motion = detail::MotionEntries<M, T>;
    using Force = detail::ForceEntries<M, T>;
    ModelEntries<T> out{.publish = &Motion::publish,
                        .measure_gaps = &Motion::measure_gaps,
                        .measure_gamma = &Motion::measure_gamma,
                        .element_forces = &Force::element_forces,
                        .push_forces = &Force::push_forces,
                        .plus = &Motion::plus,
                        .local_rate = &Motion::local_rate,
                        .share_loops = [](void const* m, Data<T>& data, Workers& threads) {
                          share_loops(Motion::model_of(m), data, threads);
                        }};
    if constexpr (std::same_as<T, double>) add_for_numbers(out);
    return out;
  }
  static constexpr ModelEntries<T> table = make();

 private:
  static constexpr void add_for_numbers(ModelEntries<double>& out) {
    using Motion = detail::MotionEntries<M, double>;
    using Tangent = detail::TangentEntries<M>;
    out.masses = &detail::ForceEntries<M, double>::masses;
    if constexpr (contains(wanted, Entries::tangent)) {
      out.element_tangents = &Tangent::element_tangents;
      out.force_tangents = &Tangent::force_tangents;
    }
    if constexpr (contains(wanted, Entries::tangent) || contains(wanted, Entries::compliance))
      out.compliant_tangents = &Tangent::compliant_tangents;
    if constexpr (contains(wanted, Entries::second_order)) {
      out.joint_stiffness = &Tangent::joint_stiffness;
      out.load_stiffness = &Tangent::load_stiffness;
    }
    if constexpr (contains(wanted, Entries::coordinate_rates)) out.coordinate_rates = &Motion::coordinate_rates;
    if constexpr (contains(wanted, Entries::energy)) {
      out.energy = &detail::EnergyEntries<M>::energy;
      out.powers = &detail::EnergyEntries<M>::powers;
    }
    if constexpr (contains(wanted, Entries::secants)) out.secants = &detail::TypedSecants<M>::table;
    if constexpr (contains(wanted, Entries::rigid_speeds)) out.rigid_speeds = &Motion::rigid_speeds;
  }
};

namespace detail {

/// Times at which a drive or a load wants a step to end.
template <class Law>
void add_corners(Law const& law, std::vector<double>& all) {
  if constexpr (HasCorners<Law>)
    for (double const t : law.corners()) all.push_back(t);
}

}  // namespace detail

/// Counts, places and names of `model`, which must outlive what is done with them.
template <class M>
ModelLayout layout_of(M const& model) {
  ModelLayout out{.serial = model.serial(),
                  .coordinates = model.coordinates(),
                  .speeds = model.speeds(),
                  .rows = model.rows(),
                  .velocity_rows = model.velocity_rows(),
                  .constant_mass = M::constant_mass,
                  .has_groups = M::has_groups};
  model.for_each_body([&](auto const& e) {
    using B = std::decay_t<decltype(e.body)>;
    Index own = 0;
    if constexpr (OwnsRows<B>) own = B::own_rows;
    out.bodies.push_back(
        {e.name, e.q0, e.body.coordinates(), e.v0, e.body.speeds(), e.row, own, B::world == World::plane});
  });
  model.for_each_joint([&](auto const& e) {
    using P = typename std::decay_t<decltype(e.joint)>::PolicyType;
    out.joints.push_back({e.name, e.a, e.b, e.row, e.rows, Eliminates<P>});
    detail::add_corners(e.joint.geometry, out.corners);
  });
  void const* type = nullptr;
  Index index = 0;
  model.for_each_force([&](auto const& e) {
    using F = std::decay_t<decltype(e.force)>;
    index = type == &detail::type_tag<F> ? index + 1 : 0;
    type = &detail::type_tag<F>;
    out.forces.push_back({e.name, type, index, &e, F::is_load});
    if constexpr (requires { e.force.law; }) detail::add_corners(e.force.law, out.corners);
  });
  return out;
}

}  // namespace polybody
