// refused: A body needs coordinates\(\), velocities\(\) and elements\(\)
#include <polybody/polybody.hpp>

using namespace polybody;

struct Particle : AddingCoordinates {
  static constexpr World world = World::space;
  static constexpr MarkerKind observes = MarkerKind::point;
  static constexpr bool constant_mass = true;
  static constexpr int element_columns = 3, point_columns = 3;
  struct Point {};
  Point at() const { return {}; }
  Index coordinates() const { return 3; }
  Index velocities() const { return 3; }
};

Model<Bodies<Particle>, Joints<>> model;
