#pragma once
// Finite element link, and the stress at named nodes of its surface, decoupled and coupled.
#include <polybody/run/body_record.hpp>

#include "links.hpp"

namespace polybody::m113 {
struct FiniteElementLink;
}

namespace chapter3 {

// Link from the files link.*.mtx and link.*.txt in the folder `o.files`. The files are read once.
std::shared_ptr<m113::FiniteElementLink const> finite_element_link(LinkSettings const& o);

// Adds the quasi-static stress for the record of a rigid link to h, after the run.
void add_surface(LinkHistory& h, LinkSettings const& o, BodyRecord const& record);
// Appends stress, strain and bending of a finite element link with the deformation coordinates q to h.
void add_surface(LinkHistory& h, LinkSettings const& o, Eigen::Ref<VecX const> const& q);

}  // namespace chapter3
