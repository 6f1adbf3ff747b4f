// refused: A joint geometry needs gamma
#include <polybody/joints/joint.hpp>

using namespace polybody;

struct Wire {
  static constexpr char const* name = "Wire";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::space;
  Mat3 triad() const { return identity(); }
  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const&, Frame<T> const&, double) const {
    return {};
  }
};

Joint<Wire, Constraint> const joint{};
