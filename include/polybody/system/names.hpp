#pragma once
/// \file
/// What the bodies, joints or forces of a model are called: each otherwise.

#include <algorithm>
#include <string>
#include <vector>

#include <polybody/math/errors.hpp>

namespace polybody::detail {

class Names {
 public:
  /// The name as it is given; where it is empty, "kind n" for the first n > `before` of which that is free.
  template <class = void>  // compiled where it is used
  [[gnu::cold]] std::string given_or_next(std::string name, char const* kind, std::size_t before) const {
    for (bool const automatic = name.empty(); name.empty() || (automatic && has(name));)
      name = kind + (" " + std::to_string(++before));
    return name;
  }
  /// \throws InvalidInput when something is called so already. \param what "body", "joint" or "force"
  template <class = void>
  void require_free(std::string const& name, char const* what) const {
    if (has(name))
      throw InvalidInput{"There is a ", what, " \"", name,
                         "\" already, and messages, records and files tell them apart by their names. Give each its "
                         "own, or none and it gets one."};
  }
  template <class = void>
  [[gnu::cold]] void take(std::string const& name) {
    sorted_.insert(std::lower_bound(sorted_.begin(), sorted_.end(), name), name);
  }

 private:
  bool has(std::string const& name) const { return std::binary_search(sorted_.begin(), sorted_.end(), name); }

  std::vector<std::string> sorted_;
};

}  // namespace polybody::detail
