// refused: must use the same JointCoordinatesBy
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>,
                                    Joint<planar::Prismatic, JointCoordinates>>>
    model;
