// refused: impact_at_limit needs a joint with one free motion
#include <polybody/polybody.hpp>

#include <polybody/run/impact_at_limit.hpp>

using namespace polybody;
using Sleeve = Joint<Cylindrical, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Sleeve>>;

Event stop(M const& model, ElementHandle<Sleeve> const& sleeve) {
  return impact_at_limit(model, sleeve, {.upper = 0.5, .restitution = 0.8});
}
