#pragma once
/// \file
/// Ratio of the axial forces in a structure of beams to its buckling forces. It estimates the error of a floating frame
/// without geometric stiffening.
///
/// Not in polybody.hpp: bodies/ffr/ffr.hpp includes it.

#include <Eigen/Cholesky>
#include <span>

#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Loads on a structure at one time, in the axes of the structure, and the inertia and weight of a rigid motion. In
/// this motion the acceleration of the point u₀ minus gravity is b + B u₀.
struct StructureAction {
  Vec3 b = Vec3::Zero();                 ///< (3) Aᵀ(r̈ − g) [m/s²]
  Mat3 B = Mat3::Zero();                 ///< (3×3) Ω˙~ + Ω~ Ω~ [1/s²]
  std::vector<PlacedWrench> loads = {};  ///< wrenches about points of the structure

  /// Loads, inertia and weight in the axes of the moving frame `frame`. The angular acceleration Ω˙ = `alpha` is in the
  /// axes of the frame. The acceleration of its origin minus gravity, r̈ − g = `acceleration` [m/s²], and `loads` are
  /// in world axes.
  template <class = void>  // compiled only if used
  static StructureAction in_frame(Frame<double> const& frame, Vec3 const& acceleration, Vec3 const& alpha,
                                  std::span<PlacedWrench const> loads) {
    Mat3 const to_frame = frame.A.transpose();
    Vec3 const omega = to_frame * frame.w;
    StructureAction x{.b = to_frame * acceleration,
                      .B = skew<double>(alpha) + skew<double>(omega) * skew<double>(omega)};
    for (PlacedWrench const& l : loads)
      x.loads.push_back({to_frame * (l.at - frame.r), {to_frame * l.w.f, to_frame * l.w.m}});
    return x;
  }
};

/// Eigenvalue ρ of largest magnitude of Φᵀ K_G Φ φ = ρ Φᵀ K Φ φ, with K_G = ∫ N (v′ᵀv′ + w′ᵀw′) dx and the axial forces
/// N due to the `action`. The structure buckles at ρ = −1. Without K_G the relative error of the deflection is about ρ.
/// The iteration converges from below.
/// \param shapes Φ (N×n) \param stiffness ΦᵀKΦ, factorised
template <class = void>  // compiled only if used
double axial_share(Structure const& s, MatX const& shapes, Eigen::LLT<MatX> const& stiffness,
                   StructureAction const& action) {
  std::vector<Vec<double, 12>> within(s.beams.size(), Vec<double, 12>::Zero());
  VecX load = VecX::Zero(s.size());
  for (std::size_t i = 0; i < s.beams.size(); ++i)
    for (int l = 0; l < 3; ++l) {
      within[i] -= action.b[l] * detail::spread_moment(s, s.beams[i], -1, l);
      for (int k = 0; k < 3; ++k) within[i] -= action.B(l, k) * detail::spread_moment(s, s.beams[i], k, l);
    }
  for (PlacedWrench const& p : action.loads) {
    std::size_t nearest = 0;
    double xi = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < s.beams.size(); ++i) {
      Vec3 const from = p.at - s.nodes[std::size_t(s.beams[i].a)], along = s.beams[i].axes.col(0);
      double const at = std::clamp(from.dot(along) / s.beams[i].length, 0.0, 1.0);
      double const distance = (from - at * s.beams[i].length * along).norm();
      if (distance >= least) continue;
      nearest = i;
      xi = at;
      least = distance;
    }
    Structure::Beam const& beam = s.beams[nearest];
    BeamShapes const at(xi, beam.length);
    Vec3 const arm = p.at - s.nodes[std::size_t(beam.a)] - xi * beam.length * beam.axes.col(0);
    Vec<double, 12> const on_beam = in_body_axes(at.axis, beam.axes).transpose() * p.w.f +
                                    in_body_axes(at.rotation, beam.axes).transpose() * (p.w.m + arm.cross(p.w.f));
    if (xi > 1e-9 && xi < 1.0 - 1e-9)
      within[nearest] += on_beam;
    else
      add_entries(beam, on_beam, load);
  }
  for (std::size_t i = 0; i < s.beams.size(); ++i) add_entries(s.beams[i], within[i], load);
  Structure::Sparse const by_axial =
      AxialForceStiffness(s)(load, [&](Structure::Beam const& b) { return within[std::size_t(&b - s.beams.data())]; });
  VecX x = VecX::LinSpaced(shapes.cols(), 1.0, 2.0);
  double share = 0.0;
  for (int i = 0; i < 40; ++i) {
    VecX const deformed = shapes * x, pull = by_axial * deformed, y = shapes.transpose() * pull;
    VecX const z = stiffness.solve(y);
    double const size = std::sqrt(std::max(z.dot(y), 0.0)), before = share;  // K-norm of K⁻¹ K_G x for x of K-norm one
    if (!(size > 0.0)) return 0.0;
    share = std::copysign(size, x.dot(y));
    x = z / size;
    if (i > 0 && std::abs(share - before) < 1e-3 * size) break;
  }
  return share;
}

}  // namespace polybody
