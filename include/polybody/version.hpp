#pragma once

namespace polybody {

/// Version of these headers, which CMake, pkg-config and packages read from here. In 0.x a minor version may change
/// the interface; CHANGELOG.md lists such changes.
inline constexpr char const* library_version = "0.2.0";

}  // namespace polybody
