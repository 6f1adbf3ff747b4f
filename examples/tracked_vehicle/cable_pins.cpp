#include "pins_by.hpp"

chapter3::Pins chapter3::cable_pins() {
  Pins pins = pins_by<AncfCable<>>("ancf", AncfLinear{}, 1e-6);
  pins.cannot_turn =
      "Tracks of ANCF cables cannot turn: at their pins, neighbouring links share a slope vector across the track, "
      "which is constant in world axes. Use --track constraint, penalty, bushing or recursive.";
  return pins;
}
