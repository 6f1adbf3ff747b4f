// refused: A force element needs check
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

struct Spring : SpringDamper {
  void check() const {}  // hides the overload with an argument
};

Model<Bodies<planar::Rigid>, Joints<>, Forces<Spring>> model;
