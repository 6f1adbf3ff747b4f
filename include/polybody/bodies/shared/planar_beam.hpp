#pragma once
/// \file
/// Flexible bar in the plane as a chain of equal two-node elements.
/// Theory: Eq. 2.32.

#include <algorithm>
#include <tuple>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/elastic_chain.hpp>

namespace polybody::detail {

/// Type of the tuple of strain groups for the strain laws of a beam theory.
template <class Laws>
struct GroupsOf;
template <class... Laws>
struct GroupsOf<std::tuple<Laws...>> {
  using type = std::tuple<StrainGroup<Laws>...>;
  /// Creates the groups of an element of length l. A pretension is the initial value of the first stress, the axial
  /// force.
  static type make(BarConstants const& c, Bar const& bar, double l) {
    type groups(StrainGroup<Laws>(c, bar.damping, l)...);
    using First = std::tuple_element_t<0, type>;
    typename First::Strains initial = First::Strains::Zero();
    initial[0] = bar.pretension;
    std::get<0>(groups) = First(c, bar.damping, l, initial);
    return groups;
  }
};

/// Product s e of a matrix s (2×n) and a vector e (n). Loops compile faster than expressions of Eigen.
template <class T, int n>
Vec<T, 2> times(Mat<double, 2, n> const& s, Vec<T, n> const& e) {
  Vec<T, 2> r(e[0] * s(0, 0), e[0] * s(1, 0));
  for (int j = 1; j < n; ++j)
    for (int i = 0; i < 2; ++i) r[i] += e[j] * s(i, j);
  return r;
}

}  // namespace polybody::detail

namespace polybody::planar {

/// Position, velocity and angle of the centre line at one point of an element with the coordinates e.
template <StateScalar T>
struct CentreLine {
  Vec<T, 2> r;  ///< position [m]
  Vec<T, 2> v;  ///< velocity [m/s]
  T angle;      ///< angle from world x to the normal of the section [rad]
  T rate;       ///< rate of the angle [rad/s]
  T rate_bias;  ///< second derivative of the angle for ë = 0 [rad/s²]
};

/// Angle of a section as a function of the coordinates e of its element.
template <StateScalar T, int n>
struct SectionAngle {
  T angle;        ///< θ [rad]
  Vec<T, n> row;  ///< θ̇ = row · ė
  T bias;         ///< θ̈ for ë = 0 [rad/s²]
};

/// Flexible bar in the plane as a chain of equal two-node elements. The policy `Theory` defines the interpolation and
/// the strains (`Theory::Groups`). This class computes mass, gravity and markers; `ElasticChain` computes the elastic
/// forces.
template <class Theory>
class Beam : public ElasticChain<Theory::node_columns, typename detail::GroupsOf<typename Theory::Groups>::type> {
  using Groups = detail::GroupsOf<typename Theory::Groups>;

 public:
  static constexpr World world = World::plane;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = true;
  using Chain = ElasticChain<Theory::node_columns, typename Groups::type>;  ///< nodes and strain groups
  using Chain::coordinates, Chain::element_columns, Chain::elements, Chain::first_column, Chain::node_columns;
  static constexpr bool vectorised_kernels = Theory::vectorised_kernels;
  template <class T>
  using Element = Vec<T, element_columns>;
  using ElementMatrix = Mat<double, element_columns, element_columns>;
  using PointMap = Mat<double, 2, element_columns>;    ///< S of r = S e, 2×n
  static constexpr int gradients = Theory::gradients;  ///< number of gradients that are linear in the coordinates
  /// Number of elements of `from(bar)` (`BarMesh`). Displacements are cubic if gradients are coordinates, and linear
  /// otherwise.
  static constexpr Index default_elements = gradients > 0 ? 8 : 32;

  /// Material point: element, position ξ ∈ [0, 1] along the element, and distance y from the axis [m].
  struct Point {
    Index element = 0;  ///< index of the element, counted from the first end of the bar
    double xi = 0.0;    ///< position ξ ∈ [0, 1] from the first node of the element to the second
    double y = 0.0;     ///< distance from the axis within the section, positive to the left of the axis [m]
  };

  /// Beam from the straight bar, with n elements of equal length.
  /// \throws InvalidInput for n outside [1, 10⁷], a placement that leaves the plane, or a bar without a stiffness that
  /// the theory needs.
  static Beam from(Bar const& bar, Index n) {
    require_elements(n, Theory::name);
    BarConstants const c = polybody::constants(bar);
    Theory::check(c);
    return Beam(bar, c, n);
  }

  /// Beam from the straight bar, with the number of elements of `mesh`.
  static Beam from(Bar const& bar, BarMesh const& mesh = {}) {
    return from(bar, mesh.elements.value_or(default_elements));
  }

  /// Beam of n elements along `curve`, with nodes at equal arc lengths. The undeformed shape remains straight, so that
  /// the beam is bent in the reference state.
  /// \throws InvalidInput for n outside [1, 10⁷], a bar without a stiffness that the theory needs, and a curve that
  /// leaves the plane or is not parameterised by its arc length.
  static Beam from(Bar const& bar, Index n, ReferenceCurve const& curve) {
    Beam beam = from(bar, n);
    beam.laid_ = beam.nodes_on(bar.placement, curve);
    return beam;
  }

  /// Beam of n elements with the undeformed shape `curve`, free of stress except for the pretension. For zero
  /// pretension
  ///   U = ½ ∫ Σ C_i (ε_i − ε⁰_i)² dx, where ε⁰ are the strains when all nodes are on the curve.
  /// A circular arc of radius R is therefore straight under the moment EI/R.
  /// \throws InvalidInput for n outside [1, 10⁷], a bar without a stiffness that the theory needs, and a curve that
  /// leaves the plane or is not parameterised by its arc length. The axial strain of an element relative to the arc
  /// length must lie in (−0.1, 0.1).
  static Beam naturally_curved(Bar const& bar, Index n, ReferenceCurve const& curve) {
    Beam beam = from(bar, n);
    beam.bend_to(bar.placement, curve);
    return beam;
  }

  char const* coordinate_unit(Index i) const {
    return i % node_columns < 2 ? "m" : Theory::gradients > 0 ? "1" : "rad";
  }
  double length() const { return length_; }
  double element_length() const { return l_; }
  BarConstants const& constants() const { return constants_; }
  /// Warning of section matrices of the bar that are probably not in SI units; empty if there is none.
  std::string const& unit_warning() const { return unit_warning_; }

  /// Point at the distance s along the axis from the first end, and y from the axis [m].
  /// \throws InvalidInput for s outside the bar.
  Point at(double s, double y = 0.0) const {
    double const x = require_inside(s, length_, Theory::name) / l_;
    require_finite(y, Theory::name, ": y of a point");
    Index const e = std::min(Index(x), elements() - 1);
    return {e, x - double(e), y};
  }

  /// Shape functions s_i of r = Σ s_i e_i, and their derivatives with respect to arc length. e_i are the entries 2i and
  /// 2i + 1 of the coordinates of an element. Only for theories with a smooth axis.
  auto axis_shape(double xi) const
    requires requires { Theory::axis_shape(xi, 1.0); }
  {
    return Theory::axis_shape(xi, l_);
  }

  void reference(std::span<double> q) const {
    std::vector<double> const& nodes = laid_.empty() ? natural_ : laid_;
    std::copy(nodes.begin(), nodes.end(), q.begin());
    if (!nodes.empty()) return;
    for (Index i = 0; i <= elements(); ++i)
      part<node_columns>(q, i * node_columns) = Theory::reference_node(origin_, angle_, double(i) * l_);
  }
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    for (Index i = 0; i <= elements(); ++i)
      part<node_columns>(v, i * node_columns) =
          Theory::rigid_velocity(part<node_columns>(q, i * node_columns), v0.head<2>(), omega[2]);
  }

  void mass(Index, std::span<double const>, ElementMatrix& m) const { m = mass_; }

  bool has_same_elements(Beam const& other) const { return this->same_strains(other) && mass_ == other.mass_; }
  /// Product M a with the accelerations of one element.
  template <KernelScalar T>
  void element_inertia(Element<T> const& a, Element<T>& out) const {
    for (int i = 0; i < element_columns; ++i) {
      T sum = a[0] * mass_(i, 0);
      for (int j = 1; j < element_columns; ++j) sum += a[j] * mass_(i, j);
      out[i] = sum;
    }
  }
  template <StateScalar T>
  void inertia(Index e, std::span<T const>, std::span<T const> a, Element<T>& out) const {
    element_inertia<T>(this->of_element(e, a), out);
  }
  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Element<T>& out) const {
    for (int i = 0; i < element_columns; ++i) out[i] = T(weight(i, g));
  }

  double kinetic_energy(Index e, std::span<double const>, std::span<double const> v) const {
    Element<double> const x = this->of_element(e, v);
    Element<double> momentum;
    element_inertia<double>(x, momentum);
    return 0.5 * x.dot(momentum);
  }
  double gravity_energy(Index e, std::span<double const> q, Vec3 const& g) const {
    Element<double> force;
    gravity<double>(e, q, g, force);
    return -this->of_element(e, q).dot(force);
  }

  /// Matrix S of r = S e at `p`, 2×n and constant. The coordinates e begin at `first_column(p)`.
  /// \throws InvalidInput for a point off the axis, whose position depends on the angle of the section.
  PointMap position_map(Point const& p) const {
    if (p.y != 0.0)
      throw InvalidInput("body.point_off_axis",
                         {ErrorObject{Theory::name},
                          ": the position of a point off the axis is not linear in the coordinates. Use y = 0 "
                          "instead of y = ",
                          ErrorValue{p.y}, " m."});
    return Theory::position(p.xi, l_);
  }
  /// Matrix S′ of r′ = S′ e at `p`, 2×n and constant.
  PointMap gradient_map(Point const& p, int) const
    requires(Theory::gradients > 0)
  {
    return Theory::gradient(p.xi, l_);
  }

  /// Position, angle and motion of the centre line at `p`.
  template <StateScalar T>
  CentreLine<T> centre_line(Point const& p, std::span<T const> q, std::span<T const> v) const {
    Element<T> const x = this->of_element(p.element, q), xd = this->of_element(p.element, v);
    PointMap const s = Theory::position(p.xi, l_);
    CentreLine<T> c;
    c.r = detail::times(s, x);
    c.v = detail::times(s, xd);
    auto const turned = Theory::template rotation<T>(p.xi, l_, x, xd);
    c.angle = turned.angle;
    c.rate = turned.row.dot(xd);
    c.rate_bias = turned.bias;
    return c;
  }

  /// Marker kinematics: r = r₀ + y n, n = (−sin θ, cos θ);  ṙ = ṙ₀ − y t θ̇, t = (cos θ, sin θ);
  /// bias = −y (t θ̈ᵇ + n θ̇²), where θ̈ᵇ is the part of θ̈ without ë.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    using std::cos, std::sin;
    Element<T> const x = this->of_element(p.element, q), xd = this->of_element(p.element, v);
    PointMap const shape = Theory::position(p.xi, l_);
    auto const [angle, row, rate_bias] = Theory::template rotation<T>(p.xi, l_, x, xd);
    T const c = cos(angle), s = sin(angle), rate = row.dot(xd);
    Vec<T, 2> const t(c, s), n(-s, c), r = detail::times(shape, x), v0 = detail::times(shape, xd);
    Eigen::Map<Mat<T, 6, element_columns>> j(out.jacobian);
    j.setZero();
    out.bias.setZero();
    for (int i = 0; i < 2; ++i) {
      out.frame.r[i] = r[i] + n[i] * p.y;
      out.frame.v[i] = v0[i] - t[i] * (rate * p.y);
      out.frame.w[i] = T(0);
      out.bias[i] = (t[i] * rate_bias + n[i] * (rate * rate)) * (-p.y);
      for (int k = 0; k < element_columns; ++k) j(i, k) = shape(i, k) - (t[i] * p.y) * row[k];
    }
    for (int k = 0; k < 3; ++k) {
      out.frame.A(0, k) = c * axes(0, k) - s * axes(1, k);
      out.frame.A(1, k) = s * axes(0, k) + c * axes(1, k);
      out.frame.A(2, k) = T(axes(2, k));
    }
    out.frame.r[2] = out.frame.v[2] = T(0);
    out.frame.w[2] = rate;
    out.bias[5] = rate_bias;
    for (int k = 0; k < element_columns; ++k) j(5, k) = row[k];
    out.shape = JacobianShape::dense;
    out.columns = element_columns;
  }

  /// Load stiffness ∂(Jᵀw)/∂e of the wrench `w`. Jᵀw = Sᵀf + h c, with S of r₀ = S e, h of θ̇ = h·ė, and c = m − y t·f.
  /// The derivative is therefore c ∂h/∂e − y (n·f) h hᵀ.
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, ElementMatrix& k) const {
    Element<double> const x = this->of_element(p.element, q), rest = Element<double>::Zero();
    SectionAngle<double, element_columns> const turned = Theory::template rotation<double>(p.xi, l_, x, rest);
    double const c = std::cos(turned.angle), s = std::sin(turned.angle);
    Theory::rotation_hessian(p.xi, l_, x, k);
    double const moment = w.m[2] - p.y * (c * w.f[0] + s * w.f[1]), normal = p.y * (c * w.f[1] - s * w.f[0]);
    for (int j = 0; j < element_columns; ++j)
      for (int i = 0; i < element_columns; ++i) k(i, j) = k(i, j) * moment - normal * turned.row[i] * turned.row[j];
  }

  /// Section strains as a vector of six (`HasSections`). Components that the theory does not have are zero. Linear
  /// elements have the strains of their middle.
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    return in_space(p.element, [&](auto const& group) { return strains_of(group, p, q); });
  }
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return in_space(p.element, [&](auto const& group) { return group.stress(strains_of(group, p, q)); });
  }
  /// Strains of group G of the theory (counted from 0) at `p`, relative to the undeformed shape.
  template <int G>
  auto strains(Point const& p, std::span<double const> q) const {
    return strains_of(std::get<G>(this->groups_of(p.element)), p, q);
  }
  /// Stress resultants of group G of the theory (counted from 0) at `p`, without damping [N], [N m].
  template <int G>
  auto resultants(Point const& p, std::span<double const> q) const {
    return std::get<G>(this->groups_of(p.element)).stress(strains<G>(p, q));
  }

 private:
  [[gnu::cold]] Beam(Bar const& bar, BarConstants const& c, Index n);

  /// Entry i of the gravity force of an element.
  double weight(int i, Vec3 const& g) const { return gravity_(i, 0) * g[0] + gravity_(i, 1) * g[1]; }

  /// Vector of six with the entries of all groups, at the rows `Theory::section_rows`.
  template <class F>
  Vec6 in_space(Index element, F&& of_group) const {
    Vec6 out = Vec6::Zero();
    std::size_t k = 0;
    this->for_each_group(element, [&](auto const& group) {
      auto const x = of_group(group);
      for (Index i = 0; i < x.size(); ++i) out[Theory::section_rows[k++]] = x[i];
    });
    return out;
  }

  template <class Group>
  auto strains_of(Group const& group, Point const& p, std::span<double const> q) const {
    double const xi = Theory::gradients > 0 ? p.xi : 0.5;  // linear elements: only strains of the middle do not lock
    auto strain = group.strains(xi, l_, this->of_element(p.element, q));
    if (!natural_.empty()) strain -= group.strains(xi, l_, this->of_element(p.element, std::span(natural_)));
    return strain;
  }

  /// Coordinates of nodes that are placed on a curve at equal arc lengths.
  std::vector<double> nodes_on(Placement const& place, ReferenceCurve const& curve) const {
    require_curve(curve, Theory::name);
    std::vector<double> nodes(std::size_t(this->coordinates()));
    double angle = angle_;  // includes full revolutions
    for (Index i = 0; i <= elements(); ++i) {
      Placement const section = curve(double(i) * l_);
      angle += std::remainder(angle_ + section.planar_angle(Theory::name) - angle, 2.0 * std::numbers::pi);
      Vec3 const r = place.origin + place.axes * section.origin;
      part<node_columns>(std::span(nodes), i * node_columns) = Theory::reference_node(r.head<2>(), angle, 0.0);
    }
    for (Index e = 0; e < elements(); ++e) require_arc_length(e, this->of_element(e, std::span<double const>(nodes)));
    return nodes;
  }
  void bend_to(Placement const& place, ReferenceCurve const& curve) {
    natural_ = nodes_on(place, curve);
    std::vector<typename Groups::type> groups(std::size_t(elements()), this->groups_of(0));
    for (Index e = 0; e < elements(); ++e) {
      Element<double> const rest = this->of_element(e, std::span<double const>(natural_));
      std::apply([&](auto&... group) { (group.set_free(rest), ...); }, groups[std::size_t(e)]);
    }
    this->set_groups(std::move(groups));
  }
  void require_arc_length(Index e, Element<double> const& rest) const {
    for (GaussPoint const& g : gauss<3>) {
      double const off = std::get<0>(this->groups_of(0)).strains(g.xi, l_, rest)[0];
      if (!(std::abs(off) < 0.1))
        throw InvalidInput(
            "reference_curve.arc_length",
            {ErrorObject{Theory::name}, ": element ", e + 1, ", counted from 1, has a strain of ", ErrorValue{off},
             ", but the limit is 0.1. Parametrise the reference curve by its arc length, from 0 to the bar's length, "
             "or use more elements."});
    }
  }

  BarConstants constants_;
  double length_;
  double l_;
  std::string unit_warning_;
  Vec2 origin_;
  double angle_;
  std::vector<double> natural_;  ///< nodal coordinates of a curved undeformed shape
  std::vector<double> laid_;     ///< nodal coordinates of the reference state; empty if it is the undeformed shape
  ElementMatrix mass_ = ElementMatrix::Zero();
  Mat<double, element_columns, 2> gravity_ = Mat<double, element_columns, 2>::Zero();
};

// Defined outside of the class, so that a program with polybody::compiled does not compile it.
template <class Theory>
Beam<Theory>::Beam(Bar const& bar, BarConstants const& c, Index n)
    : Chain(n, {Groups::make(c, bar, bar.length / double(n))}),
      constants_(c),
      length_(bar.length),
      l_(bar.length / double(n)),
      unit_warning_(polybody::detail::unit_warning(bar)),
      origin_(bar.placement.origin.head<2>()),
      angle_(bar.placement.planar_angle(Theory::name)) {
  // M = ∫ (Aρ SᵀS + Iρ h hᵀ) dx with θ̇ = h·ė, gravity_ = Aρ ∫ Sᵀ dx; exact for the polynomials of the theory
  for (GaussPoint const& g : gauss<4>) {
    PointMap const s = Theory::position(g.xi, l_);
    Element<double> const rot = Theory::rotary(g.xi, l_);
    double const mass = g.weight * l_ * c.mass_per_length, inertia = g.weight * l_ * c.rotary_inertia;
    for (int i = 0; i < element_columns; ++i) {
      for (int j = 0; j < element_columns; ++j) {
        mass_(i, j) += mass * (s(0, i) * s(0, j) + s(1, i) * s(1, j));
        mass_(i, j) += inertia * rot[i] * rot[j];
      }
      for (int k = 0; k < 2; ++k) gravity_(i, k) += mass * s(k, i);
    }
  }
}

}  // namespace polybody::planar
