// refused: The type of this body is not in the model's list. Add it to Model
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

void add(Model<Bodies<planar::Rigid>, Joints<>>& model) { model.add(Rigid<>(1.0, Mat3::Identity())); }
