#pragma once
/// \file
/// Material points of the body of a floating frame, with the matrices of their displacement, small rotation and strain.
/// Theory: Eqs. 2.73, 2.100.

#include <algorithm>
#include <optional>
#include <span>

#include <Eigen/Cholesky>

#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/node_patch.hpp>
#include <polybody/kinematics/frame.hpp>

namespace polybody {

// Ratio of the axial forces in a structure of beams to its buckling forces. It estimates the error of a floating frame
// without geometric stiffening.

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
    auto const local = [&frame](Vec3 const& x) { return transposed_product<double>(frame.A, x); };
    Vec3 const omega = local(frame.w);
    StructureAction x{.b = local(acceleration), .B = skew<double>(alpha) + skew<double>(omega) * skew<double>(omega)};
    for (PlacedWrench const& l : loads) x.loads.push_back({local(l.at - frame.r), {local(l.w.f), local(l.w.m)}});
    return x;
  }
};

/// Eigenvalue ρ of largest magnitude of Φᵀ K_G Φ φ = ρ Φᵀ K Φ φ, with K_G = ∫ N (v′ᵀv′ + w′ᵀw′) dx and the axial forces
/// N due to the `action`. The structure buckles at ρ = −1. Without K_G the relative error of the deflection is about ρ.
/// The iteration approaches |ρ| from below.
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
    BeamShapes const at(xi, beam);
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

/// Material point: position u₀ in the frame [m], displacement S q and small rotation R q, with S and R (3×n). A
/// point of a beam also has the strains and the stiffness of its section.
struct FfrPoint {
  Vec3 u = Vec3::Zero();                ///< u₀ (3), in the axes of the frame [m]
  Mat<double, 3, Eigen::Dynamic> S, R;  ///< displacement [m] and small rotation [rad] for unit q
  std::array<MatX, 3> drawn;  ///< with geometric stiffening: the displacement is S q − ½ [qᵀ drawn_k q]_k (n×n)
  Mat<double, 6, Eigen::Dynamic>
      strain;  ///< (6×n) strain, two shears [1], twist, curvatures about y, z [1/m] for unit q; or empty
  Mat<double, 6, 6> stiffness = Mat<double, 6, 6>::Zero();  ///< stiffness of the section; without shear for constants
  double y = 0.0, z = 0.0;                                  ///< distances from the axis of the beam [m]

  /// Entry (i, k) of S − qᵀ drawn, the derivative of the displacement with respect to q.
  template <class T>
  T slope(T const* q, int i, Index k) const {
    T s(S(i, k));
    MatX const& m = drawn[std::size_t(i)];
    for (Index j = 0; j < m.rows(); ++j) s -= q[j] * m(j, k);
    return s;
  }
  /// Column k of S − qᵀ drawn, the derivative of the displacement with respect to q; written to `out` (3).
  template <class T>
  void slopes(T const* q, Index k, T* out) const {
    for (int i = 0; i < 3; ++i) out[i] = T(S(i, k));
    if (drawn[0].size() == 0) return;
    for (int i = 0; i < 3; ++i) out[i] = slope(q, i, k);
  }
  /// Strains of the section of the beam for the deformation q, as a vector of six (`HasSections`).
  /// \throws InvalidInput for a point that is not on a beam.
  template <class = void>  // compiled only if used
  Vec6 section_strains(double const* q) const {
    if (strain.cols() != S.cols())
      throw InvalidInput("ffr.no_strain",
                         {ErrorObject{"Ffr"}, ": strains are available only at points of beams. Use at(s)."});
    Vec6 sum = Vec6::Zero();
    for (Index k = 0; k < strain.cols(); ++k)
      for (int i = 0; i < 6; ++i) sum[i] += strain(i, k) * q[k];
    return sum;
  }
  /// Section forces (N, M) for the deformation q [N], [N m], without damping and pretension. The shear forces are zero
  /// for a section that is not given by matrices.
  template <class = void>
  Vec6 section_forces(double const* q) const {
    return stiffness * section_strains(q);
  }
};

/// Factory for the material points of a structure with the basis Φ, e = Φ q.
class FfrPoints {
 public:
  /// Points for the basis Φ = `shapes` (N×n). With `stiffening`, beams have axial foreshortening.
  template <class = void>
  FfrPoints(Structure structure, MatX shapes, bool stiffening) : s_(std::move(structure)), shapes_(std::move(shapes)) {
    auto const make = [](auto& part, auto const& from) { part.emplace(from); };  // compiled only if used
    if (stiffening) {
      make(axial_, s_);
    } else if (!s_.beams.empty() && shapes_.cols() > 0) {
      MatX const image = s_.stiffness * shapes_, carried = shapes_.transpose() * image;
      make(unstiffened_, carried);
      if (unstiffened_->info() != Eigen::Success) unstiffened_.reset();
    }
  }
  FfrPoints(FfrPoints const&) = delete;
  FfrPoints& operator=(FfrPoints const&) = delete;

  Structure const& structure() const { return s_; }  ///< finite element model
  /// Ratio of axial forces to buckling forces (`polybody::axial_share`). It is zero with stiffening, which includes the
  /// effect of axial forces, and for a structure that is not made of beams.
  template <class = void>
  double axial_share(StructureAction const& action) const {
    return unstiffened_ ? polybody::axial_share(s_, shapes_, *unstiffened_, action) : 0.0;
  }
  MatX const& shapes() const { return shapes_; }  ///< Φ (N×n)

  /// Length of the first bar [m].
  /// \throws InvalidInput for a structure without bars.
  double length() const {
    if (s_.beams.empty())
      throw InvalidInput("ffr.no_bar",
                         {ErrorObject{"Ffr"}, ": only a body made of bars has a length. Use node(i) for a point."});
    return s_.bar_lengths.front();
  }
  /// Point at the distance s along bar number `bar` (counted from 0) from its first end, at (y, z) from the axis of the
  /// bar [m].
  /// \throws InvalidInput for s outside the bar, and for a bar that does not exist.
  template <class = void>
  FfrPoint at(double s, double y, double z, Index bar) const {
    if (s_.beams.empty())
      throw InvalidInput("ffr.no_bar", {ErrorObject{"Ffr"}, ": at(s) needs a body made of bars. Use node(i)."});
    if (bar < 0 || bar >= Index(s_.bar_lengths.size()))
      throw InvalidInput("ffr.no_bar", {ErrorObject{"Ffr"}, ": bar ", ErrorValue{bar}, " does not exist; the body has ",
                                        s_.bar_lengths.size(), " bars, counted from 0."});
    double const inside = require_inside(s, s_.bar_lengths[std::size_t(bar)], "Ffr");
    require_finite(y, "Ffr: y of a point");
    require_finite(z, "Ffr: z of a point");
    Structure::Beam const* beam = nullptr;
    for (Structure::Beam const& b : s_.beams)
      if (b.bar == bar && (!beam || b.start <= inside)) beam = &b;
    double const xi = std::min((inside - beam->start) / beam->length, 1.0);
    BeamShapes const shapes(xi, *beam);
    FfrPoint p;
    p.u = s_.nodes[std::size_t(beam->a)] + beam->axes * Vec3(inside - beam->start, y, z);
    Mat<double, 3, 12> const spread = in_body_axes(shapes.axis + y * shapes.by_y + z * shapes.by_z, beam->axes);
    p.S = of_nodes(*beam, spread);
    p.R = of_nodes(*beam, in_body_axes(shapes.rotation, beam->axes));
    p.strain = of_nodes(*beam, by_body_axes<6>(shapes.strain, beam->axes));
    p.stiffness = section_stiffness(*beam);
    p.y = y;
    p.z = z;
    if (axial_)
      draw(p, xi > 1e-9 && xi < 1.0 - 1e-9, [&](int k, Structure::Beam const& b) {
        Vec<double, 12> load = Vec<double, 12>::Zero();
        for (int j = 0; j < 12 && &b == beam; ++j) load[j] = spread(k, j);
        return load;
      });
    return p;
  }

  /// Node i.
  /// \throws InvalidInput for a node that does not exist.
  template <class = void>
  FfrPoint node(Index i) const {
    s_.require_node(i, "Ffr");
    FfrPoint p;
    p.u = s_.nodes[std::size_t(i)];
    p.S = shapes_.middleRows<3>(s_.per_node * i);
    p.R = s_.per_node == 6 ? MatX(shapes_.middleRows<3>(6 * i + 3)) : MatX(MatX::Zero(3, shapes_.cols()));
    if (axial_) {
      auto const* const first =
          &*std::find_if(s_.beams.begin(), s_.beams.end(), [&](auto const& b) { return b.a == i || b.b == i; });
      draw(p, false, [&](int k, Structure::Beam const& b) {
        Vec<double, 12> load = Vec<double, 12>::Zero();
        if (&b == first) load[(b.a == i ? 0 : 6) + k] = 1.0;
        return load;
      });
    }
    return p;
  }

  /// Point `at` of the undeformed structure [m] that follows the mean motion of a patch of its nodes.
  /// \throws InvalidInput with geometric stiffening.
  template <class = void>
  FfrPoint patch(NodePatch const& nodes, Vec3 const& at) const {
    if (axial_)
      throw InvalidInput("ffr.patch",
                         {ErrorObject{"Ffr"},
                          ": with geometric stiffening a point cannot be a patch of nodes. Use at(s) or node(i)."});
    NodePatch::Motion const motion = nodes.motion(at, shapes_);
    FfrPoint p;
    p.u = at;
    p.S = motion.displacement;
    p.R = motion.rotation;
    return p;
  }

 private:
  /// Matrix with respect to q, from the matrix m (rows × 12) with respect to the nodal coordinates of a beam.
  template <int rows>
  Mat<double, rows, Eigen::Dynamic> of_nodes(Structure::Beam const& beam, Mat<double, rows, 12> const& m) const {
    Mat<double, rows, Eigen::Dynamic> out(rows, shapes_.cols());
    for (Index k = 0; k < shapes_.cols(); ++k)
      for (int i = 0; i < rows; ++i) {
        double sum = 0.0;
        for (int j = 0; j < 12; ++j) sum += m(i, j) * shapes_(6 * (j < 6 ? beam.a : beam.b) + j % 6, k);
        out(i, k) = sum;
      }
    return out;
  }
  /// Matrices drawn_k: −½ qᵀ drawn_k q is the second-order work of a unit force along k at the point. A force at a node
  /// gives a constant axial force along each beam, and a force at the held node gives none. If `within`, the force acts
  /// between the nodes of a beam and is treated as distributed over this beam.
  template <class Load>
  void draw(FfrPoint& p, bool within, Load&& load) const {
    for (int k = 0; k < 3; ++k) {
      VecX nodal = VecX::Zero(s_.size());
      for (Structure::Beam const& b : s_.beams) add_entries(b, load(k, b), nodal);
      Structure::Sparse const m = (*axial_)(nodal, [&](Structure::Beam const& b) {
        return within ? load(k, b) : Vec<double, 12>(Vec<double, 12>::Zero());
      });
      p.drawn[std::size_t(k)] = shapes_.transpose() * (m * shapes_);
    }
  }

  Structure s_;
  MatX shapes_;
  std::optional<AxialForceStiffness> axial_;
  std::optional<Eigen::LLT<MatX>> unstiffened_;  ///< factorisation of ΦᵀKΦ; empty with stiffening or without beams
};

/// Points of a body.
/// \throws InvalidInput naming the type `body` for a body without points, which was made from integrals only.
template <class = void>
[[gnu::cold]] FfrPoints const& require_points(FfrPoints const* points, char const* body) {
  if (!points)
    throw InvalidInput("ffr.integrals_only", {ErrorObject{body},
                                              ": this body was made from integrals only, so it has no nodes and no "
                                              "bars. Give each point as a Point with its matrices S, R."});
  return *points;
}

}  // namespace polybody
