#pragma once
/// \file
/// Data of an armoured personnel carrier like the M113 with 64 links per track: the vehicle of Wallin 2016, chapters 3
/// and 4, in SI units.
///
/// The comment of each number gives its source:
///   [T…]  M. Wallin, PhD thesis, University of Illinois at Chicago 2016, with the table (T3.1), section or figure
///   [C]   the M113 data files of Project Chrono
///   [P]   public data sheets and the manual TM 9-2350-247-10
///   [D]   derived from the other sources; the derivation follows the number
///   [A]   an assumption
///
/// World axes at the start: x forward, y left, z up. The ground is z = 0; the sprockets' axes are at x = 0. Body axes
/// have their origin in the centre of mass and are parallel to the world axes, with two exceptions. Arms have x along
/// the arm, from wheel to pivot. Links have x from the rear pin to the front pin and z to the wheels. Forward drive is
/// a positive rotation about y.

#include <array>
#include <numbers>

#include <polybody/math/time_functions.hpp>
#include <polybody/vehicle/track_trace.hpp>

namespace polybody::m113 {

/// Three numbers along x, y, z that can be compile-time constants, in contrast to vectors of Eigen.
struct Vec3Storage {
  double x, y, z;  ///< components, in the unit of the quantity
  /// The components as a column (3).
  operator Vec3() const { return {x, y, z}; }  // NOLINT(google-explicit-constructor): reads as a vector
};

/// Side of the vehicle, looking forward.
enum class Side { left, right };
/// Sign of y: +1 on the left, −1 on the right.
constexpr double sign(Side side) { return side == Side::left ? 1.0 : -1.0; }

// ----------------------------------------------------------------------------------------------------------------
// masses

/// Mass [kg] and principal moments of inertia about the body's x, y, z [kg m²].
struct Solid {
  double mass;          ///< [kg]
  Vec3Storage inertia;  ///< about the body's x, y, z [kg m²]
};
/// Mass and inertia of each kind of body.
struct Solids {
  Solid chassis, sprocket, idler, wheel, arm, link, tensioner;  ///< mass and inertia of one such body each

  /// Mass of the whole vehicle [kg].
  constexpr double total() const {
    double const side = sprocket.mass + idler.mass + tensioner.mass + 5.0 * (wheel.mass + arm.mass) + 64.0 * link.mass;
    return chassis.mass + 2.0 * side;
  }
};

/// Masses of Wallin 2016. T3.1 gives the running gear in axes with x lateral and y longitudinal, so its (Ixx, Iyy, Izz)
/// are (Iyy, Ixx, Izz) here. The greatest moment of inertia of a wheel is about its axle. The least moment of an arm is
/// about its own length, and the least moment of a link about its width. In the row of the chassis, x is longitudinal:
/// the least moment is the roll inertia. A wheel of 561 kg is a solid drum as wide as the track.
inline constexpr Solids wallin_2016{
    .chassis = {5489.2, {1786.9, 10450.0, 10721.0}},  // T3.1
    .sprocket = {436.67, {12.216, 13.868, 12.216}},   // T3.1
    .idler = {429.57, {12.545, 14.698, 12.545}},      // T3.1
    .wheel = {561.07, {19.819, 26.063, 19.819}},      // T3.1
    .arm = {75.264, {0.37632, 0.77085, 0.77085}},     // T3.1
    .link = {18.024, {0.22463, 0.04113, 0.25256}},    // T3.1
    .tensioner = {10.0, {0.04, 0.04, 0.04}},          // A, equal to the value of C; T has none
};

/// Masses of a real vehicle, 11.36 t in total. The springs are tuned for `wallin_2016` and do not suit these masses.
inline constexpr Solids production_vehicle{
    .chassis = {7819.24, {13983.08, 27287.61, 28805.57}},  // C
    .sprocket = {27.68, {0.646, 0.883, 0.646}},            // C
    .idler = {25.76, {0.618, 1.12, 0.618}},                // C
    .wheel = {35.56, {1.14, 2.16, 1.14}},                  // C
    .arm = wallin_2016.arm,                                // T3.1
    .link = wallin_2016.link,                              // T3.1
    .tensioner = wallin_2016.tensioner,                    // A
};

// --------------------------------------------------------------------------------------------------------------
// geometry

inline constexpr int links = 64;                   ///< links per track  [T §3.6]
inline constexpr double pitch = 0.1524;            ///< distance between two pins [m]: 6 in  [P]
inline constexpr double half_thickness = 0.03315;  ///< half of the height of a link [m]; height of the box of T3.1  [D]
/// Half width of a link, a wheel and a sprocket [m]: the full width is 15 in  [P, and D from T3.1]
inline constexpr double half_width = 0.1905;
inline constexpr double track_y = 1.0795;  ///< y of a track's middle plane [m], for a tread of 85 in  [C, P]

inline constexpr int teeth = 10;  ///< number of teeth of a sprocket  [C, P]
/// Angle of the valley of pin 0, from z towards x [rad]  [A]
inline constexpr double first_valley = -3.0 * std::numbers::pi / 180.0;

inline constexpr int wheels = 5;  ///< road wheels per side  [T §3.6]
/// Radius R of a wheel [m], 12 in: m R²/2 is the moment of inertia about the axle in T3.1  [D, P]
inline constexpr double wheel_radius = 0.3048;
inline constexpr double idler_radius = 0.2616;  ///< radius of the idler [m], derived from T3.1 like wheel_radius  [D]
/// Distance of the middle planes of the two rims from the centre of a wheel or idler [m]  [C]
inline constexpr double rim_y = 0.058;
inline constexpr double rim_width = 0.065;  ///< width of a rim [m]  [C]

inline constexpr Vec3Storage chassis{-2.006, 0.0, 0.9921};  ///< centre of mass of the chassis [m]  [C]
/// Height of the wheels' centres on links that lie on the ground [m]  [D]
inline constexpr double wheel_z = 2.0 * half_thickness + wheel_radius;
inline constexpr double sprocket_z = wheel_z + 0.215;  ///< height of the sprockets' centres [m]  [C]
inline constexpr double idler_z = sprocket_z - 0.12;   ///< height of the idlers' centres [m]  [C]
inline constexpr double first_wheel_x = -0.700;        ///< x of the first wheels [m], mean of both sides  [C]
inline constexpr double wheel_spacing = 0.66675;       ///< distance between two wheels [m]: 105 in / 4  [P]

/// Position along x of the idler for a closed and taut track of straight runs [m]. The tensioner's spring is then
/// undeformed.  [D: wrap_track(track())]
inline constexpr double idler_reference_x = -3.963784320626;
/// Position along x of the idler in static equilibrium of the track with the preload of 20 kN [m].  [D]
inline constexpr double idler_start_x = -3.972315301771;

inline constexpr double arm_length = 0.3048;  ///< length of an arm [m], 12 in, length of the cylinder of T3.1  [D]
/// Rotation of the arms about y [rad]: the pivot is in front of the wheel and above it  [C]
inline constexpr double arm_angle = -25.0 * std::numbers::pi / 180.0;
/// Vertical distance from wheel to pivot: arm_length · sin 25° [m].
inline constexpr double arm_rise = arm_length * 0.42261826174069944;
/// Horizontal distance from wheel to pivot: arm_length · cos 25° [m].
inline constexpr double arm_reach = arm_length * 0.90630778703664996;
inline constexpr double arm_inboard = 0.12;  ///< distance of the arm from the track's middle plane [m]  [C]

/// Distance of the shock absorber from the pivot of the arm [m]  [A, such that the first dip is 7 cm]
inline constexpr double shock_on_arm = 0.147;

/// The sprocket's centre [m].
constexpr Vec3Storage sprocket(Side side) { return {0.0, sign(side) * track_y, sprocket_z}; }
/// Centres of the idler and of the tensioner [m], with the idler at `x`.
constexpr Vec3Storage idler(Side side, double x = idler_start_x) { return {x, sign(side) * track_y, idler_z}; }
/// Centre of wheel i [m]; i = 0 is in front, i = 4 at the rear.
constexpr Vec3Storage wheel(int i, Side side) {
  return {first_wheel_x - i * wheel_spacing, sign(side) * track_y, wheel_z};
}
/// Point on the arm of wheel i [m], at the distance `from_pivot` [m] from the arm's pivot on the chassis. The wheel's
/// centre is at the distance arm_length.
constexpr Vec3Storage arm_point(int i, Side side, double from_pivot) {
  double const share = 1.0 - from_pivot / arm_length;
  return {wheel(i, side).x + share * arm_reach, sign(side) * (track_y - arm_inboard), wheel_z + share * arm_rise};
}
/// Pivot of the arm of wheel i on the chassis [m].
constexpr Vec3Storage arm_pivot(int i, Side side) { return arm_point(i, side, 0.0); }
/// Middle of the arm of wheel i, which is its centre of mass [m].
constexpr Vec3Storage arm(int i, Side side) { return arm_point(i, side, 0.5 * arm_length); }

/// Layout of the track of either side in its plane, for `wrap_track`. The idler is at x = −3.95 m [C] and may move 0.02
/// m forward and 0.1 m to the rear. Wheels are listed for the ground and for the upper run, which has no rollers [P].
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
// Revolute joints about y: chassis–sprocket at `sprocket` (with a prescribed speed), chassis–arm at `arm_pivot`,
// arm–wheel and tensioner–idler at the centre of the wheel and idler, link i−1–link i at pin i. Prismatic joint along
// x: chassis–tensioner.

/// Spring and damper. The force of the spring is zero at the `length`.
struct Spring {
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
  double length;     ///< undeformed length [m]
};
/// Shock absorber between arm_point(shock_on_arm) and the point of the chassis at the distance `length` above. The
/// force is zero at the start.
inline constexpr Spring shock{1.0e6, 1.5e4, 0.508};  ///< [T3.3]
/// Spring on the tensioner along x. Its force is −stiffness s − preload − damping ṡ with s = x − idler_reference_x.
inline constexpr Spring tensioner{1.0e6, 1.4e4, 0.0};  ///< [T3.3]
inline constexpr double preload = 20.0e3;  ///< tensioner's preload [N], 0 … 60e3; at 0 tracks come off at 80 rad/s [C]

/// Stiffness of a pin as a penalty or a bushing. The rotational stiffness about x and z is the translational stiffness
/// times `pin_arm`².
inline constexpr double pin_stiffness = 1.0e9;       ///< [N/m]  [T §3.6]
inline constexpr double soft_pin_stiffness = 1.0e7;  ///< [N/m]  [T §3.6]
inline constexpr double pin_damping = 1.0e5;         ///< [N s/m]  [T §3.6]
inline constexpr double pin_arm = half_width;        ///< length in the rotational stiffness [m]  [A]

// ---------------------------------------------------------------------------------------------------------------
// contact

/// Parameters of one contact point  [T3.2]. T3.2 does not state if its stiffness and damping belong to one point or to
/// all points of a link on one body: one point  [A]. `VehicleOptions::shared_contacts` selects the other reading.
struct ContactNumbers {
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
  double friction;   ///< μ, friction coefficient [1]
};
inline constexpr ContactNumbers on_sprocket{2.0e6, 5.0e3, 0.15};  ///< link's pin in a valley of the sprocket
/// Inner face on a wheel or on the idler; T3.2 has no row for the idler  [A]
inline constexpr ContactNumbers on_wheel{2.0e6, 5.0e3, 0.10};
inline constexpr ContactNumbers on_ground{2.0e6, 5.0e3, 0.30};  ///< corner of a link's pad on the ground
inline constexpr double slip_speed = 0.05;  ///< slip velocity at which friction is 1/√2 of sliding friction [m/s]  [A]
inline constexpr double onset = 1.0e-4;     ///< penetration at which the damper reaches its full value [m]  [A]

/// Corners of the pad on the ground, in a link's axes  [x: C, half the pad's length; y, z: D]
inline constexpr std::array<Vec3Storage, 4> pad{{{0.055, 0.1905, -half_thickness},
                                                 {0.055, -0.1905, -half_thickness},
                                                 {-0.055, 0.1905, -half_thickness},
                                                 {-0.055, -0.1905, -half_thickness}}};

/// Profile of a valley between two teeth: an arc of ± `flank` about its bottom, then straight flanks up to the tip.
/// Pins are round. A pin at the bottom lies on the pitch circle, so the arc's centre is on the radius Rp +
/// valley_radius − pin_radius.
inline constexpr double pin_radius = 0.020;                       ///< radius of a pin [m]  [D]
inline constexpr double valley_radius = 0.035;                    ///< radius of the arc [m]  [D]
inline constexpr double flank = 60.0 * std::numbers::pi / 180.0;  ///< half angle of the arc [rad]  [D]
inline constexpr double tip_radius = 0.262;                       ///< outer radius of the teeth [m]  [D]
/// Distance of the planes of the two rings of teeth from the middle of the sprocket [m]  [C]
inline constexpr double tooth_y = 0.1125;

/// Horn that guides a link between the rims: a box in a link's axes  [C].
inline constexpr Vec3Storage horn{0.045, 0.0, 0.0375};          ///< centre of the horn [m]
inline constexpr Vec3Storage horn_size{0.0284, 0.0114, 0.075};  ///< lengths of its edges [m]
/// Free lateral distance on either side between horn and rim [m]: 0.051/2 − 0.0114/2  [C, D]
inline constexpr double horn_play = 0.0198;

// -----------------------------------------------------------------------------------------------------------------
// drive

/// Angular velocity of the sprocket relative to the chassis as a function of time [rad/s]. It is zero for 1 s, then a
/// ramp to `speed` at t = 8 s, then constant [T, Figures 3.6, 4.3; linear ramp: A]. A `rounding` of 0.1 s makes the
/// angular acceleration continuous.
inline Ramp drive(double speed, double rounding = 0.0) {
  return {.target = speed, .duration = 7.0, .start = 1.0, .rounding = rounding};
}
inline constexpr double moderate_sprocket_speed = 25.0;                       ///< angular speed [rad/s]  [T Fig. 3.6]
inline constexpr std::array<double, 2> fast_sprocket_velocities{30.0, 80.0};  ///< angular speeds [rad/s]  [T Fig. 4.3]
/// Forward velocity divided by the sprocket's angular velocity: N p/2π [m].
inline constexpr double rolling_radius = teeth * pitch / (2.0 * std::numbers::pi);

// --------------------------------------------------------------------------------------------------
// links as ANCF cables

inline constexpr double youngs_modulus = 200.0e9;        ///< [Pa]  [T §3.6]
inline constexpr double shear_modulus = 76.9e9;          ///< [Pa]  [T §3.6]
inline constexpr double density = 7800.0;                ///< [kg/m³]  [T §3.6]
inline constexpr double cable_width = 2.0 * half_width;  ///< width of the section [m], equal to that of a link  [A]
/// Height of the cable's section [m], such that the cable has the mass of a link  [D].
inline constexpr double cable_height = wallin_2016.link.mass / (density * pitch * cable_width);

}  // namespace polybody::m113
