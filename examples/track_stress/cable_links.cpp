#include "links_of.hpp"

std::vector<chapter4::Combination> chapter4::cable_links() { return links_of<AncfCable<>, AncfLinear>("ancf"); }
