#pragma once
/// \file Messages of errors for refused input.

#include <gtest/gtest.h>

#include <polybody/math/errors.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace polybody {

/// The message of the E that `act` throws; a test failure if it throws no exception or another one.
template <class E, class Act>
std::string message_of(Act&& act) {
  try {
    act();
  } catch (E const& error) {
    return error.what();
  } catch (std::exception const& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return "";
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

/// The message of the InvalidInput that `act` throws.
template <class Act>
std::string refusal(Act&& act) {
  return message_of<InvalidInput>(std::forward<Act>(act));
}

/// `text` contains `part`.
inline testing::AssertionResult has(std::string_view text, std::string_view part) {
  if (text.find(part) != std::string_view::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '\'' << part << "' is not in '" << text << '\'';
}

}  // namespace polybody
