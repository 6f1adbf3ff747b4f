#pragma once
/// \file
/// The laws that every Body obeys, whatever it is made of. A case says how to build the body, and what the body is to
/// weigh. A body that is made from a Bar is compared with the bar:
///
///     struct LrvfCase {
///       static Bar bar();                     // every constant, damping and a placement that is not trivial
///       static planar::Lrvf body(Bar const&);
///     };
///     bool const lrvf_obeys = obeys<LrvfCase, BodyLaws>("Lrvf");
///
/// Any other body comes with its points and its mass:
///
///     struct DumbbellCase {
///       static Dumbbell body();               // with damping, if it has any
///       static Dumbbell undamped();           // the same without; not needed where there is none
///       static std::vector<Dumbbell::Point> points();
///       static double mass();                 // [kg]
///       static Vec3 centre();                 // of mass, in the reference configuration, world axes [m]
///       static constexpr double stiffness = 900.0;  // the largest of its elastic constants; one where it is not said
///     };
///
/// Derivatives are taken with dual numbers along one direction at a time, q ⊞ ε d.
///
/// Not in polybody.hpp: needs GoogleTest.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include <polybody/math/sequence.hpp>
#include <polybody/testing/body_case.hpp>
#include <polybody/testing/differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// The laws of bodies, for one case.
template <class Case>
struct BodyLaws {
  using Made = BodyOf<Case>;                                        ///< how the case makes its body
  using B = decltype(Made::body());                                 ///< the body's type
  using D = Dual<1>;                                                ///< number with the derivative along one direction
  static constexpr bool planar = B::world == World::plane;          ///< the body moves in a plane
  static constexpr bool rolls = B::observes == Observes::frame;     ///< else a marker knows no axes across its first
  static constexpr bool directed = B::observes != Observes::point;  ///< else it knows no axis at all
  /// Whether a rigid motion of all its coordinates carries the whole body; a body that says nothing owes it.
  static constexpr bool objective = [] {
    if constexpr (requires { B::objective; })
      return B::objective;
    else
      return true;
  }();
  /// Speeds of an element, `Eigen::Dynamic` for one element of run-time size.
  static constexpr int n = B::element_columns;

  B const body = Made::body();                              ///< the body under test, with its damping
  Index const nq = body.coordinates(), nv = body.speeds();  ///< how many coordinates q and speeds v it has
  std::mt19937 generator{20240607};                         ///< source of the random numbers; its seed is fixed

  // --- random but fixed -----------------------------------------------------------------------------------

  /// Random number in [−size, size].
  double number(double size) { return size * (double(generator()) / 2147483648.0 - 1.0); }
  /// Random column (size) with entries in [−scale, scale].
  VecX vector(Index size, double scale) {
    return VecX::NullaryExpr(size, [&](Index) { return number(scale); });
  }
  Vec3 vector3() { return vector(3, 1.0); }  ///< random column (3) in [−1, 1]
  /// A velocity and an angular velocity that the body's world knows.
  Vec3 velocity() { return planar ? Vec3(number(1), number(1), 0.0) : vector3(); }
  /// Random angular velocity (3) that the body's world knows [rad/s].
  Vec3 spin() { return planar ? Vec3(0.0, 0.0, number(1)) : vector3(); }
  /// A configuration far from the undeformed one; a body in space also turns by about a radian.
  /// A case may say `deformation`: the part of it that a formulation for small deformation bears.
  VecX configuration() {
    VecX delta = vector(nv, planar ? 0.3 : 1.0);
    if constexpr (requires { Case::deformation; }) delta.tail(nv - (planar ? 3 : 6)) *= Case::deformation;
    return moved<double>(reference(), delta);
  }
  VecX speeds() { return vector(nv, 1.5); }                               ///< random speeds (nv) in [−1.5, 1.5]
  Mat3 turned() { return exp_so3<double>(vector3()); }                    ///< random rotation (3×3)
  Wrench<double> wrench() { return {vector3() * 5.0, vector3() * 3.0}; }  ///< random force [N] and moment [N m]

  /// The case's points; of a bar some on the axis, at both ends, and off it.
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
  /// The axes that a marker knows.
  static MatX known(Mat3 const& axes) { return axes.leftCols(rolls ? 3 : directed ? 1 : 0); }
  /// The part of an angular velocity w (3) (or its error) that a marker knows: none along its axis where it has one
  /// only.
  static Vec3 known_turn(Vec3 const& w, Mat3 const& axes) {
    if (!directed) return Vec3::Zero();
    Vec3 const along = axes.col(0);
    return rolls ? w : Vec3(w - along * along.dot(w));
  }

  // --- the body as a whole --------------------------------------------------------------------------------

  /// Coordinates q (nq) of the undeformed body as placed.
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
  /// The rate δ˙ (nv) with which q ⊞ δ moves at the speeds v.
  VecX rates(VecX const& delta, VecX const& v) const {
    VecX rate(nv);
    body.template local_rate<double>(view(delta), view(v), mutable_view(rate));
    return rate;
  }
  /// Speeds (nv) of a rigid motion: v0 of the body-fixed point at the world's origin, omega in world axes.
  VecX rigid_velocity(VecX const& q, Vec3 const& v0, Vec3 const& omega) const {
    VecX v(nv);
    body.rigid_velocity(view(q), v0, omega, mutable_view(v));
    return v;
  }

  /// x + ε d, and q ⊞ ε d, d being `direction`.
  static VecXOf<D> along(VecX const& x, VecX const& direction) {
    VecXOf<D> out = x.cast<D>();
    for (Index i = 0; i < x.size(); ++i) out[i].d[0] = direction[i];
    return out;
  }
  /// q ⊞ ε d (nq) in dual numbers, d the direction.
  VecXOf<D> carried(VecX const& q, VecX const& direction) const {
    return moved<D>(q, along(VecX::Zero(nv), direction));
  }

  /// Sum over the elements (nv): element(e, x) writes the column of element e into x.
  template <class T, class Element>
  VecXOf<T> assembled(Element&& element) const {
    VecXOf<T> sum = VecXOf<T>::Zero(nv);
    for (Index e = 0; e < body.elements(); ++e) {
      Vec<T, n> x = Vec<T, n>::Constant(element_columns(body), T(1e9));  // whatever stood there must be overwritten
      element(e, x);
      sum.segment(body.first_column(e), x.size()) += x;
    }
    return sum;
  }
  /// Sum over the elements (nv×nv): element(e, m) writes the matrix of element e into m.
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
  /// Sum over the elements of the number element(e).
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
  /// M a (nv), from the body's `inertia`.
  template <class T>
  VecXOf<T> inertia(VecXOf<T> const& q, VecXOf<T> const& a) const {
    return assembled<T>([&](Index e, auto& x) { body.template inertia<T>(e, view(q), view(a), x); });
  }
  /// Elastic, damping and quadratic-velocity force f (nv) of a body b.
  template <class T>
  VecXOf<T> force_of(B const& b, VecXOf<T> const& q, VecXOf<T> const& v) const {
    return assembled<T>([&](Index e, auto& x) { b.template force<T>(e, view(q), view(v), x); });
  }
  /// The force f (nv) of the body under test.
  template <class T>
  VecXOf<T> force(VecXOf<T> const& q, VecXOf<T> const& v) const {
    return force_of<T>(body, q, v);
  }
  VecX force_at_rest(VecX const& q) const { return force<double>(q, VecX::Zero(nv)); }  ///< f (nv) at v = 0
  /// The body's `tangent`, −(ck ∂f/∂q + cd ∂f/∂v) (nv×nv).
  MatX tangent(VecX const& q, VecX const& v, double ck, double cd) const {
    return assembled_matrix([&](Index e, auto& k) { body.tangent(e, view(q), view(v), ck, cd, k); });
  }
  /// G of the body's own rows.
  MatX own_map(VecX const& q) const
    requires OwnsRows<B>
  {
    Mat<double, B::own_rows, n> g;
    body.template own_map<double>(view(q), g);
    return g;
  }
  /// Force of the weight (nv) in the field g [m/s²].
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
  /// Energy of the weight in the field g [J].
  double gravity_energy(VecX const& q, Vec3 const& g) const {
    return summed([&](Index e) { return body.gravity_energy(e, view(q), g); });
  }

  /// ∂f/∂δ at δ = 0 of a number that depends on q ⊞ δ, by differences.
  template <class F>
  VecX gradient(F&& f, VecX const& q) const {
    VecX out(nv);
    for (Index j = 0; j < nv; ++j)
      out[j] = slope_at_zero([&](double h) { return f(moved<double>(q, VecX::Unit(nv, j) * h)); });
    return out;
  }

  // --- a marker -------------------------------------------------------------------------------------------

  /// A published marker, with its Jacobian over all columns of the body.
  template <class T>
  struct Seen {
    Sequence<T> memory;                  ///< of the Jacobian; moving it keeps its address
    Published<T> marker;                 ///< what `publish` wrote
    Mat<T, 6, Eigen::Dynamic> jacobian;  ///< all columns of the body
    /// Velocity [m/s] and angular velocity [rad/s] of the marker, world axes: [ṙ; ω].
    Vec<T, 6> twist() const {
      Vec<T, 6> t;
      t << marker.frame.v, marker.frame.w;
      return t;
    }
  };
  /// The marker at point p in the state q, v. Its axes in the body's are `axes` if a marker of the body knows all
  /// three.
  template <class T>
  Seen<T> see(typename B::Point const& p, Mat3 const& axes, VecXOf<T> const& q, VecXOf<T> const& v) const {
    Seen<T> s;
    s.memory.assign(std::size_t(6 * point_columns(body, p)), T(1e9));
    s.marker.jacobian = s.memory.data();
    s.marker.bias.setConstant(T(1e9));
    body.template publish<T>(p, rolls ? axes : Mat3::Identity(), view(q), view(v), s.marker);
    s.jacobian = Mat<T, 6, Eigen::Dynamic>::Zero(6, nv);
    s.jacobian.middleCols(body.first_column(p), s.marker.columns) = s.marker.full();
    return s;
  }

  // --- the laws, each a test ------------------------------------------------------------------------------

  /// M = Mᵀ and vᵀM v > 0; where a body owns rows, M + GᵀG is positive definite.
  void mass_is_symmetric_and_positive();
  /// T = ½ vᵀM v.
  void kinetic_energy_is_half_v_m_v();
  /// `inertia` = M a, in double and in dual numbers.
  void inertia_is_mass_times_acceleration();
  /// ∂M/∂q = 0 where the body says `constant_mass`.
  void constant_mass_does_not_depend_on_the_configuration();
  /// T = ½ m v₀² in a translation with v₀.
  void total_mass_is_as_given();
  /// Power of the weight in a rigid motion: m g·v₀ + (c × m g)·ω, and U = −m g·c, with the centre of mass at c.
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
  /// f·v = −U˙ − ½ vᵀM˙v without damping: elastic and quadratic-velocity forces keep the energy.
  void undamped_force_gives_back_the_strain_energy();
  /// q ⊞ 0 = q, and δ˙ = v at δ = 0.
  void plus_of_nothing_changes_nothing();
  /// While q ⊞ δ(t) moves with δ˙ = `local_rate`(δ, v), every point moves as the speeds v say.
  void local_rate_moves_the_body_with_its_speeds();
  /// With v = `rigid_velocity`(q, v₀, ω) every point has ṙ = v₀ + ω × r and the angular velocity ω.
  void rigid_velocity_is_the_field_of_a_rigid_motion();
  /// AᵀA = 1, det A > 0.
  void frame_is_orthonormal();
  /// [ṙ; ω] = J v.
  void twist_is_jacobian_times_speeds();
  /// δr = J_r δ and δA = (J_ω δ)~ A under q ⊞ δ.
  void jacobian_is_the_derivative_of_the_frame();
  /// bias = d/dt (J v) at v˙ = 0, from the Jacobian and, on another path, from the frame's own twist.
  void bias_is_the_acceleration_at_constant_speeds();
  /// `load_stiffness` = ∂(Jᵀw)/∂q of a wrench w that stands still.
  void load_stiffness_is_the_derivative_of_the_pulled_wrench();
  /// Φ(q₀) = 0, G = ∂Φ/∂q, γ = d/dt (G v) at v˙ = 0, `own_stiffness` = ∂(Gᵀλ)/∂q, of a body that owns rows.
  void own_rows_hold_at_the_reference_and_their_maps_are_derivatives();
  /// at(s, y) of the undeformed body is the bar's material point, its axes the bar's.
  void reference_stands_where_the_bar_is_placed();
  /// at(s) throws for s outside [0, L], but forgives rounding.
  void points_outside_the_bar_are_refused();

  static constexpr char const* suite = "BodyLaws";
  /// All laws, the two of bodies made from a bar last.
  static constexpr Law<BodyLaws> all[] = {
      {"MassIsSymmetricAndPositive", &BodyLaws::mass_is_symmetric_and_positive},
      {"KineticEnergyIsHalfVMV", &BodyLaws::kinetic_energy_is_half_v_m_v},
      {"InertiaIsMassTimesAcceleration", &BodyLaws::inertia_is_mass_times_acceleration},
      {"ConstantMassDoesNotDependOnTheConfiguration", &BodyLaws::constant_mass_does_not_depend_on_the_configuration},
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
      {"LocalRateMovesTheBodyWithItsSpeeds", &BodyLaws::local_rate_moves_the_body_with_its_speeds},
      {"RigidVelocityIsTheFieldOfARigidMotion", &BodyLaws::rigid_velocity_is_the_field_of_a_rigid_motion},
      {"FrameIsOrthonormal", &BodyLaws::frame_is_orthonormal},
      {"TwistIsJacobianTimesSpeeds", &BodyLaws::twist_is_jacobian_times_speeds},
      {"JacobianIsTheDerivativeOfTheFrame", &BodyLaws::jacobian_is_the_derivative_of_the_frame},
      {"BiasIsTheAccelerationAtConstantSpeeds", &BodyLaws::bias_is_the_acceleration_at_constant_speeds},
      {"LoadStiffnessIsTheDerivativeOfThePulledWrench",
       &BodyLaws::load_stiffness_is_the_derivative_of_the_pulled_wrench},
      {"OwnRowsHoldAtTheReferenceAndTheirMapsAreDerivatives",
       &BodyLaws::own_rows_hold_at_the_reference_and_their_maps_are_derivatives},
      {"ReferenceStandsWhereTheBarIsPlaced", &BodyLaws::reference_stands_where_the_bar_is_placed},
      {"PointsOutsideTheBarAreRefused", &BodyLaws::points_outside_the_bar_are_refused}};
  /// The last two are of bars.
  static constexpr std::span<Law<BodyLaws> const> laws{all, std::size(all) - (MadeFromBar<Case> ? 0 : 2)};
};

}  // namespace polybody::laws

#include <polybody/testing/body_law_definitions.hpp>
