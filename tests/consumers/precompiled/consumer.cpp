// A program that includes the whole library through its umbrella.
#include <polybody/polybody.hpp>

#include <iostream>

int main() { std::cout << "polybody found, with Eigen " << EIGEN_WORLD_VERSION << '.' << EIGEN_MAJOR_VERSION << '\n'; }
