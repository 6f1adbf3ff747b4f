#pragma once
/// \file
/// Tangent of the body of a floating frame in space.
/// Theory: Eqs. 2.85 to 2.89.

#include <span>

#include <polybody/bodies/ffr/ffr_integrals.hpp>
#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

/// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v) of `Ffr::force` f, term by term. J and H are differentiated explicitly with
/// respect to q. With w = Ω × (Ω × c) + 2 Ω × ċ + Ċ q̇, the derivatives of −f in the rows of r are
///   with respect to the rotation of the frame −A w̃,
///   with respect to Ω  A ((−Ω × c)~ − Ω̃ c̃ − 2 ċ~),
///   with respect to q  A (Ω̃² C + 2 Ω̃ ċ_q).
class FfrTangent {
 public:
  /// Tangent at coordinates q and generalised velocities v of the whole body. All arguments must outlive this object.
  template <class = void>  // compiled only if used
  FfrTangent(FfrIntegrals const& integrals, FfrTerms const& terms, std::span<double const> q, std::span<double const> v)
      : i_(integrals),
        terms_(terms),
        A_(rotation_matrix<double>(part<4>(q, 3))),
        omega_(part<3>(v, 3)),
        spin_(skew<double>(omega_)),
        x_(q.data() + 7, i_.size()),
        xd_(v.data() + 6, i_.size()) {
    i_.moments<double>(x_.data(), at_);
    if (terms.deformed_inertia) return;
    at_.c = i_.first;
    at_.J = i_.inertia;
  }

  /// Writes the tangent to k, which becomes (6 + n)×(6 + n). Call this function only once: the object accumulates
  /// sums.
  template <class = void>
  void write(double ck, double cd, MatX& k) {
    Index const n = i_.size();
    k.setZero(6 + n, 6 + n);
    k.bottomRightCorner(n, n) = ck * i_.stiffness + cd * i_.damping;
    add_columns(ck, cd, k);
    add_inertia(ck, cd, k);
    add_coupling(ck, cd, k);
    Vec3 w = omega_.cross(omega_.cross(at_.c)) + 2.0 * omega_.cross(c_rate_);
    if (i_.stiffens() && terms_.couples_frame_velocity()) add_foreshortening(ck, cd, w, k);
    k.block<3, 3>(0, 3) =
        A_ * (-ck * skew<double>(w) - cd * (skew<double>(omega_.cross(at_.c).eval()) + spin_ * skew<double>(at_.c) +
                                            2.0 * skew<double>(c_rate_)));
    k.block<3, 3>(3, 3) = cd * (j_rate_ + spin_ * at_.J - skew<double>((at_.J * omega_ + h_).eval()));
  }

 private:
  /// Adds the terms with C and H, without the derivatives of C and H.
  template <class = void>
  void add_columns(double ck, double cd, MatX& k) {
    for (Index i = 0; i < i_.size(); ++i) {
      Vec3 c, h;
      i_.columns<double>(x_.data(), i, c, h);
      if (terms_.deformed_inertia) k.block<3, 1>(0, 6 + i) += A_ * (ck * spin_ * (spin_ * c));
      if (!terms_.couples_frame_velocity()) continue;
      c_rate_ += c * xd_[i];
      h_ += h * xd_[i];
      k.block<3, 1>(0, 6 + i) += A_ * (2.0 * cd * spin_ * c);
      k.block<3, 1>(3, 6 + i) += cd * spin_ * h;
    }
  }
  /// Adds the terms with J, for each entry p of J and each q_i: slope = ∂J_p/∂q_i, bent = ∂(J˙_p)/∂q_i.
  template <class = void>
  void add_inertia(double ck, double cd, MatX& k) {
    for (std::size_t p = 0; p < 6; ++p) {
      int const a = symmetric_row[p], b = symmetric_column[p];
      bool const off = a != b;
      for (Index i = 0; i < i_.size(); ++i) {
        double const slope = i_.inertia_slope<double>(x_.data(), p, i);
        double const bent = 2.0 * i_.inertia_second[p].col(i).dot(xd_);
        double const used = terms_.centrifugal_slope(slope, i_.inertia_by[p][i]);
        double const moving = terms_.changes_inertia() ? 1.0 : 0.0;
        j_rate_(a, b) += moving * slope * xd_[i];
        if (off) j_rate_(b, a) += moving * slope * xd_[i];
        Vec3 by = Vec3::Zero();  // ∂(J Ω)/∂q_i due to entry p, divided by slope
        by[a] += omega_[b];
        if (off) by[b] += omega_[a];
        k.block<3, 1>(3, 6 + i) += moving * (ck * bent + cd * slope) * by;
        if (terms_.deformed_inertia) k.block<3, 1>(3, 6 + i) += ck * slope * spin_ * by;
        k(6 + i, 3 + a) -= cd * used * omega_[b];
        if (off) k(6 + i, 3 + b) -= cd * used * omega_[a];
      }
      if (terms_.centrifugal)
        k.bottomRightCorner(i_.size(), i_.size()) -=
            (ck * (off ? 2.0 : 1.0) * omega_[a] * omega_[b]) * i_.inertia_second[p];
    }
  }
  /// Adds the derivatives of H with respect to q.
  template <class = void>
  void add_coupling(double ck, double cd, MatX& k) const {
    for (Index i = 0; i < 3; ++i) {
      MatX const& m = i_.coupling_by[std::size_t(i)];
      for (Index j = 0; j < i_.size(); ++j) {
        double const left = m.row(j).dot(xd_), right = m.col(j).dot(xd_);  // (m q̇)_j, (mᵀ q̇)_j
        if (terms_.couples_frame_velocity()) {
          k.block<3, 1>(3, 6 + j) += ck * left * spin_.col(i);
          k(3 + i, 6 + j) += cd * (i_.stiffens() ? left + right : 0.0);
        }
        if (terms_.coriolis) k(6 + j, 3 + i) += cd * (right - left);
      }
      if (terms_.coriolis) k.bottomRightCorner(i_.size(), i_.size()) += (cd * omega_[i]) * (m.transpose() - m);
    }
  }
  /// Adds the derivatives of C with respect to q, and adds Ċ q̇ to w.
  template <class = void>
  void add_foreshortening(double ck, double cd, Vec3& w, MatX& k) const {
    for (Index i = 0; i < 3; ++i) {
      Vec3 const by = A_ * (2.0 * ck * spin_.col(i) + 2.0 * cd * Vec3::Unit(i));
      for (Index j = 0; j < i_.size(); ++j) {
        double const drawn = i_.first_second[std::size_t(i)].col(j).dot(xd_);  // −∂ċ_i/∂q_j
        w[i] -= drawn * xd_[j];
        k.block<3, 1>(0, 6 + j) -= by * drawn;
      }
    }
  }

  FfrIntegrals const& i_;
  FfrTerms terms_;
  Mat3 A_;
  Vec3 omega_;
  Mat3 spin_;  ///< Ω̃
  Eigen::Map<VecX const> x_, xd_;
  FfrIntegrals::Moments<double> at_;
  Vec3 c_rate_ = Vec3::Zero(), h_ = Vec3::Zero();  ///< ċ, H q̇
  Mat3 j_rate_ = Mat3::Zero();                     ///< J˙
};

}  // namespace polybody
