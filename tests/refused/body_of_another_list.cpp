// refused: add
#include <polybody/bodies/planar/rigid.hpp>
#include <polybody/bodies/rigid.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

void add(Model<Bodies<planar::Rigid>, Joints<>>& model) { model.add(Rigid<>(1.0, Mat3::Identity())); }
