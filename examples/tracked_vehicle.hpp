#pragma once
// Case for `compare` with the vehicle of Chapters 3 and 4. This header does not depend on the types of the tracks.
// any_vehicle.hpp creates vehicles.
#include <polybody/compare/compare.hpp>
#include <polybody/io/plot.hpp>
#include <polybody/io/visual.hpp>
#include <polybody/polybody.hpp>
#include <polybody/run/any_model.hpp>
#include <polybody/vehicle/terrain.hpp>

#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include "m113/options.hpp"
#include "m113/track_frames.hpp"

namespace polybody {
class Film;
}

namespace chapter3 {

using namespace polybody;
namespace fs = std::filesystem;

inline constexpr int watched_pin = 20;  // number of a pin of the left track that is on the ground at the start

struct Settings {
  m113::Solids masses = m113::wallin_2016;
  double end_time = 10.0;
  double step = 5e-4;
  double first_step = 0.0;  // first step with step size control, with `step` as the longest step; 0: `step` [s]
  double sampling = 0.0;    // sampling interval of the histories [s]; 0: every step
  double speed = m113::moderate_sprocket_speed;
  double left = 1.0, right = 1.0;  // factors of the speed; unequal factors make the vehicle turn
  double ramp = 7.0;               // duration of the drives' ramp [s]
  bool suspension = true;
  double preload = m113::preload;
  double rho = 0.8;
  bool bumps = false;
  int cut = 0;
  int elements = 0;  // elements of a flexible link; 0: the least number of its formulation
  m113::ContactsAct contacts = m113::ContactsAct::in_the_middle;
  bool shared_contacts = false;                        // as `VehicleOptions::shared_contacts`
  std::shared_ptr<m113::TrackStart const> start = {};  // initial positions of the links; null: each run computes them
  double animate = 0.0;                  // interval between states of a ParaView animation [s]; 0: no animation
  std::shared_ptr<Film> film = nullptr;  // film with a scene for each run; null: no film
  double film_until = std::numeric_limits<double>::infinity();  // end of the film [s]
  bool audit = false;
  bool watched = true;  // a track that leaves its sprocket ends the run
  fs::path out = "out/tracked_vehicle";
  bool no_plot = false;  // data and scripts only
};

// Ground with three bumps of 10 to 15 cm, of which one is under the left track only; without `bumps`, a plane.
BumpCourse course(bool bumps);
m113::VehicleOptions vehicle_options(Settings const& s);
GeneralisedAlpha integrator(Settings const& o);
// Names of the outputs of every run, without units.
std::vector<std::string> output_names();
void warn_of_drive(Settings const& o);

// Positions of the links of tracks at rest, common to all formulations.
m113::TrackStart settled(Settings const& s);

// Vehicle whose types of links and pins are erased.
struct AnyVehicle {
  std::shared_ptr<m113::TrackedVehicle const> tracks;
  AnyModel model;
  std::string pin, drive;          // names of the watched pin and of the left drive
  std::function<Visual()> visual;  // returns the visual shapes
};
class VehicleScene;

// Parts of a vehicle that are independent of the formulation of its tracks.
struct VehicleParts {
  BumpCourse ground;
  std::array<Ramp, 2> drives;
  m113::VehicleOptions options;
};
using MakeVehicle = std::function<AnyVehicle(VehicleParts const&)>;

// Vehicle that is ready to run, and the initial positions of its links.
struct Built {
  m113::TrackStart start;
  AnyVehicle vehicle;
};
Built build(Settings const& s, MakeVehicle const& make);

// Results of a run other than its histories.
struct Outcome {
  std::string name, trouble = {}, deepest = {};
  double depth = 0.0, deepest_time = 0.0;
  double drives = 0.0, gravity = 0.0, kinetic = 0.0, stored = 0.0, dissipated = 0.0, unaccounted = 0.0,
         relative = -1.0;  // energies [J]; relative: [1], negative without an energy audit
};

// Case of a run of the vehicle.
struct TrackCase {
  Settings const& settings;
  std::vector<Outcome>* outcomes;
  std::shared_ptr<VehicleScene> scene = nullptr;  // scene that records the run; null: if there is a film, a new scene

  Scenario<AnyModel> scenario(std::string const& name, Built const& built) const;
};

// Results of several runs: the comparison and the outcome of each run.
struct Runs {
  Comparison comparison;
  std::vector<Outcome> outcomes;
  double sampling = 0.0;  // sampling interval of the histories [s]; 0: every step

  std::vector<double> const& history(std::size_t run, std::string const& name) const;
  std::vector<double> const& times(std::size_t run) const { return comparison.runs[run].times; }
  // Times of the run, without the last time if an event ended the run between two steps.
  std::span<double const> filtered_times(std::size_t run) const;
};

// History of a run after a low-pass filter with the cut-off frequency `cut_off` [Hz].
struct Filtered {
  std::vector<double> times, values;
};
Filtered filtered(Runs const& runs, std::size_t run, std::string const& output, double cut_off);
// Filters `values` at the times of the run, which are not an output of the run.
std::vector<double> filtered_values(Runs const& runs, std::size_t run, std::vector<double> const& values,
                                    double cut_off);

// Mean, minimum and maximum of a history between two times, and the times of minimum and maximum [s].
struct Span {
  double mean = 0.0, least = std::numeric_limits<double>::infinity(), most = -least, at_least = 0.0, at_most = 0.0;
};
Span span_of(std::vector<double> const& times, std::vector<double> const& x, double from = 0.0,
             double to = std::numeric_limits<double>::infinity());
// Mean yaw rate after the time `from` [rad/s].
double yaw_rate(Runs const& runs, std::size_t run, double from);

// A curve of every `every`-th sample, so that files stay small.
Curve curve(std::string label, std::vector<double> const& x, std::vector<double> const& y, int colour,
            double scale = 1.0, std::size_t every = 4);
void draw(Settings const& o, Figure const& f, std::string const& name);
Figure history_figure(Runs const& runs, std::string const& output, std::string title, std::string label,
                      double cut_off = 0.0, double scale = 1.0);
void over_time(Settings const& o, Runs const& runs, std::string const& output, std::string title, std::string label,
               std::string const& name, double cut_off = 0.0, double scale = 1.0);

// Mean forward velocity after the time `from` [s]. The transient of the ramp may last until 9 s.
double mean_speed(Runs const& runs, std::size_t run, double from = 9.0);

}  // namespace chapter3
