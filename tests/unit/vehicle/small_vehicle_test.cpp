// A small vehicle from the parts of polybody/vehicle.hpp: a hull on one track of 24 links with two road wheels.
#include <polybody/polybody.hpp>
#include <polybody/vehicle.hpp>

#include <gtest/gtest.h>

using namespace polybody;

namespace small_vehicle_test {

using Axle = Joint<Revolute, Constraint>;
using LastPin = Joint<PointOnLine, Constraint>;
using Guide = Joint<Prismatic, Constraint>;
using Upright = Joint<PlanarJoint, Constraint>;
using Drive = Joint<PrescribedRate<Ramp>, Constraint>;
using Track = ContactGroup<Contact<LinkRollerContact<>>, Contact<PinSprocketContact<>>, Contact<LinkGroundContact<>>>;
using Part = BodyHandle<Rigid<>>;

constexpr double pi = std::numbers::pi, pitch = 0.1, half = 0.01;             // half of the height of a link [m]
constexpr double speed = 5.0, stiffness = 4e5;                                // of sprocket [rad/s] and contacts [N/m]
constexpr double weight = 9.81 * (200.0 + 15.0 + 3.0 + 3 * 10.0 + 24 * 3.0);  // of all bodies [N]
SprocketProfile const teeth{
    .teeth = 8, .pitch = pitch, .pin_radius = 0.013, .valley_radius = 0.018, .flank = pi / 3.0, .tip_radius = 0.142};
TrackLayout const layout{.links = 24,
                         .pitch = pitch,
                         .half_thickness = half,
                         .sprocket = {.centre = Vec2(0.0, 0.19), .teeth = teeth.teeth, .valley = 0.0},
                         .circles = {{"wheel 1", Vec2(-0.26, 0.14), 0.12},
                                     {"wheel 2", Vec2(-0.52, 0.14), 0.12},
                                     {"idler", Vec2(-0.79, 0.18), 0.11}},
                         .tensioner = {"idler", Vec2(-1.0, 0.0), -0.1, 0.1}};

struct Vehicle {
  Model<Bodies<Rigid<>>, Joints<Axle, LastPin, Guide, Upright, Drive>, Forces<AxialSpring, Track>> model{
      Gravity{0, 0, -9.81}};
  std::vector<FrameIn> pins = {};  // front pins of the links
  FrameIn hull, sprocket;
  ElementHandle<Track> track;

  Part add(double mass, Vec2 const& at, std::string const& name) {
    return model.add(Rigid<>(mass, 0.01 * mass * Mat3::Identity(), Placement::at({at[0], 0.0, at[1]})), name);
  }
  template <ContactGeometry G>
  void touch(G const& geometry, Friction const& friction, auto const& partner, std::string const& name) {
    model.add_partner(track, Contact<G>{geometry, {.stiffness = stiffness, .damping = 800.0, .onset = 1e-3}, friction},
                      partner, name);
  }

  Vehicle() {
    TrackPath const path = wrap_track(layout);
    Vec3 const y = Vec3::UnitY(), middle(0, 0, 0), front(0.5 * pitch, 0, 0);
    std::vector<Marker<Rigid<>>> middles;
    std::vector<Part> links;
    for (TrackLink const& place : path.links) {
      Part const link = model.add(Rigid<>(3.0, 0.003 * Mat3::Identity(), place.placement(0.0)));
      if (!links.empty()) model.connect(Axle{{.axis = y}, {}}, links.back().at(-front), link.at(front));
      links.push_back(link);
      middles.push_back(link.at(middle));
      pins.push_back(frame_in(link, link.at(front)));
    }
    model.connect(LastPin{{.axis = y}, {}}, links.back().at(-front), links[0].at(front), "last pin");
    track = model.apply(Track{}, middles, "track");
    Part const body = add(200.0, {-0.38, 0.2}, "hull"), wheel = add(15.0, path.layout.sprocket.centre, "sprocket");
    auto const on_hull = [&](Vec2 const& p) { return body.at(Vec3(p[0] + 0.38, 0.0, p[1] - 0.2)); };
    auto const axle = on_hull(path.layout.sprocket.centre);
    model.connect(Upright{{.normal = y}, {}}, model.ground().at(middle), body.at(middle), "upright");
    model.connect(Axle{{.axis = y}, {}}, axle, wheel.at(middle), "sprocket axle");
    Ramp const drive{.target = speed, .duration = 1.5, .start = 0.2, .rounding = 0.1};
    model.connect(Drive{{.law = {drive}, .axis = y}, {}}, axle, wheel.at(middle), "drive");
    touch(PinSprocketContact<>{.profile = teeth, .valley = 0.0}, {0.1, 0.05}, wheel.at(middle), "sprocket");
    for (TrackCircle const& circle : path.layout.circles) {
      Part const roller = add(10.0, circle.centre, circle.name);
      touch(LinkRollerContact<>{pitch, half, 0.1, circle.radius}, {0.1, 0.05}, roller.at(middle), circle.name);
      bool const tightens = circle.name == layout.tensioner.circle;
      auto const mount = on_hull(circle.centre),
                 end = tightens ? add(3.0, circle.centre, "tensioner").at(middle) : mount;
      model.connect(Axle{{.axis = y}, {}}, end, roller.at(middle), circle.name + " axle");
      if (!tightens) continue;
      model.connect(Guide{{.axis = Vec3::UnitX()}, {}}, mount, end, "guide");
      model.apply(AxialSpring{.stiffness = 3e5, .damping = 2e4, .preload = 1e3}, mount, end, "tension");
    }
    FlatGround const ground{.z = clearances(path, 0.0).ground};  // touches the lowest link
    touch(LinkGroundContact<>{ground, {front - half * Vec3::UnitZ(), -front - half * Vec3::UnitZ()}}, {0.5, 0.005},
          model.ground().at(middle), "ground");
    hull = frame_in(body, body.at(middle));
    sprocket = frame_in(wheel, wheel.at(middle));
  }
};

TEST(SmallVehicle, DrivesAPitchForEachToothOnItsWeightWithoutUnaccountedEnergy) {
  Vehicle const vehicle;
  State x = vehicle.model.reference_state();
  EnergyAudit audit(vehicle.model);
  System system(vehicle.model);
  double const begin = 2.5, end = begin + 12.0 * 2.0 * pi / (teeth.teeth * speed);  // 12 teeth pass
  double from = 0.0, ground = 0.0, samples = 0.0;
  for (State const& now : simulate(vehicle.model, x, GeneralisedAlpha{.rho_inf = 0.8, .tolerance = 1e-6},
                                   {.end_time = end, .step = 1e-3})) {
    audit.record(now);
    auto const pin = [&, at = vehicle.sprocket(now)](int i) -> Vec3 {
      return at.A.transpose() * (vehicle.pins[std::size_t(i)](now).r - at.r);
    };
    ASSERT_TRUE(sprocket_engagement(teeth, 0.0, layout.links, pin).holds()) << now.t;
    if (now.t < begin - 1e-9) continue;
    if (samples++ == 0.0) from = vehicle.hull(now).r.x();
    system.evaluate(now.q, now.v, now.t);
    for_each_contact(system, vehicle.track, [&](TouchingPoint const& p) {
      if (*p.against == "ground") ground += p.force.z();
    });
  }
  // Over whole teeth the polygon effect cancels: without slip the vehicle moves a pitch for each tooth. A wheel above a
  // pin presses the ends of two links δ = W/4k deep. The links turn by ±δ/p, so the pins move by up to 2hδ/p.
  EXPECT_NEAR((vehicle.hull(x).r.x() - from) / (12.0 * pitch), 1.0, half * weight / (2.0 * stiffness * pitch * pitch));
  EXPECT_NEAR(ground / samples / weight, 1.0, 0.01);
  double const velocity = speed * teeth.teeth * pitch / (2.0 * pi);
  EXPECT_GT(audit.work_of_drives(), 0.5 * weight / 9.81 * velocity * velocity);  // more than the energy of the motion
  EXPECT_LT(audit.relative(), 0.01);
}

}  // namespace small_vehicle_test
