#pragma once
// Runs of the vehicle with the stress of a link.
#include "../vehicle_links/combinations.hpp"

namespace chapter4 {

using namespace chapter3;

struct Options : LinkSettings {
  Options();

  fs::path viewer, film_file;
  std::string compare, figure, turn, recovery = "static";
  double cut_off = 15.0;  // cut-off frequency of the low pass [Hz]
  bool bands = false;     // true: figures show the range over other values of data that the thesis does not give
  bool halve = false, restart = false, fatigue = false;

  // Policy of --policy, or an empty text. Throws InvalidInput if there are several.
  std::string policy() const;
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

// Name of a combination: its links, with the policy of their pins if it is not the usual one.
std::string name_of(Combination const& c);
// Legend entry of links that deform in the run.
std::string links_in_words(std::string const& links);

// Runs one combination.
StressRuns run_of(Options const& o, Combination const& c, std::string const& name);
// Runs several combinations and joins their results. A film of several combinations shows rigid links and cables only.
StressRuns run(Options const& o, std::vector<Combination> const& combinations);
// Completes a run that writes a checkpoint at half of the end time, and resumes another run from this checkpoint.
// \throws Error unless the final states are bitwise identical, InvalidInput for an integrator that is not implicit with
// the generalised-alpha method.
void restart(Options const& o, Combination const& c);

}  // namespace chapter4
