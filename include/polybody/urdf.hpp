#pragma once
/// \file
/// Reader of URDF files, by liburdfdom (Debian: liburdfdom-dev; link -lurdfdom_model -lconsole_bridge):
///   auto robot = read_urdf<JointCoordinates>("arm.urdf", {.root = UrdfRoot::fixed, .gravity = {0, 0, -9.81}});
///   State x = robot.state({{"elbow", {.position = 0.3}}});

#include <polybody/io/urdf_file.hpp>
#include <polybody/io/urdf_model.hpp>

namespace polybody {

/// Model of the URDF file `file` whose joints have the policy P, such as `Constraint` or `JointCoordinates`. The lists
/// contain further types of joints and forces that the program adds; `flexible` are bodies in place of links.
/// \throws IoError for a file that cannot be read or is not a URDF file; InvalidInput for inertias that no distribution
/// of mass has, and for the reasons of `UrdfModel`.
template <Policy P, class JointList = Joints<>, class ForceList = Forces<>, Body... Fs>
UrdfModel<P, JointList, ForceList, Fs...> read_urdf(std::string const& file, UrdfOptions const& options,
                                                    UrdfFlexibleLink<Fs> const&... flexible) {
  return UrdfModel<P, JointList, ForceList, Fs...>(read_urdf_robot(file), options, flexible...);
}

}  // namespace polybody
