#pragma once
/// \file
/// Evaluation of a comparison at equal error: limits of each formulation by extrapolation over mesh and step,
/// references of the physical models, discretisation errors and rankings.
///
/// Let y(t; n, h) be an output with n elements and the step h. With the orders p and q of mesh and step,
///   y(t; n, h) = Y(t) + A(t) n^−p + B(t) h^q + …
/// The orders are observed from the three finest meshes and the three shortest steps, and Y is extrapolated [Richardson
/// 1911; Roache 1998]:
///   Y = y(N, H) + (y(N, H) − y(N', H))/((N/N')^p − 1) + (y(N, H) − y(N, H'))/((H'/H)^q − 1),
/// with the finest mesh N, the shortest step H, and their predecessors N' and H'.
/// Theory: Eqs. 11.29 to 11.34.

#include <polybody/compare/equal_error_report.hpp>

namespace polybody::detail {

/// Order p for which the differences d₁ = C (s₁^p − s₂^p) and d₂ = C (s₂^p − s₃^p) of three results have the observed
/// ratio d₁/d₂, for sizes s₁ > s₂ > s₃ of mesh width or step. NaN unless 0 < d₂ < 0.9 d₁.
inline double observed_order(double d1, double d2, double s1, double s2, double s3) {
  if (!(d2 < 0.9 * d1) || !(d2 > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  double least = 0.05, most = 20.0;
  for (int i = 0; i < 60; ++i) {
    double const p = 0.5 * (least + most), a = std::pow(s1 / s3, p), b = std::pow(s2 / s3, p);
    ((a - b) / (b - 1.0) < d1 / d2 ? least : most) = p;
  }
  return 0.5 * (least + most);
}

/// Extrapolation of a sequence of results to the size zero.
struct Extrapolation {
  std::vector<double> correction;                           ///< limit minus last result
  double error = 0.0;                                       ///< error bound of the limit
  double order = std::numeric_limits<double>::quiet_NaN();  ///< observed order
  bool converges = false;                                   ///< true if the differences decrease or are negligible
};

/// Extrapolates the results `y`, with the descending sizes `s`. Let D be the difference between the limit of all
/// results and the limit without the last result. The error bound is D/(r^p − 1) with the observed order p and the
/// ratio r of the last two sizes; the divisor is at most 3. With three results, or if one of the two limits has no
/// order, the error bound is the largest correction. Differences up to `negligible` count as zero, and the bound is at
/// least this number.
template <class = void>
Extrapolation extrapolate(std::vector<std::vector<double> const*> const& y, std::vector<double> const& s,
                          double negligible) {
  Extrapolation out;
  std::size_t const n = y.size(), last = n - 1;
  out.correction.assign(y[last]->size(), 0.0);
  auto const limit_at = [&](std::size_t k, double& order) {
    std::vector<double> limit = *y[k];
    double const d1 = largest_difference(*y[k - 1], *y[k - 2]), d2 = largest_difference(*y[k], *y[k - 1]);
    if (d2 <= negligible) return limit;
    order = observed_order(d1, d2, s[k - 2], s[k - 1], s[k]);
    double const factor = 1.0 / (std::pow(s[k - 1] / s[k], order) - 1.0);
    for (std::size_t i = 0; i < limit.size(); ++i) limit[i] += factor * ((*y[k])[i] - (*y[k - 1])[i]);
    return limit;
  };
  std::vector<double> const limit = limit_at(last, out.order);
  if (largest_difference(*y[last], *y[last - 1]) > negligible && std::isnan(out.order)) return out;
  out.converges = true;
  for (std::size_t i = 0; i < limit.size(); ++i) out.correction[i] = limit[i] - (*y[last])[i];
  double earlier = std::numeric_limits<double>::quiet_NaN();
  out.error = largest_difference(limit, *y[last]);
  if (n > 3) {
    std::vector<double> const before = limit_at(last - 1, earlier);
    if (std::isfinite(earlier) && std::isfinite(out.order))
      out.error = largest_difference(limit, before) / std::min(std::pow(s[last - 1] / s[last], out.order) - 1.0, 3.0);
  }
  out.error = std::max(out.error, negligible);
  return out;
}

/// Extrapolates the output of a formulation over its meshes or its steps: `select(run)` returns the size of a run of
/// this sequence, or zero for other runs. If no order is observed, the limit is the last result, and its error bound is
/// three times the larger one of the last two changes, if this bound is at most a thousandth of the span. In both cases
/// a remark gives the changes. Without a limit the function returns nothing.
template <class Select>
std::optional<Extrapolation> limit_along(EqualErrorReport const& r, StudiedFormulation& f, std::string const& axis,
                                         double negligible, Select&& select) {
  std::vector<std::vector<double> const*> y;
  std::vector<double> sizes;
  for (StudyRun const& run : f.runs)
    if (double const size = select(run); size > 0.0) {
      if (run.y.empty()) y.clear(), sizes.clear();  // only results finer than the last failure
      if (run.y.empty()) continue;
      y.push_back(&run.y);
      sizes.push_back(size);
    }
  if (y.size() < 3) {
    f.remarks.push_back("no reference: fewer than three " + axis + " have a complete run.");
    return std::nullopt;
  }
  Extrapolation out = extrapolate(y, sizes, negligible);
  if (out.converges) return out;
  std::size_t const n = y.size();
  double const last = largest_difference(*y[n - 1], *y[n - 2]), before = largest_difference(*y[n - 2], *y[n - 3]);
  std::string const changes = "the output does not converge with the " + axis + ". It changes by " + r.with_unit(last) +
                              " between the two finest and by " + r.with_unit(before) + " between the next two. ";
  out.error = 3.0 * std::max(last, before);
  out.converges = out.error <= 1e-3 * r.span;
  f.remarks.push_back(out.converges ? changes + "The error bound is three times the larger change."
                                    : "no reference: " + changes + "Add finer " + axis + ".");
  return out.converges ? std::optional(out) : std::nullopt;
}

/// Computes the limit of a formulation with its error bound and observed orders.
template <class = void>
void find_limit(EqualErrorReport const& r, StudiedFormulation& f) {
  StudyRun const& fine = f.finest();
  if (fine.y.empty()) return;
  double const negligible = std::max(1e-9 * r.span, f.spread);
  std::vector<double> limit = fine.y;
  double error = 0.0;
  auto const add = [&](std::optional<Extrapolation> const& part, double& order) {
    if (!part) return false;
    order = part->order;
    error += part->error;
    for (std::size_t k = 0; k < limit.size(); ++k) limit[k] += part->correction[k];
    return true;
  };
  bool const in_space =
      f.mesh_name.empty() ||
      add(limit_along(r, f, "meshes", negligible,
                      [&](StudyRun const& run) { return run.step == fine.step ? 1.0 / double(run.mesh) : 0.0; }),
          f.mesh_order);
  bool const in_time = add(limit_along(r, f, f.step_name == "tolerance" ? "tolerances" : "steps", negligible,
                                       [&](StudyRun const& run) { return run.mesh == fine.mesh ? run.step : 0.0; }),
                           f.step_order);
  if (!in_space || !in_time) return;
  f.limit = std::move(limit);
  f.limit_error = error;
}

/// Removes the limit of a formulation and adds a remark, if its error bound exceeds the span of the output.
template <class = void>
void refuse_limit(EqualErrorReport const& r, StudiedFormulation& f) {
  if (f.limit.empty() || f.limit_error <= r.span) return;
  std::string orders;
  auto const add = [&](double order, std::string const& axis) {
    if (!std::isnan(order))
      orders += (orders.empty() ? " The observed order is " : " and ") + number(order, 2) + " in the " + axis;
  };
  add(f.mesh_order, "mesh");
  add(f.step_order, f.step_name == "tolerance" ? "tolerance" : "step");
  f.remarks.push_back("no reference: the output \"" + r.output + "\" of \"" + f.name +
                      "\" does not converge. The error bound of its limit, " + r.with_unit(f.limit_error) +
                      ", exceeds the span, " + r.with_unit(r.span) + '.' + orders + (orders.empty() ? "" : ".") +
                      " Add finer meshes and shorter steps.");
  f.limit.clear();
  f.limit_error = std::numeric_limits<double>::quiet_NaN();
}

/// Selects the reference of each physical model, and computes discretisation errors and differences of the models.
template <class = void>
void find_references(EqualErrorReport& r) {
  for (std::size_t i = 0; i < r.formulations.size(); ++i) {
    StudiedFormulation const& f = r.formulations[i];
    if (f.limit.empty()) continue;
    auto const same = std::find_if(r.references.begin(), r.references.end(),
                                   [&](ModelReference const& reference) { return reference.model == f.model; });
    if (same == r.references.end())
      r.references.push_back({f.model, i, f.limit_error});
    else if (f.limit_error < same->error)
      same->formulation = i, same->error = f.limit_error;
  }
  for (StudiedFormulation& f : r.formulations)
    for (std::size_t k = 0; k < r.references.size(); ++k) {
      ModelReference const& reference = r.references[k];
      if (reference.model != f.model) continue;
      for (StudyRun& run : f.runs)
        if (!run.y.empty()) run.error = largest_difference(run.y, r.reference(k));
      if (f.limit.empty()) continue;
      double const apart = largest_difference(f.limit, r.reference(k));
      if (apart > f.limit_error + reference.error + f.spread)
        f.remarks.push_back("its limit differs from that of \"" + r.formulations[reference.formulation].name +
                            "\" by " + r.with_unit(apart) + ", more than the sum of the error bounds, " +
                            r.with_unit(f.limit_error + reference.error) +
                            ", although both have the same physical model. Use finer meshes and shorter steps.");
    }
  for (std::size_t a = 0; a < r.references.size(); ++a)
    for (std::size_t b = a + 1; b < r.references.size(); ++b)
      r.differences.push_back({a, b, largest_difference(r.reference(a), r.reference(b)),
                               r.references[a].error + r.references[b].error +
                                   r.formulations[r.references[a].formulation].spread +
                                   r.formulations[r.references[b].formulation].spread});
}

/// Reason why formulation f cannot be ranked at the error `wanted` [unit of the output]; empty if it can.
template <class = void>
std::string not_ranked(EqualErrorReport const& r, StudiedFormulation const& f, double wanted) {
  auto const own = std::find_if(r.references.begin(), r.references.end(),
                                [&](ModelReference const& reference) { return reference.model == f.model; });
  if (own == r.references.end()) return "its physical model has no reference";
  if (own->error > 0.5 * wanted)
    return "the error bound of its reference, " + number(own->error / r.span, 2) +
           " of the span, exceeds half of this error";
  if (f.spread > wanted)
    return "a change of the initial coordinates by round-off changes the output by " + number(f.spread / r.span, 2) +
           " of the span";
  return {};
}

/// Finds the cheapest run of each formulation for each wanted error.
template <class = void>
void rank(EqualErrorReport& r, std::vector<double> const& errors) {
  for (double const wanted : errors) {
    Ranking& ranking = r.rankings.emplace_back(Ranking{.wanted = wanted});
    for (std::size_t i = 0; i < r.formulations.size(); ++i) {
      StudiedFormulation const& f = r.formulations[i];
      std::string reason = not_ranked(r, f, wanted * r.span);
      StudyRun const* best = nullptr;
      for (StudyRun const& run : f.runs)
        if (run.error <= wanted * r.span && (best == nullptr || run.cpu < best->cpu)) best = &run;
      if (reason.empty() && best == nullptr) reason = "no run of the study reaches this error";
      if (reason.empty())
        ranking.ranked.push_back({i, std::size_t(best - f.runs.data())});
      else
        ranking.missing.push_back({i, std::move(reason)});
    }
  }
}

/// Marks the runs of the Pareto front of error and CPU time.
template <class = void>
void mark_front(EqualErrorReport& r) {
  for (StudiedFormulation& f : r.formulations)
    for (StudyRun& run : f.runs) {
      run.on_front = std::isfinite(run.error);
      for (StudiedFormulation const& g : r.formulations)
        for (StudyRun const& other : g.runs)
          if (other.error <= run.error && other.cpu <= run.cpu && (other.error < run.error || other.cpu < run.cpu))
            run.on_front = false;
    }
}

}  // namespace polybody::detail
