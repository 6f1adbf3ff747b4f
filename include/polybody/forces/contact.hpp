#pragma once
/// \file
/// Contact between two markers: a geometry that computes the penetration, a normal force law and friction.
/// Theory: Eqs. 8.1 to 8.3, 8.10 to 8.13.

#include <polybody/forces/contact_friction.hpp>
#include <polybody/forces/contact_reach.hpp>
#include <polybody/forces/contact_tangent.hpp>
#include <polybody/forces/force_group.hpp>
#include <polybody/forces/normal_force.hpp>

namespace polybody {

/// Weight of one face in a contact, near the boundary between two faces of a body. The force and the potential of a
/// face are multiplied by its weight `share`. A weight that varies with the position adds the force −U ∂share/∂place on
/// a, with the potential U of the normal force, and the opposite force on b.
template <StateScalar T>
struct ContactBlend {
  T share = T(1.0);                            ///< weight of this face, in [0, 1]
  Vec<T, 3> slope = {T(0.0), T(0.0), T(0.0)};  ///< (3) ∂share/∂place [1/m]; `place` moves with body a
  Vec<T, 3> place = {T(0.0), T(0.0), T(0.0)};  ///< (3) point of action of the added force [m]
};

/// Contact point: point in the overlap of body a and body b.
template <StateScalar T>
struct ContactPoint {
  Vec<T, 3> place;                ///< (3) point of action of the force, world axes [m]
  Vec<T, 3> normal;               ///< (3) unit vector from b to a
  T depth;                        ///< penetration d > 0 [m]
  ContactBlend<T> handover = {};  ///< weight of the face; 1 if no other face is near
  /// Number of the point's states, from 0 to `most_points` − 1. Points that exist at the same time have different
  /// numbers, and a point keeps its number as the bodies move.
  int slot = 0;
};

/// Number of contact points that a geometry can have at the same time: `G::most_points`, or 1 without this member.
template <class G>
constexpr int most_points() {
  if constexpr (requires { G::most_points; })
    return G::most_points;
  else
    return 1;
}

namespace detail {
struct AnyPoint {
  void operator()(ContactPoint<double> const& point) const;
};
/// Visitor of contact points with erased type, so that a geometry is compiled once per scalar type.
template <StateScalar T>
class PointVisitor {
 public:
  template <class Visit>
  explicit PointVisitor(Visit const& visit)
      : visit_(&visit), call_([](void const* f, ContactPoint<T> const& p) { (*static_cast<Visit const*>(f))(p); }) {}
  void operator()(ContactPoint<T> const& point) const { call_(visit_, point); }

 private:
  void const* visit_;
  void (*call_)(void const*, ContactPoint<T> const&);
};
/// Sum p + n x.
template <StateScalar T>
Vec<T, 3> shifted(Vec<T, 3> const& p, Vec<T, 3> const& n, T const& x) {
  return {p[0] + n[0] * x, p[1] + n[1] * x, p[2] + n[2] * x};
}
}  // namespace detail

/// Contact geometry: calls visit(point) for every contact point of the shapes at frames a and b. `may_touch` is a
/// fast test: it is false only if the shapes cannot overlap. The optional `reach(b)` is an even faster test
/// (`HasReach`).
template <class G>
concept ContactGeometry =
    requires(G const geometry, Frame<double> const a, Frame<double> const b, std::string const name) {
      { G::needs } -> std::convertible_to<MarkerKind>;
      { geometry.may_touch(a, b) } -> std::same_as<bool>;
      geometry.template for_each_point<double>(a, b, detail::AnyPoint{});
      geometry.check(name);
    };

namespace detail {
/// Calls visit(point, v, N) for every contact point, with the velocity v of a relative to b at the point and the normal
/// force N.
template <StateScalar T, class G, class N, class Visit>
void for_each_pressed_point(G const& geometry, N const& normal, std::array<Frame<T>, 2> const& f, Visit&& visit) {
  auto const at_point = [&](ContactPoint<T> const& p) {
    Vec<T, 3> const arm_a = p.place - f[0].r, arm_b = p.place - f[1].r;
    Vec<T, 3> const turn_a = f[0].w.cross(arm_a), turn_b = f[1].w.cross(arm_b);
    Vec<T, 3> v;
    for (int i = 0; i < 3; ++i) v[i] = (f[0].v[i] + turn_a[i]) - (f[1].v[i] + turn_b[i]);
    visit(p, v, T(normal.template force<T>(p.depth, T(-v.dot(p.normal))) * p.handover.share));
  };
  geometry.template for_each_point<T>(f[0], f[1], PointVisitor<T>(at_point));
}
/// Adds the wrenches of `force` (3) on a at `place` (3) and of the opposite force on b to w.
template <StateScalar T>
void act(Vec<T, 3> const& force, Vec<T, 3> const& place, std::array<Frame<T>, 2> const& f,
         std::array<Wrench<T>, 2>& w) {
  Vec<T, 3> const arm_a = place - f[0].r, arm_b = place - f[1].r;
  Vec<T, 3> const of_a = arm_a.cross(force), of_b = arm_b.cross(force);
  for (int i = 0; i < 3; ++i) {
    w[0].f[i] += force[i];
    w[1].f[i] -= force[i];
    w[0].m[i] += of_a[i];
    w[1].m[i] -= of_b[i];
  }
}
/// Adds the wrenches of the force −U ∂share/∂place at a contact point whose weight varies with the position.
template <StateScalar T, class N>
void act_at_handover(N const& normal, ContactPoint<T> const& p, std::array<Frame<T>, 2> const& f,
                     std::array<Wrench<T>, 2>& w) {
  if (!(value_of(p.handover.share) < 1.0)) return;
  Vec<T, 3> const& s = p.handover.slope;
  T const stored = -normal.template potential<T>(p.depth);
  act<T>({s[0] * stored, s[1] * stored, s[2] * stored}, p.handover.place, f, w);
}
/// Potential energy of the normal forces at all contact points [J].
template <class G, class N>
double potential_of_points(G const& geometry, N const& normal, std::array<Frame<double>, 2> const& f) {
  double sum = 0.0;
  auto const at_point = [&](ContactPoint<double> const& p) {
    sum += normal.template potential<double>(p.depth) * p.handover.share;
  };
  geometry.template for_each_point<double>(f[0], f[1], PointVisitor<double>(at_point));
  return sum;
}
}  // namespace detail

/// Contact force between two markers: N n + F_t on a at each contact point, with the normal force N, the normal n and
/// the friction F_t. The opposite force acts on b. The velocity of either body is that of its material point at the
/// contact point.
template <ContactGeometry G, NormalForce N = SpringDamperContact, ContactFriction F = Friction>
struct Contact {
  using Geometry = G;  ///< type of the geometry
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = G::needs;
  static constexpr MarkerKind needs_of_second = [] {
    if constexpr (requires { G::needs_of_second; })
      return G::needs_of_second;
    else
      return G::needs;
  }();

  G geometry;       ///< contact geometry
  N normal;         ///< normal force law
  F friction = {};  ///< friction law

  void check(std::string const& name) const {
    geometry.check(name);
    normal.check(name);
    friction.check(name);
  }
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const { return geometry.may_touch(a, b); }
  /// True if neither friction nor the normal force dissipates energy.
  bool is_lossless() const
    requires requires(N const& law) { law.is_lossless(); }
  {
    return friction.coefficient == 0.0 && normal.is_lossless();
  }
  /// True if the shapes do not overlap at the frames `from` and `to` of a and b, but pass through each other on the
  /// straight path between these frames.
  bool passes(Frame<double> const (&from)[2], Frame<double> const (&to)[2]) const
    requires requires(G const& shape) { shape.passes(from, to); }
  {
    return geometry.passes(from, to);
  }
  ContactReach reach(Frame<double> const& b) const
    requires HasReach<G>
  {
    return geometry.reach(b);
  }

  /// Calls visit(point, v, N) for every contact point, with the velocity v of a relative to b at the point and the
  /// normal force N.
  template <StateScalar T, class Visit>
  void for_each_point(std::array<Frame<T>, 2> const& f, Visit&& visit) const {
    detail::for_each_pressed_point<T>(geometry, normal, f, visit);
  }

  /// Force on a at a contact point [N], with the velocity v (3) of a relative to b [m/s] and the normal force n [N].
  template <StateScalar T>
  Vec<T, 3> force_at(ContactPoint<T> const& p, Vec<T, 3> const& v, T const& n) const {
    Vec<T, 3> force(p.normal[0] * n, p.normal[1] * n, p.normal[2] * n);
    if (friction.coefficient > 0.0) {
      Vec<T, 3> const slip = detail::shifted<T>(v, p.normal, -v.dot(p.normal));
      force = detail::shifted<T>(force, slip, -friction.template resistance<T>(slip.dot(slip), n));
    }
    return force;
  }

  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    std::array<Wrench<T>, 2> w;
    for_each_point(f, [&](ContactPoint<T> const& p, Vec<T, 3> const& v, T const& n) {
      if (value_of(n) > 0.0) detail::act<T>(force_at(p, v, n), p.place, f, w);
      detail::act_at_handover<T>(normal, p, f, w);
    });
    return w;
  }

  /// Adds the approximate stiffness Jᵀ(N′ n nᵀ + F′ (1 − n nᵀ))J of each contact point to `of_a` and `of_b`.
  /// J = [1, −ρ×] with the vector ρ from the marker to the point, and N′ = ck ∂N/∂d + cd ∂N/∂ḋ.
  /// F′ = cd μ N/√(v² + v_s²) with the slip velocity v is cd times the ratio of friction force and slip velocity. This
  /// secant slope is never less than the derivative of the friction force. Newton's method therefore approaches v = 0
  /// from one side and does not overshoot. The rotation of n, the change of F_t with N, and changes of the weights of
  /// faces are neglected.
  void own_stiffness(std::array<Frame<double>, 2> const& f, double ck, double cd, Mat<double, 6, 6>& of_a,
                     Mat<double, 6, 6>& of_b) const {
    for_each_point<double>(f, [&](ContactPoint<double> const& p, Vec3 const& v, double n) {
      if (n <= 0.0) return;
      double const across = normal.slope(p.depth, -v.dot(p.normal), ck, cd) * p.handover.share;
      double along = 0.0;
      if (friction.coefficient > 0.0) {
        double const vn = v.dot(p.normal), speed2 = v.dot(v) - vn * vn;
        along = friction.slope(speed2, n, cd);
      }
      Vec3 const arm_a = p.place - f[0].r, arm_b = p.place - f[1].r;
      add(p, across, along, arm_a, arm_a, of_a);
      add(p, across, along, arm_b, arm_b, of_b);
    });
  }

  /// Adds the stiffness of the pair with respect to the motion of both bodies to `to`, with the matrix K of
  /// `SlipTangent` at each contact point. ratio(slot, v, s) returns the friction ratio w (3) at the slip velocity v
  /// (3), with s = √(v² + v_s²). \param adds_remainder adds only the difference between K and the derivative of the
  /// force
  template <class Ratio>
  void pair_stiffness(std::array<Frame<double>, 2> const& f, double ck, double cd, PairStiffness const& to,
                      Ratio&& ratio, bool adds_remainder) const {
    for_each_point<double>(f, [&](ContactPoint<double> const& p, Vec3 const& v, double n) {
      if (n <= 0.0) return;
      double const vn = v.dot(p.normal);
      SlipTangent k{normal.slope(p.depth, -vn, ck, cd) * p.handover.share, p.normal, Vec3(v - vn * p.normal)};
      k.add_friction(friction, n, cd, [&](double s) { return ratio(p.slot, k.v, s); });
      to.add(adds_remainder ? k.remainder() : k.matrix(), p.place - f[0].r, p.place - f[1].r);
    });
  }

  double potential(std::array<Frame<double>, 2> const& f, double) const {
    return detail::potential_of_points(geometry, normal, f);
  }

 private:
  /// Adds Jaᵀ(across n nᵀ + along (1 − n nᵀ))Jb with J = [1, −ρ×] and the arms ρ = a and ρ = b (3) [m].
  static void add(ContactPoint<double> const& p, double across, double along, Vec3 const& a, Vec3 const& b,
                  Mat<double, 6, 6>& sum) {
    Vec3 const ma = a.cross(p.normal), mb = b.cross(p.normal);
    double const ab = a.dot(b);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double const d = across - along;
        sum(i, j) += d * p.normal[i] * p.normal[j] + (i == j ? along : 0.0);
        sum(3 + i, j) += d * ma[i] * p.normal[j];
        sum(i, 3 + j) += d * p.normal[i] * mb[j];
        sum(3 + i, 3 + j) += d * ma[i] * mb[j] + along * ((i == j ? ab : 0.0) - b[i] * a[j]);
      }
    // [1, −a×]ᵀ[1, −b×] has −b× above and a× below the diagonal
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      sum(i, 3 + j) += along * b[k];
      sum(i, 3 + k) -= along * b[j];
      sum(3 + j, i) += along * a[k];
      sum(3 + k, i) -= along * a[j];
    }
  }
};

namespace detail {
/// True if x and y lie outside a sphere of radius `reach` [m] about zero, and the line between them enters the sphere
/// by more than a twentieth of the radius.
inline bool passes_through(Vec3 const& x, Vec3 const& y, double reach) {
  Vec3 const way = y - x;
  double const length2 = way.dot(way), outside = reach * reach;
  if (length2 < 0.09 * outside || x.dot(x) < outside || y.dot(y) < outside) return false;
  double const nearest = -x.dot(way) / length2;
  return nearest > 0.0 && nearest < 1.0 && x.dot(x) - nearest * nearest * length2 < 0.9025 * outside;
}
}  // namespace detail

/// Sphere of radius `radius` about marker a on the plane z = 0 of marker b, on the side of positive z.
struct SphereOnPlane {
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  Required<double> radius;  ///< radius of the sphere [m]

  void check(std::string const& name) const { require_not_negative(radius, name, ": the sphere's radius", "m"); }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const arm = a.r - b.r, n(b.A(0, 2), b.A(1, 2), b.A(2, 2));
    return arm.dot(n) < radius;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::half_space(b.r, {b.A(0, 2), b.A(1, 2), b.A(2, 2)}, radius);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    Vec<T, 3> const arm = a.r - b.r, n(b.A(0, 2), b.A(1, 2), b.A(2, 2));
    T const depth = T(radius.value) - arm.dot(n);
    if (value_of(depth) > 0.0) visit(ContactPoint<T>{detail::shifted<T>(a.r, n, T(-radius.value)), n, depth});
  }
};

/// Spheres about both markers. Concentric spheres have no normal and therefore no contact force.
struct SphereOnSphere {
  static constexpr MarkerKind needs = MarkerKind::point;
  Required<double> radius_a;  ///< radius of the sphere about marker a [m]
  Required<double> radius_b;  ///< radius of the sphere about marker b [m]

  void check(std::string const& name) const {
    require_not_negative(radius_a, name, ": the radius of the first sphere", "m");
    require_not_negative(radius_b, name, ": the radius of the second sphere", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const line = a.r - b.r;
    double const reach = radius_a + radius_b;
    return line.dot(line) < reach * reach;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::sphere(b.r, radius_a + radius_b);
  }
  /// True if the spheres pass through each other on the straight path from the frames `from` to the frames `to` of a
  /// and b. A depth of at most 5 % of the sum of the radii does not count.
  template <class = void>  // compiled where it is used
  bool passes(Frame<double> const (&from)[2], Frame<double> const (&to)[2]) const {
    return detail::passes_through(from[0].r - from[1].r, to[0].r - to[1].r, radius_a + radius_b);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    using std::sqrt;
    Vec<T, 3> const line = a.r - b.r;
    T const distance = sqrt(line.dot(line)), depth = T(radius_a + radius_b) - distance;
    if (!(value_of(depth) > 0.0) || value_of(distance) == 0.0) return;
    Vec<T, 3> const n(line[0] / distance, line[1] / distance, line[2] / distance);
    visit(ContactPoint<T>{detail::shifted<T>(b.r, n, T(radius_b.value) - depth * 0.5), n, depth});
  }
};

/// Sphere of radius `radius` about marker a on the outside of an infinitely long cylinder about the z axis of marker b.
/// Use the radius zero for points of a belt.
struct SphereOnCylinder {
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  Required<double> radius;    ///< radius of the sphere [m]
  Required<double> cylinder;  ///< radius of the cylinder [m]

  void check(std::string const& name) const {
    require_not_negative(radius, name, ": the sphere's radius", "m");
    require_positive(cylinder, name, ": the cylinder's radius", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const arm = a.r - b.r, axis(b.A(0, 2), b.A(1, 2), b.A(2, 2));
    double const reach = radius + cylinder, along = arm.dot(axis);
    return arm.dot(arm) - along * along < reach * reach;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::cylinder(b.r, {b.A(0, 2), b.A(1, 2), b.A(2, 2)}, radius + cylinder);
  }
  /// True if the sphere passes through the cylinder on the straight path from the frames `from` to the frames `to` of a
  /// and b. A depth of at most 5 % of the sum of the radii does not count.
  template <class = void>  // compiled where it is used
  bool passes(Frame<double> const (&from)[2], Frame<double> const (&to)[2]) const {
    auto const across = [](Frame<double> const(&f)[2]) {
      Vec3 const arm = f[0].r - f[1].r;
      Vec3 out = Vec3::Zero();
      for (int i = 0; i < 2; ++i) out[i] = f[1].A(0, i) * arm[0] + f[1].A(1, i) * arm[1] + f[1].A(2, i) * arm[2];
      return out;
    };
    return detail::passes_through(across(from), across(to), radius + cylinder);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    using std::sqrt;
    Vec<T, 3> const axis(b.A(0, 2), b.A(1, 2), b.A(2, 2)), arm = a.r - b.r;
    Vec<T, 3> const line = detail::shifted<T>(arm, axis, -arm.dot(axis));
    T const distance = sqrt(line.dot(line)), depth = T(radius + cylinder) - distance;
    if (!(value_of(depth) > 0.0) || value_of(distance) == 0.0) return;
    Vec<T, 3> const n(line[0] / distance, line[1] / distance, line[2] / distance);
    visit(ContactPoint<T>{detail::shifted<T>(a.r, n, T(-radius.value)), n, depth});
  }
};

}  // namespace polybody
