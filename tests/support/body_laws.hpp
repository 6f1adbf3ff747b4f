#pragma once
/// \file
/// The laws that every Body obeys, whatever it is made of. A case says how to build the body:
///
///     struct LrvfCase {
///       static Bar bar();                     // every constant, damping and a placement that is not trivial
///       static planar::Lrvf body(Bar const&);
///     };
///     bool const obeyed = obeys<LrvfCase, BodyLaws>("Lrvf");
///
/// Derivatives are taken with dual numbers along one direction at a time, q ⊞ ε d.

#include <gtest/gtest.h>

#include <cstdint>
#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/body.hpp>
#include <random>
#include <vector>

#include "support/differences.hpp"
#include "support/laws.hpp"

namespace polybody {

template <class V>
auto view(V const& x) {
  return std::span<typename V::Scalar const>(x.data(), std::size_t(x.size()));
}
template <class V>
auto mutable_view(V& x) {
  return std::span<typename V::Scalar>(x.data(), std::size_t(x.size()));
}

/// The ε part of a matrix of Dual<1>.
inline MatX epsilon_of(MatXOf<Dual<1>> const& m) {
  return m.unaryExpr([](Dual<1> const& x) { return x.d[0]; });
}

/// |a − b| against |b|, or against one where b is smaller.
inline double mismatch(MatX const& a, MatX const& b) { return (a - b).norm() / std::max(1.0, b.norm()); }

/// The smallest pivot of L D Lᵀ without exchanges: positive exactly for a positive definite matrix.
inline double smallest_pivot(MatX m) {
  double smallest = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < m.rows(); ++k) {
    smallest = std::min(smallest, m(k, k));
    for (Index i = k + 1; i < m.rows(); ++i)
      for (Index j = k + 1; j < m.rows(); ++j) m(i, j) -= m(i, k) * m(k, j) / m(k, k);
  }
  return smallest;
}

template <class Case>
struct BodyLaws {
  using B = decltype(Case::body(Case::bar()));
  using D = Dual<1>;
  static constexpr bool planar = B::world == World::plane;
  static constexpr bool rolls = B::observes == Observes::frame;  ///< else a marker knows its tangent only
  /// Whether a rigid motion of all its coordinates carries the whole body; a body that says nothing owes it.
  static constexpr bool objective = [] {
    if constexpr (requires { B::objective; })
      return B::objective;
    else
      return true;
  }();
  static constexpr int n = B::element_columns;

  Bar const bar = Case::bar();
  B const body = Case::body(bar);
  Index const nq = body.coordinates(), nv = body.speeds();
  double const length = bar.length;
  BarConstants const c = constants(bar);
  double const total_mass = c.mass_per_length * length;
  Vec3 const middle = bar.placement.origin + bar.placement.axes.col(0) * (0.5 * length);
  std::mt19937 generator{20240607};

  // --- random but fixed -----------------------------------------------------------------------------------

  double number(double size) { return size * (double(generator()) / 2147483648.0 - 1.0); }
  VecX vector(Index size, double scale) {
    return VecX::NullaryExpr(size, [&](Index) { return number(scale); });
  }
  Vec3 vector3() { return vector(3, 1.0); }
  /// A velocity and an angular velocity that the body's world knows.
  Vec3 velocity() { return planar ? Vec3(number(1), number(1), 0.0) : vector3(); }
  Vec3 spin() { return planar ? Vec3(0.0, 0.0, number(1)) : vector3(); }
  /// A configuration far from the undeformed one; a body in space also turns by about a radian.
  /// A case may say `deformation`: the part of it that a formulation for small deformation bears.
  VecX configuration() {
    VecX delta = vector(nv, planar ? 0.3 : 1.0);
    if constexpr (requires { Case::deformation; }) delta.tail(nv - (planar ? 3 : 6)) *= Case::deformation;
    return moved<double>(reference(), delta);
  }
  VecX speeds() { return vector(nv, 1.5); }
  Mat3 turned() { return exp_so3<double>(vector3()); }
  Wrench<double> wrench() { return {vector3() * 5.0, vector3() * 3.0}; }

  /// Points on the axis, at both ends, and off it.
  std::vector<typename B::Point> points() const {
    std::vector<typename B::Point> p = {body.at(0.0), body.at(0.31 * length), body.at(0.5 * length), body.at(length)};
    if constexpr (rolls) {
      p.push_back(body.at(0.5 * length, 0.07));
      p.push_back(body.at(0.77 * length, -0.04));
    }
    if constexpr (B::world == World::space && requires { body.at(0.0, 0.0, 0.0); })
      p.push_back(body.at(0.2 * length, 0.03, -0.05));
    return p;
  }
  typename B::Point point(double s, double y) const {
    if constexpr (rolls)
      return body.at(s, y);
    else
      return body.at(s);
  }
  /// Of a marker's axes, those that it knows.
  static MatX known(Mat3 const& axes) { return axes.leftCols(rolls ? 3 : 1); }

  // --- the body as a whole --------------------------------------------------------------------------------

  VecX reference() const {
    VecX q(nq);
    body.reference(mutable_view(q));
    return q;
  }
  template <class T>
  VecXOf<T> moved(VecX const& q, VecXOf<T> const& delta) const {
    VecXOf<T> const from = q.cast<T>();
    VecXOf<T> to(nq);
    body.template plus<T>(view(from), view(delta), mutable_view(to));
    return to;
  }
  VecX rates(VecX const& delta, VecX const& v) const {
    VecX rate(nv);
    body.template local_rate<double>(view(delta), view(v), mutable_view(rate));
    return rate;
  }
  VecX rigid_velocity(VecX const& q, Vec3 const& v0, Vec3 const& omega) const {
    VecX v(nv);
    body.rigid_velocity(view(q), v0, omega, mutable_view(v));
    return v;
  }

  /// x + ε d, and q ⊞ ε d.
  static VecXOf<D> along(VecX const& x, VecX const& direction) {
    VecXOf<D> out = x.cast<D>();
    for (Index i = 0; i < x.size(); ++i) out[i].d[0] = direction[i];
    return out;
  }
  VecXOf<D> carried(VecX const& q, VecX const& direction) const {
    return moved<D>(q, along(VecX::Zero(nv), direction));
  }

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
  template <class Element>
  double summed(Element&& element) const {
    double sum = 0.0;
    for (Index e = 0; e < body.elements(); ++e) sum += element(e);
    return sum;
  }

  MatX mass(VecX const& q) const {
    return assembled_matrix([&](Index e, auto& m) { body.mass(e, view(q), m); });
  }
  template <class T>
  VecXOf<T> inertia(VecXOf<T> const& q, VecXOf<T> const& a) const {
    return assembled<T>([&](Index e, auto& x) { body.template inertia<T>(e, view(q), view(a), x); });
  }
  template <class T>
  VecXOf<T> force_of(B const& b, VecXOf<T> const& q, VecXOf<T> const& v) const {
    return assembled<T>([&](Index e, auto& x) { b.template force<T>(e, view(q), view(v), x); });
  }
  template <class T>
  VecXOf<T> force(VecXOf<T> const& q, VecXOf<T> const& v) const {
    return force_of<T>(body, q, v);
  }
  VecX force_at_rest(VecX const& q) const { return force<double>(q, VecX::Zero(nv)); }
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
  VecX gravity(VecX const& q, Vec3 const& g) const {
    return assembled<double>([&](Index e, auto& x) { body.template gravity<double>(e, view(q), g, x); });
  }
  double kinetic_energy(VecX const& q, VecX const& v) const {
    return summed([&](Index e) { return body.kinetic_energy(e, view(q), view(v)); });
  }
  double strain_energy(VecX const& q) const {
    return summed([&](Index e) { return body.strain_energy(e, view(q)); });
  }
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

  template <class T>
  struct Seen {
    std::vector<T> memory;  ///< of the Jacobian; moving it keeps its address
    Published<T> marker;
    Mat<T, 6, Eigen::Dynamic> jacobian;  ///< all columns of the body
    Vec<T, 6> twist() const {
      Vec<T, 6> t;
      t << marker.frame.v, marker.frame.w;
      return t;
    }
  };
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

  // --- the laws, each a test -----------------------------------------------------------------------------

  void mass_is_symmetric_and_positive();
  void kinetic_energy_is_half_v_m_v();
  void inertia_is_mass_times_acceleration();
  void constant_mass_does_not_depend_on_the_configuration();
  void total_mass_is_that_of_the_bar();
  void weight_acts_in_the_middle_of_the_bar();
  void weight_is_the_gradient_of_its_energy();
  void reference_is_free_of_force_and_energy();
  void elastic_force_is_the_gradient_of_the_strain_energy();
  void tangent_is_the_derivative_of_the_force_by_position();
  void tangent_is_the_derivative_of_the_force_by_speed();
  void tangent_mixes_its_two_parts_linearly();
  void undamped_force_gives_back_the_strain_energy();
  void plus_of_nothing_changes_nothing();
  void local_rate_moves_the_body_with_its_speeds();
  void rigid_velocity_is_the_field_of_a_rigid_motion();
  void reference_stands_where_the_bar_is_placed();
  void points_outside_the_bar_are_refused();
  void frame_is_orthonormal();
  void twist_is_jacobian_times_speeds();
  void jacobian_is_the_derivative_of_the_frame();
  void bias_is_the_acceleration_at_constant_speeds();
  void load_stiffness_is_the_derivative_of_the_pulled_wrench();
  void own_rows_hold_at_the_reference_and_their_maps_are_derivatives();

  static constexpr char const* suite = "BodyLaws";
  static constexpr Law<BodyLaws> laws[] = {
      {"MassIsSymmetricAndPositive", &BodyLaws::mass_is_symmetric_and_positive},
      {"KineticEnergyIsHalfVMV", &BodyLaws::kinetic_energy_is_half_v_m_v},
      {"InertiaIsMassTimesAcceleration", &BodyLaws::inertia_is_mass_times_acceleration},
      {"ConstantMassDoesNotDependOnTheConfiguration", &BodyLaws::constant_mass_does_not_depend_on_the_configuration},
      {"TotalMassIsThatOfTheBar", &BodyLaws::total_mass_is_that_of_the_bar},
      {"WeightActsInTheMiddleOfTheBar", &BodyLaws::weight_acts_in_the_middle_of_the_bar},
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
      {"ReferenceStandsWhereTheBarIsPlaced", &BodyLaws::reference_stands_where_the_bar_is_placed},
      {"PointsOutsideTheBarAreRefused", &BodyLaws::points_outside_the_bar_are_refused},
      {"FrameIsOrthonormal", &BodyLaws::frame_is_orthonormal},
      {"TwistIsJacobianTimesSpeeds", &BodyLaws::twist_is_jacobian_times_speeds},
      {"JacobianIsTheDerivativeOfTheFrame", &BodyLaws::jacobian_is_the_derivative_of_the_frame},
      {"BiasIsTheAccelerationAtConstantSpeeds", &BodyLaws::bias_is_the_acceleration_at_constant_speeds},
      {"LoadStiffnessIsTheDerivativeOfThePulledWrench",
       &BodyLaws::load_stiffness_is_the_derivative_of_the_pulled_wrench},
      {"OwnRowsHoldAtTheReferenceAndTheirMapsAreDerivatives",
       &BodyLaws::own_rows_hold_at_the_reference_and_their_maps_are_derivatives}};
};

// --- inertia ------------------------------------------------------------------------------------------------

// Where a body owns rows, its mass may be singular across them.
template <class Case>
void BodyLaws<Case>::mass_is_symmetric_and_positive() {
  VecX const q = configuration();
  MatX m = mass(q);
  EXPECT_LT(mismatch(m, m.transpose()), 1e-15);
  if constexpr (OwnsRows<B>) {
    MatX const g = own_map(q);
    m += g.transpose() * g;
  }
  EXPECT_GT(smallest_pivot(m), 1e-6 * m.diagonal().maxCoeff());
}

template <class Case>
void BodyLaws<Case>::kinetic_energy_is_half_v_m_v() {
  VecX const q = configuration(), v = speeds();
  double const expected = 0.5 * v.dot(mass(q) * v);
  EXPECT_NEAR(kinetic_energy(q, v), expected, 1e-14 * expected);
}

template <class Case>
void BodyLaws<Case>::inertia_is_mass_times_acceleration() {
  VecX const q = configuration(), a = speeds();
  VecX const expected = mass(q) * a;
  EXPECT_LT(mismatch(inertia<double>(q, a), expected), 1e-14);
  auto const dual = inertia<Dual<1>>(q.template cast<Dual<1>>(), along(VecX::Zero(nv), a));
  EXPECT_LT(mismatch(epsilon_of(dual), expected), 1e-14);
}

template <class Case>
void BodyLaws<Case>::constant_mass_does_not_depend_on_the_configuration() {
  if (!body.constant_mass) GTEST_SKIP() << "its mass is not constant";
  EXPECT_LT(mismatch(mass(configuration()), mass(configuration())), 1e-14);
}

// In a translation every formulation of one bar has its kinetic energy.
template <class Case>
void BodyLaws<Case>::total_mass_is_that_of_the_bar() {
  VecX const q = configuration();
  Vec3 const v0 = velocity();
  double const expected = 0.5 * total_mass * v0.squaredNorm();
  EXPECT_NEAR(kinetic_energy(q, rigid_velocity(q, v0, Vec3::Zero())), expected, 1e-13 * expected);
}

// --- gravity ------------------------------------------------------------------------------------------------

// Power of the weight in a rigid motion: m g · v0 + (r_c × m g) · ω, r_c the middle of the undeformed bar.
template <class Case>
void BodyLaws<Case>::weight_acts_in_the_middle_of_the_bar() {
  VecX const q = reference();
  Vec3 const v0 = velocity(), omega = spin(), g(0.7, -9.8, 1.3);
  VecX const weight = gravity(q, g);
  double const m = total_mass;
  EXPECT_NEAR(weight.dot(rigid_velocity(q, v0, Vec3::Zero())), m * g.dot(v0), 1e-12 * m);
  EXPECT_NEAR(weight.dot(rigid_velocity(q, Vec3::Zero(), omega)), m * middle.cross(g).dot(omega), 1e-12 * m);
  EXPECT_NEAR(gravity_energy(q, g), -m * g.dot(middle), 1e-12 * m);
}

template <class Case>
void BodyLaws<Case>::weight_is_the_gradient_of_its_energy() {
  VecX const q = configuration();
  Vec3 const g(0.7, -9.8, 1.3);
  VecX const slope = gradient([&](VecX const& at) { return gravity_energy(at, g); }, q);
  EXPECT_LT(mismatch(gravity(q, g), -slope), 1e-10);
}

// --- force ------------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::reference_is_free_of_force_and_energy() {
  VecX const q = reference();
  double size = c.EA + c.EI;
  if constexpr (requires { Case::rounding; }) size *= Case::rounding;  // of coordinates that are transformed
  EXPECT_LT(force_at_rest(q).norm(), 1e-14 * size);
  EXPECT_LT(strain_energy(q), 1e-25 * size);
}

template <class Case>
void BodyLaws<Case>::elastic_force_is_the_gradient_of_the_strain_energy() {
  VecX const q = configuration();
  VecX const slope = gradient([&](VecX const& at) { return strain_energy(at); }, q);
  EXPECT_LT(mismatch(force_at_rest(q), -slope), 1e-8);
}

template <class Case>
void BodyLaws<Case>::tangent_is_the_derivative_of_the_force_by_position() {
  VecX const q = configuration(), v = speeds();
  MatX slope(nv, nv);
  for (Index j = 0; j < nv; ++j)
    slope.col(j) = epsilon_of(force<Dual<1>>(carried(q, VecX::Unit(nv, j)), v.template cast<Dual<1>>()));
  EXPECT_LT(mismatch(tangent(q, v, 1.0, 0.0), -slope), 1e-12);
}

template <class Case>
void BodyLaws<Case>::tangent_is_the_derivative_of_the_force_by_speed() {
  VecX const q = configuration(), v = speeds();
  MatX slope(nv, nv);
  for (Index j = 0; j < nv; ++j)
    slope.col(j) = epsilon_of(force<Dual<1>>(q.template cast<Dual<1>>(), along(v, VecX::Unit(nv, j))));
  EXPECT_LT(mismatch(tangent(q, v, 0.0, 1.0), -slope), 1e-12);
}

template <class Case>
void BodyLaws<Case>::tangent_mixes_its_two_parts_linearly() {
  VecX const q = configuration(), v = speeds();
  MatX const expected = 0.7 * tangent(q, v, 1.0, 0.0) + 31.0 * tangent(q, v, 0.0, 1.0);
  EXPECT_LT(mismatch(tangent(q, v, 0.7, 31.0), expected), 1e-14);
}

// f · v = −U˙ − ½ vᵀ M˙ v without damping: elastic and quadratic-velocity forces keep the energy.
template <class Case>
void BodyLaws<Case>::undamped_force_gives_back_the_strain_energy() {
  Bar undamped = bar;
  undamped.damping = {};
  auto const elastic = Case::body(undamped);
  VecX const q = configuration(), v = speeds();
  double const power = force_of<double>(elastic, q, v).dot(v);
  double const rate = slope_at_zero([&](double h) { return strain_energy(moved<double>(q, v * h)); }, 3e-4);
  double by_mass = 0.0;  // with own rows ⊞ keeps them, which these speeds do not; v · Q_v of Euler parameters is zero
  if constexpr (!OwnsRows<B>)
    by_mass = slope_at_zero([&](double h) { return kinetic_energy(moved<double>(q, v * h), v); }, 3e-4);
  EXPECT_NEAR(power, -rate - by_mass, 1e-8 * (1.0 + std::abs(rate) + std::abs(by_mass)));
}

// --- coordinates ----------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::plus_of_nothing_changes_nothing() {
  VecX const q = configuration(), zero = VecX::Zero(nv), v = speeds();
  EXPECT_LT((moved<double>(q, zero) - q).norm(), 1e-15 * q.norm());
  EXPECT_EQ(rates(zero, v), v);
}

// While q ⊞ δ(t) moves with δ˙ = local_rate(δ, v), every point moves as the speeds v say.
template <class Case>
void BodyLaws<Case>::local_rate_moves_the_body_with_its_speeds() {
  VecX const q = configuration(), v = speeds();
  VecX const delta = vector(nv, 0.8), rate = rates(delta, v);
  VecX const now = moved<double>(q, delta);
  VecXOf<Dual<1>> const passing = moved<Dual<1>>(q, along(delta, rate));
  EXPECT_LT((values_of(passing) - now).norm(), 1e-14);
  for (auto const& p : points()) {
    auto const seen = see<double>(p, Mat3::Identity(), now, v).marker.frame;
    auto const moving = see<Dual<1>>(p, Mat3::Identity(), passing, v.template cast<Dual<1>>()).marker.frame;
    EXPECT_LT(mismatch(epsilon_of(moving.r), seen.v), 1e-13);
    EXPECT_LT(mismatch(known(epsilon_of(moving.A)), known(skew<double>(seen.w) * seen.A)), 1e-13);
  }
}

template <class Case>
void BodyLaws<Case>::rigid_velocity_is_the_field_of_a_rigid_motion() {
  if (!objective) GTEST_SKIP() << "it says that it is not objective";
  VecX const q = configuration();
  Vec3 const v0 = velocity(), omega = spin();
  VecX const v = rigid_velocity(q, v0, omega);
  for (auto const& p : points()) {
    auto const f = see<double>(p, turned(), q, v).marker.frame;
    EXPECT_LT((f.v - v0 - omega.cross(f.r)).norm(), 1e-14);
    Vec3 const apart = f.w - omega, along = f.A.col(0);
    EXPECT_LT((rolls ? apart : (apart - along * along.dot(apart)).eval()).norm(), 1e-14);
  }
}

// --- markers --------------------------------------------------------------------------------------------------

// at(s, y) of the undeformed body is the bar's material point, its axes the bar's.
template <class Case>
void BodyLaws<Case>::reference_stands_where_the_bar_is_placed() {
  VecX const q = reference(), rest = VecX::Zero(nv);
  Mat3 const axes = turned();
  Placement const& place = bar.placement;
  for (double const share : {0.0, 0.2, 1.0 / 3.0, 0.5, 0.9, 1.0})
    for (double const y : {0.0, 0.06}) {
      if (y != 0.0 && !rolls) continue;
      double const s = share * length;
      auto const f = see<double>(point(s, y), axes, q, rest).marker.frame;
      EXPECT_LT((f.r - place.origin - place.axes * Vec3(s, y, 0.0)).norm(), 1e-14) << s;
      EXPECT_LT((f.A - place.axes * (rolls ? axes : Mat3::Identity())).norm(), 1e-14) << s;
      EXPECT_EQ(f.v.norm() + f.w.norm(), 0.0);
    }
}

template <class Case>
void BodyLaws<Case>::points_outside_the_bar_are_refused() {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  for (double const s : {-1e-6, length * 1.000001, nan}) EXPECT_THROW((void)body.at(s), InvalidInput) << s;
  if constexpr (rolls) {
    EXPECT_THROW((void)body.at(0.0, nan), InvalidInput);
  }
  EXPECT_NO_THROW((void)body.at(length * (1 + 1e-15)));  // rounding is forgiven
}

template <class Case>
void BodyLaws<Case>::frame_is_orthonormal() {
  VecX const q = configuration(), v = speeds();
  for (auto const& p : points()) {
    Mat3 const a = see<double>(p, turned(), q, v).marker.frame.A;
    EXPECT_LT((a.transpose() * a - Mat3::Identity()).norm(), 1e-14);
    EXPECT_GT(a.determinant(), 0.0);
  }
}

template <class Case>
void BodyLaws<Case>::twist_is_jacobian_times_speeds() {
  VecX const q = configuration(), v = speeds();
  for (auto const& p : points()) {
    auto const s = see<double>(p, turned(), q, v);
    EXPECT_EQ(s.marker.columns, point_columns(body, p));
    EXPECT_LT(mismatch(s.twist(), s.jacobian * v), 1e-14);
  }
}

// δr = J_r δ and δA = (J_ω δ)~ A under q ⊞ δ.
template <class Case>
void BodyLaws<Case>::jacobian_is_the_derivative_of_the_frame() {
  VecX const q = configuration(), rest = VecX::Zero(nv);
  Mat3 const axes = turned();
  for (auto const& p : points()) {
    auto const s = see<double>(p, axes, q, rest);
    for (Index j = 0; j < nv; ++j) {
      auto const moved = see<Dual<1>>(p, axes, carried(q, VecX::Unit(nv, j)), rest.template cast<Dual<1>>());
      Vec3 const turn = s.jacobian.col(j).template tail<3>();
      EXPECT_LT((epsilon_of(moved.marker.frame.r) - s.jacobian.col(j).template head<3>()).norm(), 1e-13) << j;
      EXPECT_LT(known(epsilon_of(moved.marker.frame.A) - skew<double>(turn) * s.marker.frame.A).norm(), 1e-13) << j;
    }
  }
}

// bias = d/dt (J v) with v˙ = 0, from the Jacobian and, on another path, from the frame's own twist.
template <class Case>
void BodyLaws<Case>::bias_is_the_acceleration_at_constant_speeds() {
  VecX const q = configuration(), v = speeds();
  VecXOf<Dual<1>> const passing = carried(q, rates(VecX::Zero(nv), v));
  for (auto const& p : points()) {
    auto const s = see<double>(p, turned(), q, v);
    auto const moving = see<Dual<1>>(p, Mat3::Identity(), passing, v.template cast<Dual<1>>());
    Vec6 const expected = epsilon_of(moving.jacobian) * v;
    EXPECT_LT(mismatch(s.marker.bias, expected), 1e-13);
    EXPECT_LT(mismatch(s.marker.bias, epsilon_of(moving.twist())), 1e-13);
  }
}

template <class Case>
void BodyLaws<Case>::load_stiffness_is_the_derivative_of_the_pulled_wrench() {
  constexpr int fixed = B::point_columns;
  Index const columns = point_columns(body, points().front());
  VecX const q = configuration();
  VecXOf<Dual<1>> const rest = VecXOf<Dual<1>>::Zero(nv);
  Wrench<double> const w = wrench();
  Mat<Dual<1>, 6, 1> load;
  load << w.f.template cast<Dual<1>>(), w.m.template cast<Dual<1>>();
  for (auto const& p : points()) {
    MatX slope = MatX::Zero(nv, nv), stiffness = slope;
    for (Index j = 0; j < nv; ++j) {
      auto const moved = see<Dual<1>>(p, Mat3::Identity(), carried(q, VecX::Unit(nv, j)), rest);
      VecXOf<Dual<1>> pulled(columns);
      moved.marker.pull(load, pulled);
      slope.col(j).segment(body.first_column(p), columns) = epsilon_of(pulled);
    }
    Mat<double, fixed, fixed> k = Mat<double, fixed, fixed>::Constant(columns, columns, 1e9);
    body.load_stiffness(p, view(q), w, k);
    Index const first = body.first_column(p);
    stiffness.block(first, first, columns, columns) = k;
    EXPECT_LT(mismatch(stiffness, slope), 1e-13);
  }
}

// --- own rows -------------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::own_rows_hold_at_the_reference_and_their_maps_are_derivatives() {
  if constexpr (!OwnsRows<B>) {
    GTEST_SKIP() << "it owns no rows";
  } else {
    constexpr int m = B::own_rows;
    auto const gap = [&]<class T>(VecXOf<T> const& q) {
      Vec<T, m> phi;
      body.template own_gap<T>(view(q), phi);
      return VecXOf<T>(phi);
    };
    EXPECT_LT(gap(reference()).norm(), 1e-15);
    VecX const q = configuration(), v = speeds(), lambda = vector(m, 2.0);
    MatX const g = own_map(q);
    MatX stiffness(nv, nv);
    for (Index j = 0; j < nv; ++j) {
      VecXOf<Dual<1>> const moved = carried(q, VecX::Unit(nv, j));
      EXPECT_LT((epsilon_of(gap(moved)) - g.col(j)).norm(), 1e-14) << j;
      Mat<Dual<1>, m, n> map;
      body.template own_map<Dual<1>>(view(moved), map);
      stiffness.col(j) = epsilon_of(map).transpose() * lambda;
    }
    // γ = Φ̈ − G v̇ = d/dt(G v) at v˙ = 0
    Mat<Dual<1>, m, n> moving;
    VecXOf<Dual<1>> const passing = carried(q, rates(VecX::Zero(nv), v));
    body.template own_map<Dual<1>>(view(passing), moving);
    Vec<double, m> gamma;
    body.template own_gamma<double>(view(q), view(v), gamma);
    EXPECT_LT((gamma - epsilon_of(moving) * v).norm(), 1e-13);
    Mat<double, n, n> k;
    body.own_stiffness(view(q), Vec<double, m>(lambda), k);
    EXPECT_LT(mismatch(k, stiffness), 1e-14);
    // a rigid motion keeps them
    EXPECT_LT((g * rigid_velocity(q, velocity(), spin())).norm(), 1e-14);
  }
}

}  // namespace polybody
