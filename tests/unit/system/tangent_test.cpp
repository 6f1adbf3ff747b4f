// The tangent and the derivatives of constraint functions of full models, against dual numbers and against
// differences of the residual and the constraint functions.
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/system/system.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "support/mixed_models.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace tangent_test {

using D = Dual<1>;

/// x + ε d.
VecXOf<D> along(VecX const& x, VecX const& d) {
  VecXOf<D> out = x.cast<D>();
  for (Index i = 0; i < x.size(); ++i) out[i].d[0] = d[i];
  return out;
}

/// Inputs of the tests, for a model of any type.
struct Asked {
  std::function<State(unsigned)> state;
  std::function<VecX(VecX const& q, VecX const& delta)> plus;
  std::function<VecX(State const&)> residual, violation, violation_rate, acceleration_bias;
  std::function<MatX(State const&, TangentCoefficients, SecondOrder)> tangent;
  std::function<Sequence<Block>(State const&, TangentCoefficients, SecondOrder)> pattern;
  /// Derivative of the residual along q ⊞ ε dq, v + ε dv, by dual numbers.
  std::function<VecX(State const&, VecX const& dq, VecX const& dv)> slope;
};

/// Loads and gravity have the load factor 0.7.
template <class M>
Asked ask(M const& m) {
  auto const model = std::make_shared<M const>(m);
  auto const system = std::make_shared<System>(*model);
  system->load_factor = 0.7;
  auto const at = [model, system](State const& x) -> System& {
    system->evaluate(x.q, x.v, x.t);
    return *system;
  };
  auto const rows = [at](auto&& write) {
    return [at, write](State const& x) {
      VecX y = VecX::Constant(x.lambda.size(), 1e9);
      write(at(x), y);
      return y;
    };
  };
  Asked a;
  a.state = [model](unsigned seed) { return scrambled(*model, seed); };
  a.plus = [system](VecX const& q, VecX const& delta) {
    VecX out = q;
    system->plus(q, delta, out);
    return out;
  };
  a.residual = [at](State const& x) {
    VecX r = VecX::Constant(x.v.size(), 1e9);
    at(x).residual(x.a, x.lambda, r);
    return r;
  };
  a.violation = rows([](System& s, VecX& y) { s.violation(y); });
  a.violation_rate = rows([](System& s, VecX& y) { s.violation_rate(y); });
  a.acceleration_bias = rows([](System& s, VecX& y) { s.acceleration_bias(y); });
  a.tangent = [at](State const& x, TangentCoefficients c, SecondOrder second) {
    DenseLu sink;
    sink.analyse(x.v.size() + x.lambda.size(), {});
    sink.begin();
    at(x).tangent(c, second, x.lambda, sink);
    return sink.matrix();
  };
  a.pattern = [at](State const& x, TangentCoefficients c, SecondOrder second) {
    PatternSink sink;
    at(x).tangent(c, second, x.lambda, sink);
    return sink.blocks;
  };
  a.slope = [model](State const& x, VecX const& dq, VecX const& dv) {
    VecXOf<D> const q = x.q.cast<D>(), delta = along(VecX::Zero(dq.size()), dq), v = along(x.v, dv);
    VecXOf<D> moved_q = q, r(x.v.size());
    model->for_each_body([&](auto const& e) {
      Index const n = e.body.coordinates();
      e.body.template plus<D>(detail::body_part(q, e.q0, n), detail::body_part(delta, e.v0, e.body.velocities()),
                              detail::body_part_of(moved_q, e.q0, n));
    });
    BasicSystem<D> dual(*model);
    dual.load_factor = 0.7;
    dual.evaluate(moved_q, v, x.t);
    VecXOf<D> const acc = x.a.cast<D>(), lambda = x.lambda.cast<D>();
    dual.residual(acc, lambda, r);
    return VecX(r.unaryExpr([](D const& y) { return y.d[0]; }));
  };
  return a;
}

struct Tangent : testing::TestWithParam<Asked (*)(double damping)> {
  Asked const damped = GetParam()(12.0), undamped = GetParam()(0.0);
  State const x = damped.state(1);
  Index const nv = x.v.size(), rows = x.lambda.size();

  static State at_rest(State x) {
    x.v.setZero();
    return x;
  }
  MatX stiffness(Asked const& a, State const& at) const {
    return a.tangent(at, {.stiffness = 1.0}, SecondOrder::included).topLeftCorner(nv, nv);
  }
  MatX by_position(Asked const& a, State const& at) const {
    MatX k(nv, nv);
    for (Index j = 0; j < nv; ++j) k.col(j) = a.slope(at, VecX::Unit(nv, j), VecX::Zero(nv));
    return k;
  }
  MatX by_speed(Asked const& a, State const& at) const {
    MatX d(nv, nv);
    for (Index j = 0; j < nv; ++j) d.col(j) = a.slope(at, VecX::Zero(nv), VecX::Unit(nv, j));
    return d;
  }
  MatX G(Asked const& a, State const& at) const {
    return a.tangent(at, {}, SecondOrder::omitted).bottomLeftCorner(rows, nv);
  }
  /// The state after time h at constant velocities: exact for small and large h v, as v is constant in body axes.
  State later(State const& at, double h) const {
    State y = at;
    y.q = damped.plus(at.q, at.v * h);
    y.t = at.t + h;
    return y;
  }
};

double mismatch(MatX const& a, MatX const& b) { return (a - b).norm() / std::max(1.0, b.norm()); }

// K = ∂r/∂q of all terms together: elastic forces, followers, springs, Gᵀλ and Jᵀw. The model is at rest because the
// tangent omits ∂ġ/∂q of dampers.
TEST_P(Tangent, StiffnessIsTheDerivativeOfTheResidualByPosition) {
  for (unsigned seed : {1u, 2u}) {
    State const y = at_rest(damped.state(seed));
    EXPECT_LT(mismatch(stiffness(damped, y), by_position(damped, y)), 1e-13);
  }
}

// Without dampers between markers the tangent is exact in motion as well, with material damping.
TEST_P(Tangent, StiffnessIsExactInMotionWithoutDampers) {
  EXPECT_LT(mismatch(stiffness(undamped, x), by_position(undamped, x)), 1e-13);
}

// This comparison without dual numbers.
TEST_P(Tangent, StiffnessAgreesWithDifferencesOfTheResidual) {
  MatX k(nv, nv);
  for (Index j = 0; j < nv; ++j)
    k.col(j) = slope_at_zero(
        [&](double h) {
          State y = x;
          y.q = undamped.plus(x.q, VecX::Unit(nv, j) * h);
          return undamped.residual(y);
        },
        3e-4);
  EXPECT_LT(mismatch(stiffness(undamped, x), k), 1e-9);
}

TEST_P(Tangent, DampingIsTheDerivativeOfTheResidualBySpeed) {
  MatX const d = damped.tangent(x, {.damping = 1.0}, SecondOrder::omitted).topLeftCorner(nv, nv);
  EXPECT_LT(mismatch(d, by_speed(damped, x)), 1e-13);
  EXPECT_GT(d.norm(), 1.0);
}

TEST_P(Tangent, MassIsTheDerivativeOfTheResidualByAcceleration) {
  MatX const m = damped.tangent(x, {.mass = 1.0}, SecondOrder::omitted).topLeftCorner(nv, nv);
  MatX expected(nv, nv);
  for (Index j = 0; j < nv; ++j) {
    State y = x;
    y.a[j] += 1000.0;  // linear in a: a large difference has little round-off
    expected.col(j) = (damped.residual(y) - damped.residual(x)) / 1000.0;
  }
  EXPECT_LT(mismatch(m, expected), 1e-12);
}

TEST_P(Tangent, MixesItsPartsLinearly) {
  for (SecondOrder const second : {SecondOrder::omitted, SecondOrder::included}) {
    auto const part = [&](TangentCoefficients c) { return damped.tangent(x, c, second).topLeftCorner(nv, nv).eval(); };
    MatX const sum = 0.3 * part({.mass = 1.0}) + 20.0 * part({.damping = 1.0}) + 0.7 * part({.stiffness = 1.0});
    EXPECT_LT(mismatch(part({.mass = 0.3, .damping = 20.0, .stiffness = 0.7}), sum), 1e-14);
  }
}

TEST_P(Tangent, RowsAreTheDerivativeOfTheViolation) {
  MatX expected(rows, nv);
  for (Index j = 0; j < nv; ++j)
    expected.col(j) = slope_at_zero([&](double h) {
      State y = x;
      y.q = damped.plus(x.q, VecX::Unit(nv, j) * h);
      return damped.violation(y);
    });
  EXPECT_LT(mismatch(G(damped, x), expected), 1e-10);
}

TEST_P(Tangent, ColumnsOfMultipliersAreTheTransposedRows) {
  MatX const t = damped.tangent(x, {.mass = 2.0, .damping = 3.0, .stiffness = 5.0}, SecondOrder::included);
  EXPECT_EQ(t.topRightCorner(nv, rows), t.bottomLeftCorner(rows, nv).transpose());
  EXPECT_EQ(t.bottomRightCorner(rows, rows).norm(), 0.0);
  for (Index i = 0; i < rows; ++i) {  // Gᵀ is the derivative of the residual with respect to a multiplier
    State y = x;
    y.lambda[i] += 1.0;
    EXPECT_LT((damped.residual(y) - damped.residual(x) - t.col(nv + i).head(nv)).norm(), 1e-12);
  }
}

// Φ̇ = G v + Φ_t, along the motion and in time.
TEST_P(Tangent, ViolationRateIsTheRateOfTheViolation) {
  VecX const expected = slope_at_zero([&](double h) { return damped.violation(later(x, h)); });
  EXPECT_LT(mismatch(damped.violation_rate(x), expected), 1e-10);
  State y = x;
  y.v.setZero();
  EXPECT_LT(mismatch(damped.violation_rate(x) - damped.violation_rate(y), G(damped, x) * x.v), 1e-14);
}

// γ = Φ̈ at constant velocities.
TEST_P(Tangent, AccelerationBiasIsTheRateOfTheViolationRate) {
  VecX const expected = slope_at_zero([&](double h) { return damped.violation_rate(later(x, h)); });
  EXPECT_LT(mismatch(damped.acceleration_bias(x), expected), 1e-10);
}

// Solvers require that the pattern depends on `second` alone.
TEST_P(Tangent, BlocksComeInTheSameOrderEveryTime) {
  auto const same = [](Block const& a, Block const& b) {
    return a.row == b.row && a.col == b.col && a.rows == b.rows && a.cols == b.cols;
  };
  for (SecondOrder const second : {SecondOrder::omitted, SecondOrder::included}) {
    auto const first = damped.pattern(x, {.mass = 1.0, .damping = 1.0, .stiffness = 1.0}, second);
    EXPECT_GT(first.size(), 5u);
    for (State const& y : {damped.state(2), at_rest(x)})
      for (TangentCoefficients const c : {TangentCoefficients{.mass = 1.0}, {.stiffness = 1.0}, {}}) {
        auto const again = damped.pattern(y, c, second);
        ASSERT_EQ(again.size(), first.size());
        EXPECT_TRUE(std::equal(first.begin(), first.end(), again.begin(), same));
      }
  }
}

// The terms that `omitted` omits are not small here. Without them the tangent is not the derivative.
TEST_P(Tangent, SecondOrderTermsCount) {
  MatX const with = damped.tangent(x, {.stiffness = 1.0}, SecondOrder::included);
  MatX const without = damped.tangent(x, {.stiffness = 1.0}, SecondOrder::omitted);
  EXPECT_GT((with - without).norm(), 1.0);
  MatX const k = by_position(undamped, at_rest(x));
  EXPECT_GT(mismatch(without.topLeftCorner(nv, nv), k), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Space, Tangent, testing::Values([](double c) { return ask(MixedSpace::model(c)); }));
INSTANTIATE_TEST_SUITE_P(Plane, Tangent, testing::Values([](double c) { return ask(MixedPlane::model(c)); }));
INSTANTIATE_TEST_SUITE_P(Bushings, Tangent, testing::Values([](double c) { return ask(MixedBushings::model(c)); }));
INSTANTIATE_TEST_SUITE_P(States, Tangent, testing::Values([](double c) { return ask(MixedStates::model(c)); }));

}  // namespace tangent_test
