#pragma once
// Search for the lightest link whose stress does not exceed the allowed stress.

#include "../support/optimiser.hpp"
#include "link.hpp"

namespace lighter_link {

struct Bounds {
  double start = 0.03, least = 0.008, most = 0.06;  // initial, least and greatest height [m]
};

struct Lightest {
  std::string name{};
  std::vector<double> heights{};         // heights of the sections [m]
  double mass = 0.0;                     // mass of the link [kg]
  double aggregate = 0.0, stress = 0.0;  // aggregate and largest stress, relative to the allowed stress
  // Masses [kg], aggregates and largest stresses of all tried designs.
  std::vector<double> masses{}, aggregates{}, stresses{};
  double seconds = 0.0;  // processor time of the search [s]
  std::string why{};     // reason for the end of the search
  bool converged = false;
};

// Searches with one run with derivatives for each design. The method requests mass and stress of a design separately,
// so the results of the last run are stored. The variables are the logarithms of the heights, and the bound is on the
// logarithm of the stress: M h/2I is proportional to h⁻², so the relation of the logarithms is nearly linear, as the
// method assumes.
inline Lightest lightest(Candidate const& c, Task const& task, Bounds const& bounds) {
  Lightest out{.name = c.name};
  auto const heights = [&](std::span<double const> x) {
    std::vector<double> h(x.begin(), x.end());
    for (double& one : h) one = bounds.start * std::exp(one);
    return h;
  };
  std::vector<double> const zeros(task.sections, 0.0);
  double const mass = task.mass(heights(zeros));
  std::vector<double> asked;
  Loaded here;
  Design design{.start = zeros,
                .least = std::vector<double>(task.sections, std::log(bounds.least / bounds.start)),
                .most = std::vector<double>(task.sections, std::log(bounds.most / bounds.start))};
  design.objective = [&](std::span<double const> x) {
    ValueAndSlopes share{task.mass(heights(x)) / mass, {}};
    for (double const one : x) share.derivatives.push_back(std::exp(one) / double(x.size()));
    return share;
  };
  design.constraint = [&](std::span<double const> x) {
    std::vector<double> const h = heights(x);
    if (h != asked) {
      here = c.loaded(h);
      asked = h;
      out.masses.push_back(task.mass(h));
      out.aggregates.push_back(here.aggregate);
      out.stresses.push_back(here.most);
    }
    ValueAndSlopes bound{std::log(here.aggregate), {}};
    for (std::size_t i = 0; i < h.size(); ++i)
      bound.derivatives.push_back(here.derivatives[Index(i)] * h[i] / here.aggregate);
    return bound;
  };
  std::clock_t const begin = std::clock();
  BestDesign const best = best_design(design);
  out.seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
  out.heights = heights(best.x);
  out.mass = task.mass(out.heights);
  out.aggregate = here.aggregate;
  out.stress = here.most;
  out.why = best.why;
  out.converged = best.converged;
  return out;
}

}  // namespace lighter_link
