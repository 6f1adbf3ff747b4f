#pragma once
/// \file
/// Joints between two bodies in space, each a list of constraint equations.
///
/// Primitive geometries. Several of them between the same two markers form other joints:
///   Revolute = CoincidentPoints + ParallelAxes            Universal   = CoincidentPoints + PerpendicularAxes
///   Prismatic = PointOnLine + ConstantOrientation         Weld        = CoincidentPoints + ConstantOrientation
///   Cylindrical = PointOnLine + ParallelAxes              PlanarJoint = PointInPlane + ParallelAxes
///   PointOnLine = two of PointInPlane                     ConstantOrientation = ParallelAxes + PerpendicularAxes
/// The joint on the left permits the same motion as the primitives and evaluates the frames of its markers only once.
/// [Haug 1989, §9.4]
/// Theory: Eq. 4.13.

#include <polybody/joints/angle.hpp>
#include <polybody/joints/constraint_functions.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/joint_motion.hpp>

namespace polybody {

/// Spherical joint in space: two points coincide. 3 constraint equations in world axes.
struct Spherical {
  static constexpr char const* name = "Spherical";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident>;

  Mat3 triad() const { return identity(); }
};

/// Revolute joint in space: two points coincide and the axes of a and b stay parallel. 5 constraint equations
///   g = [r_b − r_a; a₁·b₃; a₂·b₃]   [thesis §3.5.1, the special case of the spherical joint].
/// The second marker needs only an axis. A cable, whose markers have only a tangent, can be the second body if the
/// joint axis is along the tangent (a clamp).
struct Revolute {
  static constexpr char const* name = "Revolute";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis axis = {};  ///< (3) unit vector of the joint axis, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Revolute: the axis");
  }
};

/// Two points have the distance L that the member `length` of the geometry contains [m]: d·d − L² = 0.
template <auto length>
struct SquaredDistance {
  static constexpr int rows = 1;
  static constexpr bool opposite_ends = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  [[gnu::always_inline]] static void write(auto const& geometry, auto const& a, auto const& b, auto& terms, int row) {
    auto const d = (b.r - a.r).eval();
    terms.g[row] = d.dot(d) - double(geometry.*length) * (geometry.*length);
    for (int i = 0; i < 3; ++i) {
      terms.Ga(row, i) = d[i] * -2.0;
      terms.Gb(row, i) = d[i] * 2.0;
    }
  }
  static void gamma(auto const&, auto const& a, auto const& b, auto* out) {
    auto const rate = (b.v - a.v).eval();
    *out = rate.dot(rate) * 2.0;
  }
  static void add_gradient(auto const&, Frame<double> const&, Frame<double> const&, double const* lambda,
                           WrenchGradient& k) {
    for (int i = 0; i < 3; ++i) {
      k(i, i) += 2.0 * *lambda;
      k(i, i + 6) -= 2.0 * *lambda;
      k(i + 6, i) -= 2.0 * *lambda;
      k(i + 6, i + 6) += 2.0 * *lambda;
    }
  }
};

/// Revolute joint of thesis Eq. 3.8, between two points of the joint axis at a distance L. 5 constraint equations
///   g = [a₁·b₃; a₂·b₃; a₁·d; a₂·d; d·d − k_θ],  d = r_b − r_a,  k_θ = L².
/// The last equation constrains d along the axis. For L = 0 its Jacobian is zero (rank 4), so that L must be positive.
/// The motions are those of a Revolute [thesis §3.5.1]; the force along the axis is 2 L λ₅.
struct RevolutePin {
  static constexpr char const* name = "RevolutePin";
  static constexpr World world = World::space;

  Required<double> distance;  ///< L [m]
  JointAxis axis = {};        ///< (3) unit vector of the joint axis, world axes at the reference configuration
  using Equations = EquationList<Perpendicular<0, 2>, Perpendicular<1, 2>, NoTranslation<0>, NoTranslation<1>,
                                 SquaredDistance<&RevolutePin::distance>>;

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "RevolutePin: the axis");
  }
  void check(std::string const& what) const {
    if (!(distance > 0.0) || !std::isfinite(distance))
      throw InvalidInput(
          "revolute_pin.distance",
          {ErrorObject{what}, ": the distance of its points along the axis must be positive and finite, but is ",
           ErrorValue{distance}, " m. For coincident points use Revolute."});
  }
};

/// Universal joint (Cardan joint): two points coincide, and the first axis, fixed in a, stays perpendicular to the
/// second axis, fixed in b. The axes are the arms of the cross. 4 constraint equations
///   g = [r_b − r_a; a₁·b₃]      [Haug 1989, §9.4].
struct Universal {
  static constexpr char const* name = "Universal";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<0, 2>>;

  JointAxis first = {};   ///< (3) unit vector a₁, world axes at the reference configuration
  JointAxis second = {};  ///< (3) unit vector b₃, perpendicular to `first`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_of(first.required("Universal: the first axis"),
                                                    second.required("Universal: the second axis"), "Universal");
  }
  /// Rotation about a₁, then about b₃.
  JointMotions motions() const {
    return {.list = {JointMotion{JointMotion::Kind::turn, 0}, JointMotion{JointMotion::Kind::turn, 2}}, .count = 2};
  }
};

/// Cylindrical joint: b rotates about the axis fixed in a and slides along it. 4 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
struct Cylindrical {
  static constexpr char const* name = "Cylindrical";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<0>, NoTranslation<1>, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis axis = {};  ///< (3) unit vector of translation and rotation, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Cylindrical: the axis");
  }
};

/// Prismatic joint in space: b slides along the axis fixed in a without rotation. 5 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₂; a₂·b₃; a₃·b₁],  d = r_b − r_a.
struct Prismatic {
  static constexpr char const* name = "Prismatic";
  static constexpr World world = World::space;
  using Equations =
      EquationList<NoTranslation<0>, NoTranslation<1>, Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  JointAxis axis = {};  ///< (3) unit vector of the translation, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Prismatic: the axis");
  }
};

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
                                         ErrorValue{pitch}, " m/rad. A screw without pitch is a Revolute."});
  }
};

/// Planar joint in space: a plane of b slides and rotates on a plane of a. 3 constraint equations
///   g = [a₃·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
/// The name is not `Planar`, because namespace `planar` contains the bodies and joints in the plane.
struct PlanarJoint {
  static constexpr char const* name = "PlanarJoint";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<2>, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PlanarJoint: the normal");
  }
};

/// Rigid connection in space: points coincide and axes are parallel. 6 constraint equations
///   g = [r_b − r_a; a₁·b₂; a₂·b₃; a₃·b₁].
struct Weld {
  static constexpr char const* name = "Weld";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  Mat3 triad() const { return identity(); }
};

/// The point of b stays in the plane through the point of a whose normal is fixed in a. 1 constraint equation
///   g = a₃·d,  d = r_b − r_a      [Haug 1989, §9.4].
/// In a planar model, the normal is a vector in the plane, and the point of b stays on the line perpendicular to it.
struct PointInPlane {
  static constexpr char const* name = "PointInPlane";
  static constexpr World world = World::both;
  using Equations = EquationList<NoTranslation<2>>;

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PointInPlane: the normal");
  }
};

/// The point of b stays on the line through the point of a along the axis fixed in a. 2 constraint equations
///   g = [a₁·d; a₂·d],  d = r_b − r_a      [Haug 1989, §9.4].
struct PointOnLine {
  static constexpr char const* name = "PointOnLine";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<0>, NoTranslation<1>>;

  JointAxis axis = {};  ///< (3) unit vector of the line, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "PointOnLine: the axis");
  }
};

/// The axes of b stay parallel to the axes of a; translations are free. 3 constraint equations g = [a₁·b₂; a₂·b₃;
/// a₃·b₁].
struct ConstantOrientation {
  static constexpr char const* name = "ConstantOrientation";
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  Mat3 triad() const { return identity(); }
};

/// Massless rod with a spherical joint at each end, in the plane and in space. 1 constraint equation
///   g = |r_b − r_a| − L      [Haug 1989, §9.4, there squared].
/// Since the distance is not squared, g is a length, λ is the tension of the rod [N], and a Penalty is a linear spring
/// for any elongation. The direction of the rod is undefined if the points coincide.
struct Distance {
  static constexpr char const* name = "Distance";
  static constexpr World world = World::both;

  Required<double> length;  ///< L [m]
  using Equations = EquationList<FixedDistance<&Distance::length>>;

  Mat3 triad() const { return identity(); }
  void check(std::string const& what) const {
    if (!(length > 0.0) || !std::isfinite(length))
      throw InvalidInput("distance.length",
                         {ErrorObject{what}, ": the length must be positive and finite, but is ", ErrorValue{length},
                          " m. For coincident points use Spherical or, in the plane, planar::Revolute."});
  }
};

/// Two points coincide. Alias of the spherical joint as a primitive.
using CoincidentPoints = Spherical;

/// The first axis, fixed in a, stays perpendicular to the second axis, fixed in b. 1 constraint equation g = a₁·b₃.
struct PerpendicularAxes {
  static constexpr char const* name = "PerpendicularAxes";
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 2>>;

  JointAxis first = {};   ///< (3) unit vector a₁, world axes at the reference configuration
  JointAxis second = {};  ///< (3) unit vector b₃, perpendicular to `first`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_of(first.required("PerpendicularAxes: the first axis"),
                                                    second.required("PerpendicularAxes: the second axis"),
                                                    "PerpendicularAxes");
  }
};

/// An axis of b stays parallel to an axis of a. 2 constraint equations g = [a₁·b₃; a₂·b₃].
struct ParallelAxes {
  static constexpr char const* name = "ParallelAxes";
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis axis = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "ParallelAxes: the axis");
  }
};

}  // namespace polybody
