// refused: recursive::ArticulatedBody is for models of rigid bodies
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/joints/planar/revolute.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid, planar::AncfCable<>>,
                Joints<Joint<planar::Revolute, RecursiveBy<recursive::ArticulatedBody>>>>;

void run(M const& model, State& x) { simulate(model, x, GeneralizedAlpha{}, {.until = 1.0, .step = 1e-3}); }
