#include "links_of.hpp"

std::vector<chapter4::Combination> chapter4::rotation_links() { return links_of<Lrvf<>, Constraint>("lrvf"); }
