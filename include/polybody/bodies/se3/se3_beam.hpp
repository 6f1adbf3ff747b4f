#pragma once
/// \file
/// Geometrically exact beam in space with one interpolation of position and rotation on SE(3).
/// Theory: Eqs. 2.106 to 2.108, 2.117, 2.118.

#include <concepts>

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/se3/helicoidal_section.hpp>
#include <polybody/bodies/shared/frame_chain.hpp>
#include <polybody/bodies/shared/sections.hpp>

namespace polybody {

/// Geometrically exact beam whose axis is a helix in each element, a chain of equal two-node elements [Borri & Bottasso
/// 1994; Sonneville, Cardona & Brüls 2014]. The frames H = (R, r) of the nodes define the sections between them,
///   H(ξ) = H₁ exp(ξ d),  d = log(H₁⁻¹ H₂),  (Γ, K) = (d − d₀)/l,
/// with the value d₀ of d in the reference configuration, and the arc length l. Stretch, shear, twist and bending are
/// constant in an element and need no quadrature. The strain energy of an element, without the pretension, is
///   U = ½ l (Γ, K)ᵀ C (Γ, K),  C = diag(EA, GA, GA_z, GJ, EI_y, EI),
/// in the axes of the section, with x along the beam. The strains depend only on the relative motion of the two nodes.
/// States of constant strain are exact with one element, such as circular arcs and helices. The element does not lock,
/// because an element in pure bending has no shear strain. Errors decrease with l².
///
/// Coordinates, generalised velocities and inertia are those of `FrameChain`. The relative rotation of the nodes of an
/// element must be less than π.
class Se3Beam : public FrameChain {
 public:
  static constexpr bool objective = true;

  /// Beam from the straight bar, with n elements of equal length.
  /// \throws InvalidInput for n outside [1, 10⁷], and unless GA, GA_z, GJ and EI_y of the bar are positive.
  template <class T = double>  // compiled only if used
  static Se3Beam from(Bar const& bar, Index n) {
    require_elements(n, "Se3Beam");
    return Se3Beam(bar, detail::chain_sections(bar, n, "Se3Beam"), n,
                   [](T s) { return Placement{.origin = Vec<T, 3>(s, 0, 0)}; });
  }
  /// Beam from the straight bar, with the number of elements of `mesh`.
  template <class T = double>  // compiled only if used
  static Se3Beam from(Bar const& bar, BarMesh const& mesh = {}) {
    return from<T>(bar, mesh.elements.value_or(default_elements));
  }
  /// Beam of n elements whose undeformed shape is `curve`, bent and twisted, free of stress except for the pretension.
  /// The parameter of the curve is its arc length.
  /// \throws InvalidInput as for the straight bar, for an empty `curve`, for a curve on which nodes coincide or are
  /// farther apart than the arc between them, and for an element whose sections rotate by π or more.
  template <class T = double>  // compiled only if used
  static Se3Beam from(Bar const& bar, Index n, ReferenceCurve const& curve) {
    require_elements(n, "Se3Beam");
    require_curve(curve, "Se3Beam");
    return Se3Beam(bar, detail::chain_sections(bar, n, "Se3Beam"), n, curve);
  }

  /// Point at the arc length s of the reference, and (y, z) from the axis, in the axes of the section [m].
  /// \throws InvalidInput for s outside the bar.
  template <std::convertible_to<double> T = double>  // compiled only if used
  Point at(T s, double y = 0.0, double z = 0.0) const {
    return point_at<T>(s, y, z, "Se3Beam");
  }

  /// Elastic and damping force (helicoidal_element.hpp), and −Ω × J Ω at the nodes.
  template <StateScalar T>
  void force(Index e, std::span<T const> q, std::span<T const> v, Element<T>& out) const {
    stressed<T>(e, q, v).force(out);
    for (int i = 0; i < 2; ++i) {
      Vec<T, 3> const gyro = gyroscopic_moment<T>(e + i, v);
      for (int k = 0; k < 3; ++k) out[6 * i + 3 + k] += gyro[k];
    }
  }
  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v), with δ of q ⊞ δ. Outside of equilibrium the tangent is not symmetric, because
  /// rotations do not commute.
  template <class T>  // compiled only if used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    HelicoidalElement<T> const element = stressed<T>(e, q, v);
    element.tangent(section_of(e), element.velocities(v, 6 * e), ck, cd, k);
    add_gyroscopic_tangent<T>(e, v, cd, k);
  }
  template <class T = double>  // compiled only if used
  T strain_energy(Index e, std::span<T const> q) const {
    return element_length() * section_of(e).energy<T>(strains<T>(e, q));
  }

  /// Mean force over an energy-conserving step, with the secants of (Γ, K) = (d − d₀)/l, d = (Xᵀ ρ, φ).
  template <class T, class S = Secant<12>>  // compiled only if used
  void discrete_force(Index e, FrameStep const& step, Vec<T, 12>& out) const {
    RelativeSecant<S> const relative = relative_secant<S>(step, e);
    Vec<S, 3> const p = transposed_product<S>(right_jacobian_inverse<S>(relative.phi), relative.chord);
    ScrewVector<double> const& d0 = free_[std::size_t(e)];
    Vec<S, 6> strains;
    for (int i = 0; i < 3; ++i) {
      strains[i] = (p[i] - d0.translation[i]) / element_length();
      strains[3 + i] = (relative.phi[i] - d0.rotation[i]) / element_length();
    }
    set_mean_gyroscopic(e, step, out);
    subtract_stress(strains, section_of(e).mean_forces(strains, step.means()), out);
  }
  /// Tangent s K̄ of `discrete_force`: that of the state in the middle of the step, with the coordinates `q` and `zero`
  /// velocities.
  template <class T>  // compiled only if used
  void discrete_tangent(Index e, FrameStep const& step, std::span<double const> q, std::span<double const> zero,
                        double s, Mat<T, 12, 12>& k) const {
    tangent(e, q, zero, s * (0.5 + step.decay), s / step.h, k);
    add_mean_gyroscopic_tangent(e, step, k);
  }
  /// Frame of a marker over an energy-conserving step.
  template <class S>
  FrameSecant<S> discrete_marker(Point const& p, Mat3 const& axes, FrameStep const& step) const {
    if (p.xi == 0.0 || p.xi == 1.0) return marker_on<S>(p, axes, node_secant<S>(p, step));
    RelativeSecant<S> const x = relative_secant<S>(step, p.element);
    Vec<S, 3> const part = scaled<S>(x.phi, p.xi);
    Vec<S, 3> const d = transposed_product<S>(right_jacobian_inverse<S>(x.phi), x.chord);
    Vec<S, 3> const along = transposed_product<S>(right_jacobian<S>(part), scaled<S>(d, p.xi));
    FrameSecant<S> section{carried_secant<S>(step, p.element, along),
                           carried_secant<S>(step, p.element, exp_so3<S>(part))};
    for (int i = 0; i < 3; ++i)
      section.r[i] += S::variable(step.q0[std::size_t(7 * p.element + i)], step.q1[std::size_t(7 * p.element + i)], i);
    return marker_on<S>(p, axes, section);
  }

  /// Strains (Γ, K) of the element of `p`, in the axes of its sections [1], [1/m] (`HasSections`).
  template <class T = double>  // compiled only if used
  Vec6 section_strains(Point const& p, std::span<T const> q) const {
    return section_of(p.element).template axis_strains<T>(strains<T>(p.element, q));
  }
  /// Section forces (N, M) of the element of `p`, without damping [N], [N m].
  template <class T = double>  // compiled only if used
  Vec6 section_forces(Point const& p, std::span<T const> q) const {
    return section_of(p.element).template forces<T>(strains<T>(p.element, q));
  }
  /// Rotation field at `p`, of constant curvature in an element. Its curvature includes that of the reference.
  template <class T = double>  // compiled only if used
  SectionTurn rotation_field(Point const& p, std::span<T const> q) const {
    HelicoidalElement<T> const element(q, 7 * p.element);
    Mat<T, 3, 3> const relative = exp_so3<T>(scaled<T>(element.d.rotation, p.xi));
    return {product(element.R, relative), scaled<T>(element.d.rotation, 1.0 / element_length()),
            detail::zeros<Vec<T, 3>>()};
  }

  /// Derivatives r′ = R p/l and r″ = R (φ × p)/l² of the axis at `p`, with d = (p, φ).
  template <class T = double>  // compiled only if used
  AxisSlopes<3> axis_slopes(Point const& p, std::span<T const> q) const {
    HelicoidalElement<T> const element(q, 7 * p.element);
    double const by_length = 1.0 / element_length();
    Mat<T, 3, 3> const axes = product(element.R, exp_so3<T>(scaled<T>(element.d.rotation, p.xi)));
    Vec<T, 3> const first = scaled<T>(product(axes, element.d.translation), by_length);
    return {first, scaled<T>(cross<T>(product(axes, element.d.rotation), first), by_length)};
  }

  /// Marker kinematics: with the twist (U, Ω) of the section and ρ = R (0, y, z),
  ///   r = r(ξ) + ρ,  ω = R Ω,  ṙ = R U + ω × ρ,  bias = [R (U˙ + Ω × U) + ω˙ × ρ + ω × (ω × ρ); ω˙],  ω˙ = R Ω˙,
  /// where U˙ and Ω˙ hold for constant velocities of the nodes.
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    HelicoidalPoint<T> const s(p.xi, q, 7 * p.element);
    auto const nodes = s.twists(v, 6 * p.element);
    ScrewVector<T> const twist = s.twist(nodes), rate = s.twist_rate(nodes);
    Vec<T, 3> const w = product(s.R, twist.rotation), carried = cross(twist.rotation, twist.translation);
    Vec3 const off = from_centre(p);
    Vec<T, 3> slide, arm;
    for (int i = 0; i < 3; ++i) {
      slide[i] = rate.translation[i] + carried[i];
      arm[i] = s.R(i, 1) * off[1] + s.R(i, 2) * off[2];
    }
    Vec<T, 3> const v_axis = product(s.R, twist.translation), swept = cross(w, arm), a_axis = product(s.R, slide),
                    turning = product(s.R, rate.rotation), tangential = cross(turning, arm),
                    centripetal = cross(w, swept);
    for (int i = 0; i < 3; ++i) {
      out.frame.r[i] = s.r[i] + arm[i];
      out.frame.v[i] = v_axis[i] + swept[i];
      out.frame.w[i] = w[i];
      out.bias[i] = a_axis[i] + tangential[i] + centripetal[i];
      out.bias[3 + i] = turning[i];
      for (int k = 0; k < 3; ++k)
        out.frame.A(i, k) = s.R(i, 0) * axes(0, k) + s.R(i, 1) * axes(1, k) + s.R(i, 2) * axes(2, k);
    }
    set_columns<T>(s, s.P1, s.R1, arm, out.jacobian);
    set_columns<T>(s, s.P2, s.R2, arm, out.jacobian + 36);
    out.shape = JacobianShape::dense;
    out.columns = 12;
  }

  /// Load stiffness: the derivative of Jᵀw. With P_i = [X, Y; 0, X], F = Rᵀ f, M = Rᵀ m + ρ × F, ρ = (0, y, z), the
  /// pulled wrench of node i is (R_i Xᵀ F, Yᵀ F + Xᵀ M). With the rotation δθ = X₁ δθ₁ + X₂ δθ₂ of the section,
  ///   δF = F × δθ,  δM = (M̃ₘ + ρ̃ F̃) δθ,  Mₘ = Rᵀ m,
  /// and the change of P_i follows from `pull_derivatives`.
  template <class T>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, Mat<T, 12, 12>& k) const {
    HelicoidalPoint<T> const s(p.xi, q, 7 * p.element);
    Vec<T, 3> const off = from_centre(p), f = transposed_product<T>(s.R, w.f), m = transposed_product<T>(s.R, w.m);
    Vec<T, 3> moment = cross(off, f);
    Mat<T, 3, 3> of_moment = skew_of_skew(off, f);
    Mat<T, 3, 3> const of_f = skew(f), of_m = skew(m);
    for (int i = 0; i < 3; ++i) moment[i] += m[i];
    for (int i = 0; i < 9; ++i) of_moment.data()[i] += of_m.data()[i];
    ScrewMap<T> const none{detail::zeros<Mat<T, 3, 3>>(), detail::zeros<Mat<T, 3, 3>>()};
    std::array<ScrewMap<T>, 4> change{none, none, none, none};
    if (s.inside()) change = s.pull_derivatives({moment, f});
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        ScrewMap<T> const &pi = i == 0 ? s.P1 : s.P2, &pj = j == 0 ? s.P1 : s.P2, &by = change[std::size_t(2 * i + j)];
        Mat<T, 3, 3> const f_turned = product(of_f, pj.diagonal), m_turned = product(of_moment, pj.diagonal);
        Mat<T, 3, 3> force = transposed_product(pi.diagonal, f_turned),
                     torque = transposed_product(pi.coupling, f_turned);
        Mat<T, 3, 3> const more = transposed_product(pi.diagonal, m_turned),
                           own = skew<T>(transposed_product(pi.diagonal, f)),
                           by_r = product(by.diagonal, transposed(j == 0 ? s.R1 : s.R2));
        for (int n = 0; n < 9; ++n) {
          force.data()[n] += by.diagonal.data()[n] - (i == j ? own.data()[n] : T(0.0));
          torque.data()[n] += more.data()[n] + by.coupling.data()[n];
        }
        Mat<T, 3, 3> const force_r = product(i == 0 ? s.R1 : s.R2, force);
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            k(6 * i + r, 6 * j + c) = T(0.0);
            k(6 * i + r, 6 * j + 3 + c) = force_r(r, c);
            k(6 * i + 3 + r, 6 * j + c) = by_r(r, c);
            k(6 * i + 3 + r, 6 * j + 3 + c) = torque(r, c);
          }
      }
  }

 private:
  template <class Curve>  // compiled only if used
  Se3Beam(Bar const& bar, detail::ChainSections const& sections, Index n, Curve const& curve)
      : FrameChain(bar, sections, n, curve, "Se3Beam"), free_(std::size_t(n)) {
    for (auto const& section : sections.elements) sections_.emplace_back(section, element_length(), bar.pretension);
    for (Index e = 0; e < n; ++e)
      set_free<double>(e, placed(bar, curve((double(e) + 0.5) * element_length()), "Se3Beam").axes);
    if (move_to_centres(sections.nodes))
      for (Index e = 0; e < n; ++e) free_[std::size_t(e)] = HelicoidalElement<double>(reference_, 7 * e).d;
  }
  HelicoidalSection const& section_of(Index e) const { return sections_[sections_.size() == 1 ? 0 : std::size_t(e)]; }
  /// Sets d₀ of element e; `middle` are the axes of the section of the curve in the middle of the element.
  template <class T>  // compiled only if used
  void set_free(Index e, Mat<T, 3, 3> const& middle) {
    HelicoidalElement<T> const element(reference_, 7 * e);
    ScrewVector<T> const& d = free_[std::size_t(e)] = element.d;
    double const l = element_length(), size = std::sqrt(squared_norm(d.translation));
    if (!(size > 1e-6 * l && size < (1.0 + 1e-6) * l))
      throw InvalidInput("reference_curve.arc_length",
                         {ErrorObject{"Se3Beam"}, ": element ", double(e), ", counted from 0, of arc length ", l,
                          " m connects two sections by a helical arc of ", ErrorValue{size},
                          " m. This length must be positive and at most that of the element. The argument of the "
                          "reference curve must be its arc length. Use more elements on a closed curve."});
    Mat<T, 3, 3> const between = product(element.R, exp_so3<T>(scaled<T>(d.rotation, 0.5)));
    T trace = 0.0;  // 1 + 2 cos of the angle between both middles
    for (int i = 0; i < 9; ++i) trace += between.data()[i] * middle.data()[i];
    if (trace < 1.0)
      throw InvalidInput("reference_curve.element",
                         {ErrorObject{"Se3Beam"}, ": the sections of element ", double(e),
                          ", counted from 0, rotate by half a turn or more along the reference curve: the rotation in "
                          "the middle differs by ",
                          ErrorValue{std::acos(std::max(-1.0, 0.5 * (trace - 1.0)))},
                          " rad from that of the shortest path, and must differ by less than 1.57 rad. Use more "
                          "elements."});
  }

  template <StateScalar T>
  HelicoidalElement<T> stressed(Index e, std::span<T const> q, std::span<T const> v) const {
    HelicoidalElement<T> element(q, 7 * e);
    element.set_forces(section_of(e), free_[std::size_t(e)], element.velocities(v, 6 * e));
    return element;
  }
  template <class T>
  Vec<T, 6> strains(Index e, std::span<T const> q) const {
    ScrewVector<T> const d = difference(HelicoidalElement<T>(q, 7 * e).d, free_[std::size_t(e)]);
    Vec<T, 6> out;
    for (int i = 0; i < 3; ++i) {
      out[i] = d.translation[i] / element_length();
      out[3 + i] = d.rotation[i] / element_length();
    }
    return out;
  }
  /// Writes the six columns of the Jacobian that belong to one node, [R X R_iᵀ, R Y − ρ̃ R X; 0, R X], to `columns`.
  template <StateScalar T>
  static void set_columns(HelicoidalPoint<T> const& s, ScrewMap<T> const& map, Mat<T, 3, 3> const& node,
                          Vec<T, 3> const& arm, T* columns) {
    Mat<T, 3, 3> const spin = product(s.R, map.diagonal), slide = product(s.R, map.coupling),
                       move = product(spin, transposed(node));
    for (int k = 0; k < 3; ++k) {
      T *const of_r = columns + 6 * k, *const of_turn = of_r + 18;
      T const x = spin(0, k), y = spin(1, k), z = spin(2, k);
      for (int i = 0; i < 3; ++i) {
        of_r[i] = move(i, k);
        of_r[3 + i] = T(0.0);
        of_turn[3 + i] = spin(i, k);
      }
      of_turn[0] = slide(0, k) + (y * arm[2] - z * arm[1]);
      of_turn[1] = slide(1, k) + (z * arm[0] - x * arm[2]);
      of_turn[2] = slide(2, k) + (x * arm[1] - y * arm[0]);
    }
  }

  std::vector<HelicoidalSection> sections_;  ///< of all elements, or of each
  std::vector<ScrewVector<double>> free_;    ///< d₀ of each element
};

}  // namespace polybody
