// Derivatives of the sliders' motion, on a circle as a hexapod's sliders have it: harmonics that fall slowly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "drawing.hpp"
#include "hexdbb/state.hpp"

namespace hexdbb {
namespace {

constexpr std::array<double, 5> kHarmonic_mm = {91.0, 10.6, 1.4, 0.34, 0.09};
constexpr double kOmega = 0.74;  // rad/s, 56 mm/s on a circle of 75 mm

/// Derivative of order `order` of slider k's coordinate at a time.
double exact(double time_s, int k, int order) {
  double out = 0.0;
  for (std::size_t at = 0; at < kHarmonic_mm.size(); ++at) {
    const double omega = kOmega * static_cast<double>(at + 1);
    out += kHarmonic_mm[at] * std::pow(omega, order) *
           std::sin(omega * time_s + 0.7 * k * static_cast<double>(at + 1) + M_PI_2 * order);
  }
  return out;
}

/// A sweep of two laps at given instants; stamps may be rounded, and encoders are to 0.1 um.
struct Lap {
  Eigen::VectorXd instant_s;
  SliderTable sliders_mm;

  explicit Lap(Eigen::VectorXd instants) : instant_s(std::move(instants)), sliders_mm(instant_s.size(), kLegs) {
    for (Eigen::Index row = 0; row < instant_s.size(); ++row) {
      for (int k = 0; k < kLegs; ++k) sliders_mm(row, k) = 1e-4 * std::round(1e4 * exact(instant_s[row], k, 0));
    }
  }

  Motion at(const Eigen::VectorXd& stamp_s) const {
    return motion(stamp_s, Eigen::VectorXi::Zero(stamp_s.size()), sliders_mm);
  }

  Motion rounded_to(double digit_s) const { return at(digit_s * (instant_s / digit_s).array().round()); }

  /// The largest distance of a slider, and their root mean square, from where it is after a delay, to the fourth order.
  std::array<double, 2> off_after(double delay_s, const Motion& moved) const {
    double most_mm = 0.0, sum = 0.0;
    for (Eigen::Index row = 0; row < instant_s.size(); ++row) {
      for (int k = 0; k < kLegs; ++k) {
        double off_mm = 0.0, factor = 1.0;
        int order = 0;
        for (const SliderTable* each :
             {&moved.velocity_mm_s, &moved.acceleration_mm_s2, &moved.jerk_mm_s3, &moved.snap_mm_s4}) {
          factor *= delay_s / ++order;
          off_mm += factor * ((*each)(row, k) - exact(instant_s[row], k, order));
        }
        most_mm = std::max(most_mm, std::abs(off_mm));
        sum += off_mm * off_mm;
      }
    }
    return {most_mm, std::sqrt(sum / static_cast<double>(instant_s.size() * kLegs))};
  }
};

Eigen::VectorXd even(double step_s) {
  const auto count = static_cast<Eigen::Index>(4.0 * M_PI / kOmega / step_s) + 1;
  return Eigen::VectorXd::LinSpaced(count, 32.0, 32.0 + step_s * static_cast<double>(count - 1));
}

class Rates : public ::testing::TestWithParam<double> {};

TEST_P(Rates, ALongDelayIsPredictedFromRoundedStamps) {
  const Lap lap(even(GetParam()));
  const auto [most_mm, rms_mm] = lap.off_after(0.23, lap.rounded_to(1e-4));
  EXPECT_LT(rms_mm, 0.5e-3);
  EXPECT_LT(most_mm, 10e-3);  // in the last row, from which a window reaches back only
}

INSTANTIATE_TEST_SUITE_P(Motion, Rates, ::testing::Values(1.0 / 22.33, 1.0 / 9.77, 1.0 / 50.3, 1.0 / 113.7));

TEST(Motion, MissingRowsLeaveSamplesEven) {
  const Eigen::VectorXd all_s = even(0.0447833);
  Eigen::VectorXd instant_s(all_s.size() - all_s.size() / 7);
  for (Eigen::Index row = 0, at = 0; at < instant_s.size(); ++row) {
    if (row % 7 != 6) instant_s[at++] = all_s[row];
  }
  const Lap lap(instant_s);
  EXPECT_LT(lap.off_after(0.1, lap.rounded_to(1e-3))[1], 1e-3);
}

TEST(Motion, UnevenStampsAreWhatTheySay) {
  Eigen::VectorXd instant_s = even(0.0447833);
  testing::Drawing drawing(11);
  for (double& each : instant_s) each = 1e-4 * std::round(1e4 * (each + 4e-3 * drawing.uniform(-1.0, 1.0)));
  const Lap lap(instant_s);
  EXPECT_LT(lap.off_after(0.1, lap.at(instant_s))[1], 0.2e-3);
}

/// Phase of a circle that starts from rest: its speed rises as a cosine does, within a part of a second.
double phase_from_rest(double time_s) {
  constexpr double kRise_s = 0.7, kSlow = 0.167;  // rad/s, 16.7 mm/s on a circle of 100 mm
  if (time_s >= kRise_s) return kSlow * (time_s - 0.5 * kRise_s);
  return 0.5 * kSlow * (time_s - kRise_s / M_PI * std::sin(M_PI * time_s / kRise_s));
}

class FromRest : public ::testing::TestWithParam<double> {};

TEST_P(FromRest, ADelayIsPredictedWhereASlowSweepStarts) {
  // One polynomial over five seconds is off by up to 0.1 mm, and by 5 um on average.
  constexpr double kDelay_s = 0.025;
  const Eigen::VectorXd instant_s = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(30.0 * GetParam()), 0.0, 30.0);
  const auto place_mm = [](double time_s, int k) { return exact(phase_from_rest(time_s) / kOmega, k, 0); };
  SliderTable sliders_mm(instant_s.size(), kLegs);
  for (Eigen::Index row = 0; row < instant_s.size(); ++row) {
    for (int k = 0; k < kLegs; ++k) sliders_mm(row, k) = 1e-4 * std::round(1e4 * place_mm(instant_s[row], k));
  }
  const Motion moved = motion(instant_s, Eigen::VectorXi::Zero(instant_s.size()), sliders_mm);
  double most_mm = 0.0, sum = 0.0;
  for (Eigen::Index row = 0; row < instant_s.size(); ++row) {
    for (int k = 0; k < kLegs; ++k) {
      const double predicted_mm =
          kDelay_s * (moved.velocity_mm_s(row, k) + 0.5 * kDelay_s * moved.acceleration_mm_s2(row, k));
      const double off_mm = predicted_mm - (place_mm(instant_s[row] + kDelay_s, k) - place_mm(instant_s[row], k));
      most_mm = std::max(most_mm, std::abs(off_mm));
      sum += off_mm * off_mm;
    }
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(instant_s.size() * kLegs)), 0.4e-3);
  EXPECT_LT(most_mm, 10e-3);
}

INSTANTIATE_TEST_SUITE_P(Motion, FromRest, ::testing::Values(15.0, 30.0, 100.0));

TEST(Motion, AFewRowsHaveThePolynomialThroughAll) {
  for (const Eigen::Index count : {2, 3, 5, 7}) {
    const Lap lap(Eigen::VectorXd::LinSpaced(count, 0.0, 0.02 * static_cast<double>(count - 1)));
    const Motion moved = lap.at(lap.instant_s);
    EXPECT_TRUE(moved.snap_mm_s4.allFinite()) << count;
    EXPECT_NEAR(moved.velocity_mm_s(0, 0), exact(0.0, 0, 1), 1.0) << count;
  }
}

}  // namespace
}  // namespace hexdbb
