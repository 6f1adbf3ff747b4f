#pragma once
/// \file
/// Low-pass filter (without phase shift) and amplitude spectrum of equally spaced samples, both by Fourier sums;
/// resampling at equal steps.
/// Theory: Eqs. 11.20 to 11.23.

#include <algorithm>
#include <complex>
#include <concepts>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <unsupported/Eigen/FFT>

#include <polybody/signals/samples.hpp>

namespace polybody {

namespace detail {

/// Time step of equally spaced samples [s]. The intervals may differ from their median by 0.1 %. \throws InvalidInput
/// for larger differences.
template <class = void>
double equal_step(std::span<double const> times, std::string const& who) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  std::vector<double> sorted = intervals;
  auto const middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  for (std::size_t i = 0; i < intervals.size(); ++i)
    if (std::abs(intervals[i] - *middle) > 1e-3 * *middle)
      throw InvalidInput(
          "samples.spacing",
          {ErrorObject{who}, ": the samples at ", times[i], " s and ", times[i + 1], " s are ",
           ErrorValue{intervals[i]}, " s apart, but the median interval is ", *middle,
           " s. Resample them by resampled(times, values, step) of signals/filter.hpp, or record in equal steps."});
  return (times.back() - times.front()) / double(intervals.size());
}

using HalfSpectrum = std::vector<std::complex<double>>;  ///< coefficients at the frequencies 0, 1/T, … up to the
                                                         ///< Nyquist frequency, with the period T

template <class = void>
HalfSpectrum fourier_terms(std::vector<double> const& values) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  HalfSpectrum terms;
  fft.fwd(terms, values);
  return terms;
}

}  // namespace detail

/// Resamples `values` at t₀, t₀ + step, … by linear interpolation, with the first of the `times` t₀. Frequencies above
/// half of the new sampling rate alias; histories with such frequencies require a smaller step.
/// \param step time step of the result [s] \param largest_gap largest interval between given samples that is
/// interpolated [s]; 0: 1.5 times `step`
/// \throws InvalidInput for fewer than two samples, for samples that are not finite, for times that do not increase,
/// for larger gaps, for a step that is not positive, for a negative `largest_gap`, and for more than 10⁹ samples.
template <class = void>
std::vector<double> resampled(std::span<double const> times, std::span<double const> values, double step,
                              double largest_gap = 0.0) {
  detail::require_history(times, values, 2, "resampled");
  require_positive(step, "resampled: the step");
  require_not_negative(largest_gap, "resampled: the largest gap");
  double const gap = largest_gap > 0.0 ? largest_gap : 1.5 * step;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] - times[i - 1] > gap)
      throw InvalidInput("samples.gap", {ErrorObject{"resampled"}, ": there is no sample between ", times[i - 1],
                                         " s and ", times[i], " s, a gap of more than ", ErrorValue{gap},
                                         " s. Set largest_gap to the longest interval that may be interpolated."});
  double const steps = (times.back() - times.front()) / step + 1e-6;
  if (!(steps < 1e9))
    throw InvalidInput("samples.too_many",
                       {ErrorObject{"resampled"}, ": a step of ", ErrorValue{step}, " s divides ",
                        times.back() - times.front(), " s into more than 1e9 samples. Choose a longer step."});
  std::size_t const count = std::size_t(steps) + 1;
  std::vector<double> out;
  std::size_t after = 1;
  for (std::size_t i = 0; i < count; ++i) {
    double const t = times.front() + double(i) * step;
    while (after + 1 < times.size() && times[after] < t) ++after;
    double const share = std::min((t - times[after - 1]) / (times[after] - times[after - 1]), 1.0);
    out.push_back((1.0 - share) * values[after - 1] + share * values[after]);
  }
  return out;
}

/// Low-pass filter that preserves frequencies up to the cut-off f_c in amplitude and phase, and removes higher
/// frequencies. The filter multiplies the Fourier sum of the whole record by the transfer function H,
///   y(t) = Σ_k H(f_k) c_k e^{2πi f_k t},   f_k = k/T.
/// c_k are the Fourier coefficients, and T is the period. H is 1 up to the cut-off and 0 above it. With a roll-off w, H
/// decreases from f_c to f_c + w as ½(1 + cos π(f − f_c)/w).
///
/// The Fourier sum is periodic; its period is the length of the record. If the ends of the record differ, a sharp
/// cut-off causes ringing at the ends. With `mirrored`, one period consists of the record and its mirror image: a
/// continuous function with a kink at the ends. A roll-off makes ringing decay sooner.
struct LowPass {
  Required<double> cut_off;  ///< cut-off f_c [Hz]
  double roll_off = 0.0;     ///< roll-off w [Hz]
  bool mirrored = false;     ///< true: one period consists of the record and its mirror image

  /// Transfer function H at f [Hz].
  double share(double f) const {
    if (f <= cut_off * (1.0 + 1e-12)) return 1.0;
    return f < cut_off + roll_off ? 0.5 * (1.0 + std::cos(std::numbers::pi * (f - cut_off) / roll_off)) : 0.0;
  }
};

/// Applies the low-pass filter `filter` to the history `values`. The computing time increases with the largest
/// prime factor of the number of samples. Long records should have a number of samples with small prime factors.
/// \param times equally spaced [s]
/// \throws InvalidInput for fewer than four samples, for samples that are not finite or not equally spaced, for a
/// cut-off of zero or less, above the Nyquist frequency, or with a period longer than the record, and for a negative
/// roll-off.
template <class = void>
std::vector<double> low_pass(std::span<double const> times, std::span<double const> values, LowPass const& filter) {
  detail::require_history(times, values, 4, "low_pass");
  require_positive(filter.cut_off, "low_pass: the cut-off");
  require_not_negative(filter.roll_off, "low_pass: the roll-off");
  double const step = detail::equal_step(times, "low_pass"), nyquist = 0.5 / step;
  if (filter.cut_off > nyquist * (1.0 + 1e-9))
    throw InvalidInput("filter.cut_off", {ErrorObject{"low_pass"}, ": the cut-off of ", ErrorValue{filter.cut_off},
                                          " Hz is above the Nyquist frequency of ", nyquist, " Hz for samples ", step,
                                          " s apart. Record in smaller steps or lower the cut-off."});
  if (filter.cut_off * step * double(values.size()) < 1.0)
    throw InvalidInput("filter.cut_off",
                       {ErrorObject{"low_pass"}, ": the record of ", ErrorValue{step * double(values.size())},
                        " s is shorter than a period of the cut-off, ", 1.0 / filter.cut_off,
                        " s. Record for longer or raise the cut-off."});

  std::vector<double> period(values.begin(), values.end());
  if (filter.mirrored) period.insert(period.end(), values.rbegin() + 1, values.rend() - 1);
  double mean = 0.0;
  for (double const x : period) mean += x / double(period.size());
  for (double& x : period) x -= mean;
  detail::HalfSpectrum terms = detail::fourier_terms(period);
  for (std::size_t k = 0; k < terms.size(); ++k) terms[k] *= filter.share(double(k) / (step * double(period.size())));
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.inv(period, terms, Eigen::Index(period.size()));
  period.resize(values.size());
  for (double& x : period) x += mean;
  return period;
}

/// Window function of a spectrum: weight of a sample at the relative position x ∈ [0, 1) in the record.
template <class W>
concept SpectralWindow = requires(double x) {
  { W::weight(x) } -> std::convertible_to<double>;
};
/// Rectangular window with weight one, exact if the record contains whole periods.
struct EqualWeights {
  static double weight(double) { return 1.0; }  ///< one at all positions
};
/// Hann window sin²πx with little leakage beyond neighbouring frequencies. The error of an amplitude between two
/// frequencies is up to −15 % [Harris 1978].
struct HannWindow {
  /// Weight at the relative position x of the record.
  static double weight(double x) { return 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * x)); }
};

/// Amplitude spectrum: x(t) = Σ_k a_k cos(2π f_k t + φ_k), a₀ = |mean|.
struct Spectrum {
  std::vector<double> frequencies;  ///< frequencies f_k [Hz]
  std::vector<double> amplitudes;   ///< amplitudes a_k, one per frequency [unit of the samples]
};

/// Amplitude spectrum of equally spaced samples `values` at `times` [s]. a₀ is |mean|. The other amplitudes are those
/// of the values x_i without the mean, weighted with a window w: a_k = 2|Σ_i w_i x_i e^{−2πi k i/n}|/Σ_i w_i (without
/// the factor 2 at the Nyquist frequency). \throws InvalidInput for fewer than four samples, and for samples that are
/// not finite or not equally spaced.
template <SpectralWindow W = HannWindow>
Spectrum amplitude_spectrum(std::span<double const> times, std::span<double const> values, W const& = {}) {
  detail::require_history(times, values, 4, "amplitude_spectrum");
  double const step = detail::equal_step(times, "amplitude_spectrum");
  std::size_t const n = values.size();
  double mean = 0.0, total = 0.0;
  for (double const x : values) mean += x / double(n);
  std::vector<double> weighted;
  for (std::size_t i = 0; i < n; ++i) {
    double const w = W::weight(double(i) / double(n));
    weighted.push_back(w * (values[i] - mean));
    total += w;
  }
  detail::HalfSpectrum const terms = detail::fourier_terms(weighted);
  Spectrum out;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    out.frequencies.push_back(double(k) / (step * double(n)));
    out.amplitudes.push_back((2 * k == n ? 1.0 : 2.0) * std::abs(terms[k]) / total);
  }
  out.amplitudes.front() = std::abs(mean);
  return out;
}

}  // namespace polybody
