// Many random models: the largest residual of each check with its seed, and the number of occurrences of each pair.
//   run_random_models [--models N] [--seed S] [--type K]    N models from seed S on; K: only those of one wide type
// A seed determines its model: --models 1 --seed S prints it and all its residuals.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "random_models/checks.hpp"
#include "random_models/wide_types.hpp"

using namespace polybody;
using namespace polybody::random_models;

namespace {

struct Worst {
  double value = -1.0, tolerance = 0.0;
  std::uint64_t seed = 0;
};

struct Sums {
  std::map<std::string, Worst> worst;
  long models = 0, wrong = 0, refused = 0, from_reference = 0, redundant = 0, singular = 0, failures = 0;

  void add(Outcome const& o, WideType const& type) {
    ++models;
    from_reference += o.from_reference;
    refused += o.refused;
    redundant += o.redundant;
    singular += o.singular;
    failures += o.failures;
    for (Residual const& r : o.residuals)
      if (Worst& w = worst[r.check]; !(r.value <= w.value)) w = {r.value, r.tolerance, o.seed};
    if (o.right()) return;
    if (++wrong > 40) return;
    std::printf("seed %llu, %s: %s", static_cast<unsigned long long>(o.seed), type.name, o.error.c_str());
    for (Residual const& r : o.residuals)
      if (!(r.value <= r.tolerance)) std::printf(" | %s %.3g", r.check, r.value);
    std::printf("\n");
  }

  void print() const {
    std::printf(
        "%ld models, %ld wrong; %ld refused, %ld started from their reference, %ld with rows that repeat, %ld nearly "
        "singular; %ld steps failed as they were made to\n\n| check | worst | tolerated | seed |\n|---|---|---|---|\n",
        models, wrong, refused, from_reference, redundant, singular, failures);
    for (auto const& [check, w] : worst)
      std::printf("| %s | %.2g | %.0g | %llu |\n", check.c_str(), w.value, w.tolerance,
                  static_cast<unsigned long long>(w.seed));
  }
};

/// Prints each table; returns the number of pairs that the types offer and that occurred less than 20 times.
long print(Pairs const& pairs) {
  long rare = 0;
  for (auto const& [table, cells] : pairs) {
    std::printf("\n%s: %zu pairs\n", table.c_str(), cells.size());
    std::string row;
    for (auto const& [cell, count] : cells) {
      if (cell.first != row) std::printf("%s%s:", row.empty() ? "" : "\n", cell.first.c_str());
      row = cell.first;
      std::printf(" %s %ld;", cell.second.c_str(), count);
      rare += count < 20;
    }
    std::printf("\n");
  }
  return rare;
}

/// Adds all pairs that the types offer, with zero occurrences.
void add_offered(WideType const& type, Pairs& pairs) {
  Kinds const& k = type.kinds;
  auto const name = [&](int body) -> std::string {
    return body == ground ? "the ground" : k.bodies[std::size_t(body)].name;
  };
  for (Pairing const& p : k.joint_pairs) {
    JointKind const& kind = k.joints[std::size_t(p.kind)];
    pairs["geometry, policy"][{kind.geometry, kind.policy}];
    for (int const body : {p.a, p.b}) {
      if (std::string(kind.policy) == "Constraint") pairs["geometry by Constraint, body"][{kind.geometry, name(body)}];
      pairs["policy, body"][{kind.policy, name(body)}];
    }
  }
  for (Pairing const& p : k.force_pairs) pairs["force, body"][{k.forces[std::size_t(p.kind)].name, name(p.a)}];
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t models = 12000, seed = 1;
  int only = -1;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--models") == 0) models = std::strtoull(argv[i + 1], nullptr, 10);
    if (std::strcmp(argv[i], "--seed") == 0) seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (std::strcmp(argv[i], "--type") == 0) only = std::atoi(argv[i + 1]);
  }
  std::vector<WideType> const types = all_wide_types();
  Sums sums;
  Pairs pairs;
  for (WideType const& type : types) add_offered(type, pairs);
  for (std::uint64_t s = seed; s < seed + models; ++s) {
    std::size_t const k = std::size_t(s % types.size());
    if (only >= 0 && k != std::size_t(only)) continue;
    count_pairs(s, int(types.size()), types[k], pairs);
    Outcome const o = examine(s, int(types.size()), types[k]);
    sums.add(o, types[k]);
    if (models == 1) {
      std::printf("%s\n%s", types[k].name, draw(s, int(types.size()), types[k].kinds).text(types[k].kinds).c_str());
      for (Residual const& r : o.residuals) std::printf("  %s: %.3g of %.0g\n", r.check, r.value, r.tolerance);
    }
  }
  sums.print();
  long const rare = models == 1 ? 0 : print(pairs);
  if (models >= 10000 && only < 0) std::printf("\n%ld pairs were met less than 20 times\n", rare);
  return sums.wrong == 0 && (models < 10000 || only >= 0 || rare == 0) ? 0 : 1;
}
