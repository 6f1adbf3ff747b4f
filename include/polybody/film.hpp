#pragma once
/// \file
/// Films of runs, pictures of modes, and files for ParaView.

#include <polybody/io/film.hpp>
#include <polybody/io/film_forces.hpp>
#include <polybody/io/mode_pictures.hpp>
#include <polybody/io/vtk.hpp>
