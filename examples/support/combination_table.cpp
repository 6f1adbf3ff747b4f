#include "combination_table.hpp"

#include <algorithm>
#include <iostream>

namespace combinations {

FormulationMesh BodyOnPolicy::mesh_of(Index elements, Index modes) const {
  FormulationMesh mesh{.elements = elements};
  if (body.mesh == MeshKind::modes) mesh.modes = modes;
  return mesh;
}

bool is_among(std::string const& name, std::vector<std::string> const& chosen) {
  return std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

std::string name_of(CombinationTable const& table, Choice const& choice) {
  BodyOnPolicy const& row = table.rows[choice.row];
  return row.body.name + ", " + row.policy + ", " + table.integrators[choice.integrator];
}

void print(std::vector<Cells> const& rows, std::size_t left) {
  std::vector<std::size_t> width(rows.front().size(), 0);
  for (Cells const& row : rows)
    for (std::size_t j = 0; j < row.size(); ++j) width[j] = std::max(width[j], row[j].size());
  for (Cells const& row : rows) {
    std::string line;
    for (std::size_t j = 0; j < row.size(); ++j) {
      std::string const space(width[j] - row[j].size(), ' ');
      line += "  " + (j < left ? row[j] + space : space + row[j]);
    }
    std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }
}

void print_list(CombinationTable const& table) {
  std::cout << "Combinations of --body, --policy and --integrator. +: exists; letter: the reason below.\n\n";
  std::vector<Cells> rows{{"body", "policy"}};
  rows[0].insert(rows[0].end(), table.integrators.begin(), table.integrators.end());
  std::vector<std::string> reasons;
  std::size_t exist = 0, refused = 0;
  for (BodyOnPolicy const& one : table.rows) {
    Cells row{one.body.name, one.policy};
    for (std::string const& why : one.refusals) {
      auto const known = std::find(reasons.begin(), reasons.end(), why);
      row.push_back(why.empty() ? "+" : std::string(1, char('a' + (known - reasons.begin()))));
      if (!why.empty() && known == reasons.end()) reasons.push_back(why);
      ++(why.empty() ? exist : refused);
    }
    rows.push_back(std::move(row));
  }
  print(rows, 2);
  std::cout << '\n';
  for (std::size_t i = 0; i < reasons.size(); ++i) std::cout << char('a' + i) << ": " << reasons[i] << '\n';
  std::cout << exist << " combinations exist, " << refused << " do not.\n";
}

std::vector<Choice> choices(CombinationTable const& table, Selection s, std::vector<std::string> const& usual) {
  if (s.bodies.empty()) s.bodies = usual;
  if (s.integrators.empty()) s.integrators = {table.integrators[0]};
  std::vector<Choice> chosen;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    for (std::size_t k = 0; k < table.integrators.size(); ++k) {
      BodyOnPolicy const& row = table.rows[i];
      if (!is_among(row.body.name, s.bodies) || !is_among(table.integrators[k], s.integrators) ||
          !(s.policies.empty() ? row.usual : is_among(row.policy, s.policies)))
        continue;
      if (std::string const& why = row.refusals[k]; !why.empty())
        throw InvalidInput{"\"", ErrorObject{name_of(table, {i, k})}, "\" does not exist. ", why};
      chosen.push_back({i, k});
    }
  return chosen;
}

std::vector<Choice> existing(CombinationTable const& table) {
  std::vector<Choice> all;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    for (std::size_t k = 0; k < table.integrators.size(); ++k)
      if (table.rows[i].refusals[k].empty()) all.push_back({i, k});
  return all;
}

bool run_ten_steps(CombinationTable const& table, std::function<Steps(Choice const&)> const& run) {
  std::vector<Choice> const exist = existing(table);
  std::size_t ran = 0;
  for (Choice const& choice : exist) {
    Steps const done = run(choice);
    if (done.failure.empty() && done.count == 10)
      ++ran;
    else
      std::cout << name_of(table, choice) << ": " << done.count << " steps. " << done.failure << '\n';
  }
  std::cout << ran << " of " << exist.size() << " combinations ran ten steps.\n";
  return ran == exist.size();
}

CombinationStudy::CombinationStudy(Selection const& s, std::size_t output)
    : selection_(s),
      study_({.elements = s.meshes,
              .modes = s.modes,
              .steps = s.steps,
              .tolerances = s.tolerances,
              .errors = s.errors,
              .output = output}) {}

EqualErrorReport CombinationStudy::run() const {
  EqualErrorReport report = study_.run();
  for (std::size_t i = 0; i < added_.size(); ++i) {
    report.formulations[i].family = added_[i].family;
    report.formulations[i].policy = added_[i].enforcement;
  }
  return report;
}

bool print_report(EqualErrorReport const& report) {
  std::cout << report << std::flush;
  for (StudiedFormulation const& f : report.formulations)
    for (StudyRun const& run : f.runs)
      if (run.failure.empty()) return true;
  std::cerr << "Every run of the comparison failed. The lines above give the message of each formulation.\n";
  return false;
}

std::string short_name(CombinationTable const& table, Choice const& choice, Selection const& s) {
  std::string name = table.rows[choice.row].body.name;
  if (!s.policies.empty()) name += ", " + table.rows[choice.row].policy;
  if (!s.integrators.empty()) name += ", " + table.integrators[choice.integrator];
  return name;
}

}  // namespace combinations
