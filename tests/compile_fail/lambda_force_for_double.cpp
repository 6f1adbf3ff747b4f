// refused: The lambda of user_force must return wrenches of the scalar T
#include <polybody/polybody.hpp>

using namespace polybody;

auto force() {
  return user_force<2>([](auto const&, double) {
    Wrench<double> w;
    w.f = Vec3(0, 0, 1);
    return std::array{w, w};
  });
}

Model<Bodies<Rigid<>>, Joints<>, Forces<decltype(force())>> model;
