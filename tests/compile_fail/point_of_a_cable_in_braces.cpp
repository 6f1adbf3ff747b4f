// refused: This body has no such point. A bar has at
#include <polybody/polybody.hpp>

using namespace polybody;

auto end_of(BodyHandle<AncfCable<>> const& rope) { return rope.at({0, 0, 0}); }
