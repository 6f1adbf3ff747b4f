#include <polybody/solvers/auto_lu.hpp>

#include <gtest/gtest.h>

#include <array>

using namespace polybody;

// On both sides of the limit the result is bitwise identical to that of the chosen solver.
TEST(AutoLu, ChoosesBySize) {
  for (Index const size : {AutoLu::limit - 1, AutoLu::limit, AutoLu::limit + 1}) {
    MatX const a = MatX::Random(size, size) + 10.0 * MatX::Identity(size, size);
    VecX const b = VecX::Random(size);
    auto const answer = [&](auto solver) {
      solver.analyse(size, std::array{Block{0, 0, size, size}});
      solver.begin();
      solver.add(0, 0, a);
      EXPECT_EQ(solver.factor(), -1);
      VecX x(size);
      solver.solve(b, x);
      return x;
    };
    VecX const chosen = answer(AutoLu());
    EXPECT_LT((a * chosen - b).norm(), 1e-11);
    bool const small = size <= AutoLu::limit;
    EXPECT_EQ(chosen, small ? answer(DenseLu()) : answer(EigenSparseLu())) << size;
    EXPECT_NE(chosen, small ? answer(EigenSparseLu()) : answer(DenseLu())) << size << ": cannot tell";
  }
}
