#pragma once
#include <polybody/joints/angle.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/joint_motion.hpp>

namespace polybody {

/// Nut b on the thread of a: a cylindrical joint whose translation is p times its rotation. 5 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₃; a₂·b₃; a₃·d − p θ],  d = r_b − r_a      [Haug 1989, §9.4].
/// θ is zero at the reference configuration if d is zero. The translation determines the number of full turns, which is
/// not limited.
struct Screw {
  static constexpr char const* name = "Screw";
  static constexpr World world = World::space;

  Required<double> pitch;  ///< p, translation per radian [m/rad]: the lead over 2π; negative for a left-handed thread
  JointAxis axis = {};     ///< (3) unit vector, world axes at the reference configuration
  using Equations = EquationList<NoTranslation<0>, NoTranslation<1>, Perpendicular<0, 2>, Perpendicular<1, 2>,
                                 TranslationPerRotation<2, &Screw::pitch>>;

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Screw: the axis");
  }
  JointMotions motions() const { return {.list = {JointMotion{JointMotion::Kind::screw, 2, pitch}}, .count = 1}; }
  void check(std::string const& what) const {
    if (!std::isfinite(pitch) || pitch == 0.0)
      throw InvalidInput("screw.pitch", {ErrorObject{what}, ": the pitch must be finite and not zero, but is ",
                                         ErrorValue{pitch}, " m. A screw without pitch is a Revolute."});
  }
};

}  // namespace polybody
