// refused: A force element needs wrenches<T>
#include <polybody/polybody.hpp>

using namespace polybody;

struct Rope {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  void check(std::string const&) const {}
  std::array<Wrench<double>, 2> wrenches(std::array<Frame<double>, 2> const& frames, double) const {
    Vec3 const pull = frames[1].r - frames[0].r;
    return {Wrench<double>{.f = pull}, Wrench<double>{.f = -pull}};
  }
};

Model<Bodies<Rigid<>>, Joints<>, Forces<Rope>> model;
