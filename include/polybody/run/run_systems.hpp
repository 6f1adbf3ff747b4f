#pragma once
#include <memory>

#include <polybody/system/system.hpp>

namespace polybody {

/// Systems of a run: the integrated one, and the full one if policies eliminate unknowns.
struct RunSystems {
  std::unique_ptr<System> stepped;  ///< integrated system; its address must not change, since workspaces store it
  std::unique_ptr<System> full;     ///< full system; null if policies eliminate nothing
};

}  // namespace polybody
