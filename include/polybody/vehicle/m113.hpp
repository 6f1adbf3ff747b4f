#pragma once
/// \file
/// An armoured personnel carrier like the M113 with 64 links a side: the vehicle of Wallin 2016, chapters 3 and 4, in
/// SI units. Not in polybody.hpp: of use to vehicles only.
///
/// Sources, named beside each number:
///   [T…]  M. Wallin, PhD thesis, University of Illinois at Chicago 2016, with the table (T3.1), section or figure
///   [C]   the M113 data files of Project Chrono
///   [P]   public data sheets and the manual TM 9-2350-247-10
///   [D]   derived from the others, as written beside it
///   [A]   an assumption
///
/// World axes at the start: x forward, y left, z up; the ground is z = 0, the sprockets' axes are at x = 0. Body axes
/// lie in the centre of mass and are parallel to the world's, but for the arms (x along the arm, from wheel to pivot)
/// and the links (x from the rear pin to the front pin, z to the wheels). Forward drive is a positive rotation about y.

#include <array>
#include <numbers>

#include <polybody/math/time_laws.hpp>
#include <polybody/vehicle/track_layout.hpp>

namespace polybody::m113 {

/// Three numbers along x, y, z that are known at compile time, as Eigen's are not.
struct Triple {
  double x, y, z;  ///< components, in the unit of the quantity
  /// The components as a column (3).
  operator Vec3() const { return {x, y, z}; }  // NOLINT(google-explicit-constructor): reads as a vector
};

/// A side of the vehicle, seen forward.
enum class Side { left, right };
/// +1 on the left, −1 on the right: of y.
constexpr double sign(Side side) { return side == Side::left ? 1.0 : -1.0; }

// ----------------------------------------------------------------------------------------------------------------
// masses

/// Mass [kg] and principal moments of inertia about the body's x, y, z [kg m²].
struct Solid {
  double mass;     ///< [kg]
  Triple inertia;  ///< about the body's x, y, z [kg m²]
};
/// Mass and inertia of every part.
struct Solids {
  Solid chassis, sprocket, idler, wheel, arm, link, tensioner;  ///< mass and inertia of one such body each

  /// Mass of the whole vehicle [kg].
  constexpr double total() const {
    double const side = sprocket.mass + idler.mass + tensioner.mass + 5.0 * (wheel.mass + arm.mass) + 64.0 * link.mass;
    return chassis.mass + 2.0 * side;
  }
};

/// The thesis' masses. T3.1 gives running gear in axes with x lateral and y longitudinal, so its (Ixx, Iyy, Izz) are
/// (Iyy, Ixx, Izz) here: a wheel's greatest moment is about its axle, an arm's least one about its own length, a link's
/// about its width. The chassis' row has x longitudinal: its least moment is roll. A wheel of 561 kg is a solid drum as
/// wide as the track.
inline constexpr Solids thesis{
    .chassis = {5489.2, {1786.9, 10450.0, 10721.0}},  // T3.1
    .sprocket = {436.67, {12.216, 13.868, 12.216}},   // T3.1
    .idler = {429.57, {12.545, 14.698, 12.545}},      // T3.1
    .wheel = {561.07, {19.819, 26.063, 19.819}},      // T3.1
    .arm = {75.264, {0.37632, 0.77085, 0.77085}},     // T3.1
    .link = {18.024, {0.22463, 0.04113, 0.25256}},    // T3.1
    .tensioner = {10.0, {0.04, 0.04, 0.04}},          // A, the value of C; the thesis gives none
};

/// The masses of a real vehicle, 11.36 t in all. Springs tuned for the thesis' masses do not suit them.
inline constexpr Solids public_data{
    .chassis = {7819.24, {13983.08, 27287.61, 28805.57}},  // C
    .sprocket = {27.68, {0.646, 0.883, 0.646}},            // C
    .idler = {25.76, {0.618, 1.12, 0.618}},                // C
    .wheel = {35.56, {1.14, 2.16, 1.14}},                  // C
    .arm = thesis.arm,                                     // T3.1
    .link = thesis.link,                                   // T3.1
    .tensioner = thesis.tensioner,                         // A
};

// --------------------------------------------------------------------------------------------------------------
// geometry

inline constexpr int links = 64;                   ///< a side  [T §3.6]
inline constexpr double pitch = 0.1524;            ///< 6 in  [P]
inline constexpr double half_thickness = 0.03315;  ///< of a link: half the height of the box in T3.1  [D]
inline constexpr double half_width = 0.1905;  ///< of a link, a wheel, a sprocket: 15 in in all  [P, and D from T3.1]
inline constexpr double track_y = 1.0795;     ///< of a track's middle plane: tread 85 in  [C, P]

inline constexpr int teeth = 10;                                         ///< [C, P]
inline constexpr double first_valley = -3.0 * std::numbers::pi / 180.0;  ///< of pin 0, from z towards x [rad]  [A]

inline constexpr int wheels = 5;                ///< a side  [T §3.6]
inline constexpr double wheel_radius = 0.3048;  ///< 12 in: m R²/2 is the moment about the axle in T3.1  [D, P]
inline constexpr double idler_radius = 0.2616;  ///< likewise  [D]
inline constexpr double rim_y = 0.058;  ///< middle planes of the two rims of a wheel or idler, ±, from its centre  [C]
inline constexpr double rim_width = 0.065;  ///< [C]

inline constexpr Triple chassis{-2.006, 0.0, 0.9921};                   ///< its centre of mass  [C]
inline constexpr double wheel_z = 2.0 * half_thickness + wheel_radius;  ///< on links that lie on the ground  [D]
inline constexpr double sprocket_z = wheel_z + 0.215;                   ///< [C]
inline constexpr double idler_z = sprocket_z - 0.12;                    ///< [C]
inline constexpr double first_wheel_x = -0.700;                         ///< between C's left and right side  [C]
inline constexpr double wheel_spacing = 0.66675;                        ///< 105 in / 4  [P]

/// Where the idler closes a taut track of straight runs, and the tensioner's spring has no stretch.  [D:
/// wrap_track(track())]
inline constexpr double idler_reference_x = -3.963784320626;
/// Where the idler is in static equilibrium of the track with the preload of 20 kN.  [D]
inline constexpr double idler_start_x = -3.972315301771;

inline constexpr double arm_length = 0.3048;  ///< 12 in, of the cylinder in T3.1  [D]
inline constexpr double arm_angle =
    -25.0 * std::numbers::pi / 180.0;  ///< about y [rad]: the pivot is ahead and above  [C]
inline constexpr double arm_rise = arm_length * 0.42261826174069944;   ///< sin 25°
inline constexpr double arm_reach = arm_length * 0.90630778703664996;  ///< cos 25°
inline constexpr double arm_inboard = 0.12;                            ///< of the track's middle plane  [C]

inline constexpr double shock_on_arm = 0.147;  ///< from the pivot  [A, such that the first dip is 7 cm]

/// The sprocket's centre [m].
constexpr Triple sprocket(Side side) { return {0.0, sign(side) * track_y, sprocket_z}; }
/// The idler's centre and the tensioner's, with the idler at `x`.
constexpr Triple idler(Side side, double x = idler_start_x) { return {x, sign(side) * track_y, idler_z}; }
/// The centre of wheel i, 0 in front … 4.
constexpr Triple wheel(int i, Side side) { return {first_wheel_x - i * wheel_spacing, sign(side) * track_y, wheel_z}; }
/// A point on the arm of wheel i, `from_pivot` [m] from its pivot on the chassis, arm_length at the wheel.
constexpr Triple arm_point(int i, Side side, double from_pivot) {
  double const share = 1.0 - from_pivot / arm_length;
  return {wheel(i, side).x + share * arm_reach, sign(side) * (track_y - arm_inboard), wheel_z + share * arm_rise};
}
/// Where the arm of wheel i hangs on the chassis [m].
constexpr Triple arm_pivot(int i, Side side) { return arm_point(i, side, 0.0); }
/// The middle of the arm of wheel i, its centre of mass [m].
constexpr Triple arm(int i, Side side) { return arm_point(i, side, 0.5 * arm_length); }

/// The track of either side in its plane, for `wrap_track`. The idler is at −3.95 m [C] and may move 0.1 m to the rear.
/// Wheels are listed for the ground and for the upper run, which has no rollers [P].
inline TrackLayout track() {
  TrackLayout t{.links = links,
                .pitch = pitch,
                .half_thickness = half_thickness,
                .sprocket = {.centre = Vec2(0.0, sprocket_z), .teeth = teeth, .valley = first_valley},
                .tensioner = {.circle = "idler", .direction = Vec2(-1.0, 0.0), .least = -0.02, .most = 0.1}};
  auto const add_wheel = [&](int i) {
    t.circles.push_back({"wheel " + std::to_string(i + 1), Vec2(wheel(i, Side::left).x, wheel_z), wheel_radius});
  };
  for (int i = 0; i < wheels; ++i) add_wheel(i);
  t.circles.push_back({"idler", Vec2(-3.95, idler_z), idler_radius});
  for (int i = wheels; i-- > 0;) add_wheel(i);
  return t;
}

// ----------------------------------------------------------------------------------------------------------------
// joints
//
// Revolute about y: chassis–sprocket at `sprocket` (its speed is driven), chassis–arm at `arm_pivot`, arm–wheel and
// tensioner–idler at the centre of the wheel and idler, link i−1–link i at pin i. Prismatic along x: chassis–tensioner.

/// A spring and damper; at its `length` it is free.
struct Spring {
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
  double length;     ///< [m]
};
/// Between arm_point(shock_on_arm) and the point of the chassis this length above it; without force at the start.
inline constexpr Spring shock{1.0e6, 1.5e4, 0.508};  ///< [T3.3]
/// On the tensioner along x, with s = x − idler_reference_x: −stiffness s − preload − damping ṡ.
inline constexpr Spring tensioner{1.0e6, 1.4e4, 0.0};  ///< [T3.3]
inline constexpr double preload = 20.0e3;              ///< [N], 0 … 60e3; without it 80 rad/s throws the track  [C]

/// Pins as penalties and bushings. About x and z the stiffness is that times `arm`².
inline constexpr double pin_stiffness = 1.0e9;       ///< [N/m]  [T §3.6]
inline constexpr double soft_pin_stiffness = 1.0e7;  ///< [N/m]  [T §3.6]
inline constexpr double pin_damping = 1.0e5;         ///< [N s/m]  [T §3.6]
inline constexpr double pin_arm = half_width;        ///< [m]  [A]

// ---------------------------------------------------------------------------------------------------------------
// contact

/// Parameters of one contact point  [T3.2].
struct ContactNumbers {
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
  double friction;   ///< μ, a ratio of forces
};
inline constexpr ContactNumbers on_sprocket{2.0e6, 5.0e3, 0.15};  ///< a link's pin in a valley of the sprocket
inline constexpr ContactNumbers on_wheel{2.0e6, 5.0e3, 0.10};     ///< and on the idler, for which T3.2 has no row  [A]
inline constexpr ContactNumbers on_ground{2.0e6, 5.0e3, 0.30};    ///< a corner of a link's pad on the ground
inline constexpr double slip_speed = 0.05;                        ///< at which friction is 1/√2 of sliding [m/s]  [A]
inline constexpr double onset = 1.0e-4;  ///< depth at which the damper is there in full [m]  [A]

/// Corners of the pad that stand on the ground, in a link's axes  [x: C, half the pad's length; y, z: D]
inline constexpr std::array<Triple, 4> pad{{{0.055, 0.1905, -half_thickness},
                                            {0.055, -0.1905, -half_thickness},
                                            {-0.055, 0.1905, -half_thickness},
                                            {-0.055, -0.1905, -half_thickness}}};

/// A valley between two teeth: an arc to `flank` on both sides of its bottom, then straight flanks up to the tip. Pins
/// are round. A pin at the bottom lies on the pitch circle, so the arc's centre is on the radius Rp + valley_radius −
/// pin_radius.
inline constexpr double pin_radius = 0.020;                       ///< [D]
inline constexpr double valley_radius = 0.035;                    ///< [D]
inline constexpr double flank = 60.0 * std::numbers::pi / 180.0;  ///< [rad]  [D]
inline constexpr double tip_radius = 0.262;                       ///< [D]
inline constexpr double tooth_y = 0.1125;  ///< planes of the two rings of teeth, ±, from the middle  [C]

/// The horn that guides a link between the rims: a box in a link's axes  [C].
inline constexpr Triple horn{0.045, 0.0, 0.0375};          ///< its centre
inline constexpr Triple horn_size{0.0284, 0.0114, 0.075};  ///< its half edges [m]
inline constexpr double horn_play = 0.0198;  ///< to either side before it meets a rim: 0.051/2 − 0.0114/2  [C, D]

// -----------------------------------------------------------------------------------------------------------------
// drive

/// The sprocket's speed relative to the chassis [rad/s]: zero for 1 s, then to `speed` at 8 s, then constant  [T,
/// Figures 3.6, 4.3; that the ramp is linear: A]. A `rounding` of 0.1 s makes the angular acceleration continuous.
inline Ramp drive(double speed, double rounding = 0.0) {
  return {.target = speed, .duration = 7.0, .start = 1.0, .rounding = rounding};
}
inline constexpr double chapter_3_speed = 25.0;                       ///< [rad/s]  [T Fig. 3.6]
inline constexpr std::array<double, 2> chapter_4_speeds{30.0, 80.0};  ///< [rad/s]  [T Fig. 4.3]
/// Forward speed for a unit speed of the sprocket: N p/2π [m].
inline constexpr double rolling_radius = teeth * pitch / (2.0 * std::numbers::pi);

// -------------------------------------------------------------------------------------------------- links as ANCF
// cables

inline constexpr double youngs_modulus = 200.0e9;        ///< [Pa]  [T §3.6]
inline constexpr double shear_modulus = 76.9e9;          ///< [Pa]  [T §3.6]
inline constexpr double density = 7800.0;                ///< [kg/m³]  [T §3.6]
inline constexpr double cable_width = 2.0 * half_width;  ///< [A]
/// Such that the cable has a link's mass  [D].
inline constexpr double cable_height = thesis.link.mass / (density * pitch * cable_width);

}  // namespace polybody::m113
