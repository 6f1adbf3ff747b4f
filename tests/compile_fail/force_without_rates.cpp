// refused: A force element with states needs wrenches<T>\(std::array<Frame<T>, markers> frames, std::array<T,
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

struct Valve {
  static constexpr int markers = 1, states = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;
  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const&, std::array<T, 1> const&, double) const {
    return {};
  }
};

Model<Bodies<Rigid<>>, Joints<>, Forces<Valve>> model;
