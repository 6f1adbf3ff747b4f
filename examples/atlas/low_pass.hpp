#pragma once
// Low-pass filter of an output, evaluated during a run.
#include <cmath>
#include <complex>
#include <numbers>

namespace atlas {

// Butterworth filter of second order. The samples u come in the order of their times, and u is linear between them:
//   y = 2 Re z,  ż = p z + r u,  p = ω (−1 + i)/√2,  r = −i ω/√2
// The run begins at t = 0 with y = 0. The filter delays a slow signal by √2/ω.
class LowPass {
 public:
  // \param cut_off frequency at which the amplitude is 1/√2 [Hz]
  explicit LowPass(double cut_off) {
    double const omega = std::sqrt(2.0) * std::numbers::pi * cut_off;  // ω/√2
    p_ = {-omega, omega};
    r_ = {0.0, -omega};
  }

  // Adds the sample u at the time t [s]. Returns the filtered value.
  double operator()(double t, double u) {
    if (double const h = t - t_; h > 0.0) {
      std::complex<double> const decay = std::exp(p_ * h), constant = (decay - 1.0) / p_,
                                 linear = (constant - h) / (p_ * h);
      z_ = decay * z_ + r_ * (u_ * constant + (u - u_) * linear);
    }
    t_ = t;
    u_ = u;
    return 2.0 * z_.real();
  }

 private:
  std::complex<double> p_, r_, z_ = 0.0;
  double t_ = 0.0, u_ = 0.0;  // last sample
};

}  // namespace atlas
