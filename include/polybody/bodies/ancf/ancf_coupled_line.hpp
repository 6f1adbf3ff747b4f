#pragma once
/// \file
/// Elastic force of the fully parameterised ANCF beam on its axis, for sections with coupled stiffness.
/// Theory: Eqs. 2.126 to 2.128.

#include <polybody/bodies/ancf/ancf_elastic_line.hpp>
#include <polybody/bodies/shared/bar_sections.hpp>

namespace polybody {

/// Elastic line with all couplings of a `Section6`, constant or along the bar: `AncfBeam<CoupledLine>`. The strains are
/// those of `ElasticLine`. The section forces follow from (Γ, K) and the full stiffness matrix C about the axis of the
/// bar, so that an offset of the section is part of C. Γ and K are integrated together, at three Gauss points with the
/// section of each point. For sections that rotate by θ per element the error of K is of order θ⁴, as with two points.
///
/// The mass belongs to material points in the plane of the section: ∫ρ (1, y, z, y², yz, z²) follow from the mass
/// matrix. The matrix is admissible if the inertia J about the centre of mass has J_xx = J_yy + J_zz up to 1e-4 of
/// J_xx (the rounding of a table), J_xy = J_xz = 0, and a positive definite part (y, z). Other matrices are refused,
/// because a section with r_y and r_z has no such inertia. Mass and inertia are per length of the axis, also of a
/// curved reference.
///
/// A shape or constants are accepted as a section without couplings. Damping matrix: D of `Section6`. The strains of
/// the section, r_y² and so on, have the stiffness EA and GA and the damping times of the bar.
struct CoupledLine : ElasticLine {
  static constexpr char const* name = "AncfBeam<CoupledLine>";  ///< name of the body type in messages

  /// Strains (Γ, K), with p = (r₀′, r_y, r_z, r_y′, r_z′).
  struct Line {
    using Section = ElasticLine::Section;  ///< strains of the shape of the section
    static constexpr int points = 3;
    static constexpr int components = 3;
    static constexpr int parameters = 15;
    static constexpr int strains = 6;
    static constexpr int reach = 3;
    static constexpr int difference = 4;

    static constexpr int vector(int s, int j) {
      return s == 0 ? Stretch::vector(0, j) : j < 2 ? Bend::vector(s - 1, j) : -1;
    }
    template <class T = double>  // compiled only if used
    static Mat<T, 5, 3> map(double xi, double l) {
      Mat<T, 3, 3> const stretch = Stretch::map(xi, l);
      Mat<T, 4, 2> const bend = Bend::map(xi, l);
      Mat<T, 5, 3> n = Mat<T, 5, 3>::Zero();
      for (int j = 0; j < 3; ++j) {
        n(0, j) = stretch(0, j);
        for (int s = 1; s < 5 && j < 2; ++s) n(s, j) = bend(s - 1, j);
      }
      return n;
    }

    template <KernelScalar T>
    static void evaluate(Vec<T, 15> const& p, Vec<T, 6>& strain, Mat<T, 6, 15>& b) {
      Vec<T, 3> gamma, kappa;
      Mat<T, 3, 9> by_stretch;
      Mat<T, 3, 12> by_bend;
      Stretch::evaluate<T>(part_of<9>(p, 0), gamma, by_stretch);
      Bend::evaluate<T>(part_of<12>(p, 3), kappa, by_bend);
      for (int i = 0; i < 3; ++i) {
        strain[i] = gamma[i];
        strain[3 + i] = kappa[i];
        for (int k = 0; k < 15; ++k) {
          b(i, k) = k < 9 ? by_stretch(i, k) : T(0.0);
          b(3 + i, k) = k >= 3 ? by_bend(i, k - 3) : T(0.0);
        }
      }
    }
    template <KernelScalar T>
    static void add_hessian(Vec<T, 15> const& p, Vec<T, 6> const& n, Mat<T, 15, 15>& h) {
      Mat<T, 9, 9> stretch;
      Mat<T, 12, 12> bend;
      for (int i = 0; i < 81; ++i) stretch.data()[i] = T(0.0);
      for (int i = 0; i < 144; ++i) bend.data()[i] = T(0.0);
      Stretch::add_hessian<T>(part_of<9>(p, 0), {n[0], n[1], n[2]}, stretch);
      Bend::add_hessian<T>(part_of<12>(p, 3), {n[3], n[4], n[5]}, bend);
      for (int c = 0; c < 15; ++c)
        for (int r = 0; r < 15; ++r) {
          if (r < 9 && c < 9) h(r, c) += stretch(r, c);
          if (r >= 3 && c >= 3) h(r, c) += bend(r - 3, c - 3);
        }
    }

   private:
    template <int n, class T>
    static Vec<T, n> part_of(Vec<T, 15> const& p, int first) {
      Vec<T, n> out;
      for (int i = 0; i < n; ++i) out[i] = p[first + i];
      return out;
    }
  };
  using Groups = std::tuple<StrainGroup<Line, true>, StrainGroup<Section>>;  ///< the strain groups of an element

  /// Constants of the bar at its first end, without couplings and about the centre of mass.
  template <class = void>  // compiled only if used
  static BarConstants constants(Bar const& bar) {
    return detail::constants_without_couplings(detail::section_at(bar, 0.0, name));
  }
  /// Returns true if the section is a function of the arc length.
  static bool varies(Bar const& bar) { return detail::section_varies(bar); }

  /// Mass of the section at the arc length s, as four points.
  /// \throws InvalidInput for a mass matrix that is not admissible.
  template <class = void>  // compiled only if used
  static ancf::SectionPoints section_points(Bar const& bar, double s) {
    detail::CentredSection const section = detail::section_at(bar, s, name);
    Mat3 const& j = section.inertia;
    double const yy = j(2, 2), zz = j(1, 1), yz = -j(1, 2), scale = yy + zz;
    if (!(std::abs(j(0, 0) - scale) <= 1e-4 * scale && std::abs(j(0, 1)) + std::abs(j(0, 2)) <= 1e-9 * scale &&
          yy > 0.0 && yy * zz - yz * yz > 1e-12 * yy * zz))
      throw InvalidInput("section.mass_of_points",
                         {ErrorObject{sentence_of({name, ": the section at s = ", s})},
                          " m must have the mass of points in its plane, with J_xx = J_yy + J_zz, J_xy = J_xz = 0 and "
                          "a positive definite part (y, z) of the inertia J about the centre of mass, but J_xx is ",
                          ErrorValue{j(0, 0)}, " kg m and J_yy + J_zz is ", scale,
                          " kg m. Use Se3Beam, Lrvf or Ffr, whose sections are rigid."});
    double const m = section.mass, a = std::sqrt(yy / m);
    return {m, section.centre[1], section.centre[2], a, yz / (a * m), std::sqrt((zz - yz * yz / yy) / m)};
  }

  /// Strain groups of an element with the reference `ref`.
  template <class Made = Groups, class Law = Line>  // compiled only if used
  static Made make(Bar const& bar, BarConstants const& c, ancf::Reference const& ref) {
    auto initial = detail::zeros<Vec<double, Law::strains>>();
    initial[0] = bar.pretension;
    std::tuple_element_t<0, Made> line(initial);
    for (int g = 0; g < Law::points; ++g) {
      double const xi = gauss<3>[std::size_t(g)].xi;
      detail::CentredSection const section = detail::section_at(bar, ref.start + xi * ref.l, name);
      line.set_point(g, gauss<3>[std::size_t(g)].weight * ref.l, Law::map(xi, ref.l));
      line.set_matrices(g, detail::about_axis(section.stiffness, section),
                        detail::about_axis(section.damping, section));
    }
    if (!ref.straight) line.set_free(ref.x);
    std::array<GaussPoint, 2> const nodes = {GaussPoint{0.0, 0.5}, GaussPoint{1.0, 0.5}};
    return {line, on_axis<typename Law::Section>(nodes, bar, c, ref, Vec3(0.0, 0.0, 0.0))};
  }

  /// Section forces C (Γ, K) about the axis for the `strains` at the arc length s, plus the pretension.
  template <class Made>  // compiled only if used
  static Vec6 section_forces(Bar const& bar, Made const&, double s, Vec6 const& strains) {
    detail::CentredSection const section = detail::section_at(bar, s, name);
    Mat<double, 6, 6> const c = detail::about_axis(section.stiffness, section);
    auto n = detail::zeros<Vec6>();
    n[0] = bar.pretension;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) n[i] += c(i, j) * strains[j];
    return n;
  }
};

}  // namespace polybody
