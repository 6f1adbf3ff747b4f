#pragma once
#include <memory>

#include <polybody/system/system.hpp>

namespace polybody {

/// What a run steps, and the whole mechanism where policies eliminate unknowns of it.
struct RunSystems {
  std::unique_ptr<System> stepped;  ///< what is stepped; by address, as workspaces refer to it
  std::unique_ptr<System> full;     ///< null where policies eliminate nothing
};

}  // namespace polybody
