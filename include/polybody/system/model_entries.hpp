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

/// Type and index of elements that come type by type.
struct CountOfType {
  void const* type = nullptr;
  Index index = -1;
  template <class T>
  void next() {
    index = type == &type_tag<T> ? index + 1 : 0;
    type = &type_tag<T>;
  }
};

/// The body of each published marker, by its place in the layout; −1 for the ground.
template <class M>
std::vector<Index> owners_of_markers(M const& model) {
  std::vector<Index> owners(std::size_t(model.markers()), -1);
  Index before = 0;
  auto const note = [&](auto const& pool) {
    for (auto const& m : pool.markers) owners[std::size_t(m.published)] = before + m.body;
    before += Index(pool.entries.size());
  };
  std::apply([&](auto const&... pool) { (note(pool), ...); }, model.body_pools());
  return owners;
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
                  .owners = detail::owners_of_markers(model),
                  .gravity = model.gravity().g,
                  .constant_mass = M::constant_mass,
                  .has_groups = M::has_groups};
  detail::CountOfType count;
  model.for_each_body([&](auto const& e) {
    using B = std::decay_t<decltype(e.body)>;
    count.next<B>();
    Index own = 0;
    if constexpr (OwnsRows<B>) own = B::own_rows;
    out.bodies.push_back({e.name, e.q0, e.body.coordinates(), e.v0, e.body.speeds(), e.row, own,
                          B::world == World::plane, count.type, count.index, &e.body});
  });
  model.for_each_joint([&](auto const& e) {
    using J = std::decay_t<decltype(e.joint)>;
    count.next<J>();
    LinearRows const* const linear = e.linear < 0 ? nullptr : &model.linear_rows()[std::size_t(e.linear)];
    out.joints.push_back(
        {e.name, e.a, e.b, e.row, e.rows, Eliminates<typename J::PolicyType>, count.type, count.index, linear});
    detail::add_corners(e.joint.geometry, out.corners);
  });
  model.for_each_force([&](auto const& e) {
    using F = std::decay_t<decltype(e.force)>;
    count.next<F>();
    out.forces.push_back({e.name, count.type, count.index, &e.force, {e.markers.begin(), e.markers.end()}, F::is_load});
    if constexpr (requires { e.force.law; }) detail::add_corners(e.force.law, out.corners);
  });
  return out;
}

}  // namespace polybody
