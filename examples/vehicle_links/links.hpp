#pragma once
// Vehicles with each body formulation of the links on each policy of the pins. Nothing here depends on the types of
// links and pins, which the files of this folder compile, one file for each body.
#include <functional>
#include <map>
#include <memory>

#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/run/body_record.hpp>

#include "../support/combination_table.hpp"
#include "../tracked_vehicle.hpp"
#include "m113/links.hpp"

namespace chapter3 {

using combinations::BodyName;
using combinations::MeshKind;

inline constexpr int watched_link = watched_pin;

// Settings of a vehicle with any links, pins and integrator.
struct LinkSettings : Settings {
  LinkSettings();

  combinations::Selection selection;        // --body, --policy, --integrator, and the comparison at equal error
  std::string output = "forward position";  // output of the comparison at equal error
  bool default_step = true;  // true: an explicit integrator of fixed steps takes the stable step of the pins
  double sampled = 5e-4, sampled_below = 5e-4;  // histories of steps below the second value have the first interval [s]
  double tolerance = 0.0;  // of Newton's method, or of the error of a step [1]; 0: the default of the integrator
  double spring_pins = m113::pin_stiffness;  // stiffness of pins as penalties or bushings [N/m]
  std::optional<Index> modes = {};           // modes of a floating frame; empty: three
  FfrTerms terms = {};                       // terms of the equations of floating frames
  // Height of a flexible link's section, divided by the height that gives the mass of a rigid link [1].
  double section = 1.0;
  double young = 1.0;    // Young's modulus of links other than ffr and fe, divided by that of steel [1]
  std::string files;     // folder of the files of a finite element link
  bool surface = false;  // true: computes the stress at named nodes of its surface, also after a run with rigid links

  // The settings with this mesh, whose empty values stay as they are.
  LinkSettings with(FormulationMesh const& mesh) const;
};

inline double section_height(LinkSettings const& o) { return o.section * m113::cable_height; }
// Mass of a flexible link [kg].
inline double flexible_mass(LinkSettings const& o) { return m113::with_steel_links({}, section_height(o)).link.mass; }

// History of the watched link of a run. The strain of rigid links is computed after the run.
struct LinkHistory {
  std::vector<double> strain;   // axial strain of the link: change of length divided by length [1]
  std::vector<double> bending;  // bending strain in the middle, in the fibre towards the wheels [1]
  std::map<std::string, std::vector<double>> surface = {};  // von Mises stress at named nodes [Pa]
  std::vector<double> vibrating;  // strain of a rigid link by the thesis' linear equations of its vibrations [1]
  bool decoupled = false;         // true: results computed after a run with rigid links
  double recording = 0.0, recovery = 0.0, vibration = 0.0;  // CPU times [s]
};

// A rigid link of any type, whose loads can be recorded.
struct RigidLink {
  std::string name;
  std::function<void(LoadRecorder&)> add;
  std::function<BodyRecord const&(LoadRecorder const&)> record;
};
// Selection and outputs of the watched link.
struct WatchedLink {
  std::optional<RigidLink> rigid = {};      // link whose loads are recorded; its strain is computed after the run
  std::vector<RigidLink> rigid_links = {};  // rigid links of both tracks, whose stress a film shows
  std::function<void(State const&, LinkHistory&)> see = {};  // adds the outputs of a flexible link in a state
};
struct LinkVehicle {
  AnyVehicle vehicle;
  WatchedLink link;
};

// Links of one body formulation on pins of one policy.
struct LinksOnPins : combinations::BodyOnPolicy {
  bool turns = true;  // false: the vehicle cannot turn, because its pins keep their direction in world axes
  // Longest stable step of RungeKutta4 [s]: 2.8 divided by the fastest rate, which `track_times` prints for rigid
  // links.
  double stable_step = 1e-6;
  std::function<LinkVehicle(LinkSettings const&, VehicleParts const&)> make = {};
};

Built built_of(LinkSettings const& o, LinksOnPins const& links);

// Links of each file on pins of each policy.
std::vector<LinksOnPins> rigid_links();
std::vector<LinksOnPins> rigid_links_by_euler_parameters();
std::vector<LinksOnPins> cable_links();
std::vector<LinksOnPins> engineering_cable_links();
std::vector<LinksOnPins> floating_links();  // with modes, with nodal coordinates, of finite elements
std::vector<LinksOnPins> rotation_links();
std::vector<LinksOnPins> helicoidal_links();
std::vector<LinksOnPins> beam_links();
std::vector<LinksOnPins> continuum_links();

// All of them.
std::vector<LinksOnPins> const& all_links();
std::vector<std::string> const& body_names();
// Links of this body on pins of this policy, or on the usual pins if `policy` is empty.
LinksOnPins const& links_on_pins(std::string const& body, std::string const& policy = "");

}  // namespace chapter3
