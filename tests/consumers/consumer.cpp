// The program that most consumer projects build: one header, as these projects are about where the headers are found.
// Those that include all of the installed ones are `precompiled` and `compiled`.
#include <polybody/kinematics/frame.hpp>

#include <iostream>

int main() {
  polybody::Frame<double> const frame;
  std::cout << "polybody found, a frame at " << frame.r.transpose() << ", with Eigen " << EIGEN_WORLD_VERSION << '.'
            << EIGEN_MAJOR_VERSION << '\n';
}
