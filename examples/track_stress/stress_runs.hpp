#pragma once
// What the program asks of a formulation of the links. Each formulation is compiled in a file of its own.
#include <functional>
#include <memory>

#include "../tracked_vehicle.hpp"

namespace chapter4 {

using namespace chapter3;

inline constexpr int watched_link = watched_pin;

struct Options : Settings {
  std::string links = "ancf", figure, recovery = "static";
  double cut_off = 15.0;
  bool compare = false, halve = false, restart = false, fatigue = false;
};

// What a run knows of its watched link. Of rigid links the strain is worked out after the run.
struct LinkHistory {
  std::vector<double> strain;              // of the link, change of length over length
  std::vector<double> bending;             // in the middle: what it adds in the fibre towards the wheels
  double recording = 0.0, recovery = 0.0;  // CPU times [s]
  std::function<void(LinkHistory&)> recover;
};

struct StressRuns : Runs {
  std::vector<std::shared_ptr<LinkHistory>> links;

  std::string const& name(std::size_t k) const { return comparison.runs[k].name; }
  std::vector<double> const& raw(std::size_t k) const { return links[k]->strain; }
  std::vector<double> const& bending(std::size_t k) const { return links[k]->bending; }
  std::vector<double> filtered(std::size_t k, double cut_off) const { return filtered(k, raw(k), cut_off); }
  // Without the last sample where an event ended the run between two steps.
  std::vector<double> filtered(std::size_t k, std::vector<double> const& y, double cut_off) const {
    return low_pass(filtered_times(k), std::span(y).first(filtered_times(k).size()),
                    {.cut_off = cut_off, .mirrored = true});
  }
  std::span<double const> filtered_times(std::size_t k) const {
    return std::span(times(k)).first(times(k).size() - (comparison.runs[k].run.stopped ? 1 : 0));
  }
};

// A formulation of the links.
struct Links {
  std::function<StressRuns(Options const&)> run;
  // Half of the run, put away in a file, and the other half from there: what the whole run leads to, bit by bit.
  std::function<void(Options const&)> restart;
};
Links rigid_links();
Links cable_links();
Links modal_links();
Links rotation_links();
Links beam_links();
Links continuum_links();

}  // namespace chapter4
