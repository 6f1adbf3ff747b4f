#pragma once
/// \file
/// Tests of properties that every body has, such as derivatives, inertia and energy: `BodyLaws`.
///
/// Requires GoogleTest.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include <polybody/math/sequence.hpp>
#include <polybody/testing/body_case.hpp>
#include <polybody/testing/differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Laws that every Body satisfies. A case gives the body and its mass.
///
/// A body that is made from a Bar is compared with the bar:
///
///     struct LrvfCase {
///       static Bar bar();  // all constants, damping and a general placement
///       static planar::Lrvf body(Bar const&);
///     };
///     bool const lrvf_obeys = obeys<LrvfCase, BodyLaws>("Lrvf");
///
/// For any other body, the case gives points and reference values:
///
///     struct DumbbellCase {
///       static Dumbbell body();                     // with damping, if it has any
///       static Dumbbell undamped();                 // the same body without damping; optional if it has none
///       static std::vector<Dumbbell::Point> points();
///       static double mass();                       // [kg]
///       static Vec3 centre();                       // centre of mass in the reference configuration, world axes [m]
///       static constexpr double stiffness = 900.0;  // largest elastic constant; 1 if omitted
///     };
///
/// Derivatives of forces and frames are computed with dual numbers, q ⊞ ε d along one direction d at a time.
/// Derivatives of energies are computed by differences.
template <class Case>
struct BodyLaws {
  using Made = BodyOf<Case>;                                ///< functions that create the body of the case
  using B = decltype(Made::body());                         ///< type of the body
  using D = Dual<1>;                                        ///< dual number with the derivative along one direction
  static constexpr bool planar = B::world == World::plane;  ///< true if the body moves in a plane
  static constexpr bool rolls = B::observes == MarkerKind::frame;     ///< true if markers have three axes
  static constexpr bool directed = B::observes != MarkerKind::point;  ///< true if markers have an axis
  /// True if the coordinates can represent every rigid motion of the body without strain. A body without the member
  /// `objective` is taken as objective.
  static constexpr bool objective = [] {
    if constexpr (requires { B::objective; })
      return B::objective;
    else
      return true;
  }();
  /// Number of generalised velocities of an element; `Eigen::Dynamic` if it is set at run time.
  static constexpr int n = B::element_columns;

  B const body = Made::body();                                  ///< body under test, with its damping
  Index const nq = body.coordinates(), nv = body.velocities();  ///< numbers of coordinates q and velocities v
  std::mt19937 generator{20240607};                             ///< source of the random numbers; its seed is fixed

  // --- random numbers with a fixed seed -------------------------------------------------------------------

  /// Random number in [−size, size].
  double number(double size) { return size * (double(generator()) / 2147483648.0 - 1.0); }
  /// Random column (size) with entries in [−scale, scale].
  VecX vector(Index size, double scale) {
    return VecX::NullaryExpr(size, [&](Index) { return number(scale); });
  }
  Vec3 vector3() { return vector(3, 1.0); }  ///< random column (3) in [−1, 1]
  /// Random velocity (3), in the plane for a planar body [m/s].
  Vec3 velocity() { return planar ? Vec3(number(1), number(1), 0.0) : vector3(); }
  /// Random angular velocity (3), about z for a planar body [rad/s].
  Vec3 spin() { return planar ? Vec3(0.0, 0.0, number(1)) : vector3(); }
  /// Configuration far from the undeformed one; a body in space also rotates by about one radian. For a formulation
  /// that is limited to small deformations, a case may define the factor `deformation`, by which the deformation is
  /// multiplied.
  VecX configuration() {
    VecX delta = vector(nv, planar ? 0.3 : 1.0);
    if constexpr (requires { Case::deformation; }) delta.tail(nv - (planar ? 3 : 6)) *= Case::deformation;
    return moved<double>(reference(), delta);
  }
  VecX velocities() { return vector(nv, 1.5); }         ///< random generalised velocities (nv) in [−1.5, 1.5]
  Mat3 turned() { return exp_so3<double>(vector3()); }  ///< random rotation (3×3)
  Wrench<double> wrench() { return {vector3() * 5.0, vector3() * 3.0}; }  ///< random force [N] and moment [N m]

  /// Points of the case. For a bar: points on the axis, at both ends, and off the axis.
  std::vector<typename B::Point> points() const {
    if constexpr (MadeFromBar<Case>) {
      double const length = Case::bar().length;
      std::vector<typename B::Point> p = {body.at(0.0), body.at(0.31 * length), body.at(0.5 * length), body.at(length)};
      if constexpr (rolls) {
        p.push_back(body.at(0.5 * length, 0.07));
        p.push_back(body.at(0.77 * length, -0.04));
      }
      if constexpr (B::world == World::space && requires { body.at(0.0, 0.0, 0.0); })
        p.push_back(body.at(0.2 * length, 0.03, -0.05));
      return p;
    } else {
      return Case::points();
    }
  }
  /// Columns of `axes` that a marker of this body provides: three, one or none.
  static MatX known(Mat3 const& axes) { return axes.leftCols(rolls ? 3 : directed ? 1 : 0); }
  /// Component of an angular velocity w (3), or of its error, that a marker of this body provides. A marker with one
  /// axis does not provide the component along this axis.
  static Vec3 known_turn(Vec3 const& w, Mat3 const& axes) {
    if (!directed) return Vec3::Zero();
    Vec3 const along = axes.col(0);
    return rolls ? w : Vec3(w - along * along.dot(w));
  }

  // --- the whole body -------------------------------------------------------------------------------------

  /// Coordinates q (nq) of the undeformed body at its placement.
  VecX reference() const {
    VecX q(nq);
    body.reference(mutable_view(q));
    return q;
  }
  /// q ⊞ δ (nq), in double or in dual numbers.
  template <class T>
  VecXOf<T> moved(VecX const& q, VecXOf<T> const& delta) const {
    VecXOf<T> const from = q.cast<T>();
    VecXOf<T> to(nq);
    body.template plus<T>(view(from), view(delta), mutable_view(to));
    return to;
  }
  /// Rate δ˙ (nv) with which q ⊞ δ moves at the generalised velocities v.
  VecX rates(VecX const& delta, VecX const& v) const {
    VecX rate(nv);
    body.template local_rate<double>(view(delta), view(v), mutable_view(rate));
    return rate;
  }
  /// Generalised velocities (nv) of a rigid motion. v0 is the velocity of the body-fixed point at the world's origin,
  /// and omega is the angular velocity in world axes.
  VecX rigid_velocity(VecX const& q, Vec3 const& v0, Vec3 const& omega) const {
    VecX v(nv);
    body.rigid_velocity(view(q), v0, omega, mutable_view(v));
    return v;
  }

  /// Dual numbers x + ε d, with d = `direction`.
  static VecXOf<D> along(VecX const& x, VecX const& direction) {
    VecXOf<D> out = x.cast<D>();
    for (Index i = 0; i < x.size(); ++i) out[i].d[0] = direction[i];
    return out;
  }
  /// Coordinates q ⊞ ε d (nq) in dual numbers, with d = `direction`.
  VecXOf<D> carried(VecX const& q, VecX const& direction) const {
    return moved<D>(q, along(VecX::Zero(nv), direction));
  }

  /// Sum (nv) of element vectors; `element(e, x)` writes the vector of element e to x.
  template <class T, class Element>
  VecXOf<T> assembled(Element&& element) const {
    VecXOf<T> sum = VecXOf<T>::Zero(nv);
    for (Index e = 0; e < body.elements(); ++e) {
      Vec<T, n> x = Vec<T, n>::Constant(element_columns(body), T(1e9));  // all entries must be overwritten
      element(e, x);
      sum.segment(body.first_column(e), x.size()) += x;
    }
    return sum;
  }
  /// Sum (nv×nv) of element matrices; `element(e, m)` writes the matrix of element e to m.
  template <class Element>
  MatX assembled_matrix(Element&& element) const {
    MatX sum = MatX::Zero(nv, nv);
    for (Index e = 0; e < body.elements(); ++e) {
      Index const size = element_columns(body);
      Mat<double, n, n> m = Mat<double, n, n>::Constant(size, size, 1e9);
      element(e, m);
      sum.block(body.first_column(e), body.first_column(e), size, size) += m;
    }
    return sum;
  }
  /// Sum of the numbers `element(e)` over all elements e.
  template <class Element>
  double summed(Element&& element) const {
    double sum = 0.0;
    for (Index e = 0; e < body.elements(); ++e) sum += element(e);
    return sum;
  }

  /// Mass matrix M (nv×nv).
  MatX mass(VecX const& q) const {
    return assembled_matrix([&](Index e, auto& m) { body.mass(e, view(q), m); });
  }
  /// Product M a (nv), from the body's `inertia`.
  template <class T>
  VecXOf<T> inertia(VecXOf<T> const& q, VecXOf<T> const& a) const {
    return assembled<T>([&](Index e, auto& x) { body.template inertia<T>(e, view(q), view(a), x); });
  }
  /// Elastic, damping and quadratic-velocity force f (nv) of the body b.
  template <class T>
  VecXOf<T> force_of(B const& b, VecXOf<T> const& q, VecXOf<T> const& v) const {
    return assembled<T>([&](Index e, auto& x) { b.template force<T>(e, view(q), view(v), x); });
  }
  /// Force f (nv) of the body under test.
  template <class T>
  VecXOf<T> force(VecXOf<T> const& q, VecXOf<T> const& v) const {
    return force_of<T>(body, q, v);
  }
  VecX force_at_rest(VecX const& q) const { return force<double>(q, VecX::Zero(nv)); }  ///< f (nv) at v = 0
  /// Tangent of the body, −(ck ∂f/∂q + cd ∂f/∂v) (nv×nv), from its `tangent`.
  MatX tangent(VecX const& q, VecX const& v, double ck, double cd) const {
    return assembled_matrix([&](Index e, auto& k) { body.tangent(e, view(q), view(v), ck, cd, k); });
  }
  /// Constraint Jacobian G of the body's own constraint equations.
  MatX own_jacobian(VecX const& q) const
    requires HasOwnEquations<B>
  {
    Mat<double, B::own_equations, n> g;
    body.template own_jacobian<double>(view(q), g);
    return g;
  }
  /// Generalised force of the weight (nv) in the field g [m/s²].
  VecX gravity(VecX const& q, Vec3 const& g) const {
    return assembled<double>([&](Index e, auto& x) { body.template gravity<double>(e, view(q), g, x); });
  }
  /// Kinetic energy T [J].
  double kinetic_energy(VecX const& q, VecX const& v) const {
    return summed([&](Index e) { return body.kinetic_energy(e, view(q), view(v)); });
  }
  /// Elastic energy U [J].
  double strain_energy(VecX const& q) const {
    return summed([&](Index e) { return body.strain_energy(e, view(q)); });
  }
  /// Potential energy of the weight in the field g [J].
  double gravity_energy(VecX const& q, Vec3 const& g) const {
    return summed([&](Index e) { return body.gravity_energy(e, view(q), g); });
  }

  /// Derivative ∂f/∂δ (nv) at δ = 0 of a scalar function f(q ⊞ δ), by differences.
  template <class F>
  VecX gradient(F&& f, VecX const& q) const {
    VecX out(nv);
    for (Index j = 0; j < nv; ++j)
      out[j] = slope_at_zero([&](double h) { return f(moved<double>(q, VecX::Unit(nv, j) * h)); });
    return out;
  }

  // --- markers --------------------------------------------------------------------------------------------

  /// Marker kinematics, with the Jacobian over all columns of the body.
  template <class T>
  struct Seen {
    Sequence<T> memory;                  ///< memory of `marker.jacobian`; a move keeps its address
    MarkerKinematics<T> marker;          ///< result of `evaluate_marker`
    Mat<T, 6, Eigen::Dynamic> jacobian;  ///< Jacobian over all columns of the body
    /// Twist of the marker [ṙ; ω] in world axes [m/s], [rad/s].
    Vec<T, 6> twist() const {
      Vec<T, 6> t;
      t << marker.frame.v, marker.frame.w;
      return t;
    }
  };
  /// Kinematics of a marker at point p for the coordinates q and the velocities v. If markers of the body have three
  /// axes, this marker has the axes `axes`.
  template <class T>
  Seen<T> see(typename B::Point const& p, Mat3 const& axes, VecXOf<T> const& q, VecXOf<T> const& v) const {
    Seen<T> s;
    s.memory.assign(std::size_t(6 * point_columns(body, p)), T(1e9));
    s.marker.jacobian = s.memory.data();
    s.marker.bias.setConstant(T(1e9));
    body.template evaluate_marker<T>(p, rolls ? axes : Mat3::Identity(), view(q), view(v), s.marker);
    s.jacobian = Mat<T, 6, Eigen::Dynamic>::Zero(6, nv);
    s.jacobian.middleCols(body.first_column(p), s.marker.columns) = s.marker.full();
    return s;
  }

  // --- laws, each of them a test --------------------------------------------------------------------------

  /// M = Mᵀ and vᵀM v > 0. If the body has own constraint equations, M + GᵀG is positive definite.
  void mass_is_symmetric_and_positive();
  /// T = ½ vᵀM v.
  void kinetic_energy_is_half_v_m_v();
  /// `inertia` = M a, in double and in dual numbers.
  void inertia_is_mass_times_acceleration();
  /// ∂M/∂q = 0 if the body declares `constant_mass`.
  void constant_mass_does_not_depend_on_the_configuration();
  /// T = ½ m v₀² for a translation with v₀.
  void total_mass_is_as_given();
  /// The power of the weight in a rigid motion is m g·v₀ + (c × m g)·ω, and U = −m g·c, for the centre of mass c.
  void weight_acts_at_the_centre_of_mass();
  /// `gravity` = −∂U/∂q.
  void weight_is_the_gradient_of_its_energy();
  /// f = 0 and U = 0 in the reference configuration, at rest.
  void reference_is_free_of_force_and_energy();
  /// f(q, 0) = −∂U/∂q, by differences along q ⊞ δ.
  void elastic_force_is_the_gradient_of_the_strain_energy();
  /// `tangent`(1, 0) = −∂f/∂q along q ⊞ δ.
  void tangent_is_the_derivative_of_the_force_by_position();
  /// `tangent`(0, 1) = −∂f/∂v.
  void tangent_is_the_derivative_of_the_force_by_speed();
  /// `tangent`(ck, cd) = ck `tangent`(1, 0) + cd `tangent`(0, 1).
  void tangent_mixes_its_two_parts_linearly();
  /// f·v = −U˙ − ½ vᵀM˙v for the body without damping: elastic and quadratic-velocity forces conserve the energy.
  void undamped_force_gives_back_the_strain_energy();
  /// q ⊞ 0 = q, and δ˙ = v at δ = 0.
  void plus_of_nothing_changes_nothing();
  /// If q ⊞ δ(t) moves with δ˙ = `local_rate`(δ, v), each point has the velocity that belongs to v.
  void local_rate_moves_the_body_with_its_velocities();
  /// For v = `rigid_velocity`(q, v₀, ω) every point of an objective body has ṙ = v₀ + ω × r and the angular velocity ω.
  void rigid_velocity_is_the_field_of_a_rigid_motion();
  /// AᵀA = 1, det A > 0.
  void frame_is_orthonormal();
  /// [ṙ; ω] = J v.
  void twist_is_jacobian_times_velocities();
  /// δr = J_r δ and δA = (J_ω δ)~ A under q ⊞ δ.
  void jacobian_is_the_derivative_of_the_frame();
  /// The marker's `bias` is d/dt (J v) at v˙ = 0, computed from the Jacobian and from the frame's twist.
  void bias_is_the_acceleration_at_constant_velocities();
  /// `load_stiffness` = ∂(Jᵀw)/∂q for a constant wrench w.
  void load_stiffness_is_the_derivative_of_the_pulled_wrench();
  /// Φ(q₀) = 0, G = ∂Φ/∂q, γ = d/dt (G v) at v˙ = 0 and `own_stiffness` = ∂(Gᵀλ)/∂q for a body with own constraint
  /// equations.
  void own_rows_hold_at_the_reference_and_their_maps_are_derivatives();
  /// The point at(s, y) of the undeformed body has the position and the axes of the point (s, y) of the bar.
  void reference_stands_where_the_bar_is_placed();
  /// at(s) throws for s outside of [0, L], with a tolerance for round-off.
  void points_outside_the_bar_are_refused();

  static constexpr char const* suite = "BodyLaws";
  static constexpr Law<BodyLaws> laws[] = {
      {"MassIsSymmetricAndPositive", &BodyLaws::mass_is_symmetric_and_positive},
      {"KineticEnergyIsHalfVMV", &BodyLaws::kinetic_energy_is_half_v_m_v},
      {"InertiaIsMassTimesAcceleration", &BodyLaws::inertia_is_mass_times_acceleration},
      {"ConstantMassDoesNotDependOnTheConfiguration", &BodyLaws::constant_mass_does_not_depend_on_the_configuration,
       B::constant_mass},
      {"TotalMassIsAsGiven", &BodyLaws::total_mass_is_as_given},
      {"WeightActsAtTheCentreOfMass", &BodyLaws::weight_acts_at_the_centre_of_mass},
      {"WeightIsTheGradientOfItsEnergy", &BodyLaws::weight_is_the_gradient_of_its_energy},
      {"ReferenceIsFreeOfForceAndEnergy", &BodyLaws::reference_is_free_of_force_and_energy},
      {"ElasticForceIsTheGradientOfTheStrainEnergy", &BodyLaws::elastic_force_is_the_gradient_of_the_strain_energy},
      {"TangentIsTheDerivativeOfTheForceByPosition", &BodyLaws::tangent_is_the_derivative_of_the_force_by_position},
      {"TangentIsTheDerivativeOfTheForceBySpeed", &BodyLaws::tangent_is_the_derivative_of_the_force_by_speed},
      {"TangentMixesItsTwoPartsLinearly", &BodyLaws::tangent_mixes_its_two_parts_linearly},
      {"UndampedForceGivesBackTheStrainEnergy", &BodyLaws::undamped_force_gives_back_the_strain_energy},
      {"PlusOfNothingChangesNothing", &BodyLaws::plus_of_nothing_changes_nothing},
      {"LocalRateMovesTheBodyWithItsSpeeds", &BodyLaws::local_rate_moves_the_body_with_its_velocities},
      {"RigidVelocityIsTheFieldOfARigidMotion", &BodyLaws::rigid_velocity_is_the_field_of_a_rigid_motion, objective},
      {"FrameIsOrthonormal", &BodyLaws::frame_is_orthonormal},
      {"TwistIsJacobianTimesSpeeds", &BodyLaws::twist_is_jacobian_times_velocities},
      {"JacobianIsTheDerivativeOfTheFrame", &BodyLaws::jacobian_is_the_derivative_of_the_frame},
      {"BiasIsTheAccelerationAtConstantSpeeds", &BodyLaws::bias_is_the_acceleration_at_constant_velocities},
      {"LoadStiffnessIsTheDerivativeOfThePulledWrench",
       &BodyLaws::load_stiffness_is_the_derivative_of_the_pulled_wrench},
      {"OwnRowsHoldAtTheReferenceAndTheirMapsAreDerivatives",
       &BodyLaws::own_rows_hold_at_the_reference_and_their_maps_are_derivatives, HasOwnEquations<B>},
      {"ReferenceStandsWhereTheBarIsPlaced", &BodyLaws::reference_stands_where_the_bar_is_placed, MadeFromBar<Case>},
      {"PointsOutsideTheBarAreRefused", &BodyLaws::points_outside_the_bar_are_refused, MadeFromBar<Case>}};
};

}  // namespace polybody::laws

#include <polybody/testing/body_law_definitions.hpp>
