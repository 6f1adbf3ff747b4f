#pragma once
/// \file
/// Orthonormal frame of a deformable section, with its rotation and derivatives.
/// Theory: Eqs. 2.36, 2.40.

#include <array>

#include <polybody/math/dual.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Axes of a section as the columns of the rotation matrix R, with the products R x and Rᵀ x, and products of vectors.
template <KernelScalar T>
struct SectionAxes {
  using V3 = Vec<T, 3>;  ///< three components

  Mat<T, 3, 3> R;  ///< columns t₁, t₂, t₃

  /// Product Rᵀ x, x (3).
  V3 local(V3 const& x) const {
    V3 y;
    for (int i = 0; i < 3; ++i) y[i] = R(0, i) * x[0] + R(1, i) * x[1] + R(2, i) * x[2];
    return y;
  }
  /// Product R x.
  V3 world(V3 const& x) const {
    V3 y;
    for (int i = 0; i < 3; ++i) y[i] = R(i, 0) * x[0] + R(i, 1) * x[1] + R(i, 2) * x[2];
    return y;
  }
  /// Unit vector e_k, k = 0, 1, 2.
  static V3 axis(int k) { return V3(T(k == 0 ? 1.0 : 0.0), T(k == 1 ? 1.0 : 0.0), T(k == 2 ? 1.0 : 0.0)); }
  /// Cross product a × b.
  static V3 cross(V3 const& a, V3 const& b) {
    return V3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  }
  /// Scalar product a · b.
  static T dot(V3 const& a, V3 const& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
};

/// Orthonormal frame of a deformable section, its rotation, and the derivatives of both in closed form. The frame
/// follows from two vectors b, c in the section (r_y and r_z of a beam):
///   t₂ = b/|b|,  t₁ = b × c/|b × c|,  t₃ = t₁ × t₂.
/// The axis t₁ is normal to the section, and R = [t₁ t₂ t₃] is the identity if b = e₂ and c = e₃. With β = |b|, c₃ =
/// c·t₃, σ = c·t₂/c₃, a change d = (δb, δc) has the components
///   w = (X, Y),  X = Rᵀδb/β,  Y = Rᵀδc/c₃.
/// The change rotates the frame by φ = S w in the axes of the frame, δR = R φ̃:
///   φ = (X₃, Y₁ − σ X₁, −X₁).
/// This equation follows from δt₂ = (1 − t₂t₂ᵀ) δb/β and from the condition t₁·c = 0. A second change with
/// the components ŵ = (X̂, Ŷ) rotates the frame by φ̂ = S ŵ. The components of a constant d then change by
///   δ̂X = X × φ̂ − X X̂₂,  δ̂Y = Y × φ̂ − Y (Ŷ₃ − σ X̂₃),  δ̂σ = g·ŵ = Ŷ₂ + (1 + σ²) X̂₃ − σ Ŷ₃.
/// All other derivatives follow by the chain rule. Vectors of six are ordered (X, Y). The code uses plain loops for
/// doubles, dual numbers and SIMD vectors.
template <KernelScalar T>
class SectionFrame : public SectionAxes<T> {
 public:
  using V3 = Vec<T, 3>;         ///< three components
  using V6 = Vec<T, 6>;         ///< components w = (X, Y) of a change
  using M6 = Mat<T, 6, 6>;      ///< bilinear form in two changes
  using Axes = SectionAxes<T>;  ///< base class, stores R
  using Axes::axis, Axes::cross, Axes::dot, Axes::local, Axes::R, Axes::world;

  /// Frame of b and c, which must not be parallel.
  SectionFrame(V3 const& b, V3 const& c) {
    using std::sqrt;
    V3 const n = cross(b, c);
    T const bb = dot(b, b), in = T(1.0) / sqrt(dot(n, n));
    ib_ = T(1.0) / sqrt(bb);
    ic_ = bb * ib_ * in;  // c₃ = |b × c|/|b|
    for (int i = 0; i < 3; ++i) {
      R(i, 0) = n[i] * in;
      R(i, 1) = b[i] * ib_;
    }
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      R(i, 2) = R(j, 0) * R(k, 1) - R(k, 0) * R(j, 1);
    }
    sigma_ = (R(0, 1) * c[0] + R(1, 1) * c[1] + R(2, 1) * c[2]) * ic_;
  }

  /// Components w = (Rᵀdb/β, Rᵀdc/c₃) of changes db of b and dc of c.
  V6 components(V3 const& db, V3 const& dc) const {
    V3 const x = local(db), y = local(dc);
    V6 w;
    for (int i = 0; i < 3; ++i) {
      w[i] = x[i] * ib_;
      w[3 + i] = y[i] * ic_;
    }
    return w;
  }
  /// Rotation φ = S w in the axes of the frame. If b and c change with time, φ is the angular velocity; if they change
  /// along the axis, φ is twist and curvatures.
  V3 spin(V6 const& w) const { return V3(w[2], w[3] - sigma_ * w[0], -w[0]); }
  /// Product Sᵀ m, with m (3) in the axes of the frame.
  V6 pull(V3 const& m) const {
    V6 s;
    for (int i = 0; i < 6; ++i) s[i] = T(0.0);
    s[0] = -(m[2] + sigma_ * m[1]);
    s[2] = m[0];
    s[3] = m[1];
    return s;
  }
  /// Matrix M(m), 6×6, of m·δ̂φ(w) = wᵀ M ŵ for a constant d with components w: the second derivative of the rotation.
  /// M equals `pairing(pull(m), 1)` minus m₂ g (`sigma_gradient`) in the first row.
  M6 second(V3 const& m) const {
    T const along = m[2] + sigma_ * m[1];
    M6 h;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) h(i, j) = T(0.0);
    h(0, 0) = -(sigma_ * m[0]);
    h(0, 1) = h(1, 0) = h(2, 3) = along;
    h(0, 2) = -(m[1] * (sigma_ * sigma_ + 1.0));
    h(0, 3) = m[0];
    h(1, 2) = h(2, 1) = -m[0];
    h(2, 0) = -(sigma_ * along);
    h(0, 5) = h(5, 0) = h(3, 2) = sigma_ * m[1];
    h(0, 4) = h(4, 0) = h(3, 5) = h(5, 3) = -m[1];
    return h;
  }
  /// Angular acceleration in the axes of the frame if b and c move at constant rates w: δ̂φ for d = ŵ = w.
  V3 acceleration(V6 const& w) const {
    V3 a;
    for (int k = 0; k < 3; ++k) {
      M6 const h = second(axis(k));
      T sum(0.0);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) sum += w[i] * h(i, j) * w[j];
      a[k] = sum;
    }
    return a;
  }

  /// Gradient ∂K/∂(X, Y), 3×6, of K = S w′ for the components w′ of (b′, c′). The derivative with respect to (X′, Y′)
  /// is S.
  Mat<T, 3, 6> curvature_gradient(V6 const& w) const {
    M6 const l = pairing(w, -1.0);
    V6 const g = sigma_gradient();
    Mat<T, 3, 6> k;
    for (int j = 0; j < 6; ++j) {
      k(0, j) = l(2, j);
      k(1, j) = l(3, j) - sigma_ * l(0, j) - w[0] * g[j];
      k(2, j) = -l(0, j);
    }
    return k;
  }
  /// Second derivatives of n·K at w: `twice` with respect to (X, Y), and `mixed` = M(n) with respect to (X′, Y′) (rows)
  /// and (X, Y) (columns).
  void curvature_hessian(V6 const& w, V3 const& n, M6& twice, M6& mixed) const {
    M6 const l = pairing(w, -1.0);  // δ̂w′ = l ŵ
    V6 const s = pull(n), g = sigma_gradient();
    mixed = second(n);
    V6 h, c;  // ∂(n·K)/∂(X, Y);  factor of δ̂σ
    for (int j = 0; j < 6; ++j) {
      T sum = -(n[1] * w[0] * g[j]);
      for (int i = 0; i < 6; ++i) sum += l(i, j) * s[i];
      h[j] = sum;
      c[j] = -(n[1] * l(0, j));
    }
    c[0] -= s[2] * w[0] - s[0] * w[2] + s[5] * w[3] - s[3] * w[5];
    c[2] += s[3] * w[3] + s[4] * w[4] + s[5] * w[5] - n[1] * w[0] * sigma_ * 2.0;
    c[5] += n[1] * w[0];
    twice = pairing(h, 1.0);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j)
#pragma GCC unroll 6
      for (int i = 0; i < 6; ++i) {
        if (j > i) continue;  // symmetric: only the lower half is computed
        T sum = c[i] * g[j];
#pragma GCC unroll 6
        for (int k = 0; k < 6; ++k)
          if (of_second[std::size_t(k)][std::size_t(i)]) sum += mixed(k, i) * l(k, j);
        twice(i, j) += sum;
      }
  }

  /// Writes the covector s of (X, Y) to row `row` of `out`, as a covector of (δb, δc). The three columns for δb begin
  /// at `first`, those for δc at `first + 3`.
  template <int rows, int columns>
  void to_vectors(V6 const& s, int row, int first, Mat<T, rows, columns>& out) const {
    for (int i = 0; i < 3; ++i) {
      out(row, first + i) = (R(i, 0) * s[0] + R(i, 1) * s[1] + R(i, 2) * s[2]) * ib_;
      out(row, first + 3 + i) = (R(i, 0) * s[3] + R(i, 1) * s[4] + R(i, 2) * s[5]) * ic_;
    }
  }
  /// Adds the form h of (X, Y) × (X, Y) to block (first_row, first_column) of `out`, as a form of (δb, δc) × (δb, δc).
  template <int n>
  void add_form(M6 const& h, int first_row, int first_column, Mat<T, n, n>& out) const {
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        add_world<everywhere>(
            h, a, b, [&](int i, int j, T const& x) { out(first_row + 3 * a + i, first_column + 3 * b + j) += x; });
  }
  /// Adds a symmetric form h to the diagonal block at `first`. Only the lower half of h is read.
  template <int n>
  void add_symmetric(M6 const& h, int first, Mat<T, n, n>& out) const {
    M6 whole = h;
    for (int part = 0; part < 6; part += 3)
      for (int i = 1; i < 3; ++i)
        for (int j = 0; j < i; ++j) whole(part + j, part + i) = h(part + i, part + j);
    for (int a = 0; a < 2; ++a)
      add_world<everywhere>(whole, a, a,
                            [&](int i, int j, T const& x) { out(first + 3 * a + i, first + 3 * a + j) += x; });
    add_world<everywhere>(whole, 1, 0, [&](int i, int j, T const& x) {
      out(first + 3 + i, first + j) += x;
      out(first + j, first + 3 + i) += x;
    });
  }
  /// Adds h = M(m) to the block at (first_row, first_column) off the diagonal, and its transpose to the mirrored block.
  template <int n>
  void add_second(M6 const& h, int first_row, int first_column, Mat<T, n, n>& out) const {
#pragma GCC unroll 2
    for (int a = 0; a < 2; ++a)
#pragma GCC unroll 2
      for (int b = 0; b < 2; ++b)
        add_world<of_second>(h, a, b, [&](int i, int j, T const& x) {
          out(first_row + 3 * a + i, first_column + 3 * b + j) += x;
          out(first_column + 3 * b + j, first_row + 3 * a + i) += x;
        });
  }

 private:
  /// Entries of a form that may be nonzero.
  using Places = std::array<std::array<bool, 6>, 6>;
  static constexpr Places everywhere = [] {
    Places all{};
    for (auto& row : all) row.fill(true);
    return all;
  }();
  static constexpr Places of_second = {{{true, true, true, true, true, true},
                                        {true, false, true, false, false, false},
                                        {true, true, false, true, false, false},
                                        {false, false, true, false, false, true},
                                        {true, false, false, false, false, false},
                                        {true, false, false, true, false, false}}};

  /// Calls add(i, j, x) for the entries x of block (a, b) of the form h in world axes: R h_ab Rᵀ, divided by the
  /// lengths for a and b (0: β, 1: c₃).
  template <Places places, class F>
  void add_world(M6 const& h, int a, int b, F&& add) const {
    T const scale = (a == 0 ? ib_ : ic_) * (b == 0 ? ib_ : ic_);
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      V3 column(T(0.0), T(0.0), T(0.0));  // column of R h_ab Rᵀ
#pragma GCC unroll 3
      for (int r = 0; r < 3; ++r) {
        bool any = false;
        T turned(0.0);
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
          if (places[std::size_t(3 * a + r)][std::size_t(3 * b + c)]) {
            turned = any ? turned + h(3 * a + r, 3 * b + c) * R(j, c) : h(3 * a + r, 3 * b + c) * R(j, c);
            any = true;
          }
        if (any)
          for (int i = 0; i < 3; ++i) column[i] += R(i, r) * turned;
      }
      for (int i = 0; i < 3; ++i) add(i, j, column[i] * scale);
    }
  }
  /// Gradient g of δ̂σ = g·ŵ.
  V6 sigma_gradient() const {
    V6 g;
    for (int i = 0; i < 6; ++i) g[i] = T(0.0);
    g[2] = sigma_ * sigma_ + 1.0;
    g[4] = T(1.0);
    g[5] = -sigma_;
    return g;
  }
  /// Matrix A with s·δ̂w = wᵀ A ŵ for `sign` = 1; matrix L with δ̂w = L ŵ for w = s and `sign` = −1. Both matrices are
  /// ∓ s̃ S minus s times the relative change of the lengths β and c₃.
  M6 pairing(V6 const& s, double sign) const {
    M6 m;
    for (int part = 0; part < 2; ++part) {
      T const x = s[3 * part] * sign, y = s[3 * part + 1] * sign, z = s[3 * part + 2] * sign;
      T const a[3][6] = {{y - sigma_ * z, T(0.0), T(0.0), z, T(0.0), T(0.0)},
                         {-x, T(0.0), -z, T(0.0), T(0.0), T(0.0)},
                         {sigma_ * x, T(0.0), y, -x, T(0.0), T(0.0)}};
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 6; ++j) m(3 * part + i, j) = a[i][j];
        T const& length = s[3 * part + i];
        if (part == 0) {
          m(i, 1) -= length;
        } else {
          m(3 + i, 5) -= length;
          m(3 + i, 2) += sigma_ * length;
        }
      }
    }
    return m;
  }

  T ib_, ic_, sigma_;  ///< 1/β, 1/c₃, σ
};

}  // namespace polybody
