// refused: The type of this body is not in the model's list. Add it to Model
// The variable has a type, so that the sentence comes before errors of later lines.
#include <polybody/polybody.hpp>

using namespace polybody;

void add(Model<Bodies<Rigid<>>, Joints<>>& model, Bar const& bar) {
  auto const rope = model.add(AncfCable<>::from(bar, 4));
  rope.at(0.0);
}
