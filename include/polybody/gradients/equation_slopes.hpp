#pragma once
/// \file
/// What parameters do to the equations of a step while unknowns stay, ∂r/∂p and ∂Φ/∂p, by differences of models made
/// for values beside theirs. Parameters that touch no equation in common share these models, as columns of a sparse
/// Jacobian share one difference [Curtis, Powell & Reid 1974].
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <memory>
#include <numeric>

#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/variant.hpp>

namespace polybody::detail {

/// What of the whole model's equations a parameter touches, by speeds, then by rows. \throws InvalidInput for a name
/// that the model does not have.
template <class = void>
std::vector<char> touched_in_whole(ModelLayout const& layout, Parameter const& p) {
  std::vector<char> touched(std::size_t(layout.speeds + layout.rows), p.touches.empty());
  auto const touch = [&](Index first, Index count) {
    for (Index i = first; i < first + count; ++i) touched[std::size_t(i)] = 1;
  };
  auto const touch_owner = [&](Index marker) {
    if (Index const body = marker < 0 ? -1 : layout.owners[std::size_t(marker)]; body >= 0)
      touch(layout.bodies[std::size_t(body)].v0, layout.bodies[std::size_t(body)].speeds);
  };
  for (std::string const& name : p.touches) {
    bool found = false;
    for (BodyPlace const& b : layout.bodies)
      if (b.name == name) {
        touch(b.v0, b.speeds);
        if (b.rows > 0) touch(layout.speeds + b.row, b.rows);
        found = true;
      }
    for (JointPlace const& j : layout.joints)
      if (j.name == name) {
        if (j.rows > 0) touch(layout.speeds + j.row, j.rows);
        touch_owner(j.a);
        touch_owner(j.b);
        found = true;
      }
    for (ForcePlace const& f : layout.forces)
      if (f.name == name) {
        if (f.states > 0) touch(f.v0, f.states);
        for (Index const marker : f.markers) touch_owner(marker);
        found = true;
      }
    if (!found)
      throw InvalidInput{"The parameter \"", p.name, "\" touches \"", name,
                         "\", but the model has no body, joint or force of that name."};
  }
  return touched;
}
/// What of a step's equations is touched where so much of the whole model's is. Forces on coordinates that depend on
/// others go to these; a joint that is touched itself may change how, and with that all equations. In joint coordinates
/// that depends on the place, and all are.
template <class = void>
std::vector<char> touched_in_step(System const& system, std::vector<char> const& whole) {
  Coordinates const& c = system.step_coordinates();
  if (!c) return whole;
  if (!c.narrow->keeps_mass_constant) return std::vector<char>(std::size_t(system.size()), 1);
  Index const speeds = system.layout().speeds;
  std::vector<char> touched(std::size_t(system.size()), 0), stays(whole.size(), 0);
  for (std::size_t i = 0; i < c.narrow->rows_that_stay.size(); ++i) {
    std::size_t const row = std::size_t(speeds + c.narrow->rows_that_stay[i]);
    stays[row] = 1;
    touched[std::size_t(system.speeds()) + i] = whole[row];
  }
  VecX force(speeds), narrow(system.speeds());
  for (Index i = 0; i < Index(whole.size()); ++i) {
    if (!whole[std::size_t(i)]) continue;
    if (i >= speeds && !stays[std::size_t(i)]) return std::vector<char>(touched.size(), 1);
    if (i >= speeds) continue;
    force.setZero();
    force[i] = 1.0;
    c.entries->reduce(c.self.get(), force, narrow);
    for (Index k = 0; k < narrow.size(); ++k)
      if (narrow[k] != 0.0) touched[std::size_t(k)] = 1;
  }
  return touched;
}
/// The equations of a step that a parameter touches, ascending: by speeds, then by rows. \throws InvalidInput for a
/// name that the model does not have.
template <class = void>
std::vector<Index> touched_equations(System const& system, Parameter const& p) {
  std::vector<char> const touched = touched_in_step(system, touched_in_whole(system.layout(), p));
  std::vector<Index> equations;
  for (std::size_t i = 0; i < touched.size(); ++i)
    if (touched[i]) equations.push_back(Index(i));
  return equations;
}

/// Differences of the equations by all parameters. \tparam V a Variant
template <class V>
class EquationSlopes {
 public:
  /// A group for each set of parameters that touch nothing in common. \param make makes a scenario for values of the
  /// parameters
  template <class Make>
  [[gnu::cold]] EquationSlopes(Make const& make, std::vector<Parameter> const& parameters, V const& model)
      : EquationSlopes(make, parameters, model, [](std::size_t, std::size_t) { return std::shared_ptr<V>(); }) {}
  /// The same. \param alone alone(j, k) has a model for point k beside parameter j, or none
  template <class Make, class Alone>
  [[gnu::cold]] EquationSlopes(Make const& make, std::vector<Parameter> const& parameters, V const& model,
                               Alone const& alone)
      : places_(parameters.size()) {
    std::vector<std::vector<char>> taken;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      Place& place = places_[j];
      place.distance = parameters[j].distance();
      place.equations = touched_equations(model.system, parameters[j]);
      auto const is_free = [&](std::vector<char> const& in) {
        return std::all_of(place.equations.begin(), place.equations.end(),
                           [&](Index i) { return !in[std::size_t(i)]; });
      };
      place.group = std::size_t(std::find_if(taken.begin(), taken.end(), is_free) - taken.begin());
      if (place.group == taken.size()) taken.emplace_back(std::size_t(model.system.size()), 0);
      for (Index const i : place.equations) taken[place.group][std::size_t(i)] = 1;
    }
    groups_.resize(taken.size());
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
        std::vector<double> p = values_of(parameters);
        std::size_t last = 0, members = 0;
        for (std::size_t j = 0; j < p.size(); ++j)
          if (places_[j].group == g) {
            p[j] += FourPoints::places[k] * parameters[j].distance();
            last = j;
            ++members;
          }
        std::shared_ptr<V>& there = groups_[g].models[k];
        if (members == 1) there = alone(last, k);
        if (!there) there = std::make_shared<V>(make(p), model.method);
      }
  }

  /// How many groups there are: each takes four evaluations.
  std::size_t groups() const { return groups_.size(); }

  /// What follows is asked of another step.
  void forget() {
    for (Group& group : groups_) group.known = 0;
  }
  /// Differences at x, a state or what else the equations are asked at, of which everything else is asked.
  template <class Place>
  void evaluate(Place const& x) {
    forget();
    for (Group& group : groups_) group.evaluate(x, 0);
  }
  /// ∂r/∂p and ∂Φ/∂p of parameter j, which `out` has the sizes of, at x, place number `number` of a step: the first
  /// parameter of a group evaluates them, at one place after the other.
  template <class X>
  void get(std::size_t j, X const& x, std::size_t number, EquationSlope& out) {
    Place const& place = places_[j];
    Group& group = groups_[place.group];
    if (number >= group.known) group.evaluate(x, number);
    VecX const& difference = group.differences[number];
    Index const speeds = out.balance.size();
    out.balance.setZero();
    out.rows.setZero();
    for (Index const i : place.equations)
      (i < speeds ? out.balance[i] : out.rows[i - speeds]) = difference[i] / place.distance;
  }
  /// μᵀ ∂r/∂p of parameter j. \param mu by speeds, then by rows
  double dot(std::size_t j, VecX const& mu) const {
    double sum = 0.0;
    VecX const& difference = groups_[places_[j].group].differences.front();
    for (Index const i : places_[j].equations) sum += mu[i] * difference[i];
    return sum / places_[j].distance;
  }
  /// Takes μᵀ ∂r/∂p of each parameter from its slope.
  void take_from(VecX& slopes, VecX const& mu) const {
    for (std::size_t j = 0; j < places_.size(); ++j) slopes[Index(j)] -= dot(j, mu);
  }

  /// \throws InvalidInput where parameter j changes an equation at x that it does not touch, by more than rounding.
  /// \param other the model with another value of it
  void require_touched(std::size_t j, Parameter const& p, V& model, V& other, State const& x) const {
    if (p.touches.empty()) return;
    State still = x;
    still.a.setZero();
    still.lambda.setZero();
    double const force = model.equations(still).balance.template lpNorm<Eigen::Infinity>();
    EquationSlope const here = model.equations(x), there = other.equations(x);
    Index const speeds = here.balance.size();
    auto const change = [&](Index i) {
      return i < speeds ? std::abs(there.balance[i] - here.balance[i])
                        : std::abs(there.rows[i - speeds] - here.rows[i - speeds]);
    };
    double most[2] = {1e-11 * force, 1e-13};  // of balance and rows: what they touch, or rounding
    std::vector<char> touched(std::size_t(model.system.size()), 0);
    for (Index const i : places_[j].equations) {
      touched[std::size_t(i)] = 1;
      most[i < speeds ? 0 : 1] = std::max(most[i < speeds ? 0 : 1], 1e-7 * change(i));
    }
    for (Index i = 0; i < model.system.size(); ++i)
      if (!touched[std::size_t(i)] && change(i) > most[i < speeds ? 0 : 1])
        throw InvalidInput{"The parameter \"", p.name, "\" changes the equations of ", model.system.name_of(i),
                           ", which it does not name. Add to `touches` what acts there, or leave it empty."};
  }

 private:
  struct Place {
    std::size_t group = 0;
    double distance = 1.0;
    std::vector<Index> equations;  // by speeds, then by rows
  };
  struct Group {
    std::array<std::shared_ptr<V>, 4> models;
    std::vector<VecX> differences;  // at each place, Σ of the four, weighted; over a distance it is a derivative
    std::size_t known = 0;          // of them, of this step

    template <class X>
    void evaluate(X const& x, std::size_t number) {
      known = number + 1;
      if (differences.size() < known) differences.resize(known);
      VecX& difference = differences[number];
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
        EquationSlope const& of = models[k]->equations(x);
        if (k == 0) difference.setZero(of.balance.size() + of.rows.size());
        difference.head(of.balance.size()) += FourPoints::weights[k] * of.balance;
        difference.tail(of.rows.size()) += FourPoints::weights[k] * of.rows;
      }
    }
  };
  std::vector<Place> places_;
  std::vector<Group> groups_;
};

}  // namespace polybody::detail
