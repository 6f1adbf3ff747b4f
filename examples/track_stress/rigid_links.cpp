#include "stress_case.hpp"

std::vector<chapter4::Combination> chapter4::rigid_links() { return links_of<Rigid<>, Constraint>("rigid"); }

polybody::m113::TrackStart chapter4::start_of_all(Options const& o) { return settled(o); }
