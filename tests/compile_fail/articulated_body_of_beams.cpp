// refused: joint_coordinates::ArticulatedBody needs rigid bodies
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid, planar::AncfCable<>>,
                Joints<Joint<planar::Revolute, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>>>;

void run(M const& model, State& x) { simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}); }
