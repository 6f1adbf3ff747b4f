#pragma once
/// \file Names of the parameters of each type in error messages.

#include <polybody/bodies/ffr/ffr_integrals.hpp>
#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>
#include <polybody/signals/rainflow.hpp>
#include <polybody/vehicle/link_ground_contact.hpp>
#include <polybody/vehicle/link_roller_contact.hpp>
#include <polybody/vehicle/pin_sprocket_contact.hpp>

#include "support/parameters.hpp"

namespace polybody {

// functions of time
template <>
inline constexpr auto words_of<Constant> = words("value");
template <>
inline constexpr auto words_of<Ramp> = words("target", "duration|jumps", "start|jumps", "rounding");
template <>
inline constexpr auto words_of<SmoothRamp> = words("target", "duration", "start");
template <>
inline constexpr auto words_of<SpinUp> = words("target|speed", "duration");
template <>
inline constexpr auto words_of<Window> = words("from", "to", "value");
template <class Law>
inline constexpr auto words_of<IntegralOf<Law>> = words("law");

// forces
template <class Law>
inline constexpr auto words_of<PointForce<Law>> = words("force", "axes", "law");
template <class Law>
inline constexpr auto words_of<PointMoment<Law>> = words("moment", "axes", "law");
template <>
inline constexpr auto words_of<SpringDamper> = words("stiffness", "damping", "free length");
template <>
inline constexpr auto words_of<MaxwellElement> = words("stiffness", "damping", "free length");
template <>
inline constexpr auto words_of<AxialSpring> = words("stiffness", "damping", "preload", "axis");
template <>
inline constexpr auto words_of<SpringDamperContact> = words("stiffness", "damping", "onset");
template <>
inline constexpr auto words_of<HertzContact> = words("modulus", "radius");
template <>
inline constexpr auto words_of<HuntCrossleyContact> = words("stiffness", "exponent", "damping");
template <>
inline constexpr auto words_of<Friction> = words("coefficient|slip speed", "slip speed");
template <class G, class N>
inline constexpr auto words_of<Contact<G, N>> = words("geometry", "normal", "friction");
template <>
inline constexpr auto words_of<SphereOnPlane> = words("radius");
template <>
inline constexpr auto words_of<SphereOnSphere> = words("radius of the first", "radius of the second");
template <>
inline constexpr auto words_of<SphereOnCylinder> = words("sphere's radius", "cylinder's radius");

// contact shapes
template <>
inline constexpr auto words_of<BoxOnPlane> = words("size|rounding", "rounding");
template <>
inline constexpr auto words_of<CapsuleOnPlane> = words("radius", "length");
template <int most>
inline constexpr auto words_of<PolyhedronOnPlane<most>> = words("corner", "rounding");
template <>
inline constexpr auto words_of<CapsuleOnSphere> = words("radius|radii", "length", "radius of the sphere|radii");
template <>
inline constexpr auto words_of<CapsuleOnCapsule> = words("radius of the first|radii", "length of the first",
                                                         "radius of the second|radii", "length of the second", "taper");
template <>
inline constexpr auto words_of<SphereOnBox> = words("sphere's radius", "size|rounding", "rounding");
template <>
inline constexpr auto words_of<CapsuleOnBox> = words("radius", "length", "size|rounding", "rounding", "taper");
template <>
inline constexpr auto words_of<BoxOnBox> =
    words("size of the first|rounding of the first", "rounding of the first",
          "size of the second|rounding of the second", "rounding of the second", "taper");

// shapes of contact sets
template <>
inline constexpr auto words_of<Sphere> = words("radius");
template <>
inline constexpr auto words_of<Capsule> = words("radius", "length", "taper");
template <>
inline constexpr auto words_of<Box> = words("size|rounding", "rounding", "taper");

// contacts of vehicles
template <>
inline constexpr auto words_of<FlatGround> = words("height");
template <>
inline constexpr auto words_of<Washboard> = words("amplitude", "wavelength");
template <class G, MarkerKind observed>
inline constexpr auto words_of<LinkGroundContact<G, observed>> = words("terrain", "point of the pad");
template <MarkerKind observed>
inline constexpr auto words_of<LinkRollerContact<observed>> =
    words("pitch", "half thickness", "half width", "radius", "handover", "chamfer", "rim");
template <MarkerKind observed>
inline constexpr auto words_of<GuideHornContact<observed>> = words("tip", "play", "radius");
template <>
inline constexpr auto words_of<SprocketProfile> =
    words("teeth|tip radius", "pitch|tip radius|valley", "pin|tip radius", "valley", "arc of a valley|valley", "tip");
template <MarkerKind observed>
inline constexpr auto words_of<PinSprocketContact<observed>> =
    words("profile", "valley", "ring", "position of the pin");

// wheels
template <>
inline constexpr auto words_of<LinearTyre> =
    words("longitudinal stiffness", "cornering stiffness", "longitudinal friction", "lateral friction",
          "camber stiffness", "trail");
template <>
inline constexpr auto words_of<MagicCurve> = words("factor B", "factor C", "factor D", "factor E");
template <>
inline constexpr auto words_of<MagicFormula> =
    words("longitudinal curve", "lateral curve", "aligning curve", "camber factor");
template <>
inline constexpr auto words_of<TyreRelaxation> =
    words("longitudinal relaxation", "lateral relaxation", "damping time", "parked slip", "low speed");
template <>
inline constexpr auto words_of<RollingResistance> = words("coefficient|speed of the rolling", "speed");
template <class L, class G, class N>
inline constexpr auto words_of<Wheel<L, G, N>> =
    words("radius", "crown", "axle", "normal", "tyre", "relaxation", "rolling", "terrain");

// joints
template <>
inline constexpr auto words_of<Distance> = words("length");
template <>
inline constexpr auto words_of<RevolutePin> = words("distance of its points", "axis");
template <>
inline constexpr auto words_of<Screw> = words("pitch", "axis");
template <>
inline constexpr auto words_of<Gear> = words("teeth", "teeth", "axis", "centres");
template <>
inline constexpr auto words_of<RackAndPinion> = words("radius", "axis", "direction");
template <>
inline constexpr auto words_of<RollingDisc> = words("radius", "axis", "normal");
template <>
inline constexpr auto words_of<KnifeEdge> = words("across");
template <class Law>
inline constexpr auto words_of<PrescribedAngle<Law>> = words("law", "axis");
template <class Law>
inline constexpr auto words_of<PrescribedTranslation<Law>> = words("law", "axis");
template <class Law>
inline constexpr auto words_of<PrescribedDistance<Law>> = words("law", "length");
template <>
inline constexpr auto words_of<Revolute> = words("axis");

// policies
template <>
inline constexpr auto words_of<Penalty> = words("stiffness", "damping");
template <int n>
inline constexpr auto words_of<PenaltyPerEquation<n>> = words("stiffness", "damping");
template <>
inline constexpr auto words_of<Bushing> = words("stiffness", "damping");
template <>
inline constexpr auto words_of<LinearLaw> = words("stiffness", "damping");

/// The constructor refuses invalid tables: tests/unit/math/monotone_table_test.cpp.
inline void each_hostile(MonotoneTable&, std::string const&, Changed const&) {}
template <>
inline constexpr auto words_of<TabulatedLaw> = words("force", "damping");

// integrators
template <>
inline constexpr auto words_of<NewtonOptions> =
    words("max_iterations", "factorisation_cost", "always_refactor", "max_growths", "budget", "predictive_stop");
template <>
inline constexpr auto words_of<GeneralisedAlpha> =
    words("rho_inf", "tolerance", "newton", "start_correction", "second_order_terms", "stabilised");
template <>
inline constexpr auto words_of<HhtAlpha> =
    words("alpha", "tolerance", "newton", "start_correction", "second_order_terms", "stabilised");
template <>
inline constexpr auto words_of<Newmark> =
    words("gamma", "beta", "tolerance", "newton", "second_order_terms", "stabilised");
template <>
inline constexpr auto words_of<Trapezoidal> =
    words("tolerance", "newton", "start_correction", "second_order_terms", "stabilised");
template <>
inline constexpr auto words_of<EnergyMomentum> = words("tolerance", "newton");
template <>
inline constexpr auto words_of<EnergyDecaying> = words("rho_inf", "tolerance", "newton");
template <>
inline constexpr auto words_of<Radau> = words("tolerance", "newton", "projection");
template <>
inline constexpr auto words_of<Rattle> = words("tolerance", "max_iterations");
template <>
inline constexpr auto words_of<Baumgarte> = words("alpha", "beta");
template <>
inline constexpr auto words_of<Projection> = words("tolerance", "max_iterations");
template <>
inline constexpr auto words_of<CoordinatePartitioning> =
    words("tolerance", "max_iterations", "largest_ratio", "dense_up_to");
template <class S>
inline constexpr auto words_of<RungeKutta4<S>> = words("stabilisation");
template <class S>
inline constexpr auto words_of<CentralDifference<S>> = words("stabilisation");
template <class S>
inline constexpr auto words_of<DormandPrince<S>> =
    words("relative tolerance", "absolute tolerance", "smallest step", "stabilisation");
template <class S>
inline constexpr auto words_of<AdamsBashforthMoulton<S>> =
    words("relative tolerance", "absolute tolerance", "smallest step", "max_order", "stabilisation");

// runs and statics
template <>
inline constexpr auto words_of<PlausibilityLimits> = words("violation", "energy", "warning");
template <>
inline constexpr auto words_of<Event> = words("name", "value", "stops", "tolerance", "then", "rests");
template <>
inline constexpr auto words_of<RunOptions> =
    words("end", "step", "largest step", "breakpoint", "event", "assembly_tolerance", "max_step_halvings",
          "minimum_norm", "limits", "thread", "progress");
template <>
inline constexpr auto words_of<EquilibriumOptions> =
    words("load_steps", "min_load_step", "tolerance", "max_iterations");
template <>
inline constexpr auto words_of<ArcLengthOptions> =
    words("step", "largest", "smallest", "points", "tolerance", "max_iterations");

template <>
inline constexpr auto words_of<Basquin> = words("range", "number of cycles", "exponent", "limit");

// bodies
template <>
inline constexpr auto words_of<Circle> = words("radius");
template <>
inline constexpr auto words_of<Rectangle> = words("height", "width");
template <>
inline constexpr auto words_of<Material> = words("density", "Young", "Poisson");
template <>
inline constexpr auto words_of<BarConstants> =
    words("EA", "EI", "mass per length", "GA", "GJ", "rotary inertia", "EI_y", "GA_z",
          "rotary_inertia_y|rotary inertia of the bar about y", "polar_inertia|polar inertia");
template <>
inline constexpr auto words_of<Placement> =
    words("placement's origin|origin of the placement|plane z = 0", "placement's axes|plane z = 0");
template <>
inline constexpr auto words_of<Damping> = words("axial damping", "shear damping", "bending damping");
template <>
inline constexpr auto words_of<Section6> = words("stiffness matrix", "mass matrix", "damping time");
template <>
inline constexpr auto words_of<Bar> =
    words("length", "section", "material", "constants", "placement", "damping", "pretension", "shear factor");
template <>
inline constexpr auto words_of<FfrTerms> =
    words("coupling", "onto frame", "deformed inertia", "frame velocities", "coriolis", "centrifugal", "spin");
template <>
inline constexpr auto words_of<FfrOptions> = words("placement", "terms", "frame", "stiffening", "modes", "damping");
template <>
inline constexpr auto words_of<FfrIntegrals> =
    words("mass", "first", "first_by", "first_second", "inertia", "inertia_by", "inertia_second", "coupling",
          "coupling_by", "mass matrix", "stiffness", "damping", "initial_force");
template <>
inline constexpr auto words_of<RigidShape::Parameters> = words("mass", "inertia", "placement");
template <>
inline constexpr auto words_of<Inertia> = words("mass", "centre of mass|placement's origin", "inertia");
template <>
inline constexpr auto words_of<planar::Rigid::Parameters> = words("mass", "inertia", "placement");

}  // namespace polybody
