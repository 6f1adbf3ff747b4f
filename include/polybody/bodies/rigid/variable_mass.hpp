#pragma once
/// \file
/// Rigid bodies whose mass changes with time, such as tanks that empty, rockets, and belts that are loaded.
/// Theory: Eq. 2.11.

#include <array>
#include <functional>
#include <memory>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/bodies/shared/time_varying.hpp>

namespace polybody {

/// Rigid body B with mass and inertia as functions of time. The centre of mass is fixed in the body. Example:
///
///     VariableMass<Rigid<>> const stage([](double t) { return Rigid<>(mass(t), inertia(t)); });
///
/// The equation M(t) v̇ = f is valid if mass leaves or arrives with the velocity of the body at the point of exit or
/// entry. Mass that leaves with another velocity exerts a force on the body: −ṁ u for an outflow ṁ > 0 [kg/s] with the
/// velocity u [m/s] relative to the body. Apply this force with a force element [Meshchersky 1897; Goldstein, Poole &
/// Safko 2002, ch. 1]. Energies are computed with the mass at the time of the state.
template <Body B>
class VariableMass : public B {
  static_assert(HasRigidLayout<B>,
                "VariableMass needs a rigid body with the coordinates of its centre of mass: Rigid<> or planar::Rigid. "
                "A user-defined body can define at_time(t) instead.");

 public:
  static constexpr bool constant_mass = false;

  /// Function that returns the body at time t [s]. Every evaluation calls the function, possibly from several threads.
  using Law = std::function<B(double t)>;

  /// Body with the function of time `law`.
  /// \throws InvalidInput if `law` is empty, and any exception that `law` throws for t = 0.
  explicit VariableMass(Law law) : B(at_start(law)), law_(std::make_shared<Law const>(std::move(law))) {}

  /// Body at time t [s].
  /// \throws InvalidInput if the function changes the position of the centre of mass or the axes of the body.
  VariableMass at_time(double t) const {
    VariableMass now = *this;
    static_cast<B&>(now) = (*law_)(t);
    require_same_place(now, t);
    return now;
  }

 private:
  static B at_start(Law const& law) {
    if (!law)
      throw InvalidInput(
          "variable_mass.no_function",
          {ErrorObject{"VariableMass"}, ": the function of time is empty. It must return the body at every time."});
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
    throw InvalidInput("variable_mass.moved",
                       {ErrorObject{"VariableMass"}, ": at t = ", ErrorTime{t},
                        " s the function places the body elsewhere than at t = 0. Return the same placement at all "
                        "times, and the inertia about the centre of mass."});
  }

  std::shared_ptr<Law const> law_;
};

}  // namespace polybody
