#pragma once
// Law suites of a case with a mistake.

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <polybody/testing/laws.hpp>

namespace polybody::laws {

using Names = std::vector<std::string>;

/// Names of the laws of a suite that apply to a case and that the case breaks.
template <class Laws>
Names broken() {
  Names names;
  for (Law<Laws> const& law : Laws::laws) {
    if (!law.applies) continue;
    ::testing::TestPartResultArray results;
    {
      ::testing::ScopedFakeTestPartResultReporter const caught(
          ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
      Laws laws;
      (laws.*law.holds)();
    }
    bool failed = false;
    for (int i = 0; i < results.size(); ++i) failed = failed || results.GetTestPartResult(i).failed();
    if (failed) names.push_back(law.name);
  }
  return names;
}

}  // namespace polybody::laws
