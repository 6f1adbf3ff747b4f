#pragma once
/// \file
/// Large rotation vector formulation in space, the geometrically exact beam [Reissner 1981; Simo & Vu-Quoc 1986b;
/// thesis §2.3–2.5].
/// Theory: Eqs. 2.55 to 2.59, 2.72.

#include <algorithm>
#include <vector>

#include <polybody/bodies/lrvf/direct_interpolation.hpp>
#include <polybody/bodies/lrvf/elastic_elements.hpp>
#include <polybody/bodies/shared/frame_chain.hpp>

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
class Lrvf : public FrameChain {
 public:
  static constexpr bool objective = Interpolation::objective;

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
    require_curve(curve, "Lrvf");
    return Lrvf(bar, detail::chain_sections(bar, n, "Lrvf"), n, curve);
  }

  /// Point at the arc length s of the reference, and (y, z) from the axis, in the axes of the section [m].
  /// \throws InvalidInput for s outside the bar. With `Incremental` s must be a node or the middle of an element.
  Point at(double s, double y = 0.0, double z = 0.0) const {
    Point const p = point_at(s, y, z, "Lrvf");
    if constexpr (PathDependentInterpolation<Interpolation>) interpolation_.require_known(p.xi, s);
    return p;
  }

  Index coordinates() const { return Index(reference_.size()); }
  char const* coordinate_unit(Index i) const {
    if (i < detail::carried_at(elements(), 0)) return FrameChain::coordinate_unit(i);
    return i % 7 < 4 ? "1" : "rad";  // of the section stored in an element
  }

  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    FrameChain::plus<T>(q, delta, out);
    if constexpr (PathDependentInterpolation<Interpolation>)
      for (Index e = 0; e < elements(); ++e)
        detail::set_carried_section<T>(
            out, elements(), e,
            interpolation_.template plus<T>(detail::carried_section<T>(q, elements(), e), entries<3>(delta, 6 * e + 3),
                                            entries<3>(delta, 6 * e + 9)));
  }

  /// Elastic and damping force (elastic_elements.hpp), and −Ω × J Ω at the nodes.
  template <StateScalar T>
  void force(Index e, std::span<T const> q, std::span<T const> v, Element<T>& out) const {
    auto const gyro = [&](int i) { return gyroscopic_moment<T>(e + i, v); };
    elastic_.template force<T>(e, q, v, gyro, out);
  }

  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v), with δ of q ⊞ δ. The tangent is not symmetric in general, because rotations do
  /// not commute.
  template <class T>  // compiled only if used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    elastic_.template tangent<T>(e, q, v, ck, cd, k);
    add_gyroscopic_tangent<T>(e, v, cd, k);
  }

  /// Mean force over an energy-conserving step.
  template <class T = double, class S = Secant<12>>  // compiled only if used
    requires SecantInterpolation<Interpolation>
  void discrete_force(Index e, FrameStep const& step, Vec<T, 12>& out) const {
    set_mean_gyroscopic(e, step, out);
    RelativeSecant<S> const x = relative_secant<S>(step, e);
    elastic_.template for_each_strain<S>(e, x, [&](LrvfSection const& section, Vec<S, 6> const& strains) {
      subtract_stress(strains, section.mean_forces(strains, step.means()), out);
    });
  }
  /// Tangent s K̄ of `discrete_force`: that of the state in the middle of the step, with the coordinates `q` and `zero`
  /// velocities.
  template <class T>  // compiled only if used
    requires SecantInterpolation<Interpolation>
  void discrete_tangent(Index e, FrameStep const& step, std::span<double const> q, std::span<double const> zero,
                        double s, Mat<T, 12, 12>& k) const {
    tangent(e, q, zero, s * (0.5 + step.decay), s / step.h, k);
    add_mean_gyroscopic_tangent(e, step, k);
  }
  /// Frame of a marker over an energy-conserving step.
  template <class S>
    requires SecantInterpolation<Interpolation>
  FrameSecant<S> discrete_marker(Point const& p, Mat3 const& axes, FrameStep const& step) const {
    if (!inside(p)) return marker_on<S>(p, axes, node_secant<S>(p, step));
    RelativeSecant<S> const x = relative_secant<S>(step, p.element);
    FrameSecant<S> section{{}, carried_secant<S>(step, p.element, exp_so3<S>(scaled<S>(x.phi, p.xi)))};
    for (int i = 0; i < 3; ++i)
      for (int node : {0, 1}) {
        std::size_t const k = std::size_t(7 * (p.element + node) + i);
        section.r[i] += S::variable(step.q0[k], step.q1[k], 6 * node + i) * (node == 0 ? 1.0 - p.xi : p.xi);
      }
    return marker_on<S>(p, axes, section);
  }

  double strain_energy(Index e, std::span<double const> q) const { return elastic_.energy(e, q); }

  /// Strains (Γ, K) in the middle of the element of `p`, in the axes of the middle section [1], [1/m] (`HasSections`).
  Vec6 section_strains(Point const& p, std::span<double const> q) const {
    return section_of(p.element).axis_strains(elastic_.strains(p.element, q));
  }
  /// Section forces (N, M) of the element of `p`, without damping [N], [N m].
  Vec6 section_forces(Point const& p, std::span<double const> q) const {
    return section_of(p.element).forces(elastic_.strains(p.element, q));
  }
  /// Rotation field at `p`. Its curvature includes the curvature of the reference.
  SectionTurn rotation_field(Point const& p, std::span<double const> q) const
    requires NodalInterpolation<Interpolation>
  {
    return interpolation_.turn(p.xi, element_length(), axes_of<double>(q, p.element),
                               axes_of<double>(q, p.element + 1));
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
    Vec3 const off = from_centre(p);
    for (int i = 0; i < 3; ++i) arm[i] = s.R(i, 1) * off[1] + s.R(i, 2) * off[2];
    Vec<T, 3> const rate = cross(w, arm), tangential = cross(bias, arm), centripetal = cross(w, rate);
    for (int i = 0; i < 3; ++i) {
      auto const at_q = std::size_t(7 * e + i), at_v = std::size_t(6 * e + i);
      out.frame.r[i] = q[at_q] * (1.0 - p.xi) + q[at_q + 7] * p.xi + arm[i];
      out.frame.v[i] = v[at_v] * (1.0 - p.xi) + v[at_v + 6] * p.xi + rate[i];
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
    Vec<T, 3> const off = from_centre(p), f = transposed_product<T>(s.R, w.f), m = transposed_product<T>(s.R, w.m);
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
  Lrvf(Bar const& bar, detail::ChainSections const& sections, Index n, ReferenceCurve const& curve);

  static bool inside(Point const& p) { return p.xi != 0.0 && p.xi != 1.0; }
  /// Section at p: at a node exactly the section of the node, elsewhere the section of the interpolation.
  template <StateScalar T>
  void section(Point const& p, std::span<T const> q, Section<T>& out) const {
    Quaternion<T> const a = axes_of<T>(q, p.element), b = axes_of<T>(q, p.element + 1);
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

  LrvfSection const& section_of(Index e) const { return sections_[sections_.size() == 1 ? 0 : std::size_t(e)]; }

  Interpolation interpolation_;
  std::vector<LrvfSection> sections_;  ///< of all elements, or of each
  ElasticElements<Interpolation, Quadrature> elastic_;
};

template <RotationInterpolation Interpolation, StrainQuadrature Quadrature>
Lrvf<Interpolation, Quadrature>::Lrvf(Bar const& bar, detail::ChainSections const& sections, Index n,
                                      ReferenceCurve const& curve)
    : FrameChain(bar, sections, n, curve, "Lrvf"),
      interpolation_(bar.placement),
      sections_([&] {
        std::vector<LrvfSection> all;
        for (auto const& section : sections.elements) all.emplace_back(section, element_length(), bar.pretension);
        return all;
      }()),
      elastic_(sections_, bar.placement, element_length(), n) {
  if constexpr (PathDependentInterpolation<Interpolation>) {
    reference_.resize(std::size_t(detail::carried_at(n, n)));
    std::span<double> const nodes(reference_);
    for (Index e = 0; e < n; ++e)
      detail::set_carried_section<double>(
          nodes, n, e, interpolation_.between(axes_of<double>(nodes, e), axes_of<double>(nodes, e + 1)));
  }
  std::span<double const> const q(reference_);
  double const l = element_length();
  char const* const advice =
      ", but the chord must be positive and no longer than the arc. The argument of the reference curve must be its "
      "arc length. Use more elements on a closed curve.";
  for (Index e = 0; e < n; ++e) {
    double const chord = std::sqrt(squared_norm(difference(entries<3>(q, 7 * e + 7), entries<3>(q, 7 * e))));
    if (!(chord > 1e-6 * l && chord < (1.0 + 1e-6) * l))
      throw InvalidInput("reference_curve.arc_length",
                         {ErrorObject{"Lrvf"}, ": element ", double(e), ", counted from 0, of arc length ", l,
                          " m has a chord of ", ErrorValue{chord}, " m", advice});
    elastic_.set_free(e, q, chord);
  }
  if (move_to_centres(sections.nodes))
    for (Index e = 0; e < n; ++e)
      elastic_.set_free(e, q, std::sqrt(squared_norm(difference(entries<3>(q, 7 * e + 7), entries<3>(q, 7 * e)))));
}

}  // namespace polybody
