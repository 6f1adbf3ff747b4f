#pragma once
// The case 'space' of the cantilever, compiled in its own file.
#include <filesystem>

// Prints the distance of the two meshes of a helix and of the 45 degree bend, and its parts, for Lrvf and Se3Beam with
// several meshes. Writes points and a figure of the coarsest meshes to `folder`.
void meshes_in_space(std::filesystem::path const& folder, bool plot);
