#include "pins_by.hpp"

chapter3::Pins chapter3::cable_pins() {
  Pins pins = pins_by<AncfCable<>>("ancf", AncfLinear{}, 1e-6);
  pins.cannot_turn =
      "Tracks of ANCF cables cannot turn: their pins share a slope across the track that is fixed in the world. Take "
      "--track constraint, penalty, bushing or recursive.";
  return pins;
}
