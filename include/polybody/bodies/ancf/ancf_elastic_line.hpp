#pragma once
/// \file
/// Elastic force of the fully parameterised ANCF beam by structural mechanics on its axis.
/// Theory: Eqs. 2.37 to 2.39.

#include <tuple>

#include <polybody/bodies/ancf/ancf_field.hpp>
#include <polybody/bodies/shared/strain_group.hpp>

namespace polybody {

/// Elastic force from the strains of the axis and of the sections [Simo & Vu-Quoc 1986b; Nachbagauer, Gruber &
/// Gerstmayr 2013]. With the section frame R of (r_y, r_z),
///   Γ = Rᵀ r₀′ − e₁ (stretch, two shears),  K = axial(Rᵀ R′) (twist, two curvatures):
///     the strains of the geometrically exact beam;
///   ½ (r_y·r_y − 1), ½ (r_z·r_z − 1), r_y·r_z: the strains of the section, with stiffness EA, EA, GA.
/// Γ and K are taken relative to their values in the reference. R, Γ and K do not depend on the strains of the section.
/// On fine meshes the sections therefore keep their shape, and the element converges to the geometrically exact beam.
/// The thesis (§4.6) cites an elastic line approach of another source, and gives no equations.
/// Quadrature:
///   Γ at three Gauss points, exact for linear theory, where r₀′ is quadratic. With two points, a motion with r = 0 and
///   the same transverse r_x at all nodes would have no energy: its r₀′ is the Legendre polynomial P₂, which is zero
///   at both points. The element does not lock: the quadratic r₀′ can follow any piecewise linear r_y, r_z with Γ = 0.
///   K at two points: for sections that rotate by θ per element, the result is θ/l with an error of order θ⁴.
///   The strains of the section at the nodes only. Between the nodes, interpolation along the chord reduces |r_y| to
///     cos(θ/2), which is not a strain.
/// Kelvin–Voigt times: axial for Γ₁ and the stretches of the section; shear for Γ₂, Γ₃, twist and the shear of the
/// section; bending for the curvatures.
struct ElasticLine {
  static constexpr char const* name = "AncfBeam<ElasticLine>";  ///< name of the body type in messages

  /// Strains Γ, with p = (r₀′, r_y, r_z).
  struct Stretch {
    static constexpr int points = 3;
    static constexpr int components = 3;
    static constexpr int parameters = 9;
    static constexpr int strains = 3;
    static constexpr int reach = 3;
    static constexpr int difference = 4;

    static Vec3 stiffness(BarConstants const& c) { return {c.EA, c.GA, c.GA_z.value_or(c.GA)}; }
    static Vec3 damping(Damping const& d) { return {d.axial, d.shear, d.shear}; }
    static constexpr int vector(int s, int j) {
      if (s == 0) return j == 0 ? 1 : 3 + j;
      return j < 2 ? 4 * j + 1 + s : -1;
    }
    static Mat<double, 3, 3> map(double xi, double l) {
      ShapeValues<4> const h = hermite_shape(xi, l);
      Mat<double, 3, 3> n;
      for (int j = 0; j < 3; ++j) {
        n(0, j) = h.ds[std::size_t(j + 1)];
        n(1, j) = n(2, j) = j == 0 ? 1.0 - xi : j == 1 ? xi : 0.0;
      }
      return n;
    }

    /// Vector u = Rᵀ r₀′ with the variation δu = Rᵀ δr₀′ + u × φ, with the rotation φ of the frame in its axes.
    template <KernelScalar T>
    static void evaluate(Vec<T, 9> const& p, Vec<T, 3>& strain, Mat<T, 3, 9>& b) {
      SectionFrame<T> const f({p[3], p[4], p[5]}, {p[6], p[7], p[8]});
      Vec<T, 3> const u = f.local({p[0], p[1], p[2]});
      for (int i = 0; i < 3; ++i) {
        strain[i] = i == 0 ? u[0] - 1.0 : u[i];
        for (int k = 0; k < 3; ++k) b(i, k) = f.R(k, i);
        f.to_vectors(f.pull(f.cross(f.axis(i), u)), i, 3, b);
      }
    }
    /// Second variation n·δ̂δu = α·(φ̂ × n) + α̂·(φ × n) + φᵀ (u nᵀ − (n·u) 1) φ̂ + (n × u)·δ̂φ, with α = Rᵀ δr₀′.
    template <KernelScalar T>
    static void add_hessian(Vec<T, 9> const& p, Vec<T, 3> const& n, Mat<T, 9, 9>& h) {
      SectionFrame<T> const f({p[3], p[4], p[5]}, {p[6], p[7], p[8]});
      Vec<T, 3> const u = f.local({p[0], p[1], p[2]});
      Mat<T, 6, 6> twice = f.second(f.cross(n, u));
      T const nu = f.dot(n, u);
      Vec<T, 6> const pn = f.pull(n), pu = f.pull(u);
      constexpr std::array<int, 3> turning = {0, 2, 3};  // components that rotate the frame
      for (int const i : turning)
        for (int const j : turning) twice(i, j) += pu[i] * pn[j];
      Vec<T, 3> const nw = f.world(n);
      Mat<T, 3, 9> across;
      for (int k = 0; k < 3; ++k) {
        Vec<T, 6> const s = f.pull(f.axis(k));
        for (int const i : turning)
          for (int const j : turning) twice(i, j) -= nu * s[i] * s[j];
        f.to_vectors(f.pull(f.local(f.cross(nw, f.axis(k)))), k, 3, across);  // e_k·(φ̂ × n) = (n × e_k)·φ̂
        for (int j = 3; j < 9; ++j) {
          h(k, j) += across(k, j);
          h(j, k) += across(k, j);
        }
      }
      f.add_symmetric(twice, 3, h);
    }
  };

  /// Strains K, with p = (r_y, r_z, r_y′, r_z′).
  struct Bend {
    static constexpr int points = 2;
    static constexpr int components = 3;
    static constexpr int parameters = 12;
    static constexpr int strains = 3;
    static constexpr int reach = 2;

    static Vec3 stiffness(BarConstants const& c) { return {c.GJ, c.EI_y.value_or(c.EI), c.EI}; }
    static Vec3 damping(Damping const& d) { return {d.shear, d.bending, d.bending}; }
    static constexpr int vector(int s, int j) { return 4 * j + 2 + s % 2; }
    static Mat<double, 4, 2> map(double xi, double l) {
      Mat<double, 4, 2> n;
      for (int s = 0; s < 2; ++s) {
        n(s, 0) = 1.0 - xi;
        n(s, 1) = xi;
        n(2 + s, 0) = -1.0 / l;
        n(2 + s, 1) = 1.0 / l;
      }
      return n;
    }

    template <KernelScalar T>
    static void evaluate(Vec<T, 12> const& p, Vec<T, 3>& strain, Mat<T, 3, 12>& b) {
      SectionFrame<T> const f({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
      Vec<T, 6> const w = f.components({p[6], p[7], p[8]}, {p[9], p[10], p[11]});
      strain = f.spin(w);
      Mat<T, 3, 6> const k = f.curvature_gradient(w);
      for (int i = 0; i < 3; ++i) {
        Vec<T, 6> row;
        for (int j = 0; j < 6; ++j) row[j] = k(i, j);
        f.to_vectors(row, i, 0, b);
        f.to_vectors(f.pull(f.axis(i)), i, 6, b);
      }
    }
    template <KernelScalar T>
    static void add_hessian(Vec<T, 12> const& p, Vec<T, 3> const& n, Mat<T, 12, 12>& h) {
      SectionFrame<T> const f({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
      Vec<T, 6> const w = f.components({p[6], p[7], p[8]}, {p[9], p[10], p[11]});
      Mat<T, 6, 6> twice, mixed;
      f.curvature_hessian(w, n, twice, mixed);
      f.add_symmetric(twice, 0, h);
      f.add_second(mixed, 6, 0, h);
    }
  };

  /// Strains of the section, with p = (r_y, r_z).
  struct Section {
    static constexpr int points = 2;
    static constexpr int components = 3;
    static constexpr int parameters = 6;
    static constexpr int strains = 3;
    static constexpr int reach = 2;

    static Vec3 stiffness(BarConstants const& c) { return {c.EA, c.EA, c.GA}; }
    static Vec3 damping(Damping const& d) { return {d.axial, d.axial, d.shear}; }
    static constexpr int vector(int s, int j) { return Bend::vector(s, j); }
    static Mat<double, 2, 2> map(double xi, double l) {
      Mat<double, 4, 2> const n = Bend::map(xi, l);
      Mat<double, 2, 2> top;
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) top(i, j) = n(i, j);
      return top;
    }

    template <KernelScalar T>
    static void evaluate(Vec<T, 6> const& p, Vec<T, 3>& strain, Mat<T, 3, 6>& b) {
      strain[0] = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * 0.5 - 0.5;
      strain[1] = (p[3] * p[3] + p[4] * p[4] + p[5] * p[5]) * 0.5 - 0.5;
      strain[2] = p[0] * p[3] + p[1] * p[4] + p[2] * p[5];
      for (int i = 0; i < 3; ++i) {
        b(0, i) = b(2, 3 + i) = p[i];
        b(1, 3 + i) = b(2, i) = p[3 + i];
        b(0, 3 + i) = b(1, i) = T(0.0);
      }
    }
    template <KernelScalar T>
    static void add_hessian(Vec<T, 6> const&, Vec<T, 3> const& n, Mat<T, 6, 6>& h) {
      for (int i = 0; i < 3; ++i) {
        h(i, i) += n[0];
        h(3 + i, 3 + i) += n[1];
        h(i, 3 + i) += n[2];
        h(3 + i, i) += n[2];
      }
    }
  };
  using Groups =
      std::tuple<StrainGroup<Stretch>, StrainGroup<Bend>, StrainGroup<Section>>;  ///< the strain groups of an element

  /// Checks the constants of the bar.
  /// \throws InvalidInput unless GA, GA_z, GJ and EI_y are positive.
  static void check(Bar const&, BarConstants const& c) {
    require_positive(c.GA, "AncfBeam<ElasticLine>: the shear stiffness GA of the bar");
    require_positive(c.GA_z.value_or(c.GA), "AncfBeam<ElasticLine>: the shear stiffness GA_z of the bar");
    require_positive(c.GJ, "AncfBeam<ElasticLine>: the torsional stiffness GJ of the bar");
    require_positive(c.EI_y.value_or(c.EI), "AncfBeam<ElasticLine>: the bending stiffness EI_y of the bar");
  }

  /// Strain groups of an element with the reference `ref`.
  template <class Line = ElasticLine>  // compiled only if used
  static typename Line::Groups make(Bar const& bar, BarConstants const& c, ancf::Reference const& ref) {
    Vec3 const pretension(-bar.pretension / c.EA, 0.0, 0.0), none(0.0, 0.0, 0.0);
    std::array<GaussPoint, 2> const nodes = {GaussPoint{0.0, 0.5}, GaussPoint{1.0, 0.5}};
    return {on_axis<typename Line::Stretch>(gauss<3>, bar, c, ref, pretension),
            on_axis<typename Line::Bend>(gauss<2>, bar, c, ref, none),
            on_axis<typename Line::Section>(nodes, bar, c, ref, none)};
  }

  /// Frame of markers on a section with r_y = b, r_z = c. This frame equals the frame of Γ and K. A joint or a moment
  /// therefore does work only on these strains, and the section keeps its shape.
  template <KernelScalar T>
  static SectionFrame<T> frame(Vec<T, 3> const& b, Vec<T, 3> const& c, BarConstants const&) {
    return {b, c};
  }

  /// Section forces: the stiffness of `groups` times the `strains` (Γ, K) of the section, plus the pretension.
  template <class Made>  // compiled only if used
  static Vec6 section_forces(Bar const& bar, Made const& groups, double, Vec6 const& strains) {
    Vec6 n = strains;
    for (int i = 0; i < 3; ++i) {
      n[i] *= std::get<0>(groups).stiffness()[i];
      n[3 + i] *= std::get<1>(groups).stiffness()[i];
    }
    n[0] += bar.pretension;
    return n;
  }

 protected:
  /// Group of the strains of `Law` with the quadrature points `rule`.
  template <class Law>
  static StrainGroup<Law> on_axis(std::array<GaussPoint, Law::points> const& rule, Bar const& bar,
                                  BarConstants const& c, ancf::Reference const& ref, Vec3 const& pretension) {
    StrainGroup<Law> group(Law::stiffness(c), Law::damping(bar.damping));
    for (int g = 0; g < Law::points; ++g) {
      Vec3 free = pretension;
      if (!ref.straight) free += StrainGroup<Law>::strains(rule[g].xi, ref.l, ref.x);
      group.set_point(g, rule[g].weight * ref.l, Law::map(rule[g].xi, ref.l), free);
    }
    return group;
  }
};

}  // namespace polybody
