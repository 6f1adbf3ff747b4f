#pragma once
/// \file
/// What an input that must be refused is told.

#include <gtest/gtest.h>

#include <polybody/math/errors.hpp>
#include <string>

namespace polybody {

/// The message of the InvalidInput that `act` throws; a test failure where it throws none or another.
template <class Act>
std::string refusal(Act&& act) {
  try {
    act();
  } catch (InvalidInput const& error) {
    return error.what();
  } catch (std::exception const& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return "";
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

/// `text` contains `part`.
inline testing::AssertionResult has(std::string const& text, std::string const& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '\'' << part << "' is not in '" << text << '\'';
}

}  // namespace polybody
