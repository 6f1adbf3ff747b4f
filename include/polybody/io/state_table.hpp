#pragma once
/// \file
/// Tables of states with named columns, for exchange with other programs. Checkpoints (io/checkpoint.hpp) also store
/// the integrator's history, so a resumed run is bitwise identical.

#include <optional>
#include <unordered_map>

#include <polybody/io/table.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

namespace detail {

/// Name and unit of a column in a table of states.
struct StateColumnHead {
  std::string name = "t [s]";
  std::string unit = {};  ///< unit of the numbers; empty if unknown

  /// Head of the column: name and unit.
  std::string text() const { return unit.empty() ? name : name + " [" + unit + ']'; }
};

/// Heads of the columns of a table of states, in the order t, q, v, λ.
struct StateHeads {
  std::vector<StateColumnHead> all;
  std::size_t required;  ///< number of columns that a table must have; missing multipliers are zero

  template <class = void>  // compiled where it is used
  explicit StateHeads(ModelLayout const& layout)
      : all(std::size_t(1 + layout.coordinates + layout.velocities + layout.rows)),
        required(std::size_t(1 + layout.coordinates + layout.velocities)) {
    Index const q = 1, v = q + layout.coordinates, lambda = v + layout.velocities;
    for (BodyLayout const& b : layout.bodies) {
      name(b.name, "q", q + b.q0, b.coordinates);
      name(b.name, "v", v + b.v0, b.velocities);
      name(b.name, "lambda", lambda + b.row, b.rows);
      if (b.units.of_coordinate) name_units(b, q + b.q0, v + b.v0);
    }
    for (ForceLayout const& f : layout.forces) name(f.name, "z", v + f.v0, f.states);
    for (JointLayout const& j : layout.joints) name(j.name, "lambda", lambda + j.row, j.rows);
  }

 private:
  /// Names `count` columns of one `owner` "rod q[0]", "rod q[1]", ….
  void name(std::string const& owner, char const* what, Index first, Index count) {
    for (Index i = 0; i < count; ++i)
      all[std::size_t(first + i)].name = owner + ' ' + what + '[' + std::to_string(i) + ']';
  }
  /// Sets the units of the columns of a body: coordinates from column q on, velocities from column v on.
  template <class = void>
  void name_units(BodyLayout const& b, Index q, Index v) {
    for (Index i = 0; i < b.coordinates; ++i) all[std::size_t(q + i)].unit = b.units.of_coordinate(b.body, i);
    for (Index i = 0; i < b.velocities; ++i)
      all[std::size_t(v + i)].unit =
          b.units.of_velocity ? b.units.of_velocity(b.body, i) : std::string(b.units.of_coordinate(b.body, i)) + "/s";
  }
};

/// Map from the head of each column of a table to the index of the column.
class StateColumns {
 public:
  template <class = void>
  explicit StateColumns(Table const& table) {
    for (std::size_t j = 0; j < table.columns.size(); ++j)
      if (!places_.emplace(table.columns[j], j).second)
        throw InvalidInput("table.columns",
                           {ErrorObject{"state_from"}, ": duplicate column \"", table.columns[j], "\"."});
  }

  /// Index of the column with the name of `head`, with or without the unit; empty if there is no such column.
  /// \throws InvalidInput if columns with and without unit exist, or if the unit differs.
  template <class = void>
  std::optional<std::size_t> find(StateColumnHead const& head) const {
    auto const full = places_.find(head.text()), bare = places_.find(head.name);
    if (full == places_.end() && bare == places_.end()) refuse_other_unit(head);
    if (!head.unit.empty() && full != places_.end() && bare != places_.end())
      throw InvalidInput("table.columns", {ErrorObject{"state_from"}, ": the columns \"", head.name, "\" and \"",
                                           head.text(), "\" contain the same quantity. Remove one of them."});
    if (full != places_.end()) return full->second;
    return bare != places_.end() ? std::optional(bare->second) : std::nullopt;
  }

 private:
  template <class = void>
  void refuse_other_unit(StateColumnHead const& head) const {
    if (head.unit.empty()) return;
    for (auto const& [column, place] : places_)
      if (column.starts_with(head.name + " [") && column.ends_with(']'))
        throw InvalidInput("table.unit",
                           {"state_from: the unit of the column \"", ErrorObject{column}, "\" is not [", head.unit,
                            "]. Convert its numbers and rename the column to \"", head.text(), "\"."});
  }

  std::unordered_map<std::string, std::size_t> places_;
};

template <class = void>
std::vector<std::string> state_columns(ModelLayout const& layout) {
  std::vector<std::string> texts;
  for (StateColumnHead const& head : StateHeads(layout).all) texts.push_back(head.text());
  return texts;
}

template <class = void>
Table state_table(ModelLayout const& layout, std::vector<State> const& states) {
  Table table{state_columns(layout), {}};
  for (State const& x : states) {
    require_sizes(x, layout.coordinates, layout.velocities, layout.rows);
    auto& row = table.rows.emplace_back(1, x.t);
    for (VecX const* const part : {&x.q, &x.v, &x.lambda})
      row.insert(row.end(), part->data(), part->data() + part->size());
  }
  return table;
}

template <class = void>
State state_from(ModelLayout const& layout, Table const& table, std::size_t row) {
  if (row >= table.rows.size())
    throw InvalidInput("table.row", {ErrorObject{"state_from"}, ": row ", ErrorValue{row},
                                     " does not exist; the table has ", table.rows.size(), " rows, counted from 0."});
  StateColumns const columns(table);
  StateHeads const heads(layout);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < heads.all.size(); ++i) {
    std::optional<std::size_t> const found = columns.find(heads.all[i]);
    if (!found && i < heads.required)
      throw InvalidInput(
          "table.no_column",
          {"state_from: the table has no column \"", ErrorObject{heads.all[i].text()},
           "\". A state needs the time and every coordinate and velocity of its model; state_columns lists them."});
    numbers.push_back(found ? table.rows[row].at(*found) : 0.0);
  }
  auto next = numbers.begin() + 1;
  auto const take = [&](Index count) {
    VecX part(count);
    std::copy_n(next, count, part.data());
    next += count;
    return part;
  };
  State x;
  x.t = numbers.front();
  x.q = take(layout.coordinates);
  x.v = take(layout.velocities);
  x.a = VecX::Zero(layout.velocities);
  x.lambda = take(layout.rows);
  return x;
}

}  // namespace detail

/// Heads of the columns of a state of a model. The first is "t [s]". The coordinates of all bodies follow ("rod q[0]
/// [m]", …), then their velocities ("rod v[0] [m/s]", …). Then come the first-order states of forces ("valve z[0]",
/// …) and the multipliers of the constraint equations ("pin lambda[0]", …). The order within a body is given in the
/// body's header. Units are those that a body provides (HasCoordinateUnits). Heads of first-order states and
/// multipliers have no unit.
template <class M>
std::vector<std::string> state_columns(M const& model) {
  return detail::state_columns(layout_of(model));
}

/// Table of states of a model, with one row per state.
/// \throws InvalidInput for a state that does not fit the model.
template <class M>
Table state_table(M const& model, std::vector<State> const& states) {
  return detail::state_table(layout_of(model), states);
}

/// Returns the state in a `row`, counted from 0, of a table. The table contains the columns of `state_columns` in any
/// order, with or without units, and possibly other columns. Columns of multipliers are optional; missing multipliers
/// are zero. Accelerations are zero. `simulate` computes multipliers and accelerations.
/// \throws InvalidInput with the name of a column that is missing, duplicate or in another unit, and for a row that
/// does not exist.
template <class M>
State state_from(M const& model, Table const& table, std::size_t row) {
  return detail::state_from(layout_of(model), table, row);
}

}  // namespace polybody
