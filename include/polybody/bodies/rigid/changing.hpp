#pragma once
/// \file
/// Rigid bodies whose mass changes with time: tanks that empty, rockets, belts that are loaded.
///
/// Not in polybody.hpp: few bodies gain or lose mass.

#include <array>
#include <functional>
#include <memory>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/bodies/shared/changes_with_time.hpp>

namespace polybody {

/// A rigid body B with mass and inertia by a law of time, about a centre of mass that stays at its place in the body:
///
///     Changing<Rigid<>> const stage([](double t) { return Rigid<>(mass(t), inertia(t)); });
///
/// M(t) v̇ = f holds where what leaves, or comes, has the velocity of the body at that place, so that it takes its own
/// momentum with it. What leaves by another velocity pushes: a stream of ṁ [kg/s] at u [m/s] relative to the body is a
/// force ṁ u against it, which is applied as any other [Meshchersky 1897; Goldstein, Poole & Safko 2002, ch. 1].
/// Energies are those of the mass that is there.
template <Body B>
class Changing : public B {
  static_assert(
      HasRigidLayout<B>,
      "Only rigid bodies whose coordinates are those of their centre of mass change: Rigid<> and planar::Rigid. A body "
      "of your own may say at_time(t) itself.");

 public:
  static constexpr bool constant_mass = false;

  /// The body that it is at time t [s]; it is asked in every evaluation, by several threads where there are any.
  using Law = std::function<B(double t)>;

  /// \throws InvalidInput without a law, and what the law throws for t = 0.
  explicit Changing(Law law) : B(at_start(law)), law_(std::make_shared<Law const>(std::move(law))) {}

  /// \throws InvalidInput where the law places the centre of mass or its axes elsewhere than at the start.
  Changing at_time(double t) const {
    Changing now = *this;
    static_cast<B&>(now) = (*law_)(t);
    require_same_place(now, t);
    return now;
  }

 private:
  static B at_start(Law const& law) {
    if (!law) throw InvalidInput("Changing: a law is needed that gives the body at every time.");
    return law(0.0);
  }
  void require_same_place(B const& now, double t) const {
    std::array<double, 7> here{}, there{};
    B::reference(std::span<double>(here).first(std::size_t(B::coordinates())));
    now.reference(std::span<double>(there).first(std::size_t(B::coordinates())));
    for (std::size_t i = 0; i < here.size(); ++i)
      if (!(std::abs(here[i] - there[i]) <= 1e-12 * (1.0 + std::abs(here[i])))) refuse_place(t);
  }
  [[noreturn, gnu::cold]] static void refuse_place(double t) {
    throw InvalidInput{"Changing: at t = ", t,
                       " s the law places the body elsewhere than at t = 0. Coordinates are those of the centre of "
                       "mass: keep its placement, and let mass and inertia change about it."};
  }

  std::shared_ptr<Law const> law_;
};

}  // namespace polybody
