#pragma once
/// \file
/// States as rows of named columns, for other programs to read and to write. Checkpoints (io/checkpoint.hpp) keep more:
/// what a run needs to go on with the same bits.
///
/// Not in polybody.hpp: few programs exchange states with others.

#include <unordered_map>

#include <polybody/io/table.hpp>
#include <polybody/run/fitting.hpp>
#include <polybody/system/model_entries.hpp>

namespace polybody {

namespace detail {

/// The heads of a state's columns, in the order of t, q, v, λ.
struct StateHeads {
  std::vector<std::string> all;
  std::size_t required;  ///< those before it make a state; multipliers are zero where they are not there

  template <class = void>  // compiled where it is used
  explicit StateHeads(ModelLayout const& layout)
      : all(std::size_t(1 + layout.coordinates + layout.speeds + layout.rows), "t [s]"),
        required(std::size_t(1 + layout.coordinates + layout.speeds)) {
    Index const q = 1, v = q + layout.coordinates, lambda = v + layout.speeds;
    for (BodyPlace const& b : layout.bodies) {
      name(b.name, "q", q + b.q0, b.coordinates);
      name(b.name, "v", v + b.v0, b.speeds);
      name(b.name, "lambda", lambda + b.row, b.rows);
    }
    for (ForcePlace const& f : layout.forces) name(f.name, "z", v + f.v0, f.states);
    for (JointPlace const& j : layout.joints) name(j.name, "lambda", lambda + j.row, j.rows);
  }

 private:
  /// "rod q[0]", "rod q[1]", … for `count` numbers of one owner.
  void name(std::string const& owner, char const* what, Index first, Index count) {
    for (Index i = 0; i < count; ++i) all[std::size_t(first + i)] = owner + ' ' + what + '[' + std::to_string(i) + ']';
  }
};

template <class = void>
Table state_table(ModelLayout const& layout, std::vector<State> const& states) {
  Table table{StateHeads(layout).all, {}};
  for (State const& x : states) {
    require_sizes(x, layout.coordinates, layout.speeds, layout.rows);
    auto& row = table.rows.emplace_back(1, x.t);
    for (VecX const* const part : {&x.q, &x.v, &x.lambda})
      row.insert(row.end(), part->data(), part->data() + part->size());
  }
  return table;
}

template <class = void>
State state_from(ModelLayout const& layout, Table const& table, std::size_t row) {
  if (row >= table.rows.size())
    throw InvalidInput{"state_from: row ", row, " is asked of a table of ", table.rows.size(), ", counted from 0."};
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t j = 0; j < table.columns.size(); ++j)
    if (!places.emplace(table.columns[j], j).second)
      throw InvalidInput{"state_from: two columns are called \"", table.columns[j], "\"."};
  StateHeads const heads(layout);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < heads.all.size(); ++i) {
    auto const found = places.find(heads.all[i]);
    if (found == places.end() && i < heads.required)
      throw InvalidInput{"state_from: the table has no column \"", heads.all[i],
                         "\". A state needs the time and every coordinate and speed of its model; see state_columns."};
    numbers.push_back(found == places.end() ? 0.0 : table.rows[row].at(found->second));
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
  x.v = take(layout.speeds);
  x.a = VecX::Zero(layout.speeds);
  x.lambda = take(layout.rows);
  return x;
}

}  // namespace detail

/// The heads of a state's columns: "t [s]", then for each body its coordinates ("rod q[0]", …), for each body its
/// speeds
/// ("rod v[0]", …), first-order states of forces ("valve z[0]", …), multipliers of the rows ("pin lambda[0]", …). Their
/// order within a body, and their units, are those that the body's header names.
template <class M>
std::vector<std::string> state_columns(M const& model) {
  return detail::StateHeads(layout_of(model)).all;
}

/// States of a model, one row each. \throws InvalidInput for a state that does not fit the model.
template <class M>
Table state_table(M const& model, std::vector<State> const& states) {
  return detail::state_table(layout_of(model), states);
}

/// The state in a row of a table with these columns, in any order, among others. Multipliers may be left out, and are
/// zero then; accelerations are zero, and `simulate` finds both. \throws InvalidInput naming a column that is missing
/// or there twice, and for a row that is not there.
template <class M>
State state_from(M const& model, Table const& table, std::size_t row) {
  return detail::state_from(layout_of(model), table, row);
}

}  // namespace polybody
