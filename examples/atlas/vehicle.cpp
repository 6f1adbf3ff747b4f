// The tracked vehicle of Chapter 3 with policies of its pins and with formulations of its links, by the combinations of
// the program tracked_vehicle.
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "../vehicle_links/links.hpp"
#include "low_pass.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

using chapter3::LinkSettings;
using chapter3::LinksOnPins;

// Vehicle of a problem.
struct Vehicle {
  LinkSettings settings;
  std::string output;    // name of an output of the vehicle, with unit
  double cut_off = 0.0;  // of two low-pass filters in series [Hz]; 0: no filter
};

// Body and policy by their names in --body and --policy of tracked_vehicle, and the name in the atlas.
struct Links {
  std::string body, policy, name;
  std::string model = {};  // physical model; empty: that of the body
};

Vehicle vehicle(std::string const& output, double cut_off = 0.0) {
  LinkSettings o;
  o.masses = m113::with_steel_links();  // the links of all formulations have the same inertia
  o.start = std::make_shared<m113::TrackStart const>(chapter3::settled(o));
  return {o, output, cut_off};
}

AnyCase vehicle_case(Vehicle const& of, LinksOnPins const& links, FormulationMesh const& mesh) {
  LinkSettings const o = of.settings.with(mesh);
  std::vector<chapter3::Outcome> outcomes;
  Scenario<AnyModel> const scenario = chapter3::TrackCase{o, &outcomes}.scenario("", chapter3::built_of(o, links));
  auto const output = std::find_if(scenario.outputs.begin(), scenario.outputs.end(),
                                   [&](Output<AnyModel> const& one) { return one.name == of.output; });
  auto const value = [model = scenario.model, value = output->value](State const& x) { return value(model, x); };
  if (of.cut_off == 0.0) return {scenario.model, value, scenario.start};
  return {scenario.model,
          [value, first = LowPass(of.cut_off), second = LowPass(of.cut_off)](State const& x) mutable {
            return second(x.t, first(x.t, value(x)));
          },
          scenario.start};
}

// Adds links. `elements` is the number of elements of a floating frame.
template <class B, MeshKind kind = MeshKind::elements, class P = Constraint>
void add_links(Formulations& to, Vehicle const& of, Links const& names, std::vector<Index> const& meshes = {1, 2, 4}) {
  LinksOnPins const& links = chapter3::links_on_pins(names.body, names.policy);
  to.add<B, kind, P>(
      names.name, names.model.empty() ? links.body.model : names.model, {meshes, {1e-3, 5e-4, 2.5e-4}},
      [of, &links](FormulationMesh const& mesh) { return vehicle_case(of, links, mesh); }, 4);
}

template <class P>
void add_rigid(Formulations& to, Vehicle const& of, Links const& names) {
  add_links<Rigid<>, MeshKind::none, P>(to, of, names, {});
}

void add_pins(Formulations& to) {
  Vehicle const of = vehicle("joint force x [N]", 30.0);
  Vehicle soft = of;
  soft.settings.spring_pins = m113::soft_pin_stiffness;
  std::string const ideal = "rigid links on ideal pins";
  add_rigid<Constraint>(to, of, {"rigid", "constraint", "rigid links, constraint", ideal});
  add_rigid<JointCoordinates>(to, of, {"rigid", "joint-coordinates", "rigid links, joint coordinates", ideal});
  add_rigid<Penalty>(to, of, {"rigid", "penalty", "rigid links, penalty", "rigid links on springs of 1e9 N/m"});
  add_rigid<Penalty>(to, soft, {"rigid", "penalty", "rigid links, soft penalty", "rigid links on springs of 1e7 N/m"});
  add_rigid<Bushing>(to, of, {"rigid", "bushing", "rigid links, bushing", "rigid links on bushings of 1e9 N/m"});
  add_links<AncfCable<>, MeshKind::elements, AncfLinear>(
      to, of, {"ancf", "ancf-linear", "cable links, ANCF linear", "cable links on ideal pins"});
}

void add_link_formulations(Formulations& to) {
  Vehicle const of = vehicle("vertical displacement [m]");
  add_links<Rigid<>, MeshKind::none>(to, of, {"rigid", "constraint", "rigid links"}, {});
  add_links<AncfCable<>, MeshKind::elements, AncfLinear>(to, of, {"ancf", "ancf-linear", "ANCF cable, Green strain"});
  add_links<Ffr, MeshKind::modes>(to, of, {"ffr", "constraint", "FFR, modal coordinates"});
  add_links<Ffr, MeshKind::modes>(to, of, {"fe", "constraint", "FFR of finite elements"});
  add_links<Lrvf<>>(to, of, {"lrvf", "constraint", "LRVF in space"});
  add_links<Se3Beam>(to, of, {"se3", "constraint", "SE(3) beam in space"});
  add_links<AncfBeam<ElasticLine>, MeshKind::elements, AncfLinear>(to, of,
                                                                   {"beam", "ancf-linear", "ANCF beam, elastic line"});
  add_links<AncfBeam<Continuum<>>, MeshKind::elements, AncfLinear>(
      to, of, {"continuum", "ancf-linear", "ANCF beam, continuum"});
}

std::string const start =
    "The tracked vehicle of [Chapter 3](../tracked_vehicle.md) drops into its suspension on level ground, and its "
    "sprockets accelerate from 1 s on.\nEach track has 64 links, and each link has the mass and inertia of a steel bar "
    "of "
    "0.15 m × 0.381 m × 0.0398 m.\n";

}  // namespace

Problem vehicle_pins() {
  return {.name = "vehicle_pins",
          .title = "Tracked vehicle with rigid links and five pin policies",
          .text = start +
                  "The output is the longitudinal force in a pin on the ground, pin 20 of the left track, from 0 to 3 "
                  "s.\nA low-pass filter of 30 Hz (two Butterworth filters of second order in series) removes the "
                  "impacts of single contacts.",
          .question = {.output = "pin force x, 30 Hz [N]", .end_time = 3.0, .quick_end = 0.015},
          .model = "rigid links on ideal pins",
          .add = add_pins,
          .excluded = {{"rigid links, ANCF linear", chapter3::links_on_pins("rigid", "ancf-linear").refusals.front()}},
          .has_contacts = true};
}

Problem vehicle_links() {
  return {
      .name = "vehicle_links",
      .title = "Tracked vehicle with eight link formulations",
      .text = start +
              "The pins are constraints, or `AncfLinear` for ANCF links.\nThe output is the vertical displacement of "
              "the chassis, from 0 to 3 s.",
      .question = {.output = "chassis z [m]", .end_time = 3.0, .quick_end = 0.015},
      .model = "rigid sections",
      .add = add_link_formulations,
      .has_contacts = true};
}

}  // namespace atlas
