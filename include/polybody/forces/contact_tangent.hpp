#pragma once
/// \file
/// Tangent of a contact with respect to the motion of both bodies, for steps that solve for all bodies together.
/// Theory: Eqs. 9.70, 9.71.

#include <polybody/math/types.hpp>

namespace polybody {

/// Derivative K (3×3) of the force at a contact point with respect to the relative motion of both bodies,
///   K = N′ (n − μ w) nᵀ + F′ (1 − n nᵀ − w vᵀ/s),   s = √(v² + v_s²).
/// w is the expected ratio of the friction force to μ N (`FrictionRatios`). With w = v/s, only the rotation of n and
/// the motion of the contact point are omitted. N′, F′ and F′/s contain the factors of the tangent.
struct SlipTangent {
  double across;             ///< N′ [N/m]
  Vec3 normal;               ///< (3) unit vector n from b to a
  Vec3 v;                    ///< (3) slip velocity of a relative to b [m/s]
  Vec3 w = Vec3::Zero();     ///< (3) friction ratio [1]
  double coefficient = 0.0;  ///< coefficient of friction μ [1]
  double along = 0.0;        ///< F′ [N/m]
  double bend = 0.0;         ///< F′/s [N s/m²]
  double speed = 1.0;        ///< s [m/s]

  /// Sets the terms of the friction law `law` at the normal force n [N]. ratio(s) returns w. Without
  /// `law.regularised_speed`, the tangent contains F′ (1 − n nᵀ) only. \param cd factor of the tangent
  template <class F, class Ratio>
  void add_friction(F const& law, double n, double cd, Ratio&& ratio) {
    if (!(law.coefficient > 0.0)) return;
    double const speed2 = v.dot(v);
    along = law.slope(speed2, n, cd);
    if constexpr (requires { law.regularised_speed(speed2); }) {
      speed = law.regularised_speed(speed2);
      bend = along / speed;
      coefficient = law.coefficient;
      w = ratio(speed);
    }
  }
  Mat3 matrix() const { return sum(along, across, w); }  ///< K [N/m]
  /// Difference between K and its value for w = v/s [N/m].
  Mat3 remainder() const { return sum(0.0, 0.0, bend > 0.0 ? Vec3(w - v * (1.0 / speed)) : w); }

 private:
  Mat3 sum(double of_slip, double of_normal, Vec3 const& ratio) const {
    Mat3 k;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        k(i, j) = ((of_normal - of_slip) * normal[i] - across * coefficient * ratio[i]) * normal[j] -
                  bend * ratio[i] * v[j] + (i == j ? of_slip : 0.0);
    return k;
  }
};

/// Receives the stiffness of a pair with respect to the twists of both markers: blocks of markers a and b, and the
/// blocks in rows of a and columns of b, and in rows of b and columns of a, without their negative sign.
struct PairStiffness {
  Mat<double, 6, 6>& a;   ///< (6×6) sum of JᵀK J of marker a
  Mat<double, 6, 6>& b;   ///< (6×6) sum of JᵀK J of marker b
  Mat<double, 6, 6>& ab;  ///< (6×6) sum of JᵀK J in rows of a and columns of b
  Mat<double, 6, 6>& ba;  ///< (6×6) sum of JᵀK J in rows of b and columns of a

  /// Adds the contributions of the matrix `k` (3×3) at a contact point with the arms `arm_a` and `arm_b` (3) [m] of the
  /// markers.
  void add(Mat3 const& k, Vec3 const& arm_a, Vec3 const& arm_b) const {
    add(k, arm_a, arm_a, a);
    add(k, arm_b, arm_b, b);
    add(k, arm_a, arm_b, ab);
    add(k, arm_b, arm_a, ba);
  }

 private:
  /// Adds [1, −l×]ᵀ K [1, −r×].
  static void add(Mat3 const& k, Vec3 const& l, Vec3 const& r, Mat<double, 6, 6>& sum) {
    double part[3][6];
    for (int i = 0; i < 3; ++i) {
      Vec3 const row(k(i, 0), k(i, 1), k(i, 2)), turn = r.cross(row);
      for (int j = 0; j < 3; ++j) {
        part[i][j] = row[j];
        part[i][3 + j] = turn[j];
      }
    }
    for (int j = 0; j < 6; ++j) {
      Vec3 const column(part[0][j], part[1][j], part[2][j]), moment = l.cross(column);
      for (int i = 0; i < 3; ++i) {
        sum(i, j) += column[i];
        sum(3 + i, j) += moment[i];
      }
    }
  }
};

}  // namespace polybody
