#pragma once
/// \file
/// Comparisons of formulations at equal error, and the reports of all comparisons as tables, figures and web pages.

#include <polybody/compare/equal_error.hpp>
#include <polybody/io/comparison_report.hpp>
#include <polybody/io/equal_error_page.hpp>
