// The program of most consumer projects. It includes one header, because these projects test the location of the
// headers. The projects `precompiled` and `compiled` include all installed headers.
#include <polybody/kinematics/frame.hpp>

#include <iostream>

int main() {
  polybody::Frame<double> const frame;
  std::cout << "polybody found, a frame at " << frame.r.transpose() << ", with Eigen " << EIGEN_WORLD_VERSION << '.'
            << EIGEN_MAJOR_VERSION << '\n';
}
