#pragma once
/// \file
/// Mean orthonormal frame of a deformable section.
/// Theory: Eq. 2.46.

#include <polybody/bodies/ancf/section_frame.hpp>

namespace polybody {

/// Mean orthonormal frame of a deformable section, with weights p and 1 − p of its two vectors b, c (r_y and r_z of a
/// beam). The axis t₁ = b × c/|b × c| is normal to both. Among the rotations about t₁, R = [t₁ t₂ t₃] minimises
///   p |b − t₂|² + (1 − p) |c − t₃|²,  hence  t₂ = m/|m|,  m = p b + (1 − p) c × t₁.
/// R is the identity if b = e₂ and c = e₃. The conditions for R are
///   b·t₁ = c·t₁ = 0,  p b·t₃ = (1 − p) c·t₂.
/// A change d = (δb, δc) has the components w = (X, Y), X = Rᵀδb, Y = Rᵀδc. This change rotates the frame by φ = S w in
/// the axes of the frame. The variation of the three conditions gives
///   (p b₂ + (1 − p) c₃) φ₁ = p X₃ − (1 − p) Y₂,  b₂ φ₃ − b₃ φ₂ = −X₁,  c₂ φ₃ − c₃ φ₂ = −Y₁.
/// A second change of b and c, with the components ŵ = (X̂, Ŷ), rotates the frame by φ̂ = S ŵ. The components of a
/// constant d then change by X × φ̂, Y × φ̂, and those of b, c by
///   b̂ = X̂ + b × φ̂,  ĉ = Ŷ + c × φ̂.
/// The second variation of the same three equations gives δ̂φ = S h with
///   h = (X × φ̂ − φ × b̂, Y × φ̂ − φ × ĉ).
/// With p = 1 the frame equals `SectionFrame`, which has closed forms for its strains. The code uses plain loops for
/// doubles, dual numbers and SIMD vectors.
template <KernelScalar T>
class MeanSectionFrame : public SectionAxes<T> {
 public:
  using V3 = Vec<T, 3>;         ///< three components
  using V6 = Vec<T, 6>;         ///< components w = (X, Y) of a change
  using M6 = Mat<T, 6, 6>;      ///< bilinear form in two changes
  using Axes = SectionAxes<T>;  ///< base class, stores R
  using Axes::axis, Axes::cross, Axes::dot, Axes::local, Axes::R, Axes::world;

  /// Frame from the gradients b = r_y and c = r_z (3); `share` is p in [0, 1].
  MeanSectionFrame(V3 const& b, V3 const& c, double share) : p_(share) {
    using std::sqrt;
    V3 const n = cross(b, c);
    in_ = T(1.0) / sqrt(dot(n, n));
    V3 t1, m;
    for (int i = 0; i < 3; ++i) t1[i] = n[i] * in_;
    V3 const turned = cross(c, t1);
    for (int i = 0; i < 3; ++i) m[i] = b[i] * p_ + turned[i] * (1.0 - p_);
    im_ = T(1.0) / sqrt(dot(m, m));
    V3 t2;
    for (int i = 0; i < 3; ++i) t2[i] = m[i] * im_;
    V3 const t3 = cross(t1, t2);
    for (int i = 0; i < 3; ++i) {
      R(i, 0) = t1[i];
      R(i, 1) = t2[i];
      R(i, 2) = t3[i];
    }
    b_ = V3(T(0.0), dot(b, t2), dot(b, t3));
    c_ = V3(T(0.0), dot(c, t2), dot(c, t3));
  }

  /// Components w = (Rᵀdb, Rᵀdc) of changes db of b and dc of c.
  V6 components(V3 const& db, V3 const& dc) const {
    V3 const x = local(db), y = local(dc);
    return {x[0], x[1], x[2], y[0], y[1], y[2]};
  }
  /// Rotation φ = S w in the axes of the frame. If b and c change with time, φ is the angular velocity; if they change
  /// along the axis, φ is twist and curvatures.
  V3 spin(V6 const& w) const {
    return {(w[2] * p_ - w[4] * (1.0 - p_)) * im_, (b_[1] * w[3] - c_[1] * w[0]) * in_,
            (b_[2] * w[3] - c_[2] * w[0]) * in_};
  }
  /// Product Sᵀm, with m (3) in the axes of the frame.
  V6 pull(V3 const& m) const {
    return {-(c_[1] * m[1] + c_[2] * m[2]) * in_, T(0.0), m[0] * p_ * im_, (b_[1] * m[1] + b_[2] * m[2]) * in_,
            -(m[0] * (1.0 - p_)) * im_,           T(0.0)};
  }
  /// Change δ̂φ of φ for a constant d with components w, due to a second change of b and c with components ŵ = `by`.
  V3 change(V6 const& w, V6 const& by) const {
    V3 const phi = spin(w), turn = spin(by), x = cross(head(w), turn), y = cross(tail(w), turn),
             b = cross(b_, turn) + head(by), c = cross(c_, turn) + tail(by), bx = cross(phi, b), cy = cross(phi, c);
    return spin({x[0] - bx[0], x[1] - bx[1], x[2] - bx[2], y[0] - cy[0], y[1] - cy[1], y[2] - cy[2]});
  }
  /// Angular acceleration in the axes of the frame if b and c move at constant rates w.
  V3 acceleration(V6 const& w) const { return change(w, w); }
  /// Matrix M(m), 6×6, of m·δ̂φ(w) = wᵀ M ŵ for a constant d with components w.
  M6 second(V3 const& m) const {
    M6 h;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) h(i, j) = dot(m, change(unit(i), unit(j)));
    return h;
  }

  /// Writes the covector s of (X, Y) to row `row` of `out`, as a covector of (δb, δc). The three columns for δb begin
  /// at `first`, those for δc at `first + 3`.
  template <int rows, int columns>
  void to_vectors(V6 const& s, int row, int first, Mat<T, rows, columns>& out) const {
    V3 const x = world(head(s)), y = world(tail(s));
    for (int i = 0; i < 3; ++i) {
      out(row, first + i) = x[i];
      out(row, first + 3 + i) = y[i];
    }
  }
  /// Adds the form h of (X, Y) × (X, Y) to block (first_row, first_column) of `out`, as a form of (δb, δc) × (δb, δc).
  template <int n>
  void add_form(M6 const& h, int first_row, int first_column, Mat<T, n, n>& out) const {
    M6 half;  // h in world axes on the right-hand side
    for (int i = 0; i < 6; ++i) to_vectors(V6(h.row(i)), i, 0, half);
    for (int j = 0; j < 6; ++j) {
      V6 const column = half.col(j);
      V3 const x = world(head(column)), y = world(tail(column));
      for (int i = 0; i < 3; ++i) {
        out(first_row + i, first_column + j) += x[i];
        out(first_row + 3 + i, first_column + j) += y[i];
      }
    }
  }

 private:
  static V3 head(V6 const& w) { return {w[0], w[1], w[2]}; }
  static V3 tail(V6 const& w) { return {w[3], w[4], w[5]}; }
  static V6 unit(int k) {
    V6 e;
    for (int i = 0; i < 6; ++i) e[i] = T(i == k ? 1.0 : 0.0);
    return e;
  }

  double p_;   ///< weight of b
  V3 b_, c_;   ///< Rᵀb, Rᵀc
  T im_, in_;  ///< 1/|m|, |m| = p b₂ + (1 − p) c₃;  1/|b × c|
};

}  // namespace polybody
