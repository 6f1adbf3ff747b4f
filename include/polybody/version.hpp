#pragma once
/// \file
/// Version number of the library.

namespace polybody {

/// Version of polybody. CMake, pkg-config and the packages read it from this file. A minor version 0.x may change the
/// interface; CHANGELOG.md lists such changes.
inline constexpr char const* library_version = "0.2.0";

}  // namespace polybody
