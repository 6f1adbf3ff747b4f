#pragma once
// Runs of rigid links and of ANCF cables under settings that the thesis does not give.
#include "stress_runs.hpp"

namespace chapter4 {

// One setting, its rigid links first.
struct SettingRuns {
  std::string name;
  Options options;
  StressRuns runs;
};

// The first is as the options give it.
std::vector<SettingRuns> runs_of_settings(Options const& o);

Filtered filtered_strain(StressRuns const& runs, std::size_t k, double cut_off);

// The least and the most of a history over several settings, at equal steps.
class Band {
 public:
  Band(std::vector<SettingRuns> const& settings, std::function<Filtered(SettingRuns const&)> const& history);
  // The area between them.
  Curve curve(std::string label, int colour, double scale, std::size_t every = 4) const;

 private:
  std::vector<double> times_, least_, most_;
};

// Decoupled and coupled strain under each setting, as a table and as bands.
void ensemble(Options const& o);

}  // namespace chapter4
