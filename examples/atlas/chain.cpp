// Chain of 64 links with five policies of its pins.
#include <polybody/polybody.hpp>

#include "../support/chain.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

constexpr int links = 64;
constexpr double length = 0.1, mass = 0.5, angle = 1.0;  // of a link [m], [kg]; from the vertical [rad]

// Position x of the tip of a chain of rigid links.
template <class P>
AnyCase rigid_links(P const& policy) {
  Chain<InPlane<P>> of(links, bar_link(length, mass), 9.81, angle, policy);
  auto const tip = of.end(links - 1);
  using M = typename Chain<InPlane<P>>::ModelType;
  return any_case(std::move(of.model), [tip](M const& m, State const& x) { return position(m, x, tip)[0]; });
}

// The chain of cables of one element. Its pins are equations that are linear in the coordinates.
template <class P>
AnyCase cable_links(FormulationMesh const& mesh) {
  using Cable = planar::AncfCable<planar::EngineeringStrain>;
  using Pin = Joint<planar::Revolute, P>;
  using M = Model<Bodies<Cable>, Joints<Pin>>;
  M model{Gravity{0, -9.81, 0}};
  Vec2 const along(std::sin(angle), -std::cos(angle));
  std::vector<BodyHandle<Cable>> all;
  for (int i = 0; i < links; ++i) {
    Vec2 const first = double(i) * length * along;
    Bar const bar{.length = length,
                  .constants = BarConstants{.EA = 2e6, .EI = 170.0, .mass_per_length = mass / length},
                  .placement = Placement::planar(first[0], first[1], angle - 0.5 * std::numbers::pi)};
    all.push_back(model.add(Cable::from(bar, *mesh.elements), "link " + std::to_string(i + 1)));
    std::string const pin = "pin " + std::to_string(i + 1);
    if (i == 0)
      model.connect(Pin{}, model.ground().at({0, 0, 0}), all.back().at(0.0), pin);
    else
      model.connect(Pin{}, all[std::size_t(i) - 1].at(length), all.back().at(0.0), pin);
  }
  auto const tip = all.back().at(length);
  return any_case(std::move(model), [tip](M const& m, State const& x) { return position(m, x, tip)[0]; });
}

template <class P>
void add_rigid(Formulations& to, std::string const& name, std::string const& model, P const& policy) {
  to.add<planar::Rigid, MeshKind::none, P>(name, model, {{}, {3.2e-2, 1.6e-2, 8e-3, 4e-3, 2e-3, 1e-3, 5e-4}},
                                           [policy](FormulationMesh const&) { return rigid_links(policy); });
}

void add(Formulations& to) {
  double const k = 1e7, c = 1e3;  // [N/m], [N m/rad]; [N s/m], [N m s/rad]
  Bushing const bushing{.stiffness = Bushing::diagonal(Vec3(k, k, k), Vec3(k, k, k)),
                        .damping = Bushing::diagonal(Vec3(c, c, c), Vec3(c, c, c))};
  add_rigid(to, "rigid links, constraint", "rigid links on ideal pins", Constraint{});
  add_rigid(to, "rigid links, joint coordinates", "rigid links on ideal pins", JointCoordinates{});
  add_rigid(to, "rigid links, penalty", "rigid links on springs of 1e7 N/m", Penalty{.stiffness = k, .damping = c});
  add_rigid(to, "rigid links, bushing", "rigid links on bushings of 1e7 N/m", bushing);
  Settings const settings{{1, 2, 4}, {1.6e-2, 8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4}};
  using Cable = planar::AncfCable<planar::EngineeringStrain>;
  to.add<Cable, MeshKind::elements, AncfLinear>("cable links, ANCF linear", "cable links on ideal pins", settings,
                                                cable_links<AncfLinear>);
  to.add<Cable>("cable links, constraint", "cable links on ideal pins", settings, cable_links<Constraint>);
}

}  // namespace

Problem chain() {
  return {.name = "chain",
          .title = "Chain of 64 links with five pin policies",
          .text =
              "A chain of 64 steel links of 0.1 m and 0.5 kg hangs on a pin and starts in a straight line at 1 rad to "
              "the vertical.\nThe cables of ANCF linear pins have EA = 2·10⁶ N and EI = 170 N m².\nThe output is the "
              "position x of the tip, from 0 to 1 s.",
          .question = {"tip x [m]", 1.0},
          .model = "rigid links on ideal pins",
          .add = add,
          .excluded = {{"rigid links, ANCF linear",
                        "AncfLinear needs markers that are linear in the coordinates, which those of rigid bodies are "
                        "not."}}};
}

}  // namespace atlas
