#pragma once
/// \file From a plan to a model of a wide type, and the kinds that such a type offers.

#include <functional>
#include <limits>
#include <memory>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/compiled.hpp>

#include "random_models/plan.hpp"

namespace polybody::random_models {

/// Call number at which the failing force throws.
struct Trap {
  enum class Mode { quiet, throws, not_a_number };
  Mode mode = Mode::quiet;
  int calls_left = 0;
};
struct TrapSprung : std::exception {};

/// A small dead force that fails from a given call on.
struct FailingForce {
  static constexpr int markers = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  Vec3 force = Vec3::Zero();
  Trap* trap = nullptr;

  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const&, double) const {
    Wrench<T> w;
    for (int i = 0; i < 3; ++i) w.f[i] = T(force[i]);
    if (trap->mode != Trap::Mode::quiet && trap->calls_left-- <= 0) {
      if (trap->mode == Trap::Mode::throws) throw TrapSprung();
      w.f[0] = T(std::numeric_limits<double>::quiet_NaN());
    }
    return {w};
  }
};

using SmallContact = Contact<SphereOnSphere>;

/// A type-erased model.
struct Built {
  std::shared_ptr<void const> model;
  std::unique_ptr<System> whole;               ///< system with energies and rigid motions
  std::function<RunSystems()> systems_of_run;  ///< systems for explicit steps
  State reference;
};

/// A wide model type.
struct WideType {
  char const* name;
  Kinds kinds;
  Built (*realise)(Plan const&, Trap&);
};

namespace detail {

template <class B>
constexpr bool is_rigid =
    requires { requires std::is_same_v<B, polybody::planar::Rigid>; } || std::is_base_of_v<RigidShape, B>;
template <class B>
constexpr bool is_hub = std::is_same_v<B, Rigid<>> || std::is_same_v<B, polybody::planar::Rigid>;

/// A joint J may be drawn between A and B: one of them is the ground, or a rigid body that is placed as the other
/// body requires.
template <class J, class A, class B>
constexpr bool may_join() {
  using G = typename J::Geometry;
  using P = typename J::PolicyType;
  constexpr bool of_ground = std::is_same_v<A, Ground> || std::is_same_v<B, Ground>;
  if constexpr (std::is_same_v<A, Ground> && std::is_same_v<B, Ground>)
    return false;
  else if constexpr (!SameWorld<G, A, B> || !EliminableBody<P, A> || !EliminableBody<P, B> ||
                     !SufficientFirstMarker<J, A> || !SufficientSecondMarker<J, B>)
    return false;
  else if constexpr (LinearPolicy<P>)
    return of_ground || std::is_same_v<A, B>;
  else
    return is_hub<A> || is_hub<B>;
}

/// A force F may be drawn on A, or between A and B.
template <class F, class A, class B>
constexpr bool may_push() {
  if constexpr (std::is_same_v<A, Ground> || A::observes < F::needs)
    return false;
  else if constexpr (F::markers == 1)
    return std::is_same_v<B, Ground>;
  else
    return B::observes >= needs_of_second<F>() && same_world(A::world, B::world) &&
           (std::is_same_v<B, Ground> || is_hub<A> || is_hub<B>);
}

template <class B>
BodyKind body_kind(char const* name) {
  return {name,
          B::world == World::plane,
          !is_rigid<B>,
          B::observes == MarkerKind::axis,
          !std::is_same_v<B, Lrvf<Direct>>,
          HasLinearPoints<B>};
}

template <class J>
JointKind joint_kind(char const* geometry, char const* policy) {
  using G = typename J::Geometry;
  using P = typename J::PolicyType;
  Offset offset = Offset::none;
  if constexpr (requires(G g) { g.distance; })
    offset = Offset::along_axis;
  else if constexpr (
      requires(G g) { g.length; } || requires(G g) { g.centres; } || requires(G g) { g.normal, g.radius; })
    offset = Offset::across;
  constexpr bool asks_axis = !LinearPolicy<P> && needs_of_second<typename J::Measured>() == MarkerKind::axis;
  return {geometry,       policy,    ConstrainingPolicy<P> ? constraint_equations<G>() : 0,
          offset,         asks_axis, EliminatingPolicy<P>,
          LinearPolicy<P>};
}

inline SmoothRamp ramp_of(JointPlan const& j) { return {.target = 0.4 * j.size, .duration = 1.0, .start = -0.05}; }
template <class Law>
Law law_of(JointPlan const& j) {
  if constexpr (requires(Law law) { law.law; })
    return {ramp_of(j)};
  else
    return ramp_of(j);
}

/// The geometry with the directions and numbers of the plan.
template <class G>
G geometry_of(JointPlan const& j, bool planar) {
  auto const fill = [&](auto&& make) {
    G g = make();
    if constexpr (requires { g.axis; }) {
      constexpr bool turns = std::is_same_v<decltype(g.axis), TurnAxis>;
      g.axis = planar && !turns ? j.side : j.axis;
    }
    if constexpr (requires { g.normal; }) {
      if constexpr (requires { g.axis; })
        g.normal = j.side;
      else
        g.normal = planar ? j.side : j.axis;
    }
    if constexpr (requires { g.first, g.second; }) {
      g.first = j.side;
      g.second = j.axis;
    }
    if constexpr (requires { g.across; }) g.across = planar ? j.side : j.axis;
    if constexpr (requires { g.direction; }) g.direction = j.side;
    if constexpr (requires { g.centres; }) g.centres = j.side;
    return g;
  };
  if constexpr (requires(G g) { g.law, g.length; })
    return fill([&] { return G{.law = law_of<decltype(G::law)>(j), .length = j.size}; });
  else if constexpr (requires(G g) { g.law; })
    return fill([&] { return G{.law = law_of<decltype(G::law)>(j)}; });
  else if constexpr (requires(G g) { g.pitch; })
    return fill([&] { return G{.pitch = 0.2 * j.size}; });
  else if constexpr (requires(G g) { g.teeth_a; })
    return fill([&] { return G{.teeth_a = 20, .teeth_b = 30}; });
  else if constexpr (requires(G g) { g.radius; })
    return fill([&] { return G{.radius = j.size}; });
  else if constexpr (requires(G g) { g.distance; })
    return fill([&] { return G{.distance = j.size}; });
  else if constexpr (requires(G g) { g.length; })
    return fill([&] { return G{.length = j.size}; });
  else
    return fill([] { return G{}; });
}

using Laws = NonlinearBushing<TabulatedLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, TabulatedLaw>;

template <class P, int rows>
P policy_of(JointPlan const& j) {
  double const k = j.stiffness, c = j.damping;
  if constexpr (ConstrainingPolicy<P>) {
    return {};
  } else if constexpr (std::is_same_v<P, Penalty>) {
    return {.stiffness = k, .damping = c};
  } else if constexpr (std::is_same_v<P, PenaltyPerEquation<rows>>) {
    Vec<double, rows> stiffness, damping;
    for (int i = 0; i < rows; ++i) {
      stiffness[i] = k * (1.0 + 0.1 * i);
      damping[i] = c * (1.0 - 0.1 * i);
    }
    return {.stiffness = stiffness, .damping = damping};
  } else if constexpr (std::is_same_v<P, Bushing>) {
    Bushing::Matrix m = Bushing::diagonal({k, 0.9 * k, 0.8 * k}, {0.3 * k, 0.2 * k, 0.4 * k});
    for (int i = 0; i < 5; ++i) m(i, i + 1) = m(i + 1, i) = 0.05 * k;
    return {.stiffness = m, .damping = c / k * m};
  } else {
    TabulatedLaw const table{MonotoneTable({{-1.0, -0.8 * k}, {0.0, 0.0}, {0.5, 0.3 * k}, {1.0, k}}), c};
    LinearLaw const line{.stiffness = 0.5 * k, .damping = c};
    return Laws{table, line, line, line, line, table};
  }
}

template <class F>
F force_of(ForcePlan const& f, [[maybe_unused]] bool planar, [[maybe_unused]] bool tells_axes, Trap& trap) {
  [[maybe_unused]] LoadAxes const axes = f.follows && tells_axes ? LoadAxes::marker : LoadAxes::world;
  if constexpr (std::is_same_v<F, PointForce<>>)
    return {.force = f.vector, .axes = axes};
  else if constexpr (std::is_same_v<F, PointForce<SmoothRamp>>)
    return {.force = f.vector, .axes = axes, .law = {.target = 2.0, .duration = 1.0}};
  else if constexpr (std::is_same_v<F, PointMoment<>>)
    return {.moment = 0.1 * (planar ? Vec3(0.0, 0.0, f.vector[0]) : f.vector), .axes = axes};
  else if constexpr (std::is_same_v<F, SpringDamper>)
    return {.stiffness = f.stiffness, .damping = f.damping, .free_length = 0.9 * f.distance};
  else if constexpr (std::is_same_v<F, AxialSpring>)
    return {.stiffness = f.stiffness, .damping = f.damping, .preload = f.vector[0], .axis = f.vector.normalized()};
  else if constexpr (std::is_same_v<F, MaxwellElement>)
    return {.stiffness = f.stiffness, .damping = 1.0 + f.damping, .free_length = f.distance};
  else if constexpr (std::is_same_v<F, SmallContact>)
    return {.geometry = {.radius_a = 0.6 * f.distance, .radius_b = 0.6 * f.distance},
            .normal = {.stiffness = f.stiffness, .damping = f.damping},
            .friction = {.coefficient = 0.3, .slip_speed = 0.1}};
  else
    return {.force = f.vector, .trap = &trap};
}

}  // namespace detail

/// The kinds of a wide type, and the construction of a model from a plan.
template <class M>
struct Realiser;
template <class... Bs, class... Js, class... Fs>
struct Realiser<Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>> {
  using M = Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>>;
  template <class... Ts>
  struct List {};
  using Ends = List<Ground, Bs...>;

  M model;
  Plan const& plan;
  std::tuple<std::vector<BodyHandle<Bs>>...> handles = {};
  std::vector<std::size_t> index = {};  ///< index of each body within the list of its type

  /// Calls f<T>(i) for the types of a list, numbered from `first`.
  template <class... Ts, class F>
  static void for_each(List<Ts...>, int first, F&& f) {
    (f.template operator()<Ts>(first++), ...);
  }
  template <template <class, class> class May, class K>
  static void add_pairs(int kind, std::vector<Pairing>& out) {
    for_each(Ends{}, ground, [&]<class A>(int a) {
      for_each(Ends{}, ground, [&]<class B>(int b) {
        if (May<A, B>::template with<K>) out.push_back({kind, a, b});
      });
    });
  }
  template <class A, class B>
  struct Joined {
    template <class J>
    static constexpr bool with = detail::may_join<J, A, B>();
  };
  template <class A, class B>
  struct Pushed {
    template <class F>
    static constexpr bool with = detail::may_push<F, A, B>();
  };

  static Kinds kinds(std::vector<char const*> const& bodies,
                     std::vector<std::pair<char const*, char const*>> const& joints,
                     std::vector<char const*> const& forces) {
    Kinds out;
    for_each(List<Bs...>{}, 0,
             [&]<class B>(int i) { out.bodies.push_back(detail::body_kind<B>(bodies[std::size_t(i)])); });
    for_each(List<Js...>{}, 0, [&]<class J>(int i) {
      auto const& [geometry, policy] = joints[std::size_t(i)];
      out.joints.push_back(detail::joint_kind<J>(geometry, policy));
      for_each(List<Js...>{}, 0, [&]<class K>(int k) {
        if (std::is_same_v<K, Joint<typename J::Geometry, Constraint>>) out.joints.back().twin = k;
      });
      add_pairs<Joined, J>(i, out.joint_pairs);
    });
    for_each(List<Fs...>{}, 0, [&]<class F>(int i) {
      out.forces.push_back({forces[std::size_t(i)], F::markers});
      add_pairs<Pushed, F>(i, out.force_pairs);
    });
    return out;
  }

  template <class B>
  static B body_of(BodyPlan const& b) {
    double const m = b.mass;
    if constexpr (std::is_same_v<B, polybody::planar::Rigid>)
      return B(m, 0.1 * m, b.place);
    else if constexpr (detail::is_rigid<B>)
      return B(m, Vec3(0.08 * m, 0.1 * m, 0.12 * m).asDiagonal(), b.place);
    else {
      Bar const bar{.length = b.length,
                    .section = Rectangle{.height = 0.12, .width = 0.1},
                    .material = Material{.density = 100.0, .young = 1e5},
                    .placement = b.place,
                    .damping = {.axial = 1e-4, .shear = 1e-4, .bending = 1e-4}};
      // The mass of a stiffened frame is complete to first order only, and these soft bars deform by large amounts.
      if constexpr (std::is_same_v<B, Ffr> || std::is_same_v<B, polybody::planar::Ffr>)
        return B::from(bar, 2, {.frame = FfrFrame::clamped, .stiffening = false});
      else
        return B::from(bar, 2);
    }
  }

  template <class B>
  Marker<B> marker(End const& e) const {
    if constexpr (std::is_same_v<B, Ground>) {
      return model.ground().at(e.point);
    } else {
      BodyHandle<B> const& h = std::get<std::vector<BodyHandle<B>>>(handles)[index[std::size_t(e.body)]];
      Placement const& place = plan.bodies[std::size_t(e.body)].place;
      if constexpr (!detail::is_rigid<B>)
        return h.at(e.s);
      else {
        Vec3 const u = place.axes.transpose() * (e.point - place.origin);
        if constexpr (B::world == World::plane)
          return h.at(Vec2(u[0], u[1]));
        else
          return h.at(u);
      }
    }
  }
  int kind_of(End const& e) const { return e.body == ground ? ground : plan.bodies[std::size_t(e.body)].kind; }

  /// Calls f<A, B>() for the end types that the pairing permits.
  template <template <class, class> class May, class K, class F>
  void with_ends(End const& first, End const& second, F&& f) const {
    int const kind_a = kind_of(first), kind_b = kind_of(second);
    for_each(Ends{}, ground, [&]<class A>(int a) {
      if (a != kind_a) return;
      for_each(Ends{}, ground, [&]<class B>(int b) {
        if constexpr (May<A, B>::template with<K>)
          if (b == kind_b) f.template operator()<A, B>();
      });
    });
  }

  void add_bodies() {
    for (std::size_t n = 0; n < plan.bodies.size(); ++n) {
      BodyPlan const& b = plan.bodies[n];
      for_each(List<Bs...>{}, 0, [&]<class B>(int i) {
        if (i != b.kind) return;
        auto& pool = std::get<std::vector<BodyHandle<B>>>(handles);
        index.push_back(pool.size());
        pool.push_back(model.add(body_of<B>(b), std::to_string(n)));
      });
    }
  }
  void connect() {
    for (std::size_t n = 0; n < plan.joints.size(); ++n) {
      JointPlan const& j = plan.joints[n];
      for_each(List<Js...>{}, 0, [&]<class J>(int i) {
        if (i != j.kind) return;
        J const joint{detail::geometry_of<typename J::Geometry>(j, plan.planar),
                      detail::policy_of<typename J::PolicyType, constraint_equations<typename J::Geometry>()>(j)};
        with_ends<Joined, J>(j.a, j.b, [&]<class A, class B>() {
          model.connect(joint, marker<A>(j.a), marker<B>(j.b), "joint " + std::to_string(n));
        });
      });
    }
  }
  void apply(Trap& trap) {
    for (std::size_t n = 0; n < plan.forces.size(); ++n) {
      ForcePlan const& f = plan.forces[n];
      for_each(List<Fs...>{}, 0, [&]<class F>(int i) {
        if (i != f.kind) return;
        with_ends<Pushed, F>(f.a, f.b, [&]<class A, class B>() {
          F const force = detail::force_of<F>(f, plan.planar, A::observes == MarkerKind::frame, trap);
          if constexpr (F::markers == 1)
            model.apply(force, marker<A>(f.a), "force " + std::to_string(n));
          else
            model.apply(force, marker<A>(f.a), marker<B>(f.b), "force " + std::to_string(n));
        });
      });
    }
  }

  /// The equations that any explicit method integrates.
  static RunSystems systems_of_run(M const& model) {
    constexpr auto asked = with < Capabilities::compliance | Capabilities::coordinate_rates > ;
    RunSystems out{std::make_unique<System>(stepped_system(model, asked)), nullptr};
    if constexpr (M::eliminates) out.full = std::make_unique<System>(model, with<Capabilities::compliance>);
    return out;
  }
  static Built realise(Plan const& plan, Trap& trap) {
    Realiser r{M{Gravity(plan.gravity)}, plan};
    r.add_bodies();
    r.connect();
    r.apply(trap);
    auto const model = std::make_shared<M const>(std::move(r.model));
    return {model, std::make_unique<System>(*model, with < Capabilities::energy | Capabilities::rigid_velocities >),
            [model] { return systems_of_run(*model); }, model->reference_state()};
  }
};

}  // namespace polybody::random_models
