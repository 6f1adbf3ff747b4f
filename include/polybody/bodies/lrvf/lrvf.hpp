#pragma once
/// \file
/// Large rotation vector formulation in space, the geometrically exact beam [Reissner 1981; Simo & Vu-Quoc 1986b;
/// thesis §2.3–2.5].
/// Theory: Eqs. 2.55 to 2.59, 2.72.

#include <algorithm>
#include <vector>

#include <polybody/bodies/lrvf/direct_interpolation.hpp>
#include <polybody/bodies/lrvf/elastic_elements.hpp>

namespace polybody {

/// Geometrically exact beam, a chain of equal two-node elements [Reissner 1981; Simo & Vu-Quoc 1986b; thesis §2.3–2.5].
/// Positions are interpolated linearly, and rotations by the policy `Interpolation` (rotation_interpolation.hpp). The
/// policy `Quadrature` (strain_quadrature.hpp) defines the points at which strains are evaluated. The default is one
/// point in the middle of the element, which avoids shear locking. With the rotation R of the section at such a point,
/// and axial(ã) = a,
///   Γ = Rᵀ r′ − Γ₀,  K = axial(Rᵀ R′) − K₀,  N = diag(EA, GA, GA_z) Γ,  M = diag(GJ, EI_y, EI) K,
/// in the axes of the section, with x along the beam. Γ₀ and K₀ are the values of Rᵀ r′ and axial(Rᵀ R′) in the
/// reference configuration.
///
/// The coordinates of a node are its position r (3) in world axes and a unit quaternion (4) of the section. The
/// generalised velocities of a node are ṙ (3) and Ω (3), the angular velocity in the axes of the section. q ⊞ δ acts on
/// each node as in `Rigid`, without a singular angle. With a `PathDependentInterpolation`, the coordinates of the
/// stored sections, one for each element, follow after those of the nodes.
///
/// The mass of the translation is consistent with the linear shapes, Aρ l/6 [2 1; 1 2]. The rotary inertia is lumped at
/// the nodes, J = ½ l diag(Iρ_x, Iρ_y, Iρ_z) with `rotary_inertias`, so that M is constant. Without any rotary inertia
/// M is singular, and the moments on each node are in equilibrium at every time. Implicit methods and statics permit a
/// singular M, explicit methods do not.
///
/// A curved reference is divided into n elements of arc length l whose nodes lie on the curve. r′ is (r₂ − r₁)/c₀, with
/// the chord c₀ of the element in the reference. R′ is the derivative with respect to the arc length. Uniform stretch
/// and uniform bending of a circular arc are then exact. Integrals extend over l.
template <RotationInterpolation Interpolation = RelativeRotation, StrainQuadrature Quadrature = ReducedQuadrature>
class Lrvf {
 public:
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = true;
  static constexpr bool objective = Interpolation::objective;
  static constexpr int element_columns = 12;
  static constexpr int point_columns = 12;
  static constexpr int element_stride = 6;
  static constexpr bool vectorised_kernels = false;
  static constexpr Index default_elements = 32;  ///< number of elements of `from(bar)` (`BarMesh`)
  template <class T>
  using Element = Vec<T, 12>;
  using ElementMatrix = Mat<double, 12, 12>;

  /// Material point: element, position ξ ∈ [0, 1] along the element, and distances (y, z) from the axis [m].
  struct Point {
    Index element = 0;        ///< index of the element, counted from the first end of the bar
    double xi = 0.0;          ///< position ξ ∈ [0, 1] from the first node of the element to the second
    double y = 0.0, z = 0.0;  ///< distances from the axis, in the axes of the section [m]
  };

  /// Beam from the straight bar, with n elements of equal length.
  /// \throws InvalidInput for n outside [1, 10⁷], and unless GA, GA_z, GJ and EI_y of the bar are positive.
  static Lrvf from(Bar const& bar, Index n) {
    return from(bar, n, [](double s) { return Placement{.origin = Vec3(s, 0, 0)}; });
  }
  /// Beam from the straight bar, with the number of elements of `mesh`.
  static Lrvf from(Bar const& bar, BarMesh const& mesh = {}) {
    return from(bar, mesh.elements.value_or(default_elements));
  }
  /// Beam of n elements whose undeformed shape is `curve`, bent and twisted, free of stress except for the pretension.
  /// The parameter of the curve is its arc length.
  /// \throws InvalidInput as for the straight bar, for an empty `curve`, and for a curve on which nodes coincide or are
  /// farther apart than the arc between them.
  static Lrvf from(Bar const& bar, Index n, ReferenceCurve const& curve) {
    require_elements(n, "Lrvf");
    if (!curve)
      throw InvalidInput("reference_curve.missing", {ErrorObject{"Lrvf"},
                                                     ": the reference curve is an empty function. Pass a function that "
                                                     "returns a Placement for each arc length s."});
    return Lrvf(bar, polybody::constants(bar), n, curve);
  }

  double length() const { return length_; }
  double element_length() const { return l_; }
  BarConstants const& constants() const { return constants_; }

  /// Point at the arc length s of the reference, and (y, z) from the axis, in the axes of the section [m].
  /// \throws InvalidInput for s outside the bar. With `Incremental` s must be a node or the middle of an element.
  Point at(double s, double y = 0.0, double z = 0.0) const {
    double const x = require_inside(s, length_, "Lrvf") / l_;
    require_finite(y, "Lrvf: y of a point");
    require_finite(z, "Lrvf: z of a point");
    Index const e = std::min(Index(x + 1e-12), elements() - 1);
    double const xi = x - double(e);
    Point const p{e, xi < 1e-12 ? 0.0 : xi > 1.0 - 1e-12 ? 1.0 : xi, y, z};  // exact position of a node
    if constexpr (PathDependentInterpolation<Interpolation>) interpolation_.require_known(p.xi, s);
    return p;
  }

  Index coordinates() const { return Index(reference_.size()); }
  Index velocities() const { return 6 * (elements() + 1); }
  char const* coordinate_unit(Index i) const {
    if (i < detail::carried_at(elements(), 0)) return i % 7 < 3 ? "m" : "1";
    return i % 7 < 4 ? "1" : "rad";  // of the section stored in an element
  }
  char const* velocity_unit(Index i) const { return i % 6 < 3 ? "m/s" : "rad/s"; }
  Index elements() const { return elastic_.size(); }
  Index first_column(Index e) const { return 6 * e; }
  Index first_column(Point const& p) const { return first_column(p.element); }

  void reference(std::span<double> q) const { std::copy(reference_.begin(), reference_.end(), q.begin()); }

  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    for (Index i = 0; i <= elements(); ++i) {
      for (int k = 0; k < 3; ++k)
        out[std::size_t(7 * i + k)] = q[std::size_t(7 * i + k)] + delta[std::size_t(6 * i + k)];
      set_entries<4>(out, 7 * i + 3, quaternion_plus<T>(turned<T>(q, i), entries<3>(delta, 6 * i + 3)));
    }
    if constexpr (PathDependentInterpolation<Interpolation>)
      for (Index e = 0; e < elements(); ++e)
        detail::set_carried_section<T>(
            out, elements(), e,
            interpolation_.template plus<T>(detail::carried_section<T>(q, elements(), e), entries<3>(delta, 6 * e + 3),
                                            entries<3>(delta, 6 * e + 9)));
  }
  /// Rate δ˙ for which q ⊞ δ(t) moves with the generalised velocities v: Ω = Jr(δ) δ˙ at each node.
  template <StateScalar T>
  void local_rate(std::span<T const> delta, std::span<T const> v, std::span<T> out) const {
    for (Index i = 0; i < velocities(); i += 6) {
      set_entries<3>(out, i, entries<3>(v, i));
      set_entries<3>(out, i + 3, product(right_jacobian_inverse<T>(entries<3>(delta, i + 3)), entries<3>(v, i + 3)));
    }
  }
  template <class T = double>  // compiled only if used
  void rigid_velocity(std::span<double const> q, Vec3 const& v0, Vec3 const& omega, std::span<double> v) const {
    for (Index i = 0; i <= elements(); ++i) {
      Vec<T, 3> const turning = cross<T>(omega, entries<3>(q, 7 * i));
      for (int k = 0; k < 3; ++k) v[6 * i + k] = v0[k] + turning[k];
      set_entries<3>(v, 6 * i + 3, transposed_product<T>(rotation_matrix<T>(turned<double>(q, i)), omega));
    }
  }

  void mass(Index, std::span<double const>, ElementMatrix& m) const {
    m.setZero();
    for (int i = 0; i < 3; ++i) {
      m(i, i) = m(6 + i, 6 + i) = 2.0 * sixth_;
      m(i, 6 + i) = m(6 + i, i) = sixth_;
      m(3 + i, 3 + i) = m(9 + i, 9 + i) = rotary_[i];
    }
  }
  template <StateScalar T>
  void inertia(Index e, std::span<T const>, std::span<T const> a, Element<T>& out) const {
    T const* const x = a.data() + 6 * e;
    for (int i = 0; i < 3; ++i) {
      out[i] = (2.0 * x[i] + x[6 + i]) * sixth_;
      out[6 + i] = (x[i] + 2.0 * x[6 + i]) * sixth_;
      out[3 + i] = x[3 + i] * rotary_[i];
      out[9 + i] = x[9 + i] * rotary_[i];
    }
  }

  /// Elastic and damping force (elastic_elements.hpp), and −Ω × J Ω at the nodes.
  template <StateScalar T>
  void force(Index e, std::span<T const> q, std::span<T const> v, Element<T>& out) const {
    auto const gyro = [&](int i) {
      Vec<T, 3> const omega = entries<3>(v, 6 * (e + i) + 3);
      return cross(spun(omega), omega);
    };
    elastic_.template force<T>(e, q, v, gyro, out);
  }

  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v), with δ of q ⊞ δ. The tangent is not symmetric in general, because rotations do
  /// not commute.
  template <class T>  // compiled only if used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    elastic_.template tangent<T>(e, q, v, ck, cd, k);
    for (int i = 0; i < 2; ++i) {  // ∂(Ω × J Ω)/∂Ω = Ω̃ J − (J Ω)~
      Vec<T, 3> const omega = entries<3>(v, 6 * (e + i) + 3);
      Mat<T, 3, 3> const of_omega = skew<T>(omega), of_momentum = skew<T>(spun<T>(omega));
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          k(6 * i + 3 + r, 6 * i + 3 + c) += cd * (of_omega(r, c) * rotary_[c] - of_momentum(r, c));
    }
  }

  template <StateScalar T>
  void gravity(Index, std::span<T const>, Vec3 const& g, Element<T>& out) const {
    out = detail::zeros<Element<T>>();
    for (int i = 0; i < 3; ++i) out[i] = out[6 + i] = T(3.0 * sixth_ * g[i]);
  }

  template <class T = double>  // compiled only if used
  double kinetic_energy(Index e, std::span<double const>, std::span<double const> v) const {
    Vec<T, 3> const v1 = entries<3>(v, 6 * e), w1 = entries<3>(v, 6 * e + 3), v2 = entries<3>(v, 6 * e + 6),
                    w2 = entries<3>(v, 6 * e + 9);
    return sixth_ * (squared_norm(v1) + dot(v1, v2) + squared_norm(v2)) + 0.5 * (dot(spun(w1), w1) + dot(spun(w2), w2));
  }
  double strain_energy(Index e, std::span<double const> q) const { return elastic_.energy(e, q); }
  template <class T = double>  // compiled only if used
  double gravity_energy(Index e, std::span<double const> q, Vec3 const& g) const {
    Vec<T, 3> const r1 = entries<3>(q, 7 * e), r2 = entries<3>(q, 7 * e + 7);
    return -3.0 * sixth_ * (dot<T>(g, r1) + dot<T>(g, r2));
  }

  /// Strains (Γ, K) in the middle of the element of `p`, in the axes of the middle section [1], [1/m] (`HasSections`).
  Vec6 section_strains(Point const& p, std::span<double const> q) const { return elastic_.strains(p.element, q); }
  /// Section forces (N, M) of the element of `p`, without damping [N], [N m].
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return section_.forces(section_strains(p, q));
  }
  /// Rotation field at `p`. Its curvature includes the curvature of the reference.
  SectionTurn rotation_field(Point const& p, std::span<double const> q) const
    requires NodalInterpolation<Interpolation>
  {
    return interpolation_.turn(p.xi, l_, turned<double>(q, p.element), turned<double>(q, p.element + 1));
  }

  /// Marker kinematics: r = (1 − ξ) r₁ + ξ r₂ + ρ, ρ = R(ξ) (0, y, z);  ω = R Ω;  bias = [ω˙ᵇ × ρ + ω × (ω × ρ); ω˙ᵇ],
  /// where ω˙ᵇ is ω˙ for constant velocities of the nodes.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    Index const e = p.element;
    Section<T> s;
    section<T>(p, q, s);
    Vec<T, 6> turning;
    detail::set_turning<T>(e, v, turning);
    Mat<T, 3, 6> const spin = product(s.R, s.spin);
    Vec<T, 3> const w = detail::of_nodes(spin, turning);
    Vec<T, 3> arm, bias = detail::zeros<Vec<T, 3>>();
    if (inside(p)) bias = product(s.R, interpolation_.template bias<T>(s, turning));
    for (int i = 0; i < 3; ++i) arm[i] = s.R(i, 1) * p.y + s.R(i, 2) * p.z;
    Vec<T, 3> const rate = cross(w, arm), tangential = cross(bias, arm), centripetal = cross(w, rate);
    for (int i = 0; i < 3; ++i) {
      out.frame.r[i] = q[7 * e + i] * (1.0 - p.xi) + q[7 * e + 7 + i] * p.xi + arm[i];
      out.frame.v[i] = v[6 * e + i] * (1.0 - p.xi) + v[6 * e + 6 + i] * p.xi + rate[i];
      out.frame.w[i] = w[i];
      out.bias[i] = tangential[i] + centripetal[i];
      out.bias[3 + i] = bias[i];
      for (int k = 0; k < 3; ++k)
        out.frame.A(i, k) = s.R(i, 0) * axes(0, k) + s.R(i, 1) * axes(1, k) + s.R(i, 2) * axes(2, k);
    }
    for (int k = 0; k < 6; ++k) {  // one column of (ṙ₁, ṙ₂), and one of (Ω₁, Ω₂): P × ρ, P
      T *const move = out.jacobian + 6 * (detail::turn_column(k) - 3), *const turn = move + 18;
      T const x = spin(0, k), y = spin(1, k), z = spin(2, k);
      for (int i = 0; i < 3; ++i) {
        move[i] = T(i != k % 3 ? 0.0 : k < 3 ? 1.0 - p.xi : p.xi);
        move[3 + i] = T(0.0);
      }
      turn[0] = y * arm[2] - z * arm[1];
      turn[1] = z * arm[0] - x * arm[2];
      turn[2] = x * arm[1] - y * arm[0];
      turn[3] = x;
      turn[4] = y;
      turn[5] = z;
    }
    out.shape = JacobianShape::dense;
    out.columns = 12;
  }

  /// Load stiffness: the derivative of Jᵀw = [(1 − ξ) f; P₁ᵀ c; ξ f; P₂ᵀ c], with c = ρ̃ F + M, ρ = (0, y, z), F = Rᵀf,
  /// M = Rᵀm. With δF = F̃ P δθ,
  ///   δc = (ρ̃ F̃ + M̃) P δθ,  δ(Pᵀc) = Pᵀ δc + (∂Pᵀ) c.
  template <class T = double>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, ElementMatrix& k) const {
    Section<T> s;
    section<T>(p, q, s);
    Vec<T, 3> const off(0.0, p.y, p.z), f = transposed_product<T>(s.R, w.f), m = transposed_product<T>(s.R, w.m);
    Vec<T, 3> c = cross(off, f);
    Mat<T, 3, 3> by_turn = skew_of_skew(off, f);
    Mat<T, 3, 3> const of_m = skew(m);
    for (int i = 0; i < 3; ++i) {
      c[i] += m[i];
      for (int j = 0; j < 3; ++j) by_turn(i, j) += of_m(i, j);
    }
    Mat<T, 6, 6> const turned_load = transposed_product(s.spin, product(by_turn, s.spin));
    Mat<T, 6, 6> of_spin = detail::zeros<Mat<T, 6, 6>>();
    if (inside(p)) interpolation_.spin_gradient(s, c, of_spin);
    k.setZero();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) k(detail::turn_column(i), detail::turn_column(j)) = turned_load(i, j) + of_spin(i, j);
  }

 private:
  template <class T>
  using Section = typename Interpolation::template Section<T>;
  Lrvf(Bar const& bar, BarConstants const& c, Index n, ReferenceCurve const& curve);

  template <StateScalar T>
  static Quaternion<T> turned(std::span<T const> q, Index node) {
    return detail::turned<T>(q, node);
  }
  static bool inside(Point const& p) { return p.xi != 0.0 && p.xi != 1.0; }
  /// Angular momentum J Ω of a node.
  template <class T>
  Vec<T, 3> spun(Vec<T, 3> const& omega) const {
    return {omega[0] * rotary_[0], omega[1] * rotary_[1], omega[2] * rotary_[2]};
  }
  /// Section at p: at a node exactly the section of the node, elsewhere the section of the interpolation.
  template <StateScalar T>
  void section(Point const& p, std::span<T const> q, Section<T>& out) const {
    Quaternion<T> const a = turned<T>(q, p.element), b = turned<T>(q, p.element + 1);
    if constexpr (PathDependentInterpolation<Interpolation>) {
      if (inside(p))
        return interpolation_.template section<T>(detail::carried_section<T>(q, elements(), p.element), out);
    } else if (inside(p)) {
      return interpolation_.template section<T>(p.xi, a, b, out);
    }
    set_rotation<T>(p.xi == 0.0 ? a : b, out.R);
    out.spin = detail::zeros<Mat<T, 3, 6>>();
    for (int i = 0; i < 3; ++i) out.spin(i, p.xi == 0.0 ? i : 3 + i) = T(1.0);
  }

  BarConstants constants_;
  double length_, l_;
  Interpolation interpolation_;
  LrvfSection section_;
  ElasticElements<Interpolation, Quadrature> elastic_;
  double sixth_ = 0.0;  ///< Aρ l/6 [kg]
  Vec3 rotary_;         ///< J of half an element at a node [kg m²]
  std::vector<double> reference_;
};

template <RotationInterpolation Interpolation, StrainQuadrature Quadrature>
Lrvf<Interpolation, Quadrature>::Lrvf(Bar const& bar, BarConstants const& c, Index n, ReferenceCurve const& curve)
    : constants_(c),
      length_(bar.length),
      l_(bar.length / double(n)),
      interpolation_(bar.placement),
      section_(bar, c, l_),
      elastic_(section_, bar.placement, l_, n),
      reference_(std::size_t(PathDependentInterpolation<Interpolation> ? detail::carried_at(n, n) : 7 * (n + 1))) {
  sixth_ = c.mass_per_length * l_ / 6.0;
  Vec3 const inertias = rotary_inertias(c);
  for (int i = 0; i < 3; ++i) rotary_[i] = 0.5 * l_ * inertias[i];
  std::span<double> const q(reference_);
  Mat<double, 3, 3> const axes = bar.placement.axes;
  for (Index i = 0; i <= n; ++i) {
    Placement const section = curve(double(i) * l_);
    section.check("Lrvf: the reference curve");
    Vec<double, 3> const along = product(axes, section.origin);
    for (int k = 0; k < 3; ++k) q[std::size_t(7 * i + k)] = bar.placement.origin[k] + along[k];
    set_entries<4>(q, 7 * i + 3, quaternion_of(product(axes, section.axes)));
  }
  if constexpr (PathDependentInterpolation<Interpolation>)
    for (Index e = 0; e < n; ++e)
      detail::set_carried_section<double>(
          q, n, e, interpolation_.between(detail::turned<double>(q, e), detail::turned<double>(q, e + 1)));
  char const* const advice =
      ", but the chord must be positive and no longer than the arc. The argument of the reference curve must be its "
      "arc length. Use more elements on a closed curve.";
  for (Index e = 0; e < n; ++e) {
    double const chord = std::sqrt(squared_norm(difference(entries<3>(q, 7 * e + 7), entries<3>(q, 7 * e))));
    if (!(chord > 1e-6 * l_ && chord < (1.0 + 1e-6) * l_))
      throw InvalidInput("reference_curve.arc_length",
                         {ErrorObject{"Lrvf"}, ": element ", double(e), ", counted from 0, of arc length ", l_,
                          " m has a chord of ", ErrorValue{chord}, " m", advice});
    elastic_.set_free(e, std::span<double const>(q), chord);
  }
}

}  // namespace polybody
