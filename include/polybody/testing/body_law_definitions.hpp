#pragma once
/// \file
/// Definitions of the test functions of `BodyLaws`, which body_laws.hpp declares.
///
/// Requires GoogleTest.

#include <polybody/testing/body_laws.hpp>

namespace polybody::laws {

// --- inertia ------------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::mass_is_symmetric_and_positive() {
  VecX const q = configuration();
  MatX m = mass(q);
  EXPECT_LT(mismatch(m, m.transpose()), 1e-15);
  if constexpr (HasOwnEquations<B>) {
    MatX const g = own_jacobian(q);
    m += g.transpose() * g;
  }
  EXPECT_GT(smallest_pivot(m), 1e-6 * m.diagonal().maxCoeff());
}

template <class Case>
void BodyLaws<Case>::kinetic_energy_is_half_v_m_v() {
  VecX const q = configuration(), v = velocities();
  double const expected = 0.5 * v.dot(mass(q) * v);
  EXPECT_NEAR(kinetic_energy(q, v), expected, 1e-14 * expected);
}

template <class Case>
void BodyLaws<Case>::inertia_is_mass_times_acceleration() {
  VecX const q = configuration(), a = velocities();
  VecX const expected = mass(q) * a;
  EXPECT_LT(mismatch(inertia<double>(q, a), expected), 1e-14);
  auto const dual = inertia<Dual<1>>(q.template cast<Dual<1>>(), along(VecX::Zero(nv), a));
  EXPECT_LT(mismatch(epsilon_of(dual), expected), 1e-14);
}

template <class Case>
void BodyLaws<Case>::constant_mass_does_not_depend_on_the_configuration() {
  EXPECT_LT(mismatch(mass(configuration()), mass(configuration())), 1e-14);
}

template <class Case>
void BodyLaws<Case>::total_mass_is_as_given() {
  VecX const q = configuration();
  Vec3 const v0 = velocity();
  double const expected = 0.5 * Made::mass() * v0.squaredNorm();
  EXPECT_NEAR(kinetic_energy(q, rigid_velocity(q, v0, Vec3::Zero())), expected, 1e-13 * expected);
}

// --- gravity ------------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::weight_acts_at_the_centre_of_mass() {
  VecX const q = reference();
  Vec3 const v0 = velocity(), omega = spin(), g(0.7, -9.8, 1.3);
  VecX const weight = gravity(q, g);
  double const m = Made::mass();
  Vec3 const centre = Made::centre();
  EXPECT_NEAR(weight.dot(rigid_velocity(q, v0, Vec3::Zero())), m * g.dot(v0), 1e-12 * m);
  EXPECT_NEAR(weight.dot(rigid_velocity(q, Vec3::Zero(), omega)), m * centre.cross(g).dot(omega), 1e-12 * m);
  EXPECT_NEAR(gravity_energy(q, g), -m * g.dot(centre), 1e-12 * m);
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
  double size = Made::stiffness();
  if constexpr (requires { Case::rounding; }) size *= Case::rounding;  // round-off of transformed coordinates
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
  VecX const q = configuration(), v = velocities();
  MatX slope(nv, nv);
  for (Index j = 0; j < nv; ++j)
    slope.col(j) = epsilon_of(force<Dual<1>>(carried(q, VecX::Unit(nv, j)), v.template cast<Dual<1>>()));
  EXPECT_LT(mismatch(tangent(q, v, 1.0, 0.0), -slope), 1e-12);
}

template <class Case>
void BodyLaws<Case>::tangent_is_the_derivative_of_the_force_by_speed() {
  VecX const q = configuration(), v = velocities();
  MatX slope(nv, nv);
  for (Index j = 0; j < nv; ++j)
    slope.col(j) = epsilon_of(force<Dual<1>>(q.template cast<Dual<1>>(), along(v, VecX::Unit(nv, j))));
  EXPECT_LT(mismatch(tangent(q, v, 0.0, 1.0), -slope), 1e-12);
}

template <class Case>
void BodyLaws<Case>::tangent_mixes_its_two_parts_linearly() {
  VecX const q = configuration(), v = velocities();
  MatX const expected = 0.7 * tangent(q, v, 1.0, 0.0) + 31.0 * tangent(q, v, 0.0, 1.0);
  EXPECT_LT(mismatch(tangent(q, v, 0.7, 31.0), expected), 1e-14);
}

template <class Case>
void BodyLaws<Case>::undamped_force_gives_back_the_strain_energy() {
  auto const elastic = Made::undamped();
  VecX const q = configuration(), v = velocities();
  double const power = force_of<double>(elastic, q, v).dot(v);
  double const rate = slope_at_zero([&](double h) { return strain_energy(moved<double>(q, v * h)); }, 3e-4);
  // ½ vᵀM˙v. A body with own constraint equations has no power v·Q_v of the quadratic-velocity force Q_v. Differences
  // along ⊞ do not apply, because ⊞ satisfies these equations and v does not.
  double by_mass = 0.0;
  if constexpr (!HasOwnEquations<B>)
    by_mass = slope_at_zero([&](double h) { return kinetic_energy(moved<double>(q, v * h), v); }, 3e-4);
  EXPECT_NEAR(power, -rate - by_mass, 1e-8 * (1.0 + std::abs(rate) + std::abs(by_mass)));
}

// --- coordinates ----------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::plus_of_nothing_changes_nothing() {
  VecX const q = configuration(), zero = VecX::Zero(nv), v = velocities();
  EXPECT_LT((moved<double>(q, zero) - q).norm(), 1e-15 * q.norm());
  EXPECT_EQ(rates(zero, v), v);
}

template <class Case>
void BodyLaws<Case>::local_rate_moves_the_body_with_its_velocities() {
  VecX const q = configuration(), v = velocities();
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
  VecX const q = configuration();
  Vec3 const v0 = velocity(), omega = spin();
  VecX const v = rigid_velocity(q, v0, omega);
  for (auto const& p : points()) {
    auto const f = see<double>(p, turned(), q, v).marker.frame;
    EXPECT_LT((f.v - v0 - omega.cross(f.r)).norm(), 1e-14);
    EXPECT_LT(known_turn(f.w - omega, f.A).norm(), 1e-14);
  }
}

// --- markers --------------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::frame_is_orthonormal() {
  VecX const q = configuration(), v = velocities();
  for (auto const& p : points()) {
    Mat3 const a = see<double>(p, turned(), q, v).marker.frame.A;
    EXPECT_LT((a.transpose() * a - Mat3::Identity()).norm(), 1e-14);
    EXPECT_GT(a.determinant(), 0.0);
  }
}

template <class Case>
void BodyLaws<Case>::twist_is_jacobian_times_velocities() {
  VecX const q = configuration(), v = velocities();
  for (auto const& p : points()) {
    auto const s = see<double>(p, turned(), q, v);
    EXPECT_EQ(s.marker.columns, point_columns(body, p));
    EXPECT_LT(mismatch(s.twist(), s.jacobian * v), 1e-14);
  }
}

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

template <class Case>
void BodyLaws<Case>::bias_is_the_acceleration_at_constant_velocities() {
  VecX const q = configuration(), v = velocities();
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

// --- own constraint equations ---------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::own_rows_hold_at_the_reference_and_their_maps_are_derivatives() {
  if constexpr (HasOwnEquations<B>) {
    constexpr int m = B::own_equations;
    auto const gap = [&]<class T>(VecXOf<T> const& q) {
      Vec<T, m> phi;
      body.template own_constraint<T>(view(q), phi);
      return VecXOf<T>(phi);
    };
    EXPECT_LT(gap(reference()).norm(), 1e-15);
    VecX const q = configuration(), v = velocities(), lambda = vector(m, 2.0);
    MatX const g = own_jacobian(q);
    MatX stiffness(nv, nv);
    for (Index j = 0; j < nv; ++j) {
      VecXOf<Dual<1>> const moved = carried(q, VecX::Unit(nv, j));
      EXPECT_LT((epsilon_of(gap(moved)) - g.col(j)).norm(), 1e-14) << j;
      Mat<Dual<1>, m, n> map;
      body.template own_jacobian<Dual<1>>(view(moved), map);
      stiffness.col(j) = epsilon_of(map).transpose() * lambda;
    }
    // γ = Φ̈ − G v̇ = d/dt(G v) at v˙ = 0
    Mat<Dual<1>, m, n> moving;
    VecXOf<Dual<1>> const passing = carried(q, rates(VecX::Zero(nv), v));
    body.template own_jacobian<Dual<1>>(view(passing), moving);
    Vec<double, m> gamma;
    body.template own_gamma<double>(view(q), view(v), gamma);
    EXPECT_LT((gamma - epsilon_of(moving) * v).norm(), 1e-13);
    Mat<double, n, n> k;
    body.own_stiffness(view(q), Vec<double, m>(lambda), k);
    EXPECT_LT(mismatch(k, stiffness), 1e-14);
    // a rigid motion satisfies the constraint equations
    EXPECT_LT((g * rigid_velocity(q, velocity(), spin())).norm(), 1e-14);
  }
}

// --- bars -----------------------------------------------------------------------------------------------------

template <class Case>
void BodyLaws<Case>::reference_stands_where_the_bar_is_placed() {
  if constexpr (MadeFromBar<Case>) {
    VecX const q = reference(), rest = VecX::Zero(nv);
    Mat3 const axes = turned();
    Placement const place = Case::bar().placement;
    for (double const share : {0.0, 0.2, 1.0 / 3.0, 0.5, 0.9, 1.0})
      for (double const y : {0.0, 0.06}) {
        if (y != 0.0 && !rolls) continue;
        double const s = share * Case::bar().length;
        auto const point = [&] {
          if constexpr (rolls)
            return body.at(s, y);
          else
            return body.at(s);
        }();
        auto const f = see<double>(point, axes, q, rest).marker.frame;
        EXPECT_LT((f.r - place.origin - place.axes * Vec3(s, y, 0.0)).norm(), 1e-14) << s;
        EXPECT_LT((f.A - place.axes * (rolls ? axes : Mat3::Identity())).norm(), 1e-14) << s;
        EXPECT_EQ(f.v.norm() + f.w.norm(), 0.0);
      }
  }
}

template <class Case>
void BodyLaws<Case>::points_outside_the_bar_are_refused() {
  if constexpr (MadeFromBar<Case>) {
    double const nan = std::numeric_limits<double>::quiet_NaN(), length = Case::bar().length;
    for (double const s : {-1e-6, length * 1.000001, nan}) EXPECT_THROW((void)body.at(s), InvalidInput) << s;
    if constexpr (rolls) {
      EXPECT_THROW((void)body.at(0.0, nan), InvalidInput);
    }
    EXPECT_NO_THROW((void)body.at(length * (1 + 1e-15)));  // round-off is accepted
  }
}

}  // namespace polybody::laws
