// Euler's columns (S9e) by Lrvf with all four end conditions, and the column bent beyond its buckling load.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include "support/columns.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace euler_columns_test {

using Rod = Lrvf<>;

TEST(EulerColumns, LrvfBucklesAtEulersLoads) {
  columns::buckles_at_eulers_loads<Rod>(8, "Lrvf, 8 to 32 elements extrapolated");
}
TEST(EulerColumns, LrvfStandsBentBeyond) {
  columns::stands_bent_beyond<Rod>(16, "Lrvf, 16 to 64 elements extrapolated");
}

}  // namespace euler_columns_test
