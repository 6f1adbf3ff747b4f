#pragma once
/// \file
/// Section of a bar that is given by its matrices of stiffness and mass.
/// Theory: Eqs. 2.121 to 2.125.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Section with coupled stiffness and mass, from measurements or from a program for sections. Both matrices are about
/// the axis of the bar, in the axes of the section with x along the bar. The section forces (N, Q_y, Q_z, M_x, M_y,
/// M_z) are `stiffness` · (ε, γ_y, γ_z, κ_x, κ_y, κ_z), and the kinetic energy per length is ½ Vᵀ `mass` V with the
/// twist V = (U, Ω) of the section:
///   mass = [m 1, −m c̃; m c̃, J],
/// where c = (0, y, z) is the centre of mass and J the inertia about the axis. `Se3Beam`, `Lrvf` and `Ffr` accept
/// all such sections. `AncfBeam<CoupledLine>` accepts those whose mass is in the plane of the section. Other bodies
/// accept a section that is constant along the bar, without coupling and with c = 0.
///
/// Damping is proportional to the stiffness C: with the damping times τ, the damping part of the section forces is
///   D (ε˙, …, κ˙_z),  D_ij = √τ_i C_ij √τ_j,
/// so that D is symmetric and positive semidefinite.
///
/// Runs and `equilibrium` warn of matrices that imply a modulus or a density far from those of solids (`unit_warning`).
struct Section6 {
  Mat<double, 6, 6> stiffness = detail::zeros<Mat<double, 6, 6>>();  ///< (6×6) stiffness [N], [N m], [N m²]
  Mat<double, 6, 6> mass = detail::zeros<Mat<double, 6, 6>>();       ///< (6×6) mass per length [kg/m], [kg], [kg m]
  Vec6 damping_times = Vec6::Zero();  ///< τ of each strain [s]; added to those of the bar

  /// Returns this section for each arc length.
  Section6 const& operator()(double) const { return *this; }

  /// Section in SI units, from matrices in seconds and the units `length` [m] and `force` [N].
  template <class = void>  // compiled only if used
  [[nodiscard]] Section6 in_units(double length, double force) const {
    require_positive(length, "Section6: the unit of length");
    require_positive(force, "Section6: the unit of force");
    Section6 out = *this;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        double const arms = (i < 3 ? 1.0 : length) * (j < 3 ? 1.0 : length);
        out.stiffness(i, j) *= force * arms;
        out.mass(i, j) *= force / (length * length) * arms;
      }
    return out;
  }
  /// Section whose own axis passes through (y, z) [m] of the bar's section, and whose own axes y and z are rotated by
  /// `angle` about x [rad]. The result is about the axis of the bar. Damping times are not transformed.
  template <class = void>  // compiled only if used
  [[nodiscard]] Section6 placed(double y, double z, double angle = 0.0) const;
};

/// Section at each arc length s ∈ [0, length] of a bar [m]. A `Section6` converts to a constant one.
using SectionAlong = std::function<Section6(double)>;

namespace detail {

/// Components of section forces, for messages.
inline constexpr char const* section_names[] = {"N", "Q_y", "Q_z", "M_x", "M_y", "M_z"};

/// Matrix of a quadratic form of screws (translation, rotation), for the form of the screws at another origin: the
/// strains or the twist x of the axis are x = [1, r̃; 0, 1] y of the screws y at the point r of the section.
template <class T = double>  // compiled only if used
Mat<T, 6, 6> at_point(Mat<T, 6, 6> const& form, Vec3 const& r) {
  Mat<T, 6, 6> map = Mat<T, 6, 6>::Identity(), out;
  Mat3 const tilde = skew<T>(r);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) map(i, 3 + j) = tilde(i, j);
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      T sum = 0.0;
      for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) sum += map(a, i) * form(a, b) * map(b, j);
      out(i, j) = sum;
    }
  return out;
}

/// Smallest pivot of the Cholesky factorisation of a matrix after scaling to a unit diagonal, and its row. The pivot is
/// at most 0 for a matrix that is not positive definite.
struct SmallestPivot {
  double value = 1.0;
  int row = 0;
};
template <int n>
SmallestPivot smallest_pivot(Mat<double, n, n> const& a) {
  SmallestPivot out;
  Mat<double, n, n> l = Mat<double, n, n>::Zero();
  for (int j = 0; j < n; ++j) {
    if (!(a(j, j) > 0.0)) return {-1.0, j};
    double pivot = 1.0;
    for (int k = 0; k < j; ++k) pivot -= l(j, k) * l(j, k);
    if (!(pivot >= out.value)) out = {pivot, j};
    if (!(pivot > 0.0)) return out;
    for (int i = j + 1; i < n; ++i) {
      double sum = a(i, j) / (std::sqrt(a(i, i)) * std::sqrt(a(j, j)));
      for (int k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
      l(i, j) = sum / std::sqrt(pivot);
    }
  }
  return out;
}

/// Checks that a matrix is finite and symmetric, up to 1e-9 of the geometric mean of the diagonal entries.
template <class = void>  // compiled only if used
[[gnu::cold]] void require_symmetric(Mat<double, 6, 6> const& a, std::string const& what) {
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      require_size(a(i, j), what + " entry (" + std::to_string(i + 1) + ", " + std::to_string(j + 1) + ")");
      double const scale = std::sqrt(std::abs(a(i, i))) * std::sqrt(std::abs(a(j, j)));
      if (std::abs(a(i, j) - a(j, i)) > 1e-9 * std::max(scale, std::abs(a(i, j))))
        throw InvalidInput(
            "section.symmetry",
            {ErrorObject{what}, " must be symmetric, but the entries (", double(i + 1), ", ", double(j + 1), ") and (",
             double(j + 1), ", ", double(i + 1), ") are ", ErrorValue{a(i, j)}, " and ", ErrorValue{a(j, i)}, "."});
    }
}

/// Section about its centre of mass. Stiffness and damping are those of the strains of the line of centres.
struct CentredSection {
  double mass = 0.0;                                                 ///< per length [kg/m]
  Vec3 centre = Vec3::Zero();                                        ///< centre of mass (0, y, z) [m]
  Mat3 inertia = Mat3::Zero();                                       ///< about the centre of mass, per length [kg m]
  Mat<double, 6, 6> stiffness = detail::zeros<Mat<double, 6, 6>>();  ///< [N], [N m], [N m²]
  Mat<double, 6, 6> damping =
      detail::zeros<Mat<double, 6, 6>>();  ///< stiffness times damping times [N s], [N m s], [N m² s]
};

/// Centre and inertia of the mass matrix of a section.
/// \throws InvalidInput naming `what` unless the matrix is that of a mass distribution.
template <class = void>  // compiled only if used
[[gnu::cold]] CentredSection centre_of(Mat<double, 6, 6> const& mass, std::string const& what) {
  require_symmetric(mass, what);
  CentredSection out;
  double const m = out.mass = mass(0, 0);
  require_positive(m, what, "mass per length");
  auto const same = [&](double a, double b, double scale) { return std::abs(a - b) <= 1e-9 * scale; };
  double coupling = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) coupling = std::max(coupling, std::abs(mass(i, 3 + j)));
  bool rigid = same(mass(1, 1), m, m) && same(mass(2, 2), m, m) && same(mass(0, 1), 0.0, m) &&
               same(mass(0, 2), 0.0, m) && same(mass(1, 2), 0.0, m);
  for (int i = 0; i < 3; ++i) rigid = rigid && same(mass(i, 3 + i), 0.0, coupling);
  rigid = rigid && same(mass(0, 4), -mass(1, 3), coupling) && same(mass(0, 5), -mass(2, 3), coupling) &&
          same(mass(1, 5), 0.0, coupling) && same(mass(2, 4), 0.0, coupling);
  if (!rigid)
    throw InvalidInput("section.mass",
                       {ErrorObject{what},
                        " must have the form [m 1, -m c~; m c~, J] with the mass m per length and the centre of mass "
                        "c = (0, y, z), in the order (U, W) of the twist, with x along the bar."});
  double const y = -mass(0, 5) / m, z = mass(0, 4) / m;  // −m c̃ has the entries m z at (0, 1) and −m y at (0, 2)
  out.centre = Vec3(0.0, y, z);
  double const moved[3][3] = {{y * y + z * z, 0.0, 0.0}, {0.0, z * z, -y * z}, {0.0, -y * z, y * y}};
  double trace = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out.inertia(i, j) = 0.5 * (mass(3 + i, 3 + j) + mass(3 + j, 3 + i)) - m * moved[i][j];
  for (int i = 0; i < 3; ++i) trace += std::abs(mass(3 + i, 3 + i));
  for (int i = 0; i < 3; ++i) {
    if (out.inertia(i, i) < -1e-12 * trace)
      throw InvalidInput("section.inertia",
                         {ErrorObject{what}, ": the moment of inertia about the centre of mass and axis ",
                          std::string(1, "xyz"[i]), " must not be negative, but is ", ErrorValue{out.inertia(i, i)},
                          " kg m. The entries (4, 4) to (6, 6) are about the axis of the bar."});
    out.inertia(i, i) = std::max(out.inertia(i, i), 0.0);
  }
  Mat3 raised = out.inertia;  // semidefinite matrices are accepted
  for (int i = 0; i < 3; ++i) raised(i, i) += 1e-12 * trace;
  if (SmallestPivot const p = smallest_pivot(raised); trace > 0.0 && !(p.value > 0.0))
    throw InvalidInput("section.inertia", {ErrorObject{what},
                                           ": the inertia about the centre of mass must be positive semidefinite, but "
                                           "its products of inertia are too large."});
  return out;
}

/// Section about its centre of mass, with the damping times of the bar added.
/// \throws InvalidInput naming the matrix and the arc length `s` for a matrix that is not symmetric and positive
/// definite, or is not finite, and for negative damping times.
template <class = void>  // compiled only if used
[[gnu::cold]] CentredSection centred(Section6 const& section, Vec6 const& bar_times, double s) {
  std::string const at = sentence_of({"Section6 at s = ", s, " m: the "});
  CentredSection out = centre_of(section.mass, at + "mass matrix");
  require_symmetric(section.stiffness, at + "stiffness matrix");
  if (SmallestPivot const p = smallest_pivot(section.stiffness); !(p.value > 1e-12))
    throw InvalidInput(
        "section.stiffness",
        {ErrorObject{at + "stiffness matrix"}, " must be positive definite, but the row of ", section_names[p.row],
         " depends on the rows before it: its pivot in the Cholesky factorisation, scaled by the diagonal, is ",
         ErrorValue{p.value}, ". The order of the rows is N, Q_y, Q_z, M_x, M_y, M_z."});
  for (int i = 0; i < 6; ++i) {
    std::string const time = at + "damping time of " + section_names[i];
    require_not_negative(section.damping_times[i], time);
    if (section.damping_times[i] > largest_number)
      throw InvalidInput("bar.period", {ErrorObject{time}, " must be at most ", largest_number, " s, but is ",
                                        ErrorValue{section.damping_times[i]}, " s."});
  }
  Mat<double, 6, 6> damping;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      double const ti = section.damping_times[i] + bar_times[i], tj = section.damping_times[j] + bar_times[j];
      damping(i, j) = std::sqrt(ti) * section.stiffness(i, j) * std::sqrt(tj);
    }
  out.stiffness = at_point(section.stiffness, out.centre);
  out.damping = at_point(damping, out.centre);
  return out;
}

/// Limits of E [N/m²] and ρ [kg/m³] of the solid that section matrices in SI units imply.
///
/// The lower limits are for thin walls. A tube of radius R and wall t implies an area that is 0.95 R/t times too large,
/// so that E and ρ are as many times too small. Rubber has 1e6 N/m². Carbon tubes of 1500 kg/m³ reach 5 kg/m³ only if
/// R/t is 314. No section of one solid has an area below 0.95 A, because √(det I) ≥ A²/4π.
///
/// The upper limits are a thousand times E of diamond, and 400 times ρ of osmium. This margin is for ropes (n parallel
/// wires imply an area that is n times too small), masses without stiffness, and very large axial stiffnesses.
/// Matrices in newtons, millimetres and tonnes that are taken for SI units have a density that is 1e12 times too small,
/// and matrices in pounds and inches one that is 1e7 times too small.
inline constexpr double young_limits[] = {1e4, 1e15}, density_limits[] = {5.0, 1e7};

/// Warning of matrices that are probably not in SI units; empty for other sections. The matrices need not be valid.
///
/// The implied solid is a square with the radius of gyration r of the section: A = a² = 12 r², E = EA/A, ρ = m/A. With
/// the bending stiffness K (2×2) about the tension centre, r² = √(det K)/EA, which gives A of any rectangle exactly.
template <class = void>  // compiled only if used
[[gnu::cold]] std::string unit_warning(Section6 const& section, double s) {
  auto const& c = section.stiffness;
  double const ea = c(0, 0);
  auto const k = [&](int i, int j) { return c(i, j) - c(i, 0) * c(0, j) / ea; };  // without axial force
  double const area = 12.0 * std::sqrt(k(4, 4) * k(5, 5) - k(4, 5) * k(5, 4)) / ea, young = ea / area,
               density = section.mass(0, 0) / area;
  auto const outside = [](double x, double const(&limits)[2]) { return x < limits[0] || x > limits[1]; };
  if (!outside(young, young_limits) && !outside(density, density_limits)) return {};
  auto const rounded = [](double x) { return number(x, 3); };
  return sentence_of({"the section matrices at s = ", s, " m imply E = ", rounded(young), " N/m², A = ", rounded(area),
                      " m² and ρ = ", rounded(density), " kg/m³. In SI units E lies in [", young_limits[0], ", ",
                      young_limits[1], "] and ρ in [", density_limits[0], ", ", density_limits[1],
                      "]. Convert the matrices with Section6::in_units."});
}

}  // namespace detail

template <class>
Section6 Section6::placed(double y, double z, double angle) const {
  require_finite(y, "Section6: y of the origin");
  require_finite(z, "Section6: z of the origin");
  require_finite(angle, "Section6: the angle");
  double const c = std::cos(angle), s = std::sin(angle);
  double const turn[3][3] = {{1.0, 0.0, 0.0}, {0.0, c, -s}, {0.0, s, c}};
  auto const turned = [&](Mat<double, 6, 6> const& a) {
    Mat<double, 6, 6> out;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        out(i, j) = 0.0;
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q)
            out(i, j) += turn[i % 3][p] * a(3 * (i / 3) + p, 3 * (j / 3) + q) * turn[j % 3][q];
      }
    return out;
  };
  Vec3 const back(0.0, -y, -z);  // the axis of the bar in the own section, in the axes of the bar
  return {detail::at_point(turned(stiffness), back), detail::at_point(turned(mass), back), damping_times};
}

}  // namespace polybody
