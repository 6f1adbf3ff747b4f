#pragma once
/// \file
/// Unique names of the bodies, joints or forces of a model.

#include <functional>
#include <string>

#include <polybody/math/errors.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody::detail {

/// Names in the order of their addition, with a hash table of open addressing for a search in constant time.
class Names {
 public:
  /// Returns a nonempty name unchanged, and "kind n" for an empty name. n is the first number above `before` for which
  /// the name is free.
  template <class = void>  // a template, to be compiled only if it is used
  [[gnu::cold]] std::string given_or_next(std::string name, char const* kind, std::size_t before) {
    if (!name.empty()) return name;
    Run& taken = run_of(kind);
    if (before < taken.from || before > taken.to) taken.from = taken.to = before;
    for (;; ++taken.to)
      if (name = kind + (" " + std::to_string(taken.to + 1)); !has(name)) return name;
  }
  /// \param what "body", "joint" or "force" \throws InvalidInput if the name is in use.
  template <class = void>
  void require_free(std::string const& name, char const* what) const {
    if (has(name))
      throw InvalidInput("model.duplicate_name", {"Duplicate name of a ", what, ": \"", ErrorObject{name},
                                                  "\". Use another name, or leave it empty to have one generated."});
  }
  template <class = void>
  [[gnu::cold]] void take(std::string const& name) {
    names_.push_back(name);
    if (2 * names_.size() <= slots_.size()) {
      slots_[slot_of(name)] = names_.size();
      return;
    }
    slots_.assign(std::max<std::size_t>(4 * names_.size(), 16), 0);
    for (std::size_t i = 0; i < names_.size(); ++i) slots_[slot_of(names_[i])] = i + 1;
  }

 private:
  /// Range of used numbers: "kind n" is in use for from < n ≤ to.
  struct Run {
    std::string kind;
    std::size_t from = 0, to = 0;
  };
  Run& run_of(char const* kind) {
    for (Run& run : runs_)
      if (run.kind == kind) return run;
    runs_.push_back({kind});
    return runs_.back();
  }

  /// Index of the slot of the name, or of the free slot for it.
  std::size_t slot_of(std::string const& name) const {
    std::size_t i = std::hash<std::string>{}(name) % slots_.size();
    while (slots_[i] != 0 && names_[slots_[i] - 1] != name) i = (i + 1) % slots_.size();
    return i;
  }
  bool has(std::string const& name) const { return !slots_.empty() && slots_[slot_of(name)] != 0; }

  Sequence<std::string> names_;
  Sequence<std::size_t> slots_;  ///< for each slot: index into `names_` plus one; zero for a free slot
  Sequence<Run> runs_;           ///< used numbers of each kind
};

}  // namespace polybody::detail
