// Reversals along the run-up to a circle, which no record holds: they are where they come a lap later.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "hexdbb/run_up.hpp"
#include "hexdbb/state.hpp"

namespace hexdbb {
namespace {

constexpr double kOmega = 0.74, kStart_rad = 0.35;  // rad/s; the angle of the first reading

double place_mm(double angle_rad, int k) {
  return 91.0 * std::sin(angle_rad + 0.7 * k) + 10.6 * std::sin(2.0 * angle_rad + 1.4 * k);
}

double slope_mm_rad(double angle_rad, int k) {
  return 91.0 * std::cos(angle_rad + 0.7 * k) + 21.2 * std::cos(2.0 * angle_rad + 1.4 * k);
}

/// A sweep from kStart_rad on, `turns` of a lap, 150 readings a lap; its end is not read.
struct Sweep {
  double turns, sense;
  bool wrapped;

  Eigen::VectorXd time_s() const {
    const auto count = static_cast<Eigen::Index>(std::lround(150.0 * turns));
    return Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1)) * (2.0 * M_PI / 150.0 / kOmega);
  }

  double at_rad(double time_s) const { return kStart_rad + sense * kOmega * time_s; }

  Eigen::VectorXd angle_rad() const {
    return time_s().unaryExpr([this](double time) {
      const double angle = at_rad(time);
      return wrapped ? angle - 2.0 * M_PI * std::floor(angle / (2.0 * M_PI)) : angle;
    });
  }

  Motion motion() const {
    const Eigen::VectorXd time = time_s();
    SliderTable sliders_mm(time.size(), kLegs);
    for (Eigen::Index row = 0; row < time.size(); ++row) {
      for (int k = 0; k < kLegs; ++k) sliders_mm(row, k) = place_mm(at_rad(time[row]), k);
    }
    return motions(time, Eigen::VectorXi::Zero(time.size()), angle_rad(), {{sliders_mm, 1}}).front();
  }

  /// When slider k last reversed before a time, along the sweep or its run-up; none where it did not.
  std::optional<double> reversed_s(double before_s, int k) const {
    constexpr double kStep_s = 1e-4;
    for (double time = before_s; time > -kRunUp_rad / kOmega; time -= kStep_s) {
      if (slope_mm_rad(at_rad(time), k) * slope_mm_rad(at_rad(time - kStep_s), k) <= 0.0) return time;
    }
    return std::nullopt;
  }
};

class Sweeps : public testing::TestWithParam<Sweep> {};

TEST_P(Sweeps, ReversalsOfTheRunUpAreKnown) {
  const Sweep sweep = GetParam();
  const Motion found = sweep.motion();
  const Eigen::VectorXd time_s = sweep.time_s();
  int before = 0;
  for (Eigen::Index row = 0; row < time_s.size(); row += 7) {
    for (int k = 0; k < kLegs; ++k) {
      const auto reversed = sweep.reversed_s(time_s[row], k);
      if (!reversed) {
        EXPECT_EQ(found.since_reversal_s(row, k), kLongAgo) << row << " " << k;
        continue;
      }
      before += *reversed < 0.0;
      EXPECT_NEAR(found.since_reversal_s(row, k), time_s[row] - *reversed, 0.02) << row << " " << k;
      const double travel_mm = place_mm(sweep.at_rad(time_s[row]), k) - place_mm(sweep.at_rad(*reversed), k);
      EXPECT_NEAR(found.since_reversal_mm(row, k), std::abs(travel_mm), 0.05) << row << " " << k;
    }
  }
  EXPECT_GT(before, 5);
}

INSTANTIATE_TEST_SUITE_P(Laps, Sweeps,
                         testing::Values(Sweep{1.0, 1.0, false}, Sweep{1.0, -1.0, true}, Sweep{2.0, 1.0, true},
                                         Sweep{1.1, -1.0, false}));

TEST(RunUp, BeforeLessThanALapNothingIsKnown) {
  const Sweep sweep{0.9, 1.0, false};
  EXPECT_EQ(run_up(sweep.time_s(), sweep.angle_rad()).size(), 0);
  EXPECT_GT((sweep.motion().since_reversal_s.row(0).array() == kLongAgo).count(), 4);
}

TEST(RunUp, LiesALapBehind) {
  const Sweep sweep{1.5, -1.0, true};
  const RunUp found = run_up(sweep.time_s(), sweep.angle_rad());
  EXPECT_NEAR(found.lap_s, 2.0 * M_PI / kOmega, 1e-9);
  EXPECT_EQ(found.end, 150);
  EXPECT_EQ(found.size(), 18);  // of 150 an eighth, less the start
}

TEST(RunUp, OfAMachineThatStandsThereIsNone) {
  const Eigen::VectorXd time_s = Eigen::VectorXd::LinSpaced(9, 0.0, 8.0);
  EXPECT_EQ(run_up(time_s, Eigen::VectorXd::Zero(9)).size(), 0);
  EXPECT_EQ(run_up(time_s.head(1), Eigen::VectorXd::Zero(1)).size(), 0);
}

}  // namespace
}  // namespace hexdbb
