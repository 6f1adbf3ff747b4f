// The checks of a random model. Time derivatives are finite differences along the motion with the computed
// accelerations,
//   q(h) = q ⊞ (h v + ½ h² a),  v(h) = v + h a,
// whose error is even in h: central differences at h, 2h and 4h, extrapolated twice, have an error of O(h⁶) plus
// round-off of about 1e-16/h of the quantity.
#include "random_models/checks.hpp"

#include <algorithm>
#include <cstring>

namespace polybody::random_models {

namespace {

constexpr double step_of_differences = 1e-6;  // [s]; light cross-sections on stiff joints rotate at about 10⁴ 1/s

bool same_bits(VecX const& a, VecX const& b) {
  if (a.size() != b.size()) return false;
  return a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}
bool same_bits(State const& a, State const& b) {
  return a.t == b.t && same_bits(a.q, b.q) && same_bits(a.v, b.v) && same_bits(a.a, b.a) &&
         same_bits(a.lambda, b.lambda) && same_bits(a.history, b.history);
}
double size_of(VecX const& x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

class Examination {
 public:
  Examination(std::uint64_t seed, int types, WideType const& type)
      : type_(type), plan_(draw(seed, types, type.kinds)), dice_(seed ^ 0x5eedull) {
    out_.seed = seed;
  }

  Outcome make() {
    try {
      Built built;
      try {
        built = type_.realise(plan_, trap_);
      } catch (InvalidInput const&) {
        if (!has_linear_joints()) throw;
        out_.refused = true;  // AncfLinear requires gradients, and pins across cables
        return out_;
      }
      State const x = start(built);
      solve_and_check(built, x);
      int const which = dice_.below(4);
      double const h = 1e-4;
      if (which == 0) run(RungeKutta4<Projection>{}, built, x, h);
      if (which == 1) run(DormandPrince<Projection>{}, built, x, h);
      if (which == 2) run(AdamsBashforthMoulton<Projection>{}, built, x, h);
      if (which == 3) run(CentralDifference<Projection>{}, built, x, h);
    } catch (InconsistentInitialConditions const&) {
      out_.refused = true;  // a loop that its driving constraint cannot close
    } catch (SingularMatrix const& error) {
      if (!out_.redundant && !out_.singular) out_.error = error.what();
    } catch (std::exception const& error) {
      out_.error = error.what();
    }
    return out_;
  }

 private:
  bool has_linear_joints() const {
    return std::any_of(plan_.joints.begin(), plan_.joints.end(),
                       [&](JointPlan const& j) { return type_.kinds.joints[std::size_t(j.kind)].linear; });
  }

  void note(char const* check, double value, double tolerance) {
    for (Residual& r : out_.residuals)
      if (r.check == std::string_view(check)) {
        if (!(value <= r.value)) r.value = value;
        return;
      }
    out_.residuals.push_back({check, value, tolerance});
  }

  /// A state near the reference that satisfies all joints, in motion.
  State start(Built& b) {
    System& whole = *b.whole;
    for (double const size : {0.05, 0.01}) {
      State x = b.reference;
      VecX const q = x.q;
      whole.plus(q, dice_.numbers(whole.velocities(), size), x.q);
      x.v = dice_.numbers(whole.velocities(), 0.3);
      x.t = 0.3;
      try {
        assemble(whole, x);
        return x;
      } catch (Error const&) {
        continue;
      }
    }
    out_.from_reference = true;
    State x = b.reference;
    x.v = dice_.numbers(whole.velocities(), 0.3);
    assemble(whole, x);
    return x;
  }

  /// Degree of independence of the constraint equations: the smallest column that remains in an orthogonalisation of
  /// M^(−1/2) Gᵀ with pivoting. M is taken by its diagonal and the columns as unit vectors.
  double independence(System& s) {
    struct Diagonal {
      VecX& d;
      void add(Index row, Index col, BlockView const& b) {
        if (row == col && row < d.size())
          for (Index i = 0; i < b.rows; ++i) d[row + i] += b(i, i);
      }
    };
    VecX d = VecX::Zero(s.velocities());
    s.masses(Diagonal{d});
    std::vector<VecX> columns;
    for (Index i = 0; i < s.rows(); ++i) {
      VecX e = VecX::Zero(s.rows()), column = d;
      e[i] = 1.0;
      s.rows_transposed_times(e, column);
      for (Index k = 0; k < d.size(); ++k) column[k] /= std::sqrt(d[k] > 0.0 ? d[k] : 1.0);
      columns.push_back(column / std::max(column.norm(), 1e-300));
    }
    double least = 1.0;
    while (!columns.empty()) {
      auto const largest = std::max_element(columns.begin(), columns.end(),
                                            [](VecX const& a, VecX const& b) { return a.norm() < b.norm(); });
      least = std::min(least, largest->norm());
      VecX const pivot = *largest / std::max(largest->norm(), 1e-300);
      columns.erase(largest);
      for (VecX& c : columns) c -= pivot.dot(c) * pivot;
    }
    return least;
  }

  void solve_and_check(Built& b, State x) {
    System& whole = *b.whole;
    ForwardDynamics<> forward(whole);
    forward.accelerations(whole, {x.q, x.v, x.t}, x.a, x.lambda);
    out_.redundant = out_.redundant || !forward.redundant_rows().empty();
    out_.singular = out_.singular || independence(whole) < 1e-3;
    if (out_.singular) return;
    if (plan_.has_joint_coordinates(type_.kinds)) check_twin(b, x);
    check_state(whole, x);
  }

  void check_state(System& whole, State const& x) {
    Violation const open = largest_violation(whole, x);
    note("position rows", open.position / (1.0 + size_of(x.q)), 1e-12);
    note("velocity rows", open.velocity / (1.0 + size_of(x.v)), 1e-10);
    note("acceleration rows", open.acceleration / (1.0 + size_of(x.a)), 1e-9);
    check_power(whole, x);
    check_momentum(whole, x);
  }

  /// The state after the time h.
  static State later(System const& s, State const& x, double h) {
    State out = x;
    VecX const delta = h * x.v + 0.5 * h * h * x.a;
    s.plus(x.q, delta, out.q);
    out.v = x.v + h * x.a;
    out.t = x.t + h;
    return out;
  }
  /// d/dt of the function `quantity` of a state.
  template <class F>
  static VecX rate(System const& s, State const& x, F&& quantity) {
    double const h = step_of_differences;
    auto const central = [&](double by) {
      return VecX((quantity(later(s, x, by)) - quantity(later(s, x, -by))) / (2.0 * by));
    };
    return (64.0 * central(h) - 20.0 * central(2.0 * h) + central(4.0 * h)) / 45.0;
  }

  /// d/dt (T + V) = power of driving constraints and loads − dissipation.
  void check_power(System& s, State const& x) {
    VecX const rates = rate(s, x, [&](State const& y) {
      s.evaluate(y.q, y.v, y.t);
      Energy const e = energy(s, y);
      VecX all(5);
      all << e.kinetic, e.strain, e.gravity, e.joints, e.forces;
      return all;
    });
    s.evaluate(x.q, x.v, x.t);
    Energy const e = energy(s, x);
    Powers const p = powers(s, x);
    double const scale = rates.cwiseAbs().sum() + std::abs(p.drives) + std::abs(p.loads) + std::abs(p.dissipated) +
                         e.kinetic + std::abs(e.strain) + std::abs(e.gravity) + e.joints + e.forces;
    note("power", std::abs(rates.sum() - p.drives - p.loads + p.dissipated) / (scale + 1e-6), 1e-7);
  }

  /// Force and moment about the world's origin, and the sum of their absolute values.
  struct Total {
    Vec6 sum = Vec6::Zero();
    double size = 0.0;
    void add(Vec3 const& f, Vec3 const& m, Vec3 const& r) {
      Vec3 const moment = m + r.cross(f);
      sum.head<3>() += f;
      sum.tail<3>() += moment;
      size += f.norm() + moment.norm();
    }
  };
  bool axis_only(System const& s, Index owner) const {
    int const body = std::stoi(s.layout().bodies[std::size_t(owner)].name);
    return kind_of(body).tells_axis_only;
  }
  BodyKind const& kind_of(int body) const {
    return type_.kinds.bodies[std::size_t(plan_.bodies[std::size_t(body)].kind)];
  }

  /// Wrenches from the ground and from loads on all bodies: reactions and loads as recorded.
  Total from_outside(System& s, State const& x) {
    s.evaluate(x.q, x.v, x.t);
    s.push_forces(x.lambda);
    Total total;
    ModelLayout const& layout = s.layout();
    auto const owner = [&](Index marker) { return layout.owners[std::size_t(marker)]; };
    auto const frame = [&](Index marker) -> Frame<double> const& {
      return s.data().markers[std::size_t(marker)].frame;
    };
    for (std::size_t i = 0; i < layout.joints.size(); ++i) {
      JointLayout const& j = layout.joints[i];
      if (owner(j.a) >= 0 && owner(j.b) >= 0) continue;
      Wrench<double> const w = reaction_of(s, x, Index(i));
      double const sign = owner(j.b) < 0 ? -1.0 : 1.0;
      total.add(sign * w.f, sign * w.m, frame(j.b).r);
    }
    for (AppliedWrench<double> const& action : s.data().actions) {
      bool const alone = layout.forces[std::size_t(action.source)].markers.size() == 1;
      Index const on = owner(action.marker);
      Frame<double> const& at = frame(action.marker);
      Vec3 const f(action.w[0], action.w[1], action.w[2]), m(action.w[3], action.w[4], action.w[5]);
      if (alone) total.add(f, m, at.r);
      if (!alone && on < 0) total.add(-f, -m, at.r);
      if (on >= 0 && axis_only(s, on)) {  // this marker takes no moment about the tangent
        Vec3 const tangent = at.A.col(0);
        total.add(Vec3::Zero(), -tangent.dot(m) * tangent, at.r);
      }
    }
    return total;
  }

  /// The force of gravity and its moment: the derivatives of its potential along rigid motions.
  Vec6 weight(System& s, State const& x) {
    Vec6 w;
    for (int i = 0; i < 6; ++i) {
      State y = x;
      VecX velocities = VecX::Zero(s.velocities());
      s.operations().rigid_velocities(x.q, i < 3 ? Vec3(Vec3::Unit(i)) : Vec3(Vec3::Zero()),
                                      i < 3 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(i - 3)), velocities);
      auto const potential = [&](double by) {
        s.plus(x.q, by * velocities, y.q);
        s.evaluate(y.q, y.v, y.t);
        return energy(s, y).gravity;
      };
      auto const slope = [&](double by) { return (potential(by) - potential(-by)) / (2.0 * by); };
      w[i] = -(4.0 * slope(1e-3) - slope(2e-3)) / 3.0;
    }
    return w;
  }

  /// d/dt of the momentum and of the moment of momentum = weight + wrenches of the ground and of loads.
  void check_momentum(System& s, State const& x) {
    VecX const rates = rate(s, x, [&](State const& y) {
      s.evaluate(y.q, y.v, y.t);
      Momentum const p = momentum(s, y);
      VecX all(6);
      all << p.linear, p.angular;
      return all;
    });
    Vec6 const heavy = weight(s, x);
    Total const outside = from_outside(s, x);
    Vec6 off = rates - heavy - outside.sum;
    if (plan_.planar) off[2] = off[3] = off[4] = 0.0;
    bool balanced = true;
    for (std::size_t i = 0; i < plan_.bodies.size(); ++i) balanced = balanced && kind_of(int(i)).objective;
    for (JointPlan const& j : plan_.joints) {
      JointKind const& kind = type_.kinds.joints[std::size_t(j.kind)];
      // λ of constraint equations in world axes acts at two points, which a constraint violation separates
      bool const open = std::string_view(kind.policy).starts_with("Penalty");
      // the axis of a linear pin between cables is fixed in the world and takes a moment
      bool const between = j.a.body != ground && j.b.body != ground;
      bool const world_axis = kind.linear && between && kind_of(j.b.body).tells_axis_only;
      balanced = balanced && !open && !world_axis;
    }
    double const scale = outside.size + heavy.norm() + rates.norm() + 1.0;
    note("momentum", off.head<3>().norm() / scale, 1e-7);
    if (balanced) note("moment of momentum", off.tail<3>().norm() / scale, 1e-7);
  }

  /// This model with `Constraint`: accelerations, multipliers, reactions.
  void check_twin(Built& b, State const& x) {
    RunSystems run = b.systems_of_run();
    System& stepped = *run.stepped;
    State narrow = reduce(stepped, x), full = x;
    ForwardDynamics<> of_stepped(stepped);
    of_stepped.accelerations(stepped, {narrow.q, narrow.v, narrow.t}, narrow.a, narrow.lambda);
    VecX scratch;
    expand(stepped, narrow, full, scratch);
    Built twin = type_.realise(plan_.twin(type_.kinds), trap_);
    System& whole = *twin.whole;
    ForwardDynamics<> forward(whole);
    State y = full;
    forward.accelerations(whole, {full.q, full.v, full.t}, y.a, y.lambda);
    note("twin: accelerations", size_of(y.a - full.a) / (size_of(y.a) + 1.0), 1e-9);
    if (out_.redundant) return;
    note("twin: multipliers", size_of(y.lambda - full.lambda) / (size_of(y.lambda) + 1.0), 1e-9);
    whole.evaluate(full.q, full.v, full.t);
    b.whole->evaluate(full.q, full.v, full.t);
    double off = 0.0, size = 1.0;
    for (std::size_t i = 0; i < whole.layout().joints.size(); ++i) {
      Wrench<double> const w = reaction_of(whole, y, Index(i));
      auto const& others = b.whole->layout().joints;
      for (std::size_t k = 0; k < others.size(); ++k) {
        if (others[k].name != whole.layout().joints[i].name) continue;
        Wrench<double> const v = reaction_of(*b.whole, full, Index(k));
        off = std::max({off, (w.f - v.f).norm(), (w.m - v.m).norm()});
        size = std::max({size, w.f.norm(), w.m.norm()});
      }
    }
    note("twin: reactions", off / size, 1e-9);
  }

  /// Several steps with the checks at their end, a bitwise identical repetition in a new model, and steps that fail.
  template <class I>
  void run(I const& integrator, Built& built, State const& start, double h) {
    auto const options = [&](double step) { return RunOptions{.end_time = start.t + 1e3 * step, .step = step}; };
    auto const moved = [&](Built& b) {
      State x = start;
      Simulation<I> run(b.systems_of_run(), x, integrator, options(h));
      for (int i = 0; i < 3; ++i) run.advance();
      return x;
    };
    State const end = moved(built);
    solve_and_check(built, end);
    Built again = type_.realise(plan_, trap_);
    note("the same bits twice", same_bits(moved(again), end) ? 0.0 : 1.0, 0.0);

    for (Trap::Mode const mode : {Trap::Mode::throws, Trap::Mode::not_a_number}) {
      State x = start;
      Simulation<I> run(built.systems_of_run(), x, integrator, options(h));
      run.advance();
      fail(run, x, mode, dice_.below(5));
      while (run.report().steps < 3) run.advance();
      note("the same bits after a failed step", same_bits(x, end) ? 0.0 : 1.0, 0.0);
    }
    State x = start;
    Simulation<I> run(built.systems_of_run(), x, integrator, options(1e3));
    fail(run, x, Trap::Mode::quiet, 0);
  }

  /// One step in which the force fails; a step that throws leaves the state unchanged.
  template <class I>
  void fail(Simulation<I>& run, State const& x, Trap::Mode mode, int after) {
    State const before = x;
    trap_ = {mode, after};
    bool threw = false;
    try {
      run.advance();
    } catch (Error const&) {
      threw = true;
    } catch (TrapSprung const&) {
      threw = true;
    }
    trap_ = {};
    bool const silent = !(all_finite(x.q) && all_finite(x.v) && all_finite(x.a) && all_finite(x.lambda));
    note("no failure is silent", silent ? 1.0 : 0.0, 0.0);
    if (threw) {
      ++out_.failures;
      note("a failed step leaves the state", same_bits(before, x) ? 0.0 : 1.0, 0.0);
    }
  }

  WideType const& type_;
  Plan plan_;
  Dice dice_;
  Trap trap_;
  Outcome out_;
};

}  // namespace

bool Outcome::right() const {
  return error.empty() &&
         std::all_of(residuals.begin(), residuals.end(), [](Residual const& r) { return r.value <= r.tolerance; });
}

Outcome examine(std::uint64_t seed, int types, WideType const& type) { return Examination(seed, types, type).make(); }

void count_pairs(std::uint64_t seed, int types, WideType const& type, Pairs& pairs) {
  Plan const plan = draw(seed, types, type.kinds);
  auto const name = [&](End const& e) -> std::string {
    return e.body == ground ? "the ground" : type.kinds.bodies[std::size_t(plan.bodies[std::size_t(e.body)].kind)].name;
  };
  for (JointPlan const& j : plan.joints) {
    JointKind const& kind = type.kinds.joints[std::size_t(j.kind)];
    ++pairs["geometry, policy"][{kind.geometry, kind.policy}];
    for (std::string const& body : std::set{name(j.a), name(j.b)}) {
      if (std::string(kind.policy) == "Constraint") ++pairs["geometry by Constraint, body"][{kind.geometry, body}];
      ++pairs["policy, body"][{kind.policy, body}];
    }
  }
  for (ForcePlan const& f : plan.forces) {
    ForceKind const& kind = type.kinds.forces[std::size_t(f.kind)];
    ++pairs["force, body"][{kind.name, name(f.a)}];
    if (kind.markers == 2 && name(f.b) != name(f.a)) ++pairs["force, body"][{kind.name, name(f.b)}];
  }
}

}  // namespace polybody::random_models
