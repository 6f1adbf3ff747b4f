// refused: A body type occurs twice
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

Model<Bodies<planar::Rigid, planar::Rigid>, Joints<>> model;
