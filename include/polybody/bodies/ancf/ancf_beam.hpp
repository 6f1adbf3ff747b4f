#pragma once
/// \file
/// Fully parameterised two-node ANCF beam in space [Shabana & Yakoub 2001; thesis §3.5.4]. Theory: Eqs. 2.33 to 2.35.

#include <vector>

#include <polybody/bodies/ancf/ancf_continuum.hpp>
#include <polybody/bodies/ancf/ancf_elastic_line.hpp>
#include <polybody/bodies/shared/elastic_chain.hpp>

namespace polybody {

/// Fully parameterised two-node ANCF beam in space [Shabana & Yakoub 2001; Yakoub & Shabana 2001; thesis §3.5.4]. In an
/// element r₀(x) is cubic, and r_y and r_z are linear in x (ancf_field.hpp):
///   r(x, y, z) = r₀ + y r_y + z r_z.
/// A node has twelve coordinates (r, r_x, r_y, r_z), and coordinates add. The mass matrix is constant. The policy
/// `Elastic` computes the elastic force: `ElasticLine`, `CoupledLine` (sections with couplings, ancf_coupled_line.hpp)
/// or `Continuum`. Examples: `AncfBeam<>::from(bar, n)`, `AncfBeam<Continuum<>>::from(bar, n, curve)`.
template <class Elastic = ElasticLine>
class AncfBeam : public ElasticChain<12, typename Elastic::Groups> {
  using Chain = ElasticChain<12, typename Elastic::Groups>;

 public:
  using Chain::coordinates, Chain::element_columns, Chain::elements, Chain::first_column, Chain::node_columns;
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = true;
  static_assert(element_columns == ancf::columns);
  static constexpr bool vectorised_kernels = true;
  template <class T>
  using Element = Vec<T, element_columns>;
  using ElementMatrix = typename Chain::ElementMatrix;
  using PointMap = Mat<double, 3, element_columns>;  ///< S of r = S e, 3×24
  static constexpr Index default_elements = 16;      ///< number of elements of `from(bar)` (`BarMesh`)
  static constexpr bool on_line = std::derived_from<Elastic, ElasticLine>;  ///< true for strains of the axis
  static constexpr int gradients = 3;  ///< number of position gradients that are linear in the coordinates

  /// Material point: element, position ξ ∈ [0, 1] along the element, reference distances y, z from the axis [m].
  struct Point {
    Index element = 0;        ///< index of the element, counted from the first end of the bar
    double xi = 0.0;          ///< position ξ ∈ [0, 1] from the first node of the element to the second
    double y = 0.0, z = 0.0;  ///< distances from the axis, in the axes of the reference section [m]
  };

  /// Beam from the straight bar, with n elements of equal length. Both rotary inertias must be positive, because r_y or
  /// r_z has no mass otherwise, and the polar inertia must be Iρ_y + Iρ_z.
  /// \throws InvalidInput for n outside [1, 10⁷], other inertias, and a bar without a constant that `Elastic` needs.
  static AncfBeam from(Bar const& bar, Index n) {
    return AncfBeam(bar, n, [](double s) { return Placement{Vec3(s, 0, 0)}; }, true);
  }
  /// Beam from the straight bar, with the number of elements of `mesh`.
  static AncfBeam from(Bar const& bar, BarMesh const& mesh = {}) {
    return from(bar, mesh.elements.value_or(default_elements));
  }
  /// Beam of n elements with a curved or twisted reference, free of stress except for the pretension. The nodes have
  /// the positions and axes of `curve`; the element field interpolates between them.
  /// \throws InvalidInput as for the straight bar, for an element whose reference is turned inside out, and for nodes
  /// that coincide or are farther apart than the arc between them.
  static AncfBeam from(Bar const& bar, Index n, ReferenceCurve const& curve) { return AncfBeam(bar, n, curve, false); }

  char const* coordinate_unit(Index i) const { return i % node_columns < 3 ? "m" : "1"; }
  double length() const { return bar_.length; }
  double element_length() const { return l_; }
  BarConstants const& constants() const { return constants_; }
  /// Warning of section matrices of the bar that are probably not in SI units; empty if there is none.
  std::string const& unit_warning() const { return unit_warning_; }

  /// Point at the distance s along the axis from the first end, and (y, z) from the axis [m].
  /// \throws InvalidInput for s outside the bar.
  Point at(double s, double y = 0.0, double z = 0.0) const {
    double const x = require_inside(s, bar_.length, Elastic::name) / l_;
    require_finite(y, Elastic::name, ": y of a point");
    require_finite(z, Elastic::name, ": z of a point");
    Index const e = std::min(Index(x), elements() - 1);
    return {e, x - double(e), y, z};
  }

  /// Shape functions s_v of the axis, r₀ = Σ s_v e_v, and their derivatives with respect to arc length.
  ShapeValues<ancf::vectors> axis_shape(double xi) const {
    ShapeValues<4> const h = hermite_shape(xi, l_);
    ShapeValues<ancf::vectors> out{};
    for (std::size_t i = 0; i < 4; ++i) {
      std::size_t const v = i < 2 ? i : i + 2;  // r, r_x of each node
      out.s[v] = h.s[i];
      out.ds[v] = h.ds[i];
      out.dds[v] = h.dds[i];
    }
    return out;
  }

  void reference(std::span<double> q) const {
    for (Index i = 0; i <= elements(); ++i) {
      Placement const& p = nodes_[std::size_t(i)];
      part<3>(q, i * node_columns) = bar_.placement.origin + bar_.placement.axes * p.origin;
      Mat3 const axes = bar_.placement.axes * p.axes;
      for (int k = 0; k < 3; ++k) part<3>(q, i * node_columns + 3 + 3 * k) = axes.col(k);
    }
  }
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    for (Index i = 0; i < coordinates(); i += 3) {
      part<3>(v, i) = omega.cross(part<3>(q, i).eval());
      if (i % node_columns == 0) part<3>(v, i) += v0;
    }
  }

  void mass(Index e, std::span<double const>, ElementMatrix& m) const { m = inertia_of(e).mass; }

  bool has_same_elements(AncfBeam const& other) const {
    return this->same_strains(other) && inertia_.size() == 1 && other.inertia_.size() == 1 &&
           inertia_[0].mass == other.inertia_[0].mass;
  }
  /// Product M a with the accelerations of one element, if all elements are alike.
  template <KernelScalar T>
  void element_inertia(Element<T> const& a, Element<T>& out) const {
    times_mass(inertia_[0], a, out);
  }
  template <StateScalar T>
  void inertia(Index e, std::span<T const>, std::span<T const> a, Element<T>& out) const {
    times_mass<T>(inertia_of(e), this->of_element(e, a), out);
  }
  template <StateScalar T>
  void gravity(Index e, std::span<T const>, Vec3 const& g, Element<T>& out) const {
    Inertia const& inertia = inertia_of(e);
    for (int v = 0; v < ancf::vectors; ++v)
      for (int i = 0; i < 3; ++i) out[3 * v + i] = T(inertia.first_moment[v] * g[i]);
  }

  double kinetic_energy(Index e, std::span<double const>, std::span<double const> v) const {
    Element<double> const xd = this->of_element(e, v);
    Element<double> momentum;
    times_mass<double>(inertia_of(e), xd, momentum);
    return 0.5 * xd.dot(momentum);
  }
  double gravity_energy(Index e, std::span<double const> q, Vec3 const& g) const {
    Element<double> weight;
    gravity<double>(e, q, g, weight);
    return -this->of_element(e, q).dot(weight);
  }

  /// Matrix S (3×24, constant) of r = S e at `p`, and Jacobian of ṙ. The coordinates e begin at `first_column(p)`.
  PointMap position_map(Point const& p) const { return map_of(p, 0); }
  /// Matrix S_α of the gradient S_α e = ∂r/∂x, ∂r/∂y or ∂r/∂z at `p`, for `alpha` = 0, 1 or 2; 3×24 and constant.
  /// \throws InvalidInput for another `alpha`.
  PointMap gradient_map(Point const& p, int alpha) const {
    if (alpha < 0 || alpha > 2)
      throw InvalidInput(
          "ancf.gradient_direction",
          {ErrorObject{"AncfBeam"}, ": the direction of the position gradient must be 0 (x), 1 (y) or 2 (z), but is ",
           ErrorValue{alpha}, "."});
    return map_of(p, alpha + 1);
  }

  /// Marker kinematics of the material point `p`. The axes are those of the section at the axis of the beam
  /// (`Elastic::frame` of r_y and r_z). A point off the axis moves with r(x, y, z), which includes the strain of the
  /// section.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    Index const first = first_column(p);
    Mat<double, ancf::vectors, 4> const n = ancf::shape(p.xi, p.y, p.z, l_);
    Vec<T, 3> r[3], rate[3];  // r, r_y, r_z
    for (int k = 0; k < 3; ++k) {
      r[k].setZero();
      rate[k].setZero();
      for (int a = 0; a < ancf::vectors; ++a) {
        double const s = n(a, k == 0 ? 0 : k + 1);
        if (s == 0.0) continue;
        for (int i = 0; i < 3; ++i) {
          r[k][i] += q[std::size_t(first + 3 * a + i)] * s;
          rate[k][i] += v[std::size_t(first + 3 * a + i)] * s;
        }
      }
    }
    auto const f = frame_of<T>(r[1], r[2]);
    Vec<T, 6> const w = f.components(rate[1], rate[2]);
    out.frame.r = r[0];
    out.frame.v = rate[0];
    out.frame.A = f.R * axes.template cast<T>();
    out.frame.w = f.world(f.spin(w));
    out.bias.template head<3>().setZero();
    out.bias.template tail<3>() = f.world(f.acceleration(w));
    Mat<T, 3, 6> const turn = turning<T>(f);
    Eigen::Map<Mat<T, 6, element_columns>> j(out.jacobian);
    j.setZero();
    for (int a = 0; a < ancf::vectors; ++a)
      for (int i = 0; i < 3; ++i) {
        j(i, 3 * a + i) = T(n(a, 0));
        for (int k = 0; k < 3; ++k)
          if (a % 4 >= 2) j(3 + k, 3 * a + i) = turn(k, 3 * (a % 4 - 2) + i) * n(a, a % 4);
      }
    out.shape = JacobianShape::dense;
    out.columns = element_columns;
  }

  /// Load stiffness ∂(Jᵀw)/∂e of the wrench `w`. The force contributes nothing, because S is constant. If variations δ
  /// and δ̂ rotate the section by φ and φ̂, the moment gives m·(φ̂ × φ) + m·δ̂φ in the axes of the section.
  template <class T>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, Mat<T, 24, 24>& k) const {
    PointMap const by = map_of(p, 2), bz = map_of(p, 3);
    Element<T> const x = this->of_element(p.element, q);
    auto const f = frame_of<T>(by * x, bz * x);
    Vec<T, 3> const m = f.local(w.m);
    Mat<T, 6, 6> form = f.second(m), by_vectors = Mat<T, 6, 6>::Zero();
    for (int i = 0; i < 3; ++i) {  // φ·(m × φ̂)
      Vec<T, 6> const left = f.pull(f.axis(i)), right = f.pull(f.cross(f.axis(i), m));
      form += left * right.transpose();
    }
    f.add_form(form, 0, 0, by_vectors);
    k.setZero();
    std::array<double, 2> const s = {1.0 - p.xi, p.xi};
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        k.template block<6, 6>(12 * a + 6, 12 * b + 6) = s[std::size_t(a)] * s[std::size_t(b)] * by_vectors;
  }

  /// Strains Γ = Rᵀ r_x and K = axial(Rᵀ R_x) relative to the reference, with the axes R of the markers, as a vector of
  /// six (`HasSections`).
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    if constexpr (on_line) {
      Vec3 const stretch = strains<std::tuple_element_t<0, ElasticLine::Groups>>(p, q),
                 bend = strains<std::tuple_element_t<1, ElasticLine::Groups>>(p, q);
      Vec6 x;
      for (int i = 0; i < 3; ++i) {
        x[i] = stretch[i];
        x[3 + i] = bend[i];
      }
      return x;
    } else {
      return Elastic::section_strains(constants_, deformation(p, q), p.xi);
    }
  }
  /// Section forces without damping. `ElasticLine`: stiffness × strain + pretension. `Continuum`: stress integrals.
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    if constexpr (on_line)
      return Elastic::section_forces(bar_, this->groups_of(p.element), (double(p.element) + p.xi) * l_,
                                     section_strains(p, q));
    else
      return Elastic::section_forces(bar_, constants_, deformation(p, q), p.xi);
  }
  /// Section deformation of `ElasticLine`: (r_y² − 1, r_z² − 1)/2 and r_y·r_z at `p`, relative to the reference.
  Vec3 section_deformation(Point const& p, std::span<double const> q) const
    requires on_line
  {
    return strains<std::tuple_element_t<2, ElasticLine::Groups>>(p, q);
  }

  /// Deformation gradient F at `p`, from the axes of the reference section to world axes.
  Mat3 deformation_gradient(Point const& p, std::span<double const> q) const {
    return deformation(p, q).gradient(p.xi, p.y, p.z);
  }
  /// Green–Lagrange strain E at `p`, in the axes of the reference section.
  Mat3 strain(Point const& p, std::span<double const> q) const { return deformation(p, q).strain(p.xi, p.y, p.z); }
  /// Stress at `p` without damping, for `Continuum`. With `Locking::cured` the Poisson terms follow from the strain on
  /// the axis, and S₁₂, S₁₃ follow from GA, GA_z: these shear stresses are means over the section.
  Stress stress(Point const& p, std::span<double const> q) const
    requires(!on_line)
  {
    Mat3 const f = deformation_gradient(p, q);
    Mat3 const s = Elastic::second_piola(bar_, constants_, strain(p, q), strain({p.element, p.xi}, q));
    return {s, f * s * f.transpose() / f.determinant()};
  }

 private:
  using Inertia = ancf::Inertia;

  /// Constants of the section, for matrices at the first end of the bar.
  static BarConstants constants_of(Bar const& bar) {
    if constexpr (ancf::BySectionMatrices<Elastic>)
      return Elastic::constants(bar);
    else
      return polybody::constants(bar);
  }
  AncfBeam(Bar const& bar, Index n, ReferenceCurve const& curve, bool straight);

  /// Checks the reference of element `e`.
  /// \throws InvalidInput for ends that coincide, a chord longer than the element, or a section turned inside out.
  void check_reference(ancf::Reference const& ref, Index e) const {
    std::string const what = sentence_of({Elastic::name, ": element ", e, ", counted from 0"});
    double const chord = std::hypot(ref.x[12] - ref.x[0], ref.x[13] - ref.x[1], ref.x[14] - ref.x[2]);
    if (!(chord > 1e-6 * l_))
      throw InvalidInput(
          "reference_curve.element",
          {ErrorObject{what}, ": the ends of the element coincide. Use more elements, or another reference curve."});
    if (chord > (1.0 + 1e-6) * l_)
      throw InvalidInput("reference_curve.arc_length", {ErrorObject{what},
                                                        ": the distance of its ends exceeds its arc length. The "
                                                        "argument of the reference curve must be its arc length."});
    double height = 0.0, width = 0.0;  // half height and half width
    if (auto const* r = std::get_if<Rectangle>(&bar_.section))
      height = 0.5 * r->height, width = 0.5 * r->width;
    else if (auto const* c = std::get_if<Circle>(&bar_.section))
      height = width = c->radius;
    for (double const xi : {0.0, 0.5, 1.0}) {
      double const middle = ref.determinant(xi, 0.0, 0.0), y = ref.determinant(xi, height, 0.0) - middle,
                   z = ref.determinant(xi, 0.0, width) - middle;
      double const drop = std::holds_alternative<Circle>(bar_.section) ? std::hypot(y, z) : std::abs(y) + std::abs(z);
      if (!(middle - drop > 0.0))
        throw InvalidInput(
            "reference_curve.element",
            {ErrorObject{what},
             ": the element is turned inside out in the reference configuration, because the curve bends too sharply "
             "for the section or for one element. Use more elements, or another curve."});
    }
  }

  template <class T>
  std::size_t which(std::vector<T> const& each, Index e) const {
    return each.size() == 1 ? 0 : std::size_t(e);
  }
  Inertia const& inertia_of(Index e) const { return inertia_[which(inertia_, e)]; }
  ancf::Reference const& reference_of(Index e) const { return references_[which(references_, e)]; }
  ancf::Deformation deformation(Point const& p, std::span<double const> q) const {
    return {reference_of(p.element), this->of_element(p.element, q)};
  }
  template <class Group>
  Vec3 strains(Point const& p, std::span<double const> q) const {
    return Group::strains(p.xi, l_, this->of_element(p.element, q)) -
           Group::strains(p.xi, l_, reference_of(p.element).x);
  }
  template <class T>
  auto frame_of(Vec<T, 3> const& ry, Vec<T, 3> const& rz) const {
    return Elastic::template frame<T>(ry, rz, constants_);
  }

  template <KernelScalar T>
  static void times_mass(Inertia const& inertia, Element<T> const& a, Element<T>& out) {
    for (int r = 0; r < element_columns; ++r) {
      T sum(0.0);
      for (int v = 0; v < ancf::vectors; ++v) sum += a[3 * v + r % 3] * inertia.mass(r, 3 * v + r % 3);
      out[r] = sum;
    }
  }
  PointMap map_of(Point const& p, int derivative) const {
    Mat<double, ancf::vectors, 4> const n = ancf::shape(p.xi, p.y, p.z, l_);
    PointMap map = PointMap::Zero();
    for (int a = 0; a < ancf::vectors; ++a)
      for (int i = 0; i < 3; ++i) map(i, 3 * a + i) = n(a, derivative);
    return map;
  }
  /// Matrix (3×6) that maps the rates of (r_y, r_z) to ω in world axes.
  template <class T, class SectionOf>
  static Mat<T, 3, 6> turning(SectionOf const& f) {
    Mat<T, 3, 6> local, turn;
    for (int k = 0; k < 3; ++k) f.to_vectors(f.pull(f.axis(k)), k, 0, local);
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 3; ++i)
        turn(i, j) = f.R(i, 0) * local(0, j) + f.R(i, 1) * local(1, j) + f.R(i, 2) * local(2, j);
    return turn;
  }

  Bar bar_;
  BarConstants constants_;
  std::string unit_warning_;
  double l_ = 0.0;
  std::vector<Placement> nodes_;             ///< placements of the nodes, in the axes of the bar
  std::vector<ancf::Reference> references_;  ///< one if all elements are alike, otherwise one per element
  std::vector<Inertia> inertia_;
};

template <class Elastic>
AncfBeam<Elastic>::AncfBeam(Bar const& bar, Index n, ReferenceCurve const& curve, bool straight)
    : Chain(n), bar_(bar), constants_(constants_of(bar)), unit_warning_(detail::unit_warning(bar)) {
  std::string const name = Elastic::name;
  require_elements(n, name);
  bool alike = straight;
  if constexpr (ancf::BySectionMatrices<Elastic>) alike = alike && !Elastic::varies(bar);
  require_positive(constants_.rotary_inertia, name, ": the bar's rotary inertia about z (mass of the gradient r_y)");
  require_positive(constants_.rotary_inertia_y.value_or(constants_.rotary_inertia),
                   name + ": the bar's rotary inertia about y (mass of the gradient r_z)");
  if (!ancf::BySectionMatrices<Elastic>) require_polar_inertia_of_points(constants_, name);
  Elastic::check(bar, constants_);
  l_ = bar.length / double(n);
  for (Index i = 0; i <= n; ++i) {
    double const s = std::min(double(i) * l_, length());
    nodes_.push_back(curve(s));
    nodes_.back().check(name + ": the reference curve at s = " + number(s));
  }
  for (Index e = 0; e < (alike ? Index(1) : n); ++e) {
    ancf::Reference ref;
    ref.l = l_;
    ref.start = double(e) * l_;
    ref.straight = straight;
    for (int node = 0; node < 2; ++node) {
      Placement const& p = nodes_[std::size_t(e + node)];
      for (int i = 0; i < 12; ++i) ref.x[12 * node + i] = i < 3 ? p.origin[i] : p.axes(i % 3, i / 3 - 1);
    }
    check_reference(ref, e);
    references_.push_back(ref);
    this->add_groups(Elastic::make(bar_, constants_, ref));
    inertia_.push_back(ancf::inertia_of<Elastic>(bar_, constants_, ref));
  }
}

}  // namespace polybody
