#include "links_of.hpp"

std::vector<chapter4::Combination> chapter4::rigid_links() { return links_of<Rigid<>, Constraint>("rigid"); }
