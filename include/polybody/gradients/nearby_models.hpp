#pragma once
/// \file
/// Model of a run, and four perturbed models for each parameter.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <memory>
#include <span>

#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/time_map.hpp>

namespace polybody::detail {

/// Model for the values of the parameters, and models at the four difference points of each parameter. \tparam V
/// PerturbedModel or PerturbedStageModel
template <class V>
class NearbyModels {
 public:
  /// \param who name of the calling function in messages
  template <class Make, class Method>
  [[gnu::cold]] NearbyModels(Make const& make, std::vector<Parameter> const& parameters, Method const& method,
                             char const* who)
      : parameters_(parameters), itself_(make(values_of(parameters)), method) {
    for (std::size_t j = 0; j < parameters.size(); ++j)
      for (double const place : FourPoints::places) {
        std::vector<double> p = values_of(parameters);
        p[j] += place * parameters[j].distance();
        perturbed_.push_back(std::make_shared<V>(make(p), method));
        require_alike(itself_, *perturbed_.back(), parameters[j], who);
      }
    find_times(who);
  }

  V& itself() { return itself_; }                                  ///< model for the values of the parameters
  TimeMap const& times(std::size_t j) const { return times_[j]; }  ///< times of the runs with perturbed parameter j
  /// Model at difference point k of parameter j.
  V& perturbed(std::size_t j, std::size_t k) { return *perturbed_[points * j + k]; }
  /// Model at difference point k of parameter j, with shared ownership.
  std::shared_ptr<V> shared(std::size_t j, std::size_t k) const { return perturbed_[points * j + k]; }
  Parameter const& parameter(std::size_t j) const { return parameters_[j]; }  ///< parameter number j

  /// Length of a step from the time `from` in the run with point k of parameter j [s]. Its end corresponds to t + h,
  /// the end of a step from t in the unperturbed run.
  double length(std::size_t j, std::size_t k, double t, double h, double from) const {
    double const end = times_[j](k, t + h);
    if (from == t && end == t + h) return h;
    double length = end - from;
    while (from + length > end) length = std::nextafter(length, 0.0);
    return length;
  }

 private:
  static constexpr std::size_t points = FourPoints::places.size();

  [[gnu::cold]] void find_times(char const* who) {
    std::vector<double> const here = itself_.breakpoints();
    double const start = itself_.scenario.start.t;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      std::vector<TimeMap::Moving> times;
      auto const add_time = [&](double t, auto const& of) {
        if (!std::isfinite(t)) return;
        TimeMap::Moving m{t, {}};
        for (std::size_t k = 0; k < points; ++k) m.there[k] = of(*perturbed_[points * j + k]);
        times.push_back(m);
      };
      add_time(start, [](V const& v) { return v.scenario.start.t; });
      for (std::size_t i = 0; i < here.size(); ++i) add_time(here[i], [i](V const& v) { return v.breakpoints()[i]; });
      times_.emplace_back(std::move(times), parameters_[j], 1e-9 * itself_.length(), who);
    }
  }

  std::vector<Parameter> parameters_;
  V itself_;
  std::vector<std::shared_ptr<V>> perturbed_;  // four for each parameter
  std::vector<TimeMap> times_;
};

}  // namespace polybody::detail
