// Error of the three taps of a plain patch against the mean over the pixel (kPlainFootprint_texels).
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "surface/plan/patch_selection.h"

namespace terrella {
namespace {

constexpr int kFrequencies = 160;
constexpr double kContrast_levels = 30.0;
constexpr double kRounding_levels = 0.05;  // the header states tenths

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

double frequency(int k) { return static_cast<double>(k < kFrequencies / 2 ? k : k - kFrequencies) / kFrequencies; }

/// Response of the taps of patch_plain.frag to a wave, over a pixel of `length` by 1 texels.
std::complex<double> plain_taps(double fx, double fy, double length) {
  const auto tap = [&](double a, double b) {
    return std::polar(1.0, 2.0 * std::numbers::pi * (fx * a * length + fy * b) / 3.0);
  };
  return (tap(-1, 0) + tap(0, 1) + tap(1, -1)) / 3.0;
}

double rms_levels(double length) {
  double power = 0.0;
  double error = 0.0;
  for (int i = 0; i < kFrequencies; ++i) {
    for (int j = 0; j < kFrequencies; ++j) {
      if (i == 0 && j == 0) continue;
      const double fx = frequency(i);
      const double fy = frequency(j);
      const double wave = 1.0 / (fx * fx + fy * fy);
      const double bilinear = std::pow(sinc(fx) * sinc(fy), 2.0);
      const double mean = sinc(fx * length) * sinc(fy);
      power += wave;
      error += std::norm((plain_taps(fx, fy, length) - mean) * bilinear) * wave;
    }
  }
  return kContrast_levels * std::sqrt(error / power);
}

TEST(PlainFootprint, ErrorsAreThoseThatTheHeaderStates) {
  EXPECT_NEAR(rms_levels(3.0), 1.5, kRounding_levels);
  EXPECT_NEAR(rms_levels(8.0), 3.6, kRounding_levels);
  EXPECT_NEAR(rms_levels(kPlainFootprint_texels), 5.0, kRounding_levels);
}

TEST(PlainFootprint, SelectionTakesACoarserLevelBeforePixelsGetLonger) {
  EXPECT_EQ(PatchSelectionOptions().max_footprint_texels, kPlainFootprint_texels);
}

}  // namespace
}  // namespace terrella
