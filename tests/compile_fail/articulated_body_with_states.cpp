// refused: joint_coordinates::ArticulatedBody needs rigid bodies and forces without first-order states
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid>,
                Joints<Joint<planar::Revolute, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>>,
                Forces<MaxwellElement>>;

void run(M const& model, State& x) { simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}); }
