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
  std::string files;     // of a finite element link
  bool surface = false;  // stress in named nodes of its surface, also after a run of rigid links
  FfrTerms terms = {};   // of floating frames
  double section = 1.0;  // height of a flexible link's section and of a structure's, of that which has a link's mass
  double cut_off = 15.0;
  bool bands = false;  // figures with the range over settings that the thesis does not give
  bool halve = false, restart = false, fatigue = false;
};

inline double section_height(Options const& o) { return o.section * m113::cable_height; }
// The mass of a flexible link.
inline double flexible_mass(Options const& o) { return m113::with_steel_links({}, section_height(o)).link.mass; }

// History of the watched link of a run. The strain of rigid links is computed after the run.
struct LinkHistory {
  std::vector<double> strain;   // of the link, change of length over length
  std::vector<double> bending;  // in the middle: what it adds in the fibre towards the wheels
  std::map<std::string, std::vector<double>> surface = {};  // von Mises stress in named nodes [Pa]
  std::vector<double> vibrating;  // strain of a rigid link by the thesis' linear equations of its vibrations
  bool decoupled = false;         // worked out after the run of a rigid link
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
  std::optional<BodyHandle<Rigid<>>> rigid = {};             // recorded, and its strain is worked out after the run
  std::vector<BodyHandle<Rigid<>>> rigid_links = {};         // of both tracks: so is their stress for a film
  std::function<void(State const&, LinkHistory&)> see = {};  // adds the outputs of a flexible link in a state
};
struct StressVehicle {
  AnyVehicle vehicle;
  WatchedLink link;
};

// Links of one body formulation on pins of one policy.
struct Combination {
  std::string links, pins;
  bool usual = false;        // the pins that links have where none are asked for
  std::string refusal = {};  // why it cannot be; else empty
  bool turns = true;         // else its pins are fixed to the world's axes
  std::function<StressVehicle(Options const&, VehicleParts const&)> make = {};

  std::string name() const { return usual ? links : links + ", " + pins; }
};
inline std::vector<std::string> const all_links{"rigid", "ancf", "ffr", "fe", "lrvf", "beam", "continuum"};
inline std::vector<std::string> const all_pins{"constraint", "penalty", "bushing", "linear", "recursive"};

// Legend entry of links that deform in the run.
std::string links_in_words(std::string const& links);

// The run of one formulation.
StressRuns run_of(Options const& o, Combination const& c);
// Runs the first half, writes a checkpoint, and continues from it; the result is bitwise identical to the full run.
void restart(Options const& o, Combination const& c);

// Ideal pins, by an Adams method in independent coordinates; states every `step`.
StressRuns rigid_links_by_adams(Options o);

// Of each formulation of the links, in the order of all_pins.
std::vector<Combination> rigid_links();
std::vector<Combination> cable_links();
std::vector<Combination> modal_links();
std::vector<Combination> finite_element_links();
std::vector<Combination> rotation_links();
std::vector<Combination> beam_links();
std::vector<Combination> continuum_links();

}  // namespace chapter4
