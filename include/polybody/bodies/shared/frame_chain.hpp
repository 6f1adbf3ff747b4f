#pragma once
/// \file
/// Chain of two-node elements whose nodes are frames, with its inertia: the common part of `Lrvf` and `Se3Beam`, which
/// does not depend on the strains.
/// Theory: Eqs. 2.59, 2.114.

#include <algorithm>
#include <string>
#include <vector>

#include <polybody/bodies/shared/bar_sections.hpp>
#include <polybody/bodies/shared/frame_secants.hpp>

namespace polybody {

/// Chain of n equal elements between n + 1 nodes. A node has the position r (3) in world axes and the unit quaternion
/// (4) of its section as coordinates, and ṙ (3) and Ω (3) in section axes as generalised velocities. q ⊞ δ adds δr and
/// rotates the section by exp(δθ).
///
/// The kinetic energy of an element of mass m = Aρ l is
///   T = m/6 (ṙ₁·ṙ₁ + ṙ₁·ṙ₂ + ṙ₂·ṙ₂) + ½ Ω₁·J₁ Ω₁ + ½ Ω₂·J₂ Ω₂,  J = ½ l Iρ,
/// with the rotary inertias Iρ of the sections of the nodes, diag(Iρ_x, Iρ_y, Iρ_z) unless the bar has matrices. The
/// nodes are the centres of mass of their sections. The translation is that of a straight rod between the nodes, so
/// that a straight element has its exact inertia, and the mass and the momentum are exact in every state. M is
/// constant. The inertia forces that depend on velocities are −Ω × J Ω at the nodes. Without any rotary inertia M is
/// singular, which explicit methods do not permit.
class FrameChain {
 public:
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::frame;
  static constexpr bool constant_mass = true;
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

  double length() const { return length_; }
  double element_length() const { return l_; }
  BarConstants const& constants() const { return constants_; }
  /// Warning of section matrices of the bar that are probably not in SI units; empty if there is none.
  std::string const& unit_warning() const { return unit_warning_; }

  Index elements() const { return n_; }
  Index coordinates() const { return 7 * (n_ + 1); }
  Index velocities() const { return 6 * (n_ + 1); }
  Index first_column(Index e) const { return 6 * e; }
  Index first_column(Point const& p) const { return first_column(p.element); }
  /// Number of the node at ξ = 0 or ξ = 1; −1 between nodes (`HasFrameNodes`).
  static Index node_of(Point const& p) { return p.xi == 0.0 ? p.element : p.xi == 1.0 ? p.element + 1 : -1; }
  /// Vector from the node of p to p, in the axes of its section [m].
  Vec3 node_arm(Point const& p) const { return from_centre(p); }
  char const* coordinate_unit(Index i) const { return i % 7 < 3 ? "m" : "1"; }
  char const* velocity_unit(Index i) const { return i % 6 < 3 ? "m/s" : "rad/s"; }

  void reference(std::span<double> q) const { std::copy(reference_.begin(), reference_.end(), q.begin()); }

  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    for (Index i = 0; i <= n_; ++i) {
      for (int k = 0; k < 3; ++k)
        out[std::size_t(7 * i + k)] = q[std::size_t(7 * i + k)] + delta[std::size_t(6 * i + k)];
      set_entries<4>(out, 7 * i + 3, quaternion_plus<T>(axes_of<T>(q, i), entries<3>(delta, 6 * i + 3)));
    }
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
    for (Index i = 0; i <= n_; ++i) {
      Vec<T, 3> const swept = cross<T>(omega, entries<3>(q, 7 * i));
      for (int k = 0; k < 3; ++k) v[std::size_t(6 * i + k)] = v0[k] + swept[k];
      set_entries<3>(v, 6 * i + 3, transposed_product<T>(rotation_matrix<T>(axes_of<double>(q, i)), omega));
    }
  }

  template <class T>  // compiled only if used
  void mass(Index e, std::span<double const>, Mat<T, 12, 12>& m) const {
    m.setZero();
    double const sixth = sixth_of(e);
    for (int node : {0, 6})
      for (int i = 0; i < 3; ++i) {
        m(node + i, node + i) = 2.0 * sixth;
        m(node + i, 6 - node + i) = sixth;
        for (int j = 0; j < 3; ++j) m(node + 3 + i, node + 3 + j) = rotary_of(e + node / 6)(i, j);
      }
  }
  template <StateScalar T>
  void inertia(Index e, std::span<T const>, std::span<T const> a, Element<T>& out) const {
    T const* const x = a.data() + 6 * e;
    double const sixth = sixth_of(e);
    for (int node : {0, 6}) {
      Vec<T, 3> const spin = momentum<T>(e + node / 6, entries<3>(a, 6 * e + node + 3));
      for (int i = 0; i < 3; ++i) {
        out[node + i] = (2.0 * x[node + i] + x[6 - node + i]) * sixth;
        out[node + 3 + i] = spin[i];
      }
    }
  }
  template <StateScalar T>
  void gravity(Index e, std::span<T const>, Vec3 const& g, Element<T>& out) const {
    out = detail::zeros<Element<T>>();
    for (int i = 0; i < 3; ++i) out[i] = out[6 + i] = T(3.0 * sixth_of(e) * g[i]);
  }

  template <class T = double>  // compiled only if used
  double kinetic_energy(Index e, std::span<double const>, std::span<double const> v) const {
    Vec<T, 3> const v1 = entries<3>(v, 6 * e), w1 = entries<3>(v, 6 * e + 3), v2 = entries<3>(v, 6 * e + 6),
                    w2 = entries<3>(v, 6 * e + 9);
    return sixth_of(e) * (squared_norm(v1) + dot(v1, v2) + squared_norm(v2)) +
           0.5 * (dot(momentum<T>(e, w1), w1) + dot(momentum<T>(e + 1, w2), w2));
  }
  template <class T = double>  // compiled only if used
  double gravity_energy(Index e, std::span<double const> q, Vec3 const& g) const {
    Vec<T, 3> const r1 = entries<3>(q, 7 * e), r2 = entries<3>(q, 7 * e + 7);
    return -3.0 * sixth_of(e) * (dot<T>(g, r1) + dot<T>(g, r2));
  }

 protected:
  /// Chain of n elements of the bar, with nodes on `curve` in the axes of the bar. `body` is the name of the body type
  /// in messages.
  template <class Curve>  // compiled only if used
  FrameChain(Bar const& bar, detail::ChainSections const& sections, Index n, Curve const& curve,
             std::string const& body)
      : reference_(std::size_t(7 * (n + 1))),
        constants_(sections.constants),
        n_(n),
        length_(bar.length),
        l_(bar.length / double(n)),
        unit_warning_(detail::unit_warning(bar)) {
    for (auto const& section : sections.elements) sixth_.push_back(section.mass * l_ / 6.0);
    for (auto const& section : sections.nodes) {
      rotary_.push_back(section.inertia);
      for (int i = 0; i < 9; ++i) rotary_.back().data()[i] *= 0.5 * l_;
    }
    std::span<double> const q(reference_);
    for (Index i = 0; i <= n; ++i) {
      Placement const at = placed(bar, curve(double(i) * l_), body);
      set_entries<3>(q, 7 * i, at.origin);
      set_entries<4>(q, 7 * i + 3, quaternion_of(at.axes));
    }
  }

  /// Placement in the world of a section with the placement `section` in the axes of the bar.
  template <class T = double>  // compiled only if used
  static Placement placed(Bar const& bar, Placement const& section, std::string const& body) {
    section.check(body + ": the reference curve");
    Placement out{product<T>(bar.placement.axes, section.origin), product<T>(bar.placement.axes, section.axes)};
    for (int i = 0; i < 3; ++i) out.origin[i] += bar.placement.origin[i];
    return out;
  }
  /// Point at the arc length s of the reference, and (y, z) from the axis.
  /// \throws InvalidInput naming `body` for s outside the bar.
  template <class T = double>  // compiled only if used
  Point point_at(T s, double y, double z, std::string const& body) const {
    double const x = require_inside(s, length_, body) / l_;
    require_finite(y, body, ": y of a point");
    require_finite(z, body, ": z of a point");
    Index const e = std::min(Index(x + 1e-12), n_ - 1);
    double const xi = x - double(e);
    return {e, xi < 1e-12 ? 0.0 : xi > 1.0 - 1e-12 ? 1.0 : xi, y, z};  // exact position of a node
  }
  /// Vector from the line of the centres of mass to the point p, in section axes [m].
  Vec3 from_centre(Point const& p) const {
    if (centres_.empty()) return {0.0, p.y, p.z};
    Vec3 const &a = centres_[std::size_t(p.element)], &b = centres_[std::size_t(p.element) + 1];
    return {0.0, p.y - (1.0 - p.xi) * a[1] - p.xi * b[1], p.z - (1.0 - p.xi) * a[2] - p.xi * b[2]};
  }
  /// Moves the nodes of the reference from the axis of the bar to the centres of mass of their sections. Returns false
  /// if all centres are on the axis.
  template <class T = double>  // compiled only if used
  bool move_to_centres(std::vector<detail::CentredSection> const& nodes) {
    bool offset = false;
    for (auto const& section : nodes) offset = offset || !section.centre.isZero(0.0);
    for (Index i = 0; offset && i <= n_; ++i) {
      centres_.push_back(nodes[nodes.size() == 1 ? 0 : std::size_t(i)].centre);
      Vec<T, 3> const arm = product(rotation_matrix<T>(axes_of<T>(reference_, i)), centres_.back());
      for (int k = 0; k < 3; ++k) reference_[std::size_t(7 * i + k)] += arm[k];
    }
    return offset;
  }
  /// Unit quaternion of the section of node i.
  template <StateScalar T>
  static Quaternion<T> axes_of(std::span<T const> q, Index i) {
    return entries<4>(q, 7 * i + 3);
  }

  /// Moment −Ω × J Ω of the inertia forces on node i.
  template <StateScalar T>
  Vec<T, 3> gyroscopic_moment(Index i, std::span<T const> v) const {
    Vec<T, 3> const omega = entries<3>(v, 6 * i + 3);
    return cross<T>(momentum<T>(i, omega), omega);
  }
  /// Adds cd ∂(Ω × J Ω)/∂Ω = cd (Ω̃ J − (J Ω)~) of both nodes of element e to k.
  template <class T>
  void add_gyroscopic_tangent(Index e, std::span<double const> v, double cd, Mat<T, 12, 12>& k) const {
    for (int i = 0; i < 2; ++i) {
      Vec<T, 3> const omega = entries<3>(v, 6 * (e + i) + 3);
      Mat<T, 3, 3> const of_omega = skew_product<T>(omega, rotary_of(e + i)),
                         of_momentum = skew<T>(momentum<T>(e + i, omega));
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) k(6 * i + 3 + r, 6 * i + 3 + c) += cd * (of_omega(r, c) - of_momentum(r, c));
    }
  }

  /// Marker p with `axes` on the section `at` of its element.
  template <class S>
  FrameSecant<S> marker_on(Point const& p, Mat3 const& axes, FrameSecant<S> const& at) const {
    return marker_of_frame<S>(from_centre(p), axes, at);
  }
  /// Section of a node, for a point at ξ = 0 or ξ = 1.
  template <class S>
  static FrameSecant<S> node_secant(Point const& p, FrameStep const& step) {
    return frame_secant<S>(step, p.element + (p.xi == 0.0 ? 0 : 1), p.xi == 0.0 ? 0 : 6);
  }
  /// Sets f to the mean gyroscopic moments of both nodes of element e.
  template <class S>
  void set_mean_gyroscopic(Index e, FrameStep const& step, Vec<S, 12>& f) const {
    f = detail::zeros<Vec<S, 12>>();
    for (int i = 0; i < 2; ++i) {
      Vec<S, 3> const moment = mean_gyroscopic_moment<S>(step, e + i, rotary_of(e + i));
      for (int k = 0; k < 3; ++k) f[6 * i + 3 + k] = moment[k];
    }
  }
  /// Adds −l Σ n_i s(ε_i) to f, with the slopes s of the `strains` and the section forces `n`.
  template <class S>
  void subtract_stress(Vec<S, 6> const& strains, Vec6 const& n, Vec<double, 12>& f) const {
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 12; ++k) f[k] -= l_ * n[i] * strains[i].d[k];
  }
  /// Adds the tangent of the mean gyroscopic moments of both nodes of element e to k.
  template <class T>
  void add_mean_gyroscopic_tangent(Index e, FrameStep const& step, Mat<T, 12, 12>& k) const {
    for (int i = 0; i < 2; ++i) {
      Mat<T, 3, 3> const block = mean_gyroscopic_tangent<T>(step, e + i, rotary_of(e + i));
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) k(6 * i + 3 + r, 6 * i + 3 + c) += block(r, c);
    }
  }

  std::vector<double> reference_;  ///< coordinates of the undeformed beam
  std::vector<Vec3> centres_;      ///< centres of mass at the nodes; empty if all are on the axis

 private:
  /// Aρ l/6 of element e [kg].
  double sixth_of(Index e) const { return sixth_[sixth_.size() == 1 ? 0 : std::size_t(e)]; }
  /// J of half an element at node i [kg m²].
  Mat3 const& rotary_of(Index i) const { return rotary_[rotary_.size() == 1 ? 0 : std::size_t(i)]; }
  /// Angular momentum J Ω of half an element at node i.
  template <class T>
  Vec<T, 3> momentum(Index i, Vec<T, 3> const& omega) const {
    Mat3 const& j = rotary_of(i);
    Vec<T, 3> out;
    for (int r = 0; r < 3; ++r) out[r] = omega[0] * j(r, 0) + omega[1] * j(r, 1) + omega[2] * j(r, 2);
    return out;
  }

  BarConstants constants_;
  Index n_;
  double length_, l_;
  std::vector<double> sixth_;  ///< Aρ l/6 of all elements, or of each [kg]
  std::vector<Mat3> rotary_;   ///< J of half an element at all nodes, or at each [kg m²]
  std::string unit_warning_;
};

}  // namespace polybody
