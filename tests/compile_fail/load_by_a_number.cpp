// refused: The law must be a function of time that returns a Motion
#include <polybody/polybody.hpp>

using namespace polybody;

auto const law = [](double t) { return 3.0 * t; };

Model<Bodies<Rigid<>>, Joints<>, Forces<PointForce<decltype(law)>>> model;
