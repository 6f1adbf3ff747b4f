// refused: not for all stages of a step together
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid>,
                Joints<Joint<planar::Revolute, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>>>;

void run(M const& model, State& x) { simulate(model, x, Radau{}, {.end_time = 1.0, .step = 1e-3}); }
