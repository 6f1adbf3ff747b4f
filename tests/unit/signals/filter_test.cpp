// Filters and spectra of histories. The references are closed forms: sums of sines with or without a whole number of
// periods in the record.
#include <polybody/signals/filter.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace filter_test {

using namespace polybody;
constexpr double pi = std::numbers::pi;

/// n samples of f(t) at equal steps from t = 2 s on.
struct Record {
  std::vector<double> times, values;
  template <class F>
  Record(int n, double step, F&& f) {
    for (int i = 0; i < n; ++i) {
      times.push_back(2.0 + i * step);
      values.push_back(f(times.back()));
    }
  }
};

double worst(std::vector<double> const& a, std::vector<double> const& b, std::size_t skip = 0) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0.0;
  for (std::size_t i = skip; i + skip < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// 5 Hz and 40 Hz have whole numbers of periods in 1 s. The number of samples is even, odd, prime or a power of two.
TEST(LowPass, KeepsWhatIsBelowInSizeAndPhaseAndRemovesWhatIsAbove) {
  for (int const n : {1000, 1001, 997, 1024, 90}) {
    double const step = 1.0 / n;
    auto const slow = [](double t) { return 1e3 + 3.0 * std::sin(2 * pi * 5 * t + 0.7); };
    Record const both(n, step, [&](double t) { return slow(t) + 2.0 * std::cos(2 * pi * 40 * t - 0.2); }),
        below(n, step, slow);
    EXPECT_LT(worst(low_pass(both.times, both.values, {.cut_off = 30.0}), below.values), 1e-11) << n;
    EXPECT_LT(worst(low_pass(both.times, both.values, {.cut_off = 40.0}), both.values), 1e-11)
        << n;  // the cut-off frequency itself is kept
    EXPECT_LT(worst(low_pass(both.times, both.values, {.cut_off = 4.0}), std::vector<double>(std::size_t(n), 1e3)),
              1e-11)
        << n;
  }
}

// Cosine roll-off between 30 and 50 Hz: H(35), H(40), H(45) = ½(1 + cos(π/4)), ½, ½(1 − cos(π/4)).
TEST(LowPass, RollsOffAsACosine) {
  LowPass const filter{.cut_off = 30.0, .roll_off = 20.0};
  double const high = 0.5 * (1 + std::sqrt(0.5)), low = 1.0 - high;
  for (auto const& [f, share] :
       {std::pair(30.0, 1.0), {35.0, high}, {40.0, 0.5}, {45.0, low}, {50.0, 0.0}, {60.0, 0.0}}) {
    Record const x(500, 0.002, [f = f](double t) { return std::sin(2 * pi * f * t + 1.0); });
    std::vector<double> expected;
    for (double const v : x.values) expected.push_back(share * v);
    EXPECT_LT(worst(low_pass(x.times, x.values, filter), expected), 1e-12) << f;
  }
}

// The periodic continuation of a ramp jumps by its height at the ends and rings (Gibbs: half of the jump at the ends
// themselves). The mirrored ramp is a triangle wave of period T′ = 2T with terms 4/(πk)² for odd k only. The terms
// beyond f_c = m/T′ sum up to less than 2/(π²(m − 1)) of the height.
TEST(LowPass, MirroredRecordsDoNotRingAtTheEnds) {
  int const n = 1001;
  Record const ramp(n, 1e-3, [](double t) { return 7.0 + (t - 2.0); });
  double const m = 2 * 30.0;
  std::vector<double> const plain = low_pass(ramp.times, ramp.values, {.cut_off = 30.0});
  EXPECT_GT(worst(plain, ramp.values), 0.4);
  std::vector<double> const mirrored = low_pass(ramp.times, ramp.values, {.cut_off = 30.0, .mirrored = true});
  EXPECT_LT(worst(mirrored, ramp.values), 2.0 / (pi * pi * (m - 1)));
  // the mirrored continuation of a cosine with a whole number of half periods in the record is periodic
  for (int const count : {1001, 1000}) {
    double const length = (count - 1) * 1e-3;
    Record const half(count, 1e-3, [&](double t) { return std::cos(pi * 7 * (t - 2.0) / length); });
    EXPECT_LT(worst(low_pass(half.times, half.values, {.cut_off = 10.0, .mirrored = true}), half.values), 1e-12);
  }
}

// Parseval: Σ x²/n = a₀² + ½ Σ a_k² + a_N², with the last term for even n only.
TEST(AmplitudeSpectrum, KeepsTheMeanSquare) {
  for (int const n : {600, 601}) {
    Record const x(n, 0.01, [](double t) { return 0.3 + std::exp(-t) * std::sin(40 * t) + std::fmod(7919 * t, 1.0); });
    Spectrum const s = amplitude_spectrum(x.times, x.values, EqualWeights{});
    ASSERT_EQ(s.amplitudes.size(), std::size_t(n / 2 + 1));
    double mean_square = 0.0, sum = 0.0;
    for (double const v : x.values) mean_square += v * v / n;
    for (std::size_t k = 0; k < s.amplitudes.size(); ++k)
      sum += (k == 0 || int(2 * k) == n ? 1.0 : 0.5) * s.amplitudes[k] * s.amplitudes[k];
    EXPECT_NEAR(sum, mean_square, 1e-13);
  }
}

// A sine with a whole number of periods has a peak of its amplitude at its frequency, for every window. The sin²
// window gives half of it at each neighbour.
TEST(AmplitudeSpectrum, PeaksAreAmplitudes) {
  Record const x(2000, 1e-3, [](double t) {
    return -12.0 + 3.0 * std::sin(2 * pi * 30 * t + 0.4) + 0.5 * std::cos(2 * pi * 500 * t);
  });
  Spectrum const plain = amplitude_spectrum(x.times, x.values, EqualWeights{}),
                 hann = amplitude_spectrum(x.times, x.values);
  for (Spectrum const& s : {plain, hann}) {
    EXPECT_NEAR(s.frequencies[60], 30.0, 1e-10);
    EXPECT_NEAR(s.amplitudes[60], 3.0, 1e-12);
    EXPECT_NEAR(s.amplitudes[0], 12.0, 1e-12);
    EXPECT_NEAR(s.amplitudes[1000], 0.5, 1e-12);  // Nyquist frequency
    EXPECT_NEAR(s.amplitudes[200], 0.0, 1e-12);
  }
  EXPECT_NEAR(plain.amplitudes[61], 0.0, 1e-12);
  EXPECT_NEAR(hann.amplitudes[61], 1.5, 1e-12);
}

// Between two frequencies the sin² window gives 8/(3π) = 0.849 of the amplitude, equal weights give 2/π = 0.637
// [Harris 1978]. Far from the peak the sin² window leaks less. The other half of the cosine, at −30.25 Hz, adds some
// 1e-6 and 1e-2.
TEST(AmplitudeSpectrum, TheWindowDecidesWhatLeaks) {
  Record const x(2000, 1e-3, [](double t) { return std::sin(2 * pi * 30.25 * t); });
  Spectrum const plain = amplitude_spectrum(x.times, x.values, EqualWeights{});
  Spectrum const hann = amplitude_spectrum(x.times, x.values, HannWindow{});
  EXPECT_NEAR(plain.amplitudes[60], 2 / pi, 1e-2);
  EXPECT_NEAR(hann.amplitudes[60], 8 / (3 * pi), 1e-4);
  EXPECT_LT(hann.amplitudes[200], 1e-2 * plain.amplitudes[200]);
}

TEST(Resampled, DrawsStraightLines) {
  std::vector<double> const times{0.0, 0.1, 0.15, 0.3, 0.4}, values{1.0, 2.0, 2.5, 4.0, 5.0};  // samples of 1 + 10 t
  std::vector<double> const x = resampled(times, values, 0.1), expected{1.0, 2.0, 3.0, 4.0, 5.0};
  EXPECT_LT(worst(x, expected), 1e-14);
  EXPECT_EQ(resampled(times, values, 0.15).size(), 3u);
  EXPECT_LT(worst(resampled(times, values, 0.05, 0.2), {1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5}), 1e-14);
}

TEST(Filters, RefuseWhatTheyCannotUse) {
  Record const good(100, 0.01, [](double t) { return t; });
  auto const refused = [&](LowPass const& f, auto&& spoil) {
    Record bad = good;
    spoil(bad);
    return refusal([&] { low_pass(bad.times, bad.values, f); });
  };
  auto const as_it_is = [](Record&) {};
  std::string const above = refused({.cut_off = 60.0}, as_it_is);
  EXPECT_TRUE(has(above, "60 Hz") && has(above, "50 Hz") && has(above, "0.01 s"));
  EXPECT_TRUE(has(refused({.cut_off = 0.9}, as_it_is), "shorter than a period"));
  EXPECT_TRUE(has(refused({.cut_off = 0.0}, as_it_is), "the cut-off must be positive"));
  EXPECT_TRUE(has(refused({.cut_off = 5.0, .roll_off = -1.0}, as_it_is), "the roll-off"));
  LowPass const f{.cut_off = 5.0};
  auto const with_a_gap = [](Record& r) { r.times.erase(r.times.begin() + 40), r.values.pop_back(); };
  EXPECT_TRUE(has(refused(f, with_a_gap), "2.39 s and 2.41 s are 0.02 s apart"));
  EXPECT_TRUE(has(refused(f, [](Record& r) { r.times[9] += 1e-4; }), "the median interval is 0.01 s"));
  EXPECT_TRUE(has(refused(f, [](Record& r) { r.times[9] = r.times[8]; }), "times must increase"));
  EXPECT_TRUE(has(refused(f, [](Record& r) { r.values[9] = std::nan(""); }), "sample 9 at t = 2.09 s is not finite"));
  EXPECT_TRUE(has(refused(f, [](Record& r) { r.values.pop_back(); }), "100 times, but 99 values"));
  EXPECT_TRUE(
      has(refused(f, [](Record& r) { r.times.resize(3), r.values.resize(3); }), "samples are needed, but there are 3"));
  std::vector<double> const times{0.0, 0.1, 0.4}, values{0.0, 0.0, 0.0};
  EXPECT_TRUE(has(refusal([&] { resampled(times, values, 0.1); }), "between 0.1 s and 0.4 s"));
  EXPECT_TRUE(has(refusal([&] { resampled(times, values, 0.0); }), "the step"));
  EXPECT_TRUE(has(refusal([&] { resampled(times, values, 1e-300, 1.0); }), "into more than 1e9 samples"));
  EXPECT_TRUE(has(refusal([&] { amplitude_spectrum(times, values); }), "samples are needed"));
}

}  // namespace filter_test
