// The drawing of a model. First the bodies are placed, joint by joint along a tree. Then loops are closed at points
// that coincide already.
#include "random_models/plan.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace polybody::random_models {

Vec3 Dice::vector(bool planar, double size) {
  double const x = between(-size, size), y = between(-size, size), z = between(-size, size);
  return Vec3(x, y, planar ? 0.0 : z);
}
Vec3 Dice::unit(bool planar) {
  for (;;)
    if (Vec3 const v = vector(planar, 1.0); v.norm() > 0.2) return v / v.norm();
}
VecX Dice::numbers(Index n, double size) {
  VecX v(n);
  for (Index i = 0; i < n; ++i) v[i] = between(-size, size);
  return v;
}

bool Plan::has_joint_coordinates(Kinds const& kinds) const {
  return std::any_of(joints.begin(), joints.end(), [&](JointPlan const& j) {
    JointKind const& kind = kinds.joints[std::size_t(j.kind)];
    return kind.eliminates && !kind.linear;
  });
}

Plan Plan::twin(Kinds const& kinds) const {
  Plan out = *this;
  for (JointPlan& j : out.joints)
    if (int const other = kinds.joints[std::size_t(j.kind)].twin; other != ground) j.kind = other;
  return out;
}

std::string Plan::text(Kinds const& kinds) const {
  std::ostringstream out;
  auto const name = [&](End const& e) {
    if (e.body == ground) return std::string("ground");
    return kinds.bodies[std::size_t(bodies[std::size_t(e.body)].kind)].name + (" " + std::to_string(e.body));
  };
  for (JointPlan const& j : joints) {
    JointKind const& kind = kinds.joints[std::size_t(j.kind)];
    out << "  " << kind.geometry << ", " << kind.policy << ": " << name(j.a) << " - " << name(j.b) << '\n';
  }
  for (ForcePlan const& f : forces) {
    ForceKind const& kind = kinds.forces[std::size_t(f.kind)];
    out << "  " << kind.name << ": " << name(f.a) << (kind.markers == 2 ? " - " + name(f.b) : "") << '\n';
  }
  return out.str();
}

namespace {

/// Draws one model.
class Drawing {
 public:
  Drawing(std::uint64_t seed, int types, Kinds const& kinds)
      : kinds_(kinds), dice_(seed), turn_(std::size_t(seed) / std::size_t(types)), plan_{seed, false, {}, {}, {}, {}} {
    bool const plane = some(true), space = some(false);
    plan_.planar = plane && (!space || dice_.chance(0.4));
    plan_.gravity = dice_.chance(0.8) ? dice_.vector(plan_.planar, 9.81) : Vec3::Zero();
  }

  Plan make() {
    std::vector<Pairing> const eliminating = joint_pairs(true), others = joint_pairs(false);
    int const items = 3 + dice_.below(4);
    for (int i = 0; i < items; ++i) {
      bool const reduced = !eliminating.empty() && (others.empty() || i == 0 || dice_.chance(0.75));
      hang(next(reduced ? eliminating : others, i));
    }
    for (int i = dice_.below(3); i > 0 && !others.empty(); --i) close(next(others, 6 + i));
    while (freedoms() < 2) add_body(hub_kind(), free_place());
    std::vector<Pairing> const forces = force_pairs();
    for (int i = 0, most = 2 + dice_.below(3); i < most; ++i) push(next(forces, i));
    push({int(kinds_.forces.size()) - 1, plan_.bodies[0].kind, ground});  // the force that fails
    return plan_;
  }

 private:
  static constexpr std::size_t most_joints = 9;

  bool some(bool planar) const {
    return std::any_of(kinds_.bodies.begin(), kinds_.bodies.end(),
                       [&](BodyKind const& b) { return b.planar == planar; });
  }
  bool here(int kind) const { return kind == ground || kinds_.bodies[std::size_t(kind)].planar == plan_.planar; }
  bool here(Pairing const& p) const { return here(p.a) && here(p.b); }
  std::vector<Pairing> joint_pairs(bool eliminating) const {
    std::vector<Pairing> out;
    for (Pairing const& p : kinds_.joint_pairs)
      if (here(p) && kinds_.joints[std::size_t(p.kind)].eliminates == eliminating) out.push_back(p);
    return out;
  }
  std::vector<Pairing> force_pairs() const {
    std::vector<Pairing> out;
    for (Pairing const& p : kinds_.force_pairs)
      if (here(p)) out.push_back(p);
    return out;
  }
  /// The i-th pairing of this model. A stride that shares no factor with the number of pairings makes each i pass all
  /// of them.
  Pairing next(std::vector<Pairing> const& list, int i) const {
    std::size_t stride = most_joints;
    while (std::gcd(stride, list.size()) > 1) ++stride;
    return list[(turn_ * stride + std::size_t(i)) * 7919 % list.size()];
  }

  BodyKind const& kind_of(int body) const { return kinds_.bodies[std::size_t(plan_.bodies[std::size_t(body)].kind)]; }
  bool is_bar(int body) const { return body != ground && kind_of(body).is_bar; }
  int hub_kind() const {
    for (std::size_t k = 0; k < kinds_.bodies.size(); ++k)
      if (kinds_.bodies[k].planar == plan_.planar && !kinds_.bodies[k].is_bar) return int(k);
    for (std::size_t k = 0; k < kinds_.bodies.size(); ++k)
      if (kinds_.bodies[k].planar == plan_.planar) return int(k);
    return 0;
  }
  /// Degrees of freedom of all bodies without those that joints remove; a bar counts no more than a rigid body.
  int freedoms() const {
    int sum = int(plan_.bodies.size()) * (plan_.planar ? 3 : 6);
    for (JointPlan const& j : plan_.joints) sum -= kinds_.joints[std::size_t(j.kind)].rows;
    return sum;
  }

  Mat3 turned() {
    return exp_so3<double>(plan_.planar ? Vec3(0.0, 0.0, dice_.between(-3.0, 3.0)) : dice_.vector(false, 2.0));
  }
  Placement free_place() { return {dice_.vector(plan_.planar, 1.0), turned()}; }
  int add_body(int kind, Placement const& place) {
    plan_.bodies.push_back({kind, place, dice_.between(0.8, 1.4), dice_.between(0.5, 3.0)});
    return int(plan_.bodies.size()) - 1;
  }
  /// An existing body of this kind, or none; the ground always exists.
  bool find(int kind, int& body) {
    std::vector<int> all;
    for (std::size_t i = 0; i < plan_.bodies.size(); ++i)
      if (plan_.bodies[i].kind == kind) all.push_back(int(i));
    body = all.empty() ? ground : all[std::size_t(dice_.below(all.size()))];
    return kind == ground || !all.empty();
  }

  /// A point of a placed body.
  End end_on(int body) {
    End e{.body = body};
    if (body == ground) {
      e.point = dice_.vector(plan_.planar, 1.0);
    } else {
      BodyPlan const& b = plan_.bodies[std::size_t(body)];
      if (is_bar(body)) {
        e.s = along(b.length);
        e.point = b.place.origin + e.s * b.place.axes.col(0);
      } else {
        e.point = b.place.origin + dice_.vector(plan_.planar, 0.5);
      }
    }
    return e;
  }
  double along(double length) {
    int const which = dice_.below(3);
    return which == 0 ? 0.0 : which == 1 ? length : dice_.between(0.2, 0.8) * length;
  }
  /// Places a body such that a point of it is at `point`.
  End put(int body, Vec3 const& point) {
    BodyPlan& b = plan_.bodies[std::size_t(body)];
    End e{body, point, 0.0};
    if (is_bar(body)) {
      e.s = along(b.length);
      b.place.origin = point - e.s * b.place.axes.col(0);
    } else {
      b.place.origin = point - dice_.vector(plan_.planar, 0.5);
    }
    return e;
  }

  /// Directions and numbers of a joint between bodies with given rotations.
  JointPlan joint(int kind, int a, int b) {
    JointKind const& k = kinds_.joints[std::size_t(kind)];
    JointPlan j{.kind = kind,
                .a = {},
                .b = {},
                .axis = plan_.planar ? Vec3::UnitZ() : dice_.unit(false),
                .side = {},
                .size = dice_.between(0.3, 0.6),
                .stiffness = dice_.between(200.0, 2000.0),
                .damping = dice_.between(0.0, 0.5)};
    int const lined = b != ground ? b : a;
    if (k.linear && !plan_.planar) j.axis = plan_.bodies[std::size_t(lined)].place.axes.col(2);
    if (k.asks_axis && b != ground && kind_of(b).tells_axis_only)
      j.axis = plan_.bodies[std::size_t(b)].place.axes.col(0);
    Vec3 const across = j.axis.cross(dice_.unit(false));
    j.side = plan_.planar ? dice_.unit(true) : Vec3(across / across.norm());
    return j;
  }
  Vec3 offset(JointPlan const& j) const {
    Offset const o = kinds_.joints[std::size_t(j.kind)].offset;
    return o == Offset::none ? Vec3(Vec3::Zero()) : Vec3(j.size * (o == Offset::along_axis ? j.axis : j.side));
  }

  /// Adds one body to the tree, by a joint of this pairing.
  void hang(Pairing const& p) {
    int a = ground, b = ground;
    bool has_a = find(p.a, a), has_b = find(p.b, b);
    if (!has_a && !has_b) {  // the tree has a second root
      a = add_body(p.a, free_place());
      has_a = true;
    }
    bool const new_b = p.a == ground || (p.b != ground && has_a && (!has_b || dice_.chance(0.5)));
    int& fresh = new_b ? b : a;
    int const old = new_b ? a : b;
    fresh = add_body(new_b ? p.b : p.a, {Vec3::Zero(), turned()});
    if (kinds_.joints[std::size_t(p.kind)].linear && old != ground)
      plan_.bodies[std::size_t(fresh)].place.axes = plan_.bodies[std::size_t(old)].place.axes;
    JointPlan j = joint(p.kind, a, b);
    End const there = end_on(old);
    End const here = put(fresh, new_b ? Vec3(there.point + offset(j)) : Vec3(there.point - offset(j)));
    j.a = new_b ? there : here;
    j.b = new_b ? here : there;
    plan_.joints.push_back(j);
  }

  bool joined(int a, int b) const {
    return std::any_of(plan_.joints.begin(), plan_.joints.end(), [&](JointPlan const& j) {
      return (j.a.body == a && j.b.body == b) || (j.a.body == b && j.b.body == a);
    });
  }
  /// A joint that closes a loop, if one of its bodies has a point at every required position.
  void close(Pairing const& p) {
    int a = ground, b = ground;
    JointKind const& kind = kinds_.joints[std::size_t(p.kind)];
    if (!find(p.a, a) || !find(p.b, b) || a == b || joined(a, b)) return;
    if ((is_bar(a) && is_bar(b)) || kind.linear || kind.rows > 3 || freedoms() - kind.rows < 2) return;
    JointPlan j = joint(p.kind, a, b);
    if (is_bar(b)) {
      j.b = end_on(b);
      j.a = {a, j.b.point - offset(j), 0.0};
    } else {
      j.a = end_on(a);
      j.b = {b, j.a.point + offset(j), 0.0};
    }
    plan_.joints.push_back(j);
  }

  void push(Pairing const& p) {
    ForceKind const& kind = kinds_.forces[std::size_t(p.kind)];
    ForcePlan f{.kind = p.kind,
                .a = {},
                .b = {},
                .vector = dice_.vector(plan_.planar, 5.0),
                .follows = dice_.chance(0.5),
                .stiffness = dice_.between(20.0, 200.0),
                .damping = dice_.between(0.0, 1.0),
                .distance = 0.0};
    int a = ground, b = ground;
    if (!find(p.a, a)) a = add_body(p.a, free_place());
    f.a = end_on(a);
    if (kind.markers == 2) {
      if (!find(p.b, b) || a == b) b = p.b == ground ? ground : add_body(p.b, free_place());
      f.b = end_on(b);
      f.distance = (f.a.point - f.b.point).norm();
    }
    plan_.forces.push_back(f);
  }

  Kinds const& kinds_;
  Dice dice_;
  std::size_t turn_;
  Plan plan_;
};

}  // namespace

Plan draw(std::uint64_t seed, int types, Kinds const& kinds) { return Drawing(seed, types, kinds).make(); }

}  // namespace polybody::random_models
