// refused: The law must be a function of time that returns a Motion
#include <polybody/polybody.hpp>

using namespace polybody;

int main() {
  auto const law = [](double t) { return 3.0 * t; };
  using Drive = Joint<PrescribedAngle<decltype(law)>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Drive>> model;
}
