#pragma once
/// \file
/// Checks of the matrices of a finite element model, and the structure of a checked model.
/// Theory: Eqs. 10.13 to 10.16.

#include <array>

#include <polybody/bodies/fe/fe_units.hpp>
#include <polybody/bodies/ffr/matrix_structure.hpp>

namespace polybody {

/// Limits of `check_matrices`.
struct FeLimits {
  double asymmetry = 1e-9;      ///< largest difference of mirrored entries, relative to the largest entry (1)
  double rigid_force = 1e-6;    ///< largest relative force ‖K φ‖/(‖K‖ ‖φ‖) of a rigid motion φ (1)
  double mass_error = 0.01;     ///< largest relative difference from the given mass (1)
  double fastest_wave = 1e5;    ///< largest speed of waves [m/s]
  double least_density = 0.01;  ///< smallest mean density of the box around the nodes [kg/m³]
  double least_pivot = 1e-13;   ///< smallest pivot of the stiffness with six displacements fixed, relative (1)
};

/// Results of `check_matrices`, in SI units.
struct FeReport {
  double mass = 0.0;                        ///< total mass [kg]
  Vec3 centre = Vec3::Zero();               ///< centre of mass [m]
  double asymmetry = 0.0;                   ///< largest relative difference of mirrored entries of both matrices (1)
  std::array<double, 6> rigid_forces = {};  ///< ‖K φ‖/(‖K‖ ‖φ‖) of translations and rotations about x, y, z (1)
  double density = 0.0;                     ///< total mass, divided by the volume of the box around the nodes [kg/m³]
  double wave_speed = 0.0;                  ///< speed of waves from node to node, to a factor of two [m/s]
  std::vector<std::string> remarks;         ///< sentences about the interpretation of the files, and about units
};

namespace detail {

/// Largest difference of mirrored entries, relative to the largest entry.
/// \throws InvalidInput for a difference above the limit.
template <class = void>  // compiled only if used
double asymmetry_of(FeMatrix const& m, FeNodes const& nodes, double limit) {
  double const largest = largest_entry(m.entries);
  if (m.entries.rows() != 3 * nodes.size() || m.entries.cols() != 3 * nodes.size() || largest == 0.0)
    throw InvalidInput("fe.size", {ErrorObject{m.file}, ": the matrix is ", ErrorValue{m.entries.rows()}, "×",
                                   m.entries.cols(), " with the largest entry ", largest, ", but ", nodes.size(),
                                   " nodes need a matrix with ", 3 * nodes.size(), " rows that is not zero."});
  Structure::Sparse const turned = m.entries.transpose();
  double worst = 0.0;
  for (Index j = 0; j < m.entries.outerSize(); ++j)
    for (Structure::Sparse::InnerIterator it(m.entries, j); it; ++it) {
      double const other = turned.coeff(it.row(), j), difference = std::abs(it.value() - other) / largest;
      if (!(difference <= limit))
        throw InvalidInput("fe.not_symmetric", {ErrorObject{m.file}, ": the matrix is not symmetric: the entry of ",
                                                row_name(nodes, it.row()), " and ", row_name(nodes, j), " is ",
                                                ErrorValue{it.value()}, ", but its mirror image is ", other, "."});
      worst = std::max(worst, difference);
    }
  return worst;
}

/// Rigid motion φ of the nodes: translations along x, y, z, and rotations about these axes through `middle`.
template <class = void>
VecX rigid_motion(FeNodes const& nodes, int motion, Vec3 const& middle) {
  VecX shape(3 * nodes.size());
  Vec3 const unit = Vec3::Unit(motion % 3);
  for (Index i = 0; i < nodes.size(); ++i)
    shape.segment<3>(3 * i) = motion < 3 ? unit : Vec3(unit.cross(nodes.positions[std::size_t(i)] - middle));
  return shape;
}

/// ‖K φ‖/(‖K‖ ‖φ‖) of the six rigid motions.
/// \throws InvalidInput for a value above the limit.
template <class = void>
std::array<double, 6> rigid_forces_of(FeModel const& model, double limit) {
  Vec3 middle = Vec3::Zero();
  for (Vec3 const& r : model.nodes.positions) middle += r / double(model.nodes.size());
  std::array<double, 6> forces = {};
  double const norm = model.stiffness.entries.norm();
  for (int motion = 0; motion < 6; ++motion) {
    VecX const shape = rigid_motion(model.nodes, motion, middle);
    VecX const force = model.stiffness.entries * shape;
    double const size = shape.norm(), ratio = size > 0.0 ? force.norm() / (norm * size) : 0.0;
    forces[std::size_t(motion)] = ratio;
    if (ratio <= limit) continue;
    Index worst = 0;
    force.cwiseAbs().maxCoeff(&worst);
    throw InvalidInput(
        "fe.rigid_motion",
        {ErrorObject{model.stiffness.file}, ": a rigid ", motion < 3 ? "displacement along " : "rotation about ",
         "xyz"[motion % 3], " strains the structure, most at ", row_name(model.nodes, worst),
         ": the relative force is ", ErrorValue{ratio}, ", but the limit is ", limit,
         ". The displacements are fixed, an element or a triangle of the matrix is missing, or the "
         "nodes of ",
         model.nodes.file, " do not belong to the matrix or have too few digits."});
  }
  return forces;
}

/// Six displacements that support the structure without constraint forces: all of the first node, two of the node
/// farthest from it, one of the node farthest from the line through both.
template <class = void>
std::array<Index, 6> supports_of(FeNodes const& nodes) {
  Vec3 const a = nodes.positions[0];
  std::size_t far = 0, third = 0;
  for (std::size_t i = 0; i < nodes.positions.size(); ++i)
    if ((nodes.positions[i] - a).squaredNorm() > (nodes.positions[far] - a).squaredNorm()) far = i;
  Vec3 const line = nodes.positions[far] - a;
  auto const normal = [&](std::size_t i) -> Vec3 { return line.cross(nodes.positions[i] - a); };
  for (std::size_t i = 0; i < nodes.positions.size(); ++i)
    if (normal(i).squaredNorm() > normal(third).squaredNorm()) third = i;
  Index along = 0, across = 0;
  line.cwiseAbs().maxCoeff(&along);
  normal(third).cwiseAbs().maxCoeff(&across);
  return {0, 1, 2, 3 * Index(far) + (along + 1) % 3, 3 * Index(far) + (along + 2) % 3, 3 * Index(third) + across};
}

/// \throws InvalidInput if the stiffness with six supports has a pivot below the limit: then more than six motions
/// need no force.
template <class = void>
void require_connected(FeModel const& model, double limit) {
  std::array<Index, 6> const fixed = supports_of(model.nodes);
  std::vector<Eigen::Triplet<double>> entries;
  auto const is_fixed = [&](Index i) { return std::find(fixed.begin(), fixed.end(), i) != fixed.end(); };
  for (Index j = 0; j < model.stiffness.entries.outerSize(); ++j)
    for (Structure::Sparse::InnerIterator it(model.stiffness.entries, j); it; ++it)
      if (it.row() == j || !(is_fixed(it.row()) || is_fixed(j)))
        entries.emplace_back(int(it.row()), int(j), it.value());
  Structure::Sparse k(model.stiffness.entries.rows(), model.stiffness.entries.cols());
  k.setFromTriplets(entries.begin(), entries.end());
  Eigen::SimplicialLDLT<Structure::Sparse> const factor(k);
  for (Index i = 0; i < k.rows(); ++i) {
    Index const row = factor.permutationPinv().indices()[i];
    double const pivot = factor.info() == Eigen::Success ? factor.vectorD()[i] / std::abs(k.coeff(row, row)) : 0.0;
    if (pivot > limit) continue;
    throw InvalidInput("fe.loose",
                       {ErrorObject{model.stiffness.file},
                        ": more than six motions need no force, or the stiffness has a negative eigenvalue: the "
                        "factorisation fails at ",
                        row_name(model.nodes, row), " with the relative pivot ", ErrorValue{pivot},
                        ". The parts of the model must be connected."});
  }
}

/// Masses m_ij = ∫ρ N_i N_j of the nodes, of the displacements along x.
template <class = void>
Structure::Sparse masses_along_x(Structure::Sparse const& mass) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < mass.outerSize(); j += 3)
    for (Structure::Sparse::InnerIterator it(mass, j); it; ++it)
      if (it.row() % 3 == 0) entries.emplace_back(int(it.row() / 3), int(j / 3), it.value());
  Structure::Sparse m(mass.rows() / 3, mass.cols() / 3);
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

/// Volume of the box around the nodes, with edges along the axes [m³].
template <class = void>
double box_volume(FeNodes const& nodes) {
  Vec3 low = nodes.positions[0], high = low;
  for (Vec3 const& r : nodes.positions) low = low.cwiseMin(r), high = high.cwiseMax(r);
  return (high - low).prod();
}

/// \throws InvalidInput unless the mass is the given one [kg], and the speed of waves and the mean density are within
/// the limits. The sentence names units that fit.
template <class = void>
void require_units(FeModel const& model, FeReport& report, double mass, FeLimits const& limits) {
  std::string const units = unit_sentence({report.wave_speed, report.mass, box_volume(model.nodes), mass});
  if (!(std::abs(report.mass - mass) <= limits.mass_error * mass))
    throw InvalidInput("fe.mass", {ErrorObject{model.mass.file}, ": the total mass is ", ErrorValue{report.mass},
                                   " kg, but the given mass is ", mass, " kg.", units});
  if (!(report.wave_speed <= limits.fastest_wave))
    throw InvalidInput("fe.units",
                       {ErrorObject{model.stiffness.file}, ": waves would travel at ", ErrorValue{report.wave_speed},
                        " m/s, but the limit is ", limits.fastest_wave, " m/s.", units});
  if (!(report.density >= limits.least_density))
    throw InvalidInput(
        "fe.units", {ErrorObject{model.nodes.file}, ": the mean density in the box around the nodes is ",
                     ErrorValue{report.density}, " kg/m³, but the limit is ", limits.least_density, " kg/m³.", units});
  if (report.wave_speed < 1e3 && !units.empty())
    report.remarks.push_back(sentence_of(
        {model.stiffness.file, ": waves travel at ", report.wave_speed, " m/s, slower than in metals.", units}));
}

}  // namespace detail

/// Checks the matrices of a model in SI units: symmetry; six rigid motions without force, and no other such motion; the
/// total mass against `mass` [kg]; and the units by the speed of waves and the density. The sentence about a wrong
/// mass, speed or density names units that fit, such as millimetres and tonnes.
/// \throws InvalidInput that names the file and the displacement of a node for a violated limit.
template <class = void>  // compiled only if used
FeReport check_matrices(FeModel const& model, double mass, FeLimits const& limits = {}) {
  if (!(mass > 0.0) || !std::isfinite(mass))
    throw InvalidInput("fe.given_mass", {ErrorObject{"check_matrices"}, ": the given mass must be positive, but is ",
                                         ErrorValue{mass}, " kg."});
  FeReport report;
  report.asymmetry = std::max(detail::asymmetry_of(model.mass, model.nodes, limits.asymmetry),
                              detail::asymmetry_of(model.stiffness, model.nodes, limits.asymmetry));
  for (FeMatrix const* m : {&model.mass, &model.stiffness})
    report.remarks.insert(report.remarks.end(), m->remarks.begin(), m->remarks.end());
  report.rigid_forces = detail::rigid_forces_of(model, limits.rigid_force);
  detail::require_connected(model, limits.least_pivot);
  Structure::Sparse const m = detail::masses_along_x(model.mass.entries);
  VecX const masses = m * VecX::Ones(m.cols());
  report.mass = masses.sum();
  for (Index i = 0; i < model.nodes.size(); ++i)
    report.centre += masses[i] / report.mass * model.nodes.positions[std::size_t(i)];
  report.density = report.mass / detail::box_volume(model.nodes);
  report.wave_speed = detail::wave_speed(m, model.stiffness.entries, model.nodes.positions);
  detail::require_units(model, report, mass, limits);
  return report;
}

/// Structure of a checked model in SI units, with the nodes in ascending order of their labels (`FeNodes::index`).
/// \throws InvalidInput as `check_matrices`, and for a mass matrix that is not of solid elements.
template <class = void>
Structure structure_of(FeModel const& model, double mass, FeLimits const& limits = {}) {
  check_matrices(model, mass, limits);
  try {
    return structure_of(model.mass.entries, model.stiffness.entries, model.nodes.positions, limits.fastest_wave);
  } catch (InvalidInput const& error) {
    throw InvalidInput(
        {ErrorObject{model.mass.file}, ", ", model.stiffness.file, ", ", model.nodes.file, ": ", ErrorCause{error}});
  }
}

}  // namespace polybody
