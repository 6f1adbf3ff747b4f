// refused: A body needs tangent
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

struct Crate : planar::Rigid {
  using planar::Rigid::Rigid;
  void tangent() const {}  // hides the overload with arguments
};

void add(Model<Bodies<Crate>, Joints<>>& model) { model.add(Crate(1.0, 1.0)); }
