#pragma once
/// \file
/// Finite element matrices from the files of Abaqus, Ansys, CalculiX and Nastran and from Matrix Market files: nodes,
/// mass matrix and stiffness, their checks, and the structure of a floating frame of reference (`Ffr`).

#include <polybody/bodies/fe/abaqus_files.hpp>
#include <polybody/bodies/fe/ansys_files.hpp>
#include <polybody/bodies/fe/calculix_files.hpp>
#include <polybody/bodies/fe/fe_checks.hpp>
#include <polybody/bodies/fe/fe_matrix.hpp>
#include <polybody/bodies/fe/fe_text.hpp>
#include <polybody/bodies/fe/fe_units.hpp>
#include <polybody/bodies/fe/matrix_market.hpp>
#include <polybody/bodies/fe/nastran_cards.hpp>
#include <polybody/bodies/fe/op4_file.hpp>
