#pragma once

namespace polybody {

/// The version of these headers; CMake, pkg-config and packages take theirs from here. Before 1.0 a minor version may
/// change what programs see, which CHANGELOG.md says.
inline constexpr char const* library_version = "0.2.0";

}  // namespace polybody
