#pragma once
// Runs with rigid links and with ANCF cables for several values of data that the thesis does not give.
#include "stress_runs.hpp"

namespace chapter4 {

// Runs with one setting: rigid links, then cables.
struct SettingRuns {
  std::string name;
  Options options;
  StressRuns runs;
};

// Runs with several settings. The first setting is that of the options.
std::vector<SettingRuns> runs_of_settings(Options const& o);

Filtered filtered_strain(StressRuns const& runs, std::size_t k, double cut_off);

// Minimum and maximum of a history over several settings, at equal time steps.
class Band {
 public:
  Band(std::vector<SettingRuns> const& settings, std::function<Filtered(SettingRuns const&)> const& history);
  // Area between minimum and maximum, as a filled curve.
  Curve curve(std::string label, int colour, double scale, std::size_t every = 4) const;

 private:
  std::vector<double> times_, least_, most_;
};

// Prints decoupled and coupled strain for each setting as a table, and draws bands over all settings.
void ensemble(Options const& o);

// Prints decoupled and coupled strain for links of several stiffnesses as a table.
void compare_stiffnesses(Options o);

}  // namespace chapter4
