#pragma once
/// \file
/// Gradient-deficient ANCF cable in space [thesis Eq. 3.16–3.20, 4.8; Gerstmayr & Shabana 2006].
/// Theory: Eqs. 2.12 to 2.16, 2.29 to 2.31.

#include <polybody/bodies/ancf/cable_laws.hpp>
#include <polybody/bodies/shared/elastic_chain.hpp>

namespace polybody {

/// Strain groups of a cable: axial strain and bending, each with its number of Gauss points.
template <class Strain, int axial_points, int bending_points>
using CableGroups =
    std::tuple<StrainGroup<CableAxial<Strain, axial_points>>, StrainGroup<CableBending<Strain, bending_points>>>;

/// Gradient-deficient ANCF cable in space [thesis Eq. 3.16–3.20, 4.8; Gerstmayr & Shabana 2006]. The position field is
/// a cubic Hermite polynomial with the coordinates (r, r′) at each node, 12 per element. The mass matrix is constant.
/// The cable has no torsion, and its section does not deform. Of the constants of the bar, only EA, EI and the mass
/// per length have an effect. With s_i of `hermite_shape`,
///   r(ξ) = Σ s_i e_i,   M = Aρ ∫ s_i s_j dx ⊗ 1,   U = ½ ∫ (EA ε² + EI κ·κ) dx.
/// `AncfCable<>::from(bar, n)` has Green strain, `AncfCable<EngineeringStrain>` has engineering strain. The numbers of
/// Gauss points for axial strain and bending are template parameters; 5 and 3 are suitable for the cubic field
/// [Gerstmayr & Irschik 2008].
///
/// A marker has a position and a tangent. The rotation of the section about the tangent is undetermined: ω = r′ ×
/// ṙ′/|r′|² has no component along r′, and a moment along r′ has no effect. The other two axes of the marker follow
/// from the reference axes by the smallest rotation. Use `Revolute` about the tangent as a clamp, with the marker of
/// the cable as the second marker.
template <class Strain = GreenStrain, int axial_points = 5, int bending_points = 3>
class AncfCable : public ElasticChain<6, CableGroups<Strain, axial_points, bending_points>> {
  using Groups = CableGroups<Strain, axial_points, bending_points>;
  using Axial = std::tuple_element_t<0, Groups>;
  using Bending = std::tuple_element_t<1, Groups>;
  using Chain = ElasticChain<6, Groups>;

 public:
  using Chain::coordinates, Chain::elements, Chain::first_column;
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::axis;
  static constexpr bool constant_mass = true;
  static constexpr bool vectorised_kernels = true;
  static constexpr char const* name = "AncfCable";  ///< name of the body type in messages
  template <class T>
  using Element = Vec<T, 12>;
  using ElementMatrix = typename Chain::ElementMatrix;
  using PointMap = Mat<RealFor<Strain>, 3, 12>;  ///< S of r = S e, 3×12
  static constexpr Index default_elements = 8;   ///< number of elements of `from(bar)` (`BarMesh`)
  static constexpr int gradients = 1;            ///< number of position gradients that are linear in the coordinates

  /// Material point of the axis: element, and position ξ ∈ [0, 1] along the element.
  struct Point {
    Index element = 0;  ///< index of the element, counted from the first end of the bar
    double xi = 0.0;    ///< position ξ ∈ [0, 1] from the first node of the element to the second
  };

  /// Cable from the straight bar, with n elements of equal length.
  /// \throws InvalidInput for n outside [1, 10⁷], and for invalid data of the bar.
  static AncfCable from(Bar const& bar, Index n) {
    return from(bar, n, [](double s) { return Placement::at({s, 0, 0}); });
  }
  /// Cable from the straight bar, with the number of elements of `mesh`.
  static AncfCable from(Bar const& bar, BarMesh const& mesh = {}) {
    return from(bar, mesh.elements.value_or(default_elements));
  }
  /// Cable of n elements along `curve`, with nodes at equal arc lengths. The undeformed shape remains straight, so the
  /// initial configuration is bent.
  /// \throws InvalidInput for n outside [1, 10⁷], and for a curve that is not parameterised by its arc length. The
  /// axial strain of the cubic through the nodes must lie in (−0.1, 0.1).
  static AncfCable from(Bar const& bar, Index n, ReferenceCurve const& curve) {
    require_elements(n, "AncfCable");
    return AncfCable(bar, polybody::constants(bar), n, curve);
  }

  char const* coordinate_unit(Index i) const { return i % Chain::node_columns < 3 ? "m" : "1"; }
  double length() const { return length_; }
  double element_length() const { return l_; }
  BarConstants const& constants() const { return constants_; }
  /// Warning of section matrices of the bar that are probably not in SI units; empty if there is none.
  std::string const& unit_warning() const { return unit_warning_; }

  /// Point at the distance s along the axis from the first end [m].
  /// \throws InvalidInput for s outside the bar.
  Point at(double s) const {
    double const x = require_inside(s, length_, name) / l_;
    Index const e = std::min(Index(x), elements() - 1);
    return {e, x - double(e)};
  }

  /// Shape functions s_i of r = Σ s_i e_i, and their derivatives with respect to arc length. e_i are the entries 3i to
  /// 3i + 2 of the coordinates of an element.
  ShapeValues<4> axis_shape(double xi) const { return hermite_shape(xi, l_); }

  void reference(std::span<double> q) const { std::copy(reference_.begin(), reference_.end(), q.begin()); }
  template <class T = double>  // compiled only if used
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    for (Index i = 0; i <= elements(); ++i) {
      Vec<T, 3> const r = part<3>(q, 6 * i), slope = part<3>(q, 6 * i + 3);
      part<3>(v, 6 * i) = v0 + omega.cross(r);
      part<3>(v, 6 * i + 3) = omega.cross(slope);
    }
  }

  void mass(Index, std::span<double const>, ElementMatrix& m) const {
    m.setZero();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 3; ++k) m(3 * i + k, 3 * j + k) = mass_(i, j);
  }

  bool has_same_elements(AncfCable const& other) const { return this->same_strains(other) && mass_ == other.mass_; }
  /// Product M a with the accelerations of one element.
  template <KernelScalar T>
  void element_inertia(Element<T> const& a, Element<T>& out) const {
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) {
        T sum = a[k] * mass_(i, 0);
        for (int j = 1; j < 4; ++j) sum += a[3 * j + k] * mass_(i, j);
        out[3 * i + k] = sum;
      }
  }
  template <StateScalar T>
  void inertia(Index e, std::span<T const>, std::span<T const> a, Element<T>& out) const {
    element_inertia<T>(this->of_element(e, a), out);
  }
  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Element<T>& out) const {
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) out[3 * i + k] = T(weight_[i] * g[k]);
  }

  template <class T = double>  // compiled only if used
  double kinetic_energy(Index e, std::span<double const>, std::span<double const> v) const {
    Element<T> const x = part<12>(v, first_column(e));
    Element<T> momentum;
    element_inertia<T>(x, momentum);
    return 0.5 * x.dot(momentum);
  }
  template <class T = double>  // compiled only if used
  double gravity_energy(Index e, std::span<double const> q, Vec3 const& g) const {
    Element<T> const x = part<12>(q, first_column(e));
    Element<T> weight;
    gravity<T>(e, q, g, weight);
    return -x.dot(weight);
  }

  /// Matrix S of r = S e at `p`, 3×12 and constant. The coordinates e begin at `first_column(p)`.
  PointMap position_map(Point const& p) const { return map_of(hermite_shape(p.xi, l_).s); }
  /// Matrix S′ of r′ = S′ e at `p`, 3×12 and constant. r′ is the only gradient of a cable.
  PointMap gradient_map(Point const& p, int) const { return map_of(hermite_shape(p.xi, l_).ds); }

  /// Section strains at `p`, in the axes of a marker there (`HasSections`). A cable has axial strain and curvature, and
  /// neither shear nor torsion.
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    Element<double> const x = element_of(p, q);
    return in_section_axes(p, x, axial().strains(p.xi, l_, x)[0], bending().strains(p.xi, l_, x));
  }
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    Element<double> const x = element_of(p, q);
    return in_section_axes(p, x, axial().stress(axial().strains(p.xi, l_, x))[0],
                           bending().stress(bending().strains(p.xi, l_, x)));
  }

  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    ShapeValues<4> const s = hermite_shape(p.xi, l_);
    Index const first = first_column(p);
    Vec<T, 3> r, slope, v_r, rate;
    for (int k = 0; k < 3; ++k) {
      r[k] = slope[k] = v_r[k] = rate[k] = T(0.0);
      for (int i = 0; i < 4; ++i) {
        r[k] += q[first + 3 * i + k] * s.s[i];
        slope[k] += q[first + 3 * i + k] * s.ds[i];
        v_r[k] += v[first + 3 * i + k] * s.s[i];
        rate[k] += v[first + 3 * i + k] * s.ds[i];
      }
    }
    T const inverse = T(1.0) / detail::dot(slope, slope);
    Mat<T, 3, 3> const turned = smallest_turn<T>(slope, axes_[std::size_t(p.element)]);
    T const fade = detail::dot(slope, rate) * inverse * (-2.0);  // ω˙ = r′ × r̈′/n² − 2 (r′·ṙ′) ω/n², n = |r′|
    T along[3];
    for (int k = 0; k < 3; ++k) {
      int const j = (k + 1) % 3, l = (k + 2) % 3;
      T const w = (slope[j] * rate[l] - slope[l] * rate[j]) * inverse;
      out.frame.r[k] = r[k];
      out.frame.v[k] = v_r[k];
      out.frame.w[k] = w;
      out.bias[k] = T(0.0);
      out.bias[3 + k] = w * fade;
      for (int i = 0; i < 3; ++i)
        out.frame.A(i, k) = turned(i, 0) * axes(0, k) + turned(i, 1) * axes(1, k) + turned(i, 2) * axes(2, k);
      along[k] = slope[k] * inverse;
    }
    for (int i = 0; i < 4; ++i) {  // columns of nodal vector i: s e_k above r′ × e_k s′/n²
      T *const x = out.jacobian + 18 * i, *const y = x + 6, *const z = y + 6;
      double const ds = s.ds[std::size_t(i)];
      T const none(0.0), here(s.s[std::size_t(i)]), a = along[0] * ds, b = along[1] * ds, c = along[2] * ds;
      x[0] = y[1] = z[2] = here;
      x[1] = x[2] = x[3] = y[0] = y[2] = y[4] = z[0] = z[1] = z[5] = none;
      x[4] = c;
      x[5] = -b;
      y[3] = -c;
      y[5] = a;
      z[3] = b;
      z[4] = -a;
    }
    out.shape = JacobianShape::dense;
    out.columns = 12;
  }

  /// Load stiffness ∂(Jᵀw)/∂e of the wrench `w`. Only the term s_i′ (m × r′)/n² of Jᵀw, n = |r′|, depends on the
  /// coordinates: ∂/∂r′ = m̃/n² − 2 (m × r′) r′ᵀ/n⁴.
  template <class T>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, Mat<T, 12, 12>& k) const {
    ShapeValues<4> const s = hermite_shape(p.xi, l_);
    Vec<T, 3> const slope = slope_of(s, element_of(p, q));
    T const n2 = slope.squaredNorm();
    Mat<T, 3, 3> const each = skew<T>(w.m) / n2 - (2.0 / (n2 * n2)) * w.m.cross(slope) * slope.transpose();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) k.template block<3, 3>(3 * i, 3 * j) = (s.ds[i] * s.ds[j]) * each;
  }

 private:
  Axial const& axial() const { return std::get<0>(this->groups_of(0)); }
  Bending const& bending() const { return std::get<1>(this->groups_of(0)); }

  AncfCable(Bar const& bar, BarConstants const& c, Index n, ReferenceCurve const& curve);

  static PointMap map_of(std::array<double, 4> const& s) {
    PointMap map = detail::zeros<PointMap>();
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) map(k, 3 * i + k) = s[std::size_t(i)];
    return map;
  }
  Element<double> element_of(Point const& p, std::span<double const> q) const { return part<12>(q, first_column(p)); }
  static Vec3 slope_of(ShapeValues<4> const& s, Element<double> const& x) {
    Vec3 slope(0.0, 0.0, 0.0);
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) slope[k] += s.ds[std::size_t(i)] * x[3 * i + k];
    return slope;
  }
  template <class T>
  Vec6 in_section_axes(Point const& p, Element<double> const& x, double along, Vec<T, 3> const& bending) const {
    Vec3 const slope = slope_of(hermite_shape(p.xi, l_), x);
    Vec6 out = Vec6::Zero();
    out[0] = along;
    out.tail<3>() = smallest_turn<T>(slope, axes_[std::size_t(p.element)]).transpose() * bending;
    return out;
  }

  /// Axes `from` after the smallest rotation of their first axis onto `slope`. If the angle exceeds a right angle, the
  /// axes are first rotated by π about their third axis, so that the smallest rotation is unique.
  template <StateScalar T>
  static Mat<T, 3, 3> smallest_turn(Vec<T, 3> const& slope, Mat3 from) {
    using std::sqrt;
    Vec<T, 3> const t = slope / sqrt(detail::dot(slope, slope));
    if (value_of(t[0]) * from(0, 0) + value_of(t[1]) * from(1, 0) + value_of(t[2]) * from(2, 0) < 0.0)
      for (int i = 0; i < 3; ++i) {
        from(i, 0) *= -1.0;
        from(i, 1) *= -1.0;
      }
    Vec<T, 3> const e = from.col(0).template cast<T>();
    Mat<T, 3, 3> const turn = skew<T>(e.cross(t));
    Mat<T, 3, 3> const both = turn * from.template cast<T>();
    return from.template cast<T>() + both + turn * both * (T(1.0) / (detail::dot(e, t) + 1.0));
  }

  BarConstants constants_;
  double length_;
  double l_;
  std::string unit_warning_;
  Mat<RealFor<Strain>, 4, 4> mass_ = detail::zeros<decltype(mass_)>();  ///< mass matrix of each component
  Vec4 weight_ = detail::zeros<Vec4>();  ///< generalised weight per unit of gravity, for each component
  std::vector<double> reference_;
  std::vector<Mat3> axes_;  ///< axes of the reference at the middle of each element
};

template <class Strain, int axial_points, int bending_points>
AncfCable<Strain, axial_points, bending_points>::AncfCable(Bar const& bar, BarConstants const& c, Index n,
                                                           ReferenceCurve const& curve)
    : Chain(n, {{Axial(c, bar.damping, bar.length / double(n), Vec<double, 1>(bar.pretension)),
                 Bending(c, bar.damping, bar.length / double(n))}}),
      constants_(c),
      length_(bar.length),
      l_(bar.length / double(n)),
      unit_warning_(detail::unit_warning(bar)) {
  for (GaussPoint const& g : gauss<4>) {
    ShapeValues<4> const s = hermite_shape(g.xi, l_);
    double const mass = g.weight * l_ * c.mass_per_length;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) mass_(i, j) += mass * s.s[i] * s.s[j];
      weight_[i] += mass * s.s[i];
    }
  }
  reference_.resize(std::size_t(coordinates()));
  Mat<RealFor<Strain>, 3, 3> const axes = bar.placement.axes;
  for (Index i = 0; i <= elements(); ++i) {
    Placement const section = curve(double(i) * l_);
    section.check(name);
    part<3>(std::span<double>(reference_), 6 * i) = bar.placement.origin + axes * section.origin;
    part<3>(std::span<double>(reference_), 6 * i + 3) = axes * section.axes.col(0);
  }
  for (Index e = 0; e < elements(); ++e) {
    for (GaussPoint const& g : gauss<3>) {
      double const off = axial().strains(g.xi, l_, element_of({e, g.xi}, reference_))[0];
      if (!(std::abs(off) < 0.1))
        throw InvalidInput(
            "reference_curve.arc_length",
            {ErrorObject{"AncfCable"}, ": element ", e + 1, ", counted from 1, has a strain of ", ErrorValue{off},
             ", but the limit is 0.1. Parametrise the reference curve by its arc length, from 0 to the bar's length, "
             "or use more elements."});
    }
    axes_.push_back(axes * curve((double(e) + 0.5) * l_).axes);
  }
}

}  // namespace polybody
