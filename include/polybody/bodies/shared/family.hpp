#pragma once
/// \file
/// Families of body formulations. A family has one name in all reports, and one colour and marker in all figures
/// (io/formulation_style.hpp).

#include <string_view>

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody {

/// Names of the families.
namespace families {
inline constexpr std::string_view rigid = "rigid body";                       ///< `Rigid`, `planar::Rigid`
inline constexpr std::string_view lrvf = "LRVF in the plane";                 ///< `planar::Lrvf` with any quadrature
inline constexpr std::string_view lrvf_in_space = "LRVF in space";            ///< `Lrvf`
inline constexpr std::string_view se3_beam = "SE(3) beam in the plane";       ///< `planar::Se3Beam`
inline constexpr std::string_view se3_beam_in_space = "SE(3) beam in space";  ///< `Se3Beam`
inline constexpr std::string_view cable_green =
    "ANCF cable, Green strain";  ///< `AncfCable<GreenStrain>`, in space and in the plane
inline constexpr std::string_view cable_engineering =
    "ANCF cable, engineering strain";  ///< `AncfCable<EngineeringStrain>`, in space and in the plane
inline constexpr std::string_view beam_elastic_line =
    "ANCF beam, elastic line";                                              ///< `AncfBeam<ElasticLine>`, `CoupledLine`
inline constexpr std::string_view beam_continuum = "ANCF beam, continuum";  ///< `AncfBeam<Continuum<…>>`
inline constexpr std::string_view ffr_nodal = "FFR, nodal coordinates";     ///< `Ffr`, `planar::Ffr`
inline constexpr std::string_view ffr_modal = "FFR, modal coordinates";     ///< `Ffr` and `planar::Ffr` with modes
inline constexpr std::string_view other = "other body";                     ///< a body without a family
}  // namespace families

// Declarations of bodies and of their policies, so that this header does not include the headers of the bodies.
template <class Rotation>
class Rigid;
template <RotationInterpolation Interpolation, StrainQuadrature Quadrature>
class Lrvf;
class Se3Beam;
template <class Strain, int axial_points, int bending_points>
class AncfCable;
template <class Elastic>
class AncfBeam;
template <Body B>
class WithSliders;
template <Body B>
  requires(B::constant_mass && B::element_columns > 0)
class CholeskyCoordinates;
struct GreenStrain;
struct EngineeringStrain;
struct ElasticLine;
struct CoupledLine;
enum class Locking;
template <Locking locking>
struct Continuum;
namespace planar {
template <class Theory>
class Beam;
template <class Strain, int axial_points, int bending_points>
struct HermiteCable;
struct SimoVuQuoc;
class Se3Beam;
}  // namespace planar

namespace detail {

/// Family that the members of a body determine: its member `family` (of a user-defined body), the layout of a rigid
/// body, or a floating frame.
template <class B>
constexpr std::string_view family_of_members() {
  if constexpr (requires { std::string_view(B::family); })
    return B::family;
  else if constexpr (HasRigidLayout<B>)
    return families::rigid;
  else if constexpr (FloatingFrameBody<B>)
    return families::ffr_nodal;
  else
    return families::other;
}

}  // namespace detail

/// Family of the body type B. A user-defined body has the family of its static member `family`, a text, or
/// `families::other`. The type of a floating frame does not depend on its modes, so its family is `ffr_nodal`.
template <class B>
inline constexpr std::string_view formulation_family = detail::family_of_members<B>();

/// Family of rigid bodies in space.
template <class Rotation>
inline constexpr std::string_view formulation_family<Rigid<Rotation>> = families::rigid;
/// Family of LRVF beams in space.
template <class Interpolation, class Quadrature>
inline constexpr std::string_view formulation_family<Lrvf<Interpolation, Quadrature>> = families::lrvf_in_space;
/// Family of beams on SE(3) in space.
template <>
inline constexpr std::string_view formulation_family<Se3Beam> = families::se3_beam_in_space;
/// Family of beams on SE(3) in the plane.
template <>
inline constexpr std::string_view formulation_family<planar::Se3Beam> = families::se3_beam;
/// Family of ANCF cables with Green strain.
template <int axial_points, int bending_points>
inline constexpr std::string_view formulation_family<AncfCable<GreenStrain, axial_points, bending_points>> =
    families::cable_green;
/// Family of ANCF cables with engineering strain.
template <int axial_points, int bending_points>
inline constexpr std::string_view formulation_family<AncfCable<EngineeringStrain, axial_points, bending_points>> =
    families::cable_engineering;
/// Family of ANCF beams with an elastic line.
template <>
inline constexpr std::string_view formulation_family<AncfBeam<ElasticLine>> = families::beam_elastic_line;
/// Family of ANCF beams with an elastic line and coupled sections.
template <>
inline constexpr std::string_view formulation_family<AncfBeam<CoupledLine>> = families::beam_elastic_line;
/// Family of ANCF beams as a continuum.
template <Locking locking>
inline constexpr std::string_view formulation_family<AncfBeam<Continuum<locking>>> = families::beam_continuum;
/// Family of planar ANCF cables with Green strain.
template <int axial_points, int bending_points>
inline constexpr std::string_view
    formulation_family<planar::Beam<planar::HermiteCable<GreenStrain, axial_points, bending_points>>> =
        families::cable_green;
/// Family of planar ANCF cables with engineering strain.
template <int axial_points, int bending_points>
inline constexpr std::string_view
    formulation_family<planar::Beam<planar::HermiteCable<EngineeringStrain, axial_points, bending_points>>> =
        families::cable_engineering;
/// Family of LRVF beams in the plane.
template <class Theory>
  requires std::is_base_of_v<planar::SimoVuQuoc, Theory>
inline constexpr std::string_view formulation_family<planar::Beam<Theory>> = families::lrvf;
/// Family of a body with sliders: that of the body.
template <class B>
inline constexpr std::string_view formulation_family<WithSliders<B>> = formulation_family<B>;
/// Family of a body in Cholesky coordinates: that of the body.
template <class B>
inline constexpr std::string_view formulation_family<CholeskyCoordinates<B>> = formulation_family<B>;

}  // namespace polybody
