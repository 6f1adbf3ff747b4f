// The laws of support/joint_laws.hpp, compiled once for the geometries of every *_test.cpp in this folder.
#include "support/joint_laws.hpp"

#include "support/differences.hpp"

namespace polybody {

VecX FramePair::twists() const {
  VecX v(12);
  v << twist(a), twist(b);
  return v;
}

FramePair FramePair::moved_by(VecX const& motion) const {
  return {moved<double>(a, motion.head<6>()), moved<double>(b, motion.tail<6>())};
}

std::vector<FramePair> JointLawsOf::closed() {
  std::vector<FramePair> pairs(3);
  for (FramePair& p : pairs) {
    Mate const mate = geometry.mate(number, t);
    p.a = number.frame(planar);
    p.b = number.frame(planar);
    p.b.r = p.a.r + p.a.A * mate.d;
    p.b.A = p.a.A * mate.R;
    p.freedoms.resize(6, mate.freedoms.cols());
    p.freedoms << p.a.A * mate.freedoms.topRows<3>(), p.a.A * mate.freedoms.bottomRows<3>();
  }
  return pairs;
}

std::vector<FramePair> JointLawsOf::open() {
  std::vector<FramePair> pairs = closed();
  for (FramePair& p : pairs) p.b = moved<double>(p.b, number.motion(planar, 0.4));
  return pairs;
}

std::vector<FramePair> JointLawsOf::all() {
  std::vector<FramePair> pairs = closed();
  for (FramePair& p : open()) pairs.push_back(std::move(p));
  return pairs;
}

MatX JointLawsOf::known() const {
  std::vector<Index> const columns =
      planar ? std::vector<Index>{0, 1, 5, 6, 7, 11} : std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  MatX k = MatX::Zero(12, Index(columns.size()));
  for (Index j = 0; j < k.cols(); ++j) k(columns[std::size_t(j)], j) = 1.0;
  return k;
}

VecX JointLawsOf::multipliers() { return number.vector(m, 3.0); }

VecX JointLawsOf::wrenches(FramePair const& p, VecX const& lambda) const {
  return geometry.gap(p, t).G.transpose() * lambda;
}

/// Moment of both wrenches about a point.
static Vec3 moment(FramePair const& p, VecX const& w, Vec3 const& about) {
  Vec3 const fa = w.segment<3>(0), fb = w.segment<3>(6);
  return w.segment<3>(3) + (p.a.r - about).cross(fa) + w.segment<3>(9) + (p.b.r - about).cross(fb);
}

void JointLawsOf::closed_frames_have_no_gap() {
  for (FramePair const& p : closed()) EXPECT_LT(geometry.gap(p, t).g.norm(), 1e-14);
  if (held == 0) return;
  for (FramePair const& p : open()) EXPECT_GT(geometry.gap(p, t).g.norm(), 1e-3);
}

// Velocity rows have no gap, so that nothing is to be differentiated.
void JointLawsOf::maps_are_the_derivative_of_the_gap() {
  for (FramePair const& p : all()) {
    SeenGap const seen = geometry.gap_with_slopes(p, t);
    EXPECT_LT(((seen.G - seen.slope).topRows(held) * known()).norm(), tolerance);
    EXPECT_TRUE(seen.g.tail(m - held).isZero(0.0) && seen.slope.bottomRows(m - held).isZero(0.0));
  }
}

void JointLawsOf::rate_is_the_derivative_of_the_gap_by_time() {
  for (FramePair const& p : all()) {
    VecX const slope = slope_at_zero([&](double h) { return geometry.gap(p, t + h).g; });
    EXPECT_LT((geometry.gap(p, t).rate - slope).norm(), tolerance);
  }
}

// γ = d/dt (G V + Φ_t) while V stands still: along the motion by dual numbers, in time by differences.
void JointLawsOf::gamma_is_the_second_derivative_without_accelerations() {
  for (FramePair const& p : all()) {
    VecX const v = p.twists();
    VecX const by_time = slope_at_zero(
        [&](double h) {
          SeenGap const later = geometry.gap(p, t + h);
          return VecX(later.G * v + later.rate);
        },
        1e-2);
    VecX const expected = geometry.gap_with_slopes(p, t).G_rate * v + by_time;
    EXPECT_LT((geometry.gamma(p, t) - expected).norm(), tolerance * (1.0 + expected.norm()));
  }
}

// Gaᵀλ · Va + Gbᵀλ · Vb = λ · (ġ − Φ_t), ġ − Φ_t along the motion
void JointLawsOf::wrenches_have_the_power_of_the_multipliers() {
  for (FramePair const& p : all()) {
    VecX const lambda = multipliers(), v = p.twists();
    SeenGap const seen = geometry.gap_with_slopes(p, t);
    VecX rate = seen.slope * v;
    rate.tail(m - held) = seen.G.bottomRows(m - held) * v;
    EXPECT_NEAR(wrenches(p, lambda).dot(v), lambda.dot(rate), tolerance * (1.0 + lambda.norm() * rate.norm()));
  }
}

// Forces balance always. Moments balance about every point while the joint is closed; open, rows in world axes
// leave the moment d × f, f the force of these rows (none for a force along d, a spring's).
void JointLawsOf::wrenches_are_equal_and_opposite() {
  for (FramePair const& p : all()) {
    VecX const lambda = multipliers(), w = wrenches(p, lambda);
    Vec3 f = Vec3::Zero(), about = number.vec<3>(5.0);
    if (planar) about[2] = 0.0;
    f.head(geometry.world_rows) = lambda.head(geometry.world_rows);
    EXPECT_LT((w.segment<3>(0) + w.segment<3>(6)).norm(), tolerance);
    EXPECT_LT((moment(p, w, about) - (p.b.r - p.a.r).cross(f)).norm(), 10 * tolerance);
  }
  for (FramePair const& p : closed())
    EXPECT_LT(moment(p, wrenches(p, multipliers()), Vec3::Zero()).norm(), 10 * tolerance);
}

// Both frames and their twists turned and shifted: rows in world axes turn with them, the others stay.
void JointLawsOf::does_not_see_a_rigid_motion_of_both_frames() {
  for (FramePair const& p : all()) {
    Vec6 const motion = number.motion(planar, 2.0);
    Mat3 const turn = exp_so3<double>(motion.tail<3>());
    Vec3 const shift = motion.head<3>();
    FramePair const q{carried(p.a, turn, shift), carried(p.b, turn, shift)};
    Index const n = geometry.world_rows;
    MatX rows = MatX::Identity(m, m), back = MatX::Zero(12, 12);
    rows.topLeftCorner(n, n) = turn.topLeftCorner(n, n);
    for (int i = 0; i < 12; i += 3) back.block<3, 3>(i, i) = turn.transpose();
    SeenGap const before = geometry.gap(p, t), after = geometry.gap(q, t);
    EXPECT_LT((after.g - rows * before.g).norm(), tolerance);
    EXPECT_LT((after.rate - rows * before.rate).norm(), tolerance);
    EXPECT_LT(((after.G - rows * before.G * back) * known()).norm(), tolerance);
    EXPECT_LT((geometry.gamma(q, t) - rows * geometry.gamma(p, t)).norm(), 10 * tolerance);
  }
}

void JointLawsOf::wrench_gradient_is_the_derivative_of_the_wrenches() {
  MatX const k = known();
  for (FramePair const& p : all()) {
    VecX const lambda = multipliers();
    MatX slope(12, k.cols());
    for (Index j = 0; j < k.cols(); ++j)
      slope.col(j) = slope_at_zero([&](double h) { return wrenches(p.moved_by(k.col(j) * h), lambda); });
    EXPECT_LT((k.transpose() * (geometry.gradient(p, t, lambda) * k - slope)).norm(), 1e-9);
  }
}

// The rows are independent where the joint is closed, and stop everything but its freedoms.
void JointLawsOf::rows_and_freedoms_make_up_all_motions() {
  MatX const k = known();
  auto const smallest_part = [](MatX a) {  // of a row that the rows before it do not explain
    double smallest = a.row(0).norm();
    for (Index i = 1; i < a.rows(); ++i) {
      a.row(i - 1).normalize();
      for (Index j = 0; j < i; ++j) a.row(i) -= a.row(i).dot(a.row(j)) * a.row(j);
      smallest = std::min(smallest, a.row(i).norm());
    }
    return smallest;
  };
  for (FramePair const& p : closed()) {
    EXPECT_EQ(m + p.freedoms.cols(), k.cols() / 2);
    MatX const g = geometry.gap(p, t).G;
    EXPECT_GT(smallest_part(g * k), 0.3);
    EXPECT_GT(smallest_part((g * k).rightCols(k.cols() / 2)), 0.3);
    EXPECT_LT((g.rightCols<6>() * p.freedoms).norm(), tolerance);
  }
}

}  // namespace polybody
