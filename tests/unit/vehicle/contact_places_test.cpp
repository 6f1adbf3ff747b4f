// Points of action of contacts on a link: all in its middle, or at the contact points. Also links of a finite element
// model.
#include <polybody/bodies/ffr/matrix_structure.hpp>

#include <gtest/gtest.h>

#include "m113/modal_links.hpp"
#include "m113/vehicle.hpp"
#include "support/held.hpp"

namespace polybody {
namespace contact_places_test {

m113::VehicleOptions options(m113::ContactsAct contacts) {
  return {.masses = m113::with_steel_links(), .contacts = contacts};
}
std::array<Ramp, 2> const at_rest{m113::drive(0.0, 0.1), m113::drive(0.0, 0.1)};

/// Contact loads on the links of the left track, for wheels that are `deeper` into them than at the start.
struct Pressed {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< about the world's origin
  double farthest = 0.0;  ///< distance of a point from the middle of the link that the contact names
  int points = 0;
};
template <class V>
Pressed pressed(V const& vehicle, double deeper) {
  State x = vehicle.model.reference_state();
  for (auto const& link : vehicle.side(m113::Side::left).links) x.q[vehicle.model.entry(link).q0 + 2] += deeper;
  System system(vehicle.model);
  system.evaluate(x.q, x.v, x.t);
  m113::Track const& track = vehicle.track(m113::Side::left);
  Pressed sum;
  track.contacts(system, [&](TouchingPoint const& p) {
    sum.force += p.force;
    sum.moment += p.place.cross(p.force);
    Vec3 const from_middle = p.place - track.middle[std::size_t(p.body)](x).r;
    sum.farthest = std::max(sum.farthest, std::hypot(from_middle.x(), from_middle.z()));
    ++sum.points;
  });
  return sum;
}

TEST(ContactPlaces, HaveTheSameResultant) {  // links of one face and of three faces share the contact force
  using Track = m113::Vehicle<>;
  Pressed const one = pressed(Track(Constraint{}, at_rest, options(m113::ContactsAct::in_the_middle)), 2e-3);
  Pressed const three = pressed(Track(Constraint{}, at_rest, options(m113::ContactsAct::at_their_places)), 2e-3);
  EXPECT_GT(one.force.norm(), 1e4);
  EXPECT_GT(three.points, one.points);
  EXPECT_LT((three.force - one.force).norm(), 0.01 * one.force.norm());
  EXPECT_LT((three.moment - one.moment).norm(), 0.01 * one.moment.norm());
  for (Pressed const& p : {one, three}) EXPECT_LT(p.farthest, 0.5 * m113::pitch + 0.05);
}

TEST(ContactPlaces, AreTheSameOnALinkOfFiniteElements) {  // for a link without deformation
  using Rigids = m113::Vehicle<>;
  using Modal = m113::Vehicle<Ffr, Constraint>;
  std::string const files = POLYBODY_FE_LINK_FILES;
  auto const link = m113::finite_element_link(
      read_structure(files + "/link.mass.mtx", files + "/link.stiffness.mtx", files + "/link.nodes.txt"));
  auto const with = options(m113::ContactsAct::at_their_places);
  Pressed const rigid = pressed(Rigids(Constraint{}, at_rest, with), 2e-3);
  Pressed const modal = pressed(Modal(Constraint{}, at_rest, with, {}, {.model = link}), 2e-3);
  EXPECT_EQ(modal.points, rigid.points);
  EXPECT_LT((modal.force - rigid.force).norm(), 1e-9 * rigid.force.norm());
  EXPECT_LT((modal.moment - rigid.moment).norm(), 1e-9 * rigid.moment.norm());
}

TEST(FiniteElementLink, StretchesAsABar) {  // loaded in tension at its pins
  std::string const files = POLYBODY_FE_LINK_FILES;
  auto const link = m113::finite_element_link(
      read_structure(files + "/link.mass.mtx", files + "/link.stiffness.mtx", files + "/link.nodes.txt"));
  Structure const& s = link->structure;
  MatX const& shapes = link->shapes;
  ASSERT_EQ(shapes.cols(), 18);  // 15 loads and three modes; none is redundant
  Vec3 const pin = 0.5 * m113::pitch * Vec3::UnitX();
  VecX const pull = link->pin(1.0).loads(pin, s.size()).col(0) - link->pin(-1.0).loads(Vec3(-pin), s.size()).col(0);
  MatX const k = shapes.transpose() * s.stiffness * shapes;
  VecX const u = shapes * k.ldlt().solve(shapes.transpose() * pull);
  double const third = m113::pitch / 3.0;
  auto const moved = [&](double x) { return link->section(x).motion(x * Vec3::UnitX(), u).displacement(0, 0); };
  double const strain = (moved(third) - moved(-third)) / (2.0 * third);
  held({"M113 link", "strain of a link of finite elements by a unit pull, times EA [N]", By::closed_form, "N = EA ε",
        "Ffr, structure from CalculiX"},
       strain * constants(m113::link_bar()).EA, 1.0, 0.05);
}

}  // namespace contact_places_test
}  // namespace polybody
