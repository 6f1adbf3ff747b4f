#pragma once
// A finite element link, and the stress in named nodes of its surface, decoupled and coupled.
#include <polybody/run/body_record.hpp>

#include "stress_runs.hpp"

namespace polybody::m113 {
struct FiniteElementLink;
}

namespace chapter4 {

// Of the files link.*.mtx and link.*.txt in the folder that the options name; read once.
std::shared_ptr<m113::FiniteElementLink const> finite_element_link(Options const& o);

// Stress after a run of rigid links, quasi-static.
void add_surface(LinkHistory& h, Options const& o, BodyRecord const& record);
// Stress, strain and bending at one more moment of a run of such links, deformed by q.
void add_surface(LinkHistory& h, Options const& o, Eigen::Ref<VecX const> const& q);

}  // namespace chapter4
