#pragma once
/// \file
/// Geometrically exact beam in the plane whose elements are circular arcs, with one interpolation of position and angle
/// on SE(2).
/// Theory: Eqs. 2.119, 2.120.

#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/shared/sections.hpp>
#include <polybody/math/se3.hpp>

namespace polybody::planar {

/// Theory of the planar `Se3Beam`. With Δr = r₂ − r₁, φ = θ₂ − θ₁, and the axes t₁, t₂ at the mean angle of the nodes,
///   (1 + ε, γ) = g (t₁·Δr, t₂·Δr)/l,  κ = φ/l,  g = (φ/2)/sin(φ/2).
/// (ε, γ, κ) are the logarithm of the relative motion of the nodes, divided by l.
struct CircularArc : SimoVuQuoc {
  static constexpr char const* name = "planar::Se3Beam";  ///< name of the body type in messages

  /// Checks the constants of the bar.
  /// \throws InvalidInput unless GA is positive.
  static void check(BarConstants const& c) {
    require_positive(c.GA, "planar::Se3Beam: the shear stiffness GA of the bar");
  }

  /// Function g of φ and its derivatives.
  template <class T>
  struct Growth {
    T g, dg, ddg;                    ///< g without unit, g′ [1/rad], g″ [1/rad²]
    explicit Growth(T const& phi) {  ///< at the angle φ [rad]
      T const x = phi * phi;
      if constexpr (!requires { value_of(x); }) {  // SIMD vector
        bool small = true;
        for (int i = 0; i < T::size; ++i) small = small && x[i] < 0.04;
        if (small) set(phi, detail::polynomial<8, T>(detail::inverse_sine_series, x));
        for (int i = 0; i < T::size && !small; ++i) {
          Growth<double> const one(phi[i]);
          g.set(i, one.g);
          dg.set(i, one.dg);
          ddg.set(i, one.ddg);
        }
      } else if (value_of(x) < 0.04) {
        set(phi, detail::polynomial<8, T>(detail::inverse_sine_series, x));
      } else {
        set(phi, large(phi));
      }
    }

   private:
    /// Sets g and its derivatives from those of g(x), x = φ², as (g, dg/dx, ½ d²g/dx²).
    void set(T const& phi, std::array<T, 3> const& by_x) {
      g = by_x[0];
      dg = 2.0 * phi * by_x[1];
      ddg = 2.0 * by_x[1] + 8.0 * phi * phi * by_x[2];
    }
    /// (g, dg/dx, ½ d²g/dx²) at x = φ² ≥ 0.04. From φ = 2 rad on, with s = sin(φ/2), c = cot(φ/2) and h = φ c/2:
    ///   dg/dx = (1 − h)/(4 φ s),  d²g/dx² = (φ²/4 + (2 h + 1)(h − 1))/(8 φ³ s).
    [[gnu::noinline]] static std::array<T, 3> large(T phi) {
      using std::cos, std::sin;
      T const x = phi * phi;
      if (value_of(x) < 4.0) return detail::polynomial<20, T>(detail::inverse_sine_series, x);
      T const s = phi * sin(0.5 * phi), h = 0.5 * x * cos(0.5 * phi) / s;
      return {0.5 * x / s, (0.25 - 0.25 * h) / s, (0.25 * x + (2.0 * h + 1.0) * (h - 1.0)) / (16.0 * x * s)};
    }
  };

  /// Derivatives r′ and r″ of the axis in the middle of an element of length l [m]. `chord` (2) [m] and `phi` [rad] are
  /// the differences of position and angle of its nodes.
  template <class T = double>  // compiled only if used
  static AxisSlopes<2> axis_slopes(Vec<T, 2> const& chord, T phi, double l) {
    double const stretch = Growth<T>(phi).g / l, bend = stretch * phi / l;
    return {stretch * chord, bend * Vec<T, 2>(-chord[1], chord[0])};
  }

  /// Strains ε, γ, κ, with p = (x′, y′, θ, θ′, φ) in the middle of the element.
  struct Section : SimoVuQuoc::Section {
    static constexpr int parameters = 5;

    /// Parameters in the middle of the element, because the strains are those of the whole element.
    template <class T = double>  // compiled only if used
    static Mat<T, 5, 2> map(double, double l) {
      Mat<T, 5, 2> p;
      p << SimoVuQuoc::Section::map<T>(0.5, l), T(-1), T(1);
      return p;
    }
    template <KernelScalar T>
    static void evaluate(Vec<T, 5> const& p, Vec<T, 3>& strain, Mat<T, 3, 5>& b) {
      using std::cos, std::sin;
      Growth<T> const by(p[4]);
      T const c = cos(p[2]), s = sin(p[2]), stretch = c * p[0] + s * p[1], slide = c * p[1] - s * p[0];
      strain[0] = by.g * stretch - 1.0;
      strain[1] = by.g * slide;
      strain[2] = p[3];
      b << by.g * c, by.g * s, by.g * slide, T(0), by.dg * stretch,  //
          -(by.g * s), by.g * c, -(by.g * stretch), T(0), by.dg * slide, T(0), T(0), T(0), T(1), T(0);
    }
    template <KernelScalar T>
    static void add_hessian(Vec<T, 5> const& p, Vec<T, 3> const& n, Mat<T, 5, 5>& h) {
      using std::cos, std::sin;
      Growth<T> const by(p[4]);
      T const c = cos(p[2]), s = sin(p[2]), stretch = c * p[0] + s * p[1], slide = c * p[1] - s * p[0];
      T const along = c * n[0] - s * n[1], across = s * n[0] + c * n[1];  // (N, Q) in world axes
      T const work = stretch * n[0] + slide * n[1], torque = slide * n[0] - stretch * n[1];
      auto const add = [&](int i, int j, T const& x) {
        h(i, j) += x;
        h(j, i) += x;
      };
      add(0, 2, -(by.g * across));
      add(1, 2, by.g * along);
      add(0, 4, by.dg * along);
      add(1, 4, by.dg * across);
      add(2, 4, by.dg * torque);
      h(2, 2) -= by.g * work;
      h(4, 4) += by.ddg * work;
    }
    /// Rate of B for the rates `pd` of the parameters.
    template <KernelScalar T>
    static void slope_rate(Vec<T, 5> const& p, Vec<T, 5> const& pd, Mat<T, 3, 5>& rate) {
      using std::cos, std::sin;
      Growth<T> const by(p[4]);
      T const c = cos(p[2]), s = sin(p[2]), stretch = c * p[0] + s * p[1], slide = c * p[1] - s * p[0];
      T const stretching = c * pd[0] + s * pd[1] + slide * pd[2], sliding = c * pd[1] - s * pd[0] - stretch * pd[2];
      T const dg = by.dg * pd[4], ddg = by.ddg * pd[4], turning = by.g * pd[2];
      T const along = dg * c - turning * s, across = dg * s + turning * c;
      rate << along, across, dg * slide + by.g * sliding, T(0), ddg * stretch + by.dg * stretching,  //
          -across, along, -(dg * stretch + by.g * stretching), T(0), ddg * slide + by.dg * sliding,  //
          T(0), T(0), T(0), T(0), T(0);
    }
  };
  using Groups = std::tuple<Section>;  ///< strain laws of the beam
};

/// Geometrically exact beam in the plane, a chain of circular arcs [Sonneville, Cardona & Brüls 2014]. Node coordinates
/// (x, y, θ), generalised velocities and mass matrix are those of `planar::Lrvf`. Strains are constant in an element
/// and depend on the relative motion of its nodes. The relative rotation of the nodes must be less than 2π.
///
/// The position between the nodes is r = r₁ + Z Δr, where Z is the rotation and scaling by the complex number
///   z(φ) = (exp(iξφ) − 1)/(exp(iφ) − 1) = ξ s₁(ξ²φ²/4)/s₁(φ²/4) exp(i(ξ − 1)φ/2).
class Se3Beam : public Beam<CircularArc> {
  using Base = Beam<CircularArc>;

 public:
  /// Beam from the straight bar, with n elements of equal length.
  /// \throws InvalidInput for n outside [1, 10⁷], a placement that leaves the plane, or a bar without GA.
  template <class = void>  // compiled only if used
  static Se3Beam from(Bar const& bar, Index n) {
    return Se3Beam(Base::from(bar, n));
  }
  /// Beam from the straight bar, with the number of elements of `mesh`.
  template <class = void>  // compiled only if used
  static Se3Beam from(Bar const& bar, BarMesh const& mesh = {}) {
    return Se3Beam(Base::from(bar, mesh));
  }
  /// Beam of n elements along `curve` whose undeformed shape is straight (`Beam`).
  template <class = void>  // compiled only if used
  static Se3Beam from(Bar const& bar, Index n, ReferenceCurve const& curve) {
    return Se3Beam(Base::from(bar, n, curve));
  }
  /// Beam of n elements with the undeformed shape `curve` (`Beam`).
  template <class = void>  // compiled only if used
  static Se3Beam naturally_curved(Bar const& bar, Index n, ReferenceCurve const& curve) {
    return Se3Beam(Base::naturally_curved(bar, n, curve));
  }

  /// Positions are not linear in the coordinates.
  PointMap position_map(Point const&) const = delete;

  /// Position, angle and motion of the axis at `p`.
  template <StateScalar T>
  CentreLine<T> centre_line(Point const& p, std::span<T const> q, std::span<T const> v) const {
    Arc<T> const a(p.xi, this->of_element(p.element, q), this->of_element(p.element, v));
    return {a.r, a.v, a.angle, a.rate, T(0.0)};
  }
  /// Marker kinematics as in `Beam`, with r₀ = r₁ + Z Δr, ṙ₀ = ṙ₁ + Z Δṙ + Z′ Δr φ̇ and the bias
  /// 2 Z′ Δṙ φ̇ + Z″ Δr φ̇².
  template <StateScalar T>
  void evaluate_marker(Point const& p, Mat3 const& axes, std::span<T const> q, std::span<T const> v,
                       MarkerKinematics<T>& out) const {
    using std::cos, std::sin;
    Arc<T> const a(p.xi, this->of_element(p.element, q), this->of_element(p.element, v));
    T const c = cos(a.angle), s = sin(a.angle);
    Vec<T, 2> const t(c, s), n(-s, c);
    Eigen::Map<Mat<T, 6, 6>> j(out.jacobian);
    j.setZero();
    out.bias.setZero();
    for (int i = 0; i < 2; ++i) {
      out.frame.r[i] = a.r[i] + n[i] * p.y;
      out.frame.v[i] = a.v[i] - t[i] * (a.rate * p.y);
      out.frame.w[i] = T(0.0);
      out.bias[i] = a.bias[i] - n[i] * (a.rate * a.rate * p.y);
      j(i, 0) = (i == 0 ? 1.0 - a.z[0] : -a.z[1]);
      j(i, 1) = (i == 0 ? a.z[1] : 1.0 - a.z[0]);
      j(i, 3) = a.z[i];
      j(i, 4) = (i == 0 ? -a.z[1] : a.z[0]);
      j(i, 2) = -(a.by_phi[i] + t[i] * (p.y * (1.0 - p.xi)));
      j(i, 5) = a.by_phi[i] - t[i] * (p.y * p.xi);
    }
    for (int k = 0; k < 3; ++k) {
      out.frame.A(0, k) = c * axes(0, k) - s * axes(1, k);
      out.frame.A(1, k) = s * axes(0, k) + c * axes(1, k);
      out.frame.A(2, k) = T(axes(2, k));
    }
    out.frame.r[2] = out.frame.v[2] = T(0.0);
    out.frame.w[2] = a.rate;
    j(5, 2) = T(1.0 - p.xi);
    j(5, 5) = T(p.xi);
    out.shape = JacobianShape::dense;
    out.columns = 6;
  }
  /// Load stiffness of the wrench `w`: with the signs s = (−1, 1) of the nodes,
  ///   ∂²(f·r₀)/∂r_i∂θ_j = s_i s_j Z′ᵀf,  ∂²(f·r₀)/∂θ_i∂θ_j = s_i s_j f·Z″Δr, and −y (n·f) h hᵀ, h = (1 − ξ, ξ).
  template <class = void>  // compiled only if used
  void load_stiffness(Point const& p, std::span<double const> q, Wrench<double> const& w, ElementMatrix& k) const {
    Arc<double> const a(p.xi, this->of_element(p.element, q), Element<double>::Zero());
    double const pull[] = {a.dz[0] * w.f[0] + a.dz[1] * w.f[1], a.dz[0] * w.f[1] - a.dz[1] * w.f[0]};
    double const bend = a.by_phi2[0] * w.f[0] + a.by_phi2[1] * w.f[1];
    double const normal = p.y * (std::cos(a.angle) * w.f[1] - std::sin(a.angle) * w.f[0]);
    double const h[] = {1.0 - p.xi, p.xi};
    k.setZero();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        double const sign = i == j ? 1.0 : -1.0;
        for (int c = 0; c < 2; ++c) k(3 * i + c, 3 * j + 2) = k(3 * j + 2, 3 * i + c) = sign * pull[c];
        k(3 * i + 2, 3 * j + 2) = sign * bend - normal * h[i] * h[j];
      }
  }

 private:
  template <class = void>  // compiled only if used
  explicit Se3Beam(Base const& base) : Base(base) {}

  /// Axis at a point of an element.
  template <StateScalar T>
  struct Arc {
    T angle, rate;         ///< θ [rad], θ̇ [rad/s]
    Vec<T, 2> r, v, bias;  ///< position, velocity, and acceleration for constant velocities of the nodes
    Vec<T, 2> z, dz;       ///< z and z′ as (real, imaginary)
    Vec<T, 2> by_phi;      ///< Z′ Δr [m]
    Vec<T, 2> by_phi2;     ///< Z″ Δr [m]

    /// Axis at ξ of the element with coordinates x and velocities xd.
    Arc(double xi, Vec<T, 6> const& x, Vec<T, 6> const& xd) {
      using std::cos, std::sin;
      T const phi = x[5] - x[2], turning = xd[5] - xd[2];
      double const slope = 0.5 * (xi - 1.0);
      detail::SineSeries<T> const top(0.25 * xi * xi * phi * phi), bottom(0.25 * phi * phi);
      T const n1 = 0.5 * xi * xi * phi * top.slope(1), d1 = 0.5 * phi * bottom.slope(1);
      T const n2 = 0.25 * xi * xi * (xi * xi * phi * phi * top.second(1) + 2.0 * top.slope(1)),
              d2 = 0.25 * (phi * phi * bottom.second(1) + 2.0 * bottom.slope(1));
      T const size = top[1] / bottom[1], size1 = (n1 - size * d1) / bottom[1],
              size2 = (n2 - 2.0 * size1 * d1 - size * d2) / bottom[1];
      T const c = cos(slope * phi), s = sin(slope * phi);
      Vec<T, 2> const dr(x[3] - x[0], x[4] - x[1]), dv(xd[3] - xd[0], xd[4] - xd[1]);
      z = {xi * size * c, xi * size * s};
      dz = times_unit(xi * size1, xi * slope * size, c, s);
      Vec<T, 2> const ddz = times_unit(xi * (size2 - slope * slope * size), 2.0 * xi * slope * size1, c, s);
      by_phi = times(dz, dr);
      by_phi2 = times(ddz, dr);
      Vec<T, 2> const moved = times(z, dr), moving = times(z, dv), mixed = times(dz, dv);
      for (int i = 0; i < 2; ++i) {
        r[i] = x[i] + moved[i];
        v[i] = xd[i] + moving[i] + by_phi[i] * turning;
        bias[i] = (2.0 * mixed[i] + by_phi2[i] * turning) * turning;
      }
      angle = (1.0 - xi) * x[2] + xi * x[5];
      rate = (1.0 - xi) * xd[2] + xi * xd[5];
    }

   private:
    /// Product of complex numbers.
    static Vec<T, 2> times(Vec<T, 2> const& a, Vec<T, 2> const& b) {
      return {a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]};
    }
    static Vec<T, 2> times_unit(T const& re, T const& im, T const& c, T const& s) {
      return {re * c - im * s, re * s + im * c};
    }
  };
};

}  // namespace polybody::planar
