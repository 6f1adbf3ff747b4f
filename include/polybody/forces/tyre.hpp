#pragma once
/// \file
/// Tyre laws: steady forces of a tyre in the plane of the ground as functions of slip, camber and load. The axes are x
/// forwards, z normal to the ground and y = z × x, to the left.
/// Theory: Eqs. 9.56 to 9.60.

#include <polybody/math/dual.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Slip, camber and load of a tyre. V_x is the velocity of the wheel centre along x, and V_s the slip velocity of the
/// wheel at the contact point.
template <StateScalar T>
struct TyreSlip {
  T longitudinal;  ///< κ = −V_sx/|V_x| [1]; positive when driven, −1 for a locked wheel [Pacejka 2012, ch. 1]
  T lateral;       ///< tan α = −V_sy/|V_x| [1]; positive for a side velocity to the right
  T camber;        ///< sin γ [1]; positive if the top of the wheel leans to the right
  T load;          ///< normal force N ≥ 0 [N]
};

/// Forces of the ground on a tyre.
template <StateScalar T>
struct TyreForce {
  T x;         ///< longitudinal force [N]
  T y;         ///< lateral force [N]
  T aligning;  ///< moment about the normal of the ground [N m]
};

/// Tyre law: steady forces from slip, camber and load. The forces are zero without load, and continuous.
template <class L>
concept TyreLaw = requires(L const law, TyreSlip<double> const slip, std::string const name) {
  { law.template force<double>(slip) } -> std::same_as<TyreForce<double>>;
  law.check(name);
};

/// Linear tyre with saturation. The linear forces F_x = C_κ κ and F_y = C_α tan α − C_γ sin γ apply within the friction
/// ellipse (F_x/μ_x)² + (F_y/μ_y)² ≤ N². Outside of the ellipse both forces are multiplied by the same factor, so that
/// they lie on the ellipse. The aligning moment is −t F_y [Pacejka 2012, ch. 1 and §3.2].
struct LinearTyre {
  Required<double> longitudinal_stiffness;  ///< C_κ [N]
  Required<double> cornering_stiffness;     ///< C_α [N/rad]
  Required<double> longitudinal_friction;   ///< coefficient of friction μ_x [1]
  Required<double> lateral_friction;        ///< coefficient of friction μ_y [1]
  double camber_stiffness = 0.0;            ///< C_γ [N/rad]; the wheel is pushed to the side to which it leans
  double trail = 0.0;                       ///< pneumatic trail t [m]

  void check(std::string const& name) const {
    require_positive(longitudinal_stiffness, name, ": the longitudinal stiffness of the tyre", "N");
    require_positive(cornering_stiffness, name, ": the cornering stiffness of the tyre", "N/rad");
    require_positive(longitudinal_friction, name, ": the longitudinal friction of the tyre");
    require_positive(lateral_friction, name, ": the lateral friction of the tyre");
    require_not_negative(camber_stiffness, name, ": the camber stiffness of the tyre", "N/rad");
    require_finite(trail, name, ": the trail of the tyre", "m");
  }
  /// Forces at slip, camber and load.
  template <StateScalar T>
  TyreForce<T> force(TyreSlip<T> const& slip) const {
    using std::sqrt;
    T x = slip.longitudinal * longitudinal_stiffness.value;
    T y = slip.lateral * cornering_stiffness.value - slip.camber * camber_stiffness;
    double const a = value_of(x) / longitudinal_friction, b = value_of(y) / lateral_friction;
    if (std::hypot(a, b) > value_of(slip.load)) {
      T const along = x / longitudinal_friction.value, across = y / lateral_friction.value;
      T const share = slip.load / sqrt(along * along + across * across);
      x = x * share;
      y = y * share;
    }
    return {x, y, y * -trail};
  }
};

/// Curve of the Magic Formula, y(x) = D sin(C atan(B x − E (B x − atan(B x)))), with the slope B C D at x = 0
/// [Pacejka 2012, ch. 4; Bakker, Nyborg & Pacejka 1987].
struct MagicCurve {
  Required<double> B;  ///< stiffness factor [1]
  Required<double> C;  ///< shape factor [1]
  Required<double> D;  ///< peak factor per load: [1] for a force, [m] for a moment
  double E = 0.0;      ///< curvature factor [1], at most 1

  /// \throws InvalidInput naming the curve `of` of `name` unless B and C are positive, D finite and E at most 1.
  void check(std::string const& name, std::string const& of) const {
    require_positive(B, name, ": the stiffness factor B of the " + of);
    require_positive(C, name, ": the shape factor C of the " + of);
    require_finite(D, name, ": the peak factor D of the " + of);
    if (!(E <= 1.0) || !std::isfinite(E))
      throw InvalidInput("tyre.curvature", {ErrorObject{name}, ": the curvature factor E of the ", of,
                                            " must be at most 1, but is ", ErrorValue{E}, "."});
  }
  /// Value y(x) per load at the slip x.
  template <StateScalar T>
  T value(T const& x) const {
    using std::atan, std::sin;
    T const b = x * B.value;
    return sin(atan(b - (b - atan(b)) * E) * C.value) * D.value;
  }
  /// Ratio y(x)/x as a function of `x2` = x², with the limit B C D at zero.
  template <StateScalar T>
  T secant_slope(T const& x2) const {
    using std::sqrt;
    if (value_of(x2) < 1e-20) return T(B * C * D);
    T const x = sqrt(x2);
    return value(x) / x;
  }
};

/// Tyre by the Magic Formula with combined slip by similarity. With the slips s_x = κ, s_y = tan α − k_γ sin γ and the
/// normalised slip k² = (B_x C_x s_x)² + (B_y C_y s_y)², the forces are
///   F_x = N s_x y_x(x)/x at x = k/(B_x C_x),  F_y = N s_y y_y(x)/x at x = k/(B_y C_y),
/// and the aligning moment is N s_y y_z(x)/x at the same x as F_y. For pure slip these are the curves y_x, y_y and y_z.
/// The forces lie within the ellipse (F_x/D_x)² + (F_y/D_y)² ≤ N² [similarity method, Pacejka 2012, §4.2].
struct MagicFormula {
  Required<MagicCurve> longitudinal;                     ///< y_x as a function of κ, with D = μ_x
  Required<MagicCurve> lateral;                          ///< y_y as a function of tan α, with D = μ_y
  MagicCurve aligning = {.B = 1.0, .C = 1.0, .D = 0.0};  ///< y_z as a function of tan α; D < 0 reduces the slip angle
  double camber_factor = 0.0;                            ///< k_γ, ratio of camber stiffness and cornering stiffness [1]

  void check(std::string const& name) const {
    longitudinal.value.check(name, "longitudinal curve");
    lateral.value.check(name, "lateral curve");
    require_positive(longitudinal.value.D, name, ": the peak factor D of the longitudinal curve");
    require_positive(lateral.value.D, name, ": the peak factor D of the lateral curve");
    aligning.check(name, "aligning curve");
    require_not_negative(camber_factor, name, ": the camber factor of the tyre");
  }
  /// Forces at slip, camber and load.
  template <StateScalar T>
  TyreForce<T> force(TyreSlip<T> const& slip) const {
    MagicCurve const &x = longitudinal.value, &y = lateral.value;
    T const along = slip.longitudinal, across = slip.lateral - slip.camber * camber_factor;
    double const a = x.B * x.C, b = y.B * y.C;
    T const p = along * a, r = across * b, k2 = p * p + r * r;
    T const side = slip.load * across, at = k2 * (1.0 / (b * b));
    return {slip.load * along * x.secant_slope<T>(k2 * (1.0 / (a * a))), side * y.secant_slope<T>(at),
            side * aligning.secant_slope<T>(at)};
  }
};

}  // namespace polybody
