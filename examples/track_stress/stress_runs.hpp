#pragma once
// Interface of a formulation of the links. Each formulation is compiled in a separate file.
#include <functional>
#include <map>
#include <memory>

#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/run/body_record.hpp>

#include "../tracked_vehicle.hpp"
#include "m113/links.hpp"

namespace chapter4 {

using namespace chapter3;

inline constexpr int watched_link = watched_pin;

struct Options : Settings {
  fs::path viewer, film_file;
  std::string links = "ancf", pins, compare, figure, turn, recovery = "static";
  std::string files;     // folder of the files of a finite element link
  bool surface = false;  // true: computes the stress at named nodes of its surface, also after a run with rigid links
  FfrTerms terms = {};   // terms of the equations of floating frames
  // Height of a flexible link's section, divided by the height that gives the mass of a rigid link [1].
  double section = 1.0;
  double young = 1.0;     // Young's modulus of links other than ffr and fe, divided by that of steel [1]
  double cut_off = 15.0;  // cut-off frequency of the low pass [Hz]
  bool bands = false;     // true: figures show the range over other values of data that the thesis does not give
  bool halve = false, restart = false, fatigue = false;
};

inline double section_height(Options const& o) { return o.section * m113::cable_height; }
// Mass of a flexible link [kg].
inline double flexible_mass(Options const& o) { return m113::with_steel_links({}, section_height(o)).link.mass; }

// History of the watched link of a run. The strain of rigid links is computed after the run.
struct LinkHistory {
  std::vector<double> strain;   // axial strain of the link: change of length divided by length [1]
  std::vector<double> bending;  // bending strain in the middle, in the fibre towards the wheels [1]
  std::map<std::string, std::vector<double>> surface = {};  // von Mises stress at named nodes [Pa]
  std::vector<double> vibrating;  // strain of a rigid link by the thesis' linear equations of its vibrations [1]
  bool decoupled = false;         // true: results computed after a run with rigid links
  double recording = 0.0, recovery = 0.0, vibration = 0.0;  // CPU times [s]
};

struct StressRuns : Runs {
  std::vector<std::shared_ptr<LinkHistory>> links;

  std::string const& name(std::size_t k) const { return comparison.runs[k].name; }
  std::vector<double> const& raw(std::size_t k) const { return links[k]->strain; }
  std::vector<double> const& bending(std::size_t k) const { return links[k]->bending; }
  std::vector<double> const& vibrating(std::size_t k) const { return links[k]->vibrating; }
  std::vector<double> filtered(std::size_t k, double cut_off) const { return filtered(k, raw(k), cut_off); }
  std::vector<double> filtered(std::size_t k, std::vector<double> const& y, double cut_off) const {
    return filtered_values(*this, k, y, cut_off);
  }
};

// Selection and outputs of the watched link.
struct WatchedLink {
  // Rigid link whose loads are recorded; its strain is computed after the run.
  std::optional<BodyHandle<Rigid<>>> rigid = {};
  std::vector<BodyHandle<Rigid<>>> rigid_links = {};         // rigid links of both tracks, whose stress a film shows
  std::function<void(State const&, LinkHistory&)> see = {};  // adds the outputs of a flexible link in a state
};
struct StressVehicle {
  AnyVehicle vehicle;
  WatchedLink link;
};

// Links of one body formulation on pins of one policy.
struct Combination {
  std::string links, pins;
  bool usual = false;        // true: default pins of these links
  std::string refusal = {};  // reason for which the combination is impossible; empty if it is possible
  bool turns = true;         // false: the vehicle cannot turn, because its pins keep their direction in world axes
  std::function<StressVehicle(Options const&, VehicleParts const&)> make = {};

  std::string name() const { return usual ? links : links + ", " + pins; }
};
inline std::vector<std::string> const all_links{"rigid", "ancf", "ffr", "fe", "lrvf", "beam", "continuum"};
inline std::vector<std::string> const all_pins{"constraint", "penalty", "bushing", "linear", "recursive"};

// Legend entry of links that deform in the run.
std::string links_in_words(std::string const& links);

// Runs one combination.
StressRuns run_of(Options const& o, Combination const& c);
// Completes a run that writes a checkpoint at half of the end time, and resumes another run from this checkpoint.
// \throws Error unless the final states are bitwise identical.
void restart(Options const& o, Combination const& c);

// Runs rigid links on ideal pins with an Adams method in independent coordinates. The histories have a state every
// `step`.
StressRuns rigid_links_by_adams(Options o);

// Combinations of each formulation of the links with all pins, in the order of all_pins.
std::vector<Combination> rigid_links();
std::vector<Combination> cable_links();
std::vector<Combination> modal_links();
std::vector<Combination> finite_element_links();
std::vector<Combination> rotation_links();
std::vector<Combination> beam_links();
std::vector<Combination> continuum_links();

}  // namespace chapter4
