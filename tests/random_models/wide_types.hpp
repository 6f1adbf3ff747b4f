#pragma once
/// \file
/// The wide model types, each in a file of its own.

#include "random_models/realise.hpp"

namespace polybody::random_models {

inline constexpr int wide_types = 12, number_of_trees_by_augmented = 6;  ///< seed s is of type s mod 12

WideType rigid_joints();
WideType ancf_joints();
WideType frame_and_rotation_joints();
WideType penalties();
WideType bushings();
WideType policies_of_bodies();
WideType trees_by_augmented();
WideType trees_by_bodies();
WideType linear_joints();
WideType planar_joints();
WideType planar_policies();

/// All of them; seed s is of type s mod 12.
std::vector<WideType> all_wide_types();

}  // namespace polybody::random_models
