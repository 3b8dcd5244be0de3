// Columns of the state that follow from the sliders' positions over time: velocity, reversals, leg forces, joints.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "circles.hpp"
#include "drawing.hpp"
#include "hexdbb/state.hpp"
#include "refusal.hpp"

namespace hexdbb::testing {
namespace {

constexpr double kAmplitude_mm = 60.0, kOmega = 0.126;  // a 100 mm circle at 754 mm/min

/// Six sliders swinging in different phases, read `rate` times a second through encoders of 0.1 um with some noise.
struct Swing {
  Eigen::VectorXd time_s;
  Eigen::VectorXi sweep;
  SliderTable sliders_mm;

  Swing(double rate, double seconds, double noise_mm, double phase = 0.3) {
    const auto count = static_cast<Eigen::Index>(rate * seconds);
    Drawing drawing(3);
    time_s = Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1) / rate);
    sweep.setZero(count);
    sliders_mm.resize(count, kLegs);
    for (Eigen::Index row = 0; row < count; ++row) {
      for (int k = 0; k < kLegs; ++k) {
        const double exact = 400.0 + kAmplitude_mm * std::sin(angle(row, k, phase));
        sliders_mm(row, k) = 1e-4 * std::round((exact + noise_mm * drawing.normal()) / 1e-4);
      }
    }
  }
  double angle(Eigen::Index row, int k, double phase = 0.3) const { return kOmega * time_s[row] + phase + 0.7 * k; }
};

class Encoders : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(Encoders, VelocityAndReversals) {
  const auto [rate, noise_mm] = GetParam();
  const Swing swing(rate, 60.0, noise_mm);
  const Motion moved = motion(swing.time_s, swing.sweep, swing.sliders_mm);
  for (int k = 0; k < kLegs; ++k) {
    for (Eigen::Index row = 0; row < swing.time_s.size(); ++row) {
      const double angle = swing.angle(row, k), speed = kAmplitude_mm * kOmega;
      ASSERT_NEAR(moved.velocity_mm_s(row, k), speed * std::cos(angle), 0.03 * speed) << "row " << row;
      const double past = std::fmod(angle + 0.5 * M_PI, M_PI) / kOmega;  // s since the last reversal, if in the sweep
      if (past < 0.1 || past > M_PI / kOmega - 0.1) continue;            // a tenth of a second about a reversal
      ASSERT_EQ(moved.travel_direction(row, k), std::cos(angle) > 0.0 ? 1.0 : -1.0) << "row " << row << " slider " << k;
      if (past < swing.time_s[row]) {
        ASSERT_NEAR(moved.since_reversal_s(row, k), past, 0.06);
        ASSERT_NEAR(moved.since_reversal_mm(row, k),
                    kAmplitude_mm * (1.0 - std::abs(std::sin(angle))) * (past < 0.5 * M_PI / kOmega ? 1.0 : 0.0) +
                        kAmplitude_mm * (1.0 + std::abs(std::sin(angle))) * (past < 0.5 * M_PI / kOmega ? 0.0 : 1.0),
                    5e-3);
      } else {
        ASSERT_EQ(moved.since_reversal_s(row, k), kLongAgo);
        ASSERT_EQ(moved.since_reversal_mm(row, k), kLongAgo);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, Encoders,
                         ::testing::Values(std::pair{250.0, 0.0}, std::pair{250.0, 3e-4}, std::pair{1000.0, 3e-4},
                                           std::pair{20.0, 0.0}));

TEST(State, SweepsAreApart) {
  Swing swing(50.0, 10.0, 0.0);
  const Motion whole = motion(swing.time_s, swing.sweep, swing.sliders_mm);
  const Eigen::Index half = swing.time_s.size() / 2;
  swing.sweep.tail(half).setConstant(1);
  swing.time_s.tail(half).array() -= 100.0;  // sweeps do not affect each other
  swing.sliders_mm.bottomRows(half).array() += 7.0;
  const Motion apart = motion(swing.time_s, swing.sweep, swing.sliders_mm);
  EXPECT_LT((whole.velocity_mm_s - apart.velocity_mm_s).cwiseAbs().maxCoeff(), 0.1);
}

TEST(State, SweepsMayBeInterleaved) {
  const Swing swing(50.0, 30.0, 0.0);
  const Eigen::Index count = swing.time_s.size();
  Eigen::VectorXd time_s(2 * count);
  Eigen::VectorXi sweep(2 * count);
  SliderTable sliders_mm(2 * count, kLegs);
  for (Eigen::Index row = 0; row < count; ++row) {
    for (int which = 0; which < 2; ++which) {
      time_s[2 * row + which] = swing.time_s[row];
      sweep[2 * row + which] = which;
      sliders_mm.row(2 * row + which) = (which == 0 ? 1.0 : -1.0) * swing.sliders_mm.row(row);
    }
  }
  const Motion alone = motion(swing.time_s, swing.sweep, swing.sliders_mm);
  const Motion both = motion(time_s, sweep, sliders_mm);
  for (Eigen::Index row = 0; row < count; ++row) {
    ASSERT_EQ(both.travel_direction.row(2 * row), alone.travel_direction.row(row));
    ASSERT_EQ(both.travel_direction.row(2 * row + 1), -alone.travel_direction.row(row));
    ASSERT_LT((both.since_reversal_mm.row(2 * row) - alone.since_reversal_mm.row(row)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(State, SliderThatStandsHasNoSide) {
  Swing swing(100.0, 2.0, 0.0);
  Drawing drawing(5);
  for (Eigen::Index row = 0; row < swing.time_s.size(); ++row) {
    swing.sliders_mm(row, 0) = 300.0 + 1e-4 * std::round(2.0 * drawing.normal());  // noise of 0.2 um
  }
  const Motion moved = motion(swing.time_s, swing.sweep, swing.sliders_mm);
  EXPECT_TRUE(moved.travel_direction.col(0).isZero(0.0));
  EXPECT_TRUE((moved.since_reversal_mm.col(0).array() == kLongAgo).all());
}

TEST(State, ShortSweeps) {
  Swing swing(100.0, 0.06, 0.0);
  ASSERT_EQ(swing.time_s.size(), 6);
  swing.sweep << 0, 1, 1, 2, 2, 2;
  const Motion moved = motion(swing.time_s, swing.sweep, swing.sliders_mm);
  EXPECT_TRUE(moved.velocity_mm_s.row(0).array().isNaN().all());
  EXPECT_NEAR(moved.velocity_mm_s(1, 0), (swing.sliders_mm(2, 0) - swing.sliders_mm(1, 0)) * 100.0, 1e-9);
  EXPECT_TRUE(moved.velocity_mm_s.bottomRows(3).allFinite());
}

TEST(State, TimeThatStandsStillIsNamed) {
  Swing swing(100.0, 1.0, 0.0);
  swing.time_s[40] = swing.time_s[39];
  EXPECT_EQ(refusal([&] { motion(swing.time_s, swing.sweep, swing.sliders_mm); }),
            "time_s[40] is not after the sample before it");
}

// Forces of the legs on the platform and the load in equilibrium: sum of forces, and moments about the reference point.
TEST(State, LegForcesAreInEquilibriumWithAUnitLoad) {
  const Machine machine;
  const NominalGeometry nominal(machine);
  const Samples samples = circle_samples(machine, seven_circles(), 20);
  const SliderTable force = leg_force(nominal, samples.sliders_mm);
  const PoseTable poses = forward_table(Model(machine), samples);
  for (Eigen::Index row = 0; row < samples.size(); ++row) {
    const Vector3 position = poses.pose.row(row).head<3>().transpose();
    Matrix3 rotation;
    for (int i = 0; i < 3; ++i) rotation.row(i) = poses.pose.row(row).segment<3>(3 + 3 * i);
    Vector3 sum = -Vector3::UnitZ(), moment = Vector3::Zero();
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 arm = rotation * nominal.platform_joint.col(k);
      const Vector3 joint = nominal.vertex.col(k) + samples.sliders_mm(row, k) * nominal.direction.col(k);
      const Vector3 pull = force(row, k) * (joint - position - arm).normalized();  // tension pulls to the slider
      sum += pull;
      moment += Vector3(arm[1] * pull[2] - arm[2] * pull[1], arm[2] * pull[0] - arm[0] * pull[2],
                        arm[0] * pull[1] - arm[1] * pull[0]);
    }
    ASSERT_LT(sum.norm(), 1e-6);
    ASSERT_LT(moment.norm(), 1e-4);
  }
}

TEST(State, PlaceWithoutAPoseHasNoForces) {
  SliderTable sliders_mm(1, int{kLegs});
  sliders_mm << 20, 846, 20, 846, 20, 846;
  EXPECT_TRUE(leg_force(NominalGeometry(Machine()), sliders_mm).array().isNaN().all());
}

TEST(State, RowsKeepTheirPlaceInTheTable) {
  const Samples samples = moving_samples(Machine(), seven_circles(), 20);
  const Samples part = samples.rows({5, 3, 100}).rows({2, 0});
  EXPECT_EQ(part.state.row, Eigen::Vector2i(100, 5));
  EXPECT_EQ(part.state.time_s[0], samples.state.time_s[100]);
  EXPECT_EQ(part.state.travel_direction.row(1), samples.state.travel_direction.row(5));
  EXPECT_THROW(samples.rows({140}), std::invalid_argument);
}

// The angular velocity of a leg relative to its slider is u x du/dt; the joint's rate is its component across leg and
// guideway. du/dt from the nominal poses a moment before and after.
TEST(State, JointRatesAreThoseOfTheLegs) {
  const Machine machine;
  const NominalGeometry nominal(machine);
  const double lap_s = 20.0;
  const int count = 2000;
  std::vector<CircleSpec> tilted = {CircleSpec(), {Vector3(0.2, -0.1, 0.15), Vector3(0.1, 0.0, 0.0), 0}};
  const Samples samples = moving_samples(machine, tilted, count, lap_s);
  const PoseTable poses = forward_table(Model(machine), samples);
  const auto leg = [&](Eigen::Index row, int k) {
    const Pose pose = poses.at(row);
    return Vector3((pose.position + pose.rotation * nominal.platform_joint.col(k) - nominal.vertex.col(k) -
                    samples.sliders_mm(row, k) * nominal.direction.col(k)) /
                   machine.leg_length_mm[k]);
  };
  for (Eigen::Index row = 5; row + 5 < samples.size(); row += 37) {
    if (samples.state.circle[row - 5] != samples.state.circle[row + 5]) continue;
    EXPECT_LT((samples.state.position_mm.row(row).transpose() - poses.at(row).position).norm(), 1e-12);
    const Vector3 rpy = samples.state.platform_rpy_rad.row(row);
    EXPECT_LT((rotation_from_rpy(rpy[0], rpy[1], rpy[2]) - poses.at(row).rotation).norm(), 1e-12);
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 u = leg(row, k), du_dt = (leg(row + 1, k) - leg(row - 1, k)) / (2.0 * lap_s / count);
      const Vector3 turning = u.cross(du_dt), d = nominal.direction.col(k), normal = poses.at(row).rotation.col(2);
      const double slider_rate = turning.dot(d.cross(u).normalized());
      const double platform_rate = turning.dot(normal.cross(u).normalized());
      EXPECT_NEAR(samples.state.slider_joint_rate_rad_s(row, k), slider_rate, 2e-5) << "row " << row << " leg " << k;
      EXPECT_NEAR(samples.state.platform_joint_rate_rad_s(row, k), platform_rate, 2e-5);
      EXPECT_NEAR(samples.state.platform_joint_angle_rad(row, k), std::acos(u.dot(normal)), 1e-9);
      const double direction = samples.state.slider_joint_direction(row, k);
      if (samples.state.slider_joint_since_reversal_rad(row, k) > 1e-3) {
        EXPECT_EQ(direction, std::copysign(1.0, slider_rate));
      }
    }
  }
}

TEST(State, AngleIsWrapped) {
  Samples samples = moving_samples(Machine(), {CircleSpec()}, 20);
  samples.state.angle_rad = Eigen::VectorXd::LinSpaced(20, -9.0, 13.0);
  samples.state.angle_rad[0] = -1e-17;
  derive(NominalGeometry(Machine()), samples);
  const Eigen::VectorXd& wrapped = samples.state.angle_wrapped_rad;
  EXPECT_GE(wrapped.minCoeff(), 0.0);
  EXPECT_LT(wrapped.maxCoeff(), 2.0 * M_PI);
  EXPECT_LT((wrapped.array().sin() - samples.state.angle_rad.array().sin()).abs().maxCoeff(), 1e-14);
  EXPECT_LT((wrapped.array().cos() - samples.state.angle_rad.array().cos()).abs().maxCoeff(), 1e-14);
}

TEST(State, EveryColumnIsDescribed) {
  const Samples samples = moving_samples(Machine(), {CircleSpec()}, 20);
  std::vector<std::string> names, filled;
  for_each_column(samples.state, [&](const ColumnInfo& info, const auto& column) {
    names.push_back(info.name);
    if (column.size() > 0) filled.push_back(info.name);
    EXPECT_FALSE(std::string(info.unit).empty()) << info.name;
    EXPECT_FALSE(std::string(info.meaning).empty()) << info.name;
    const int width = static_cast<int>(column.cols());
    const int expected = info.of == ColumnOf::kSample ? 1 : info.of == ColumnOf::kAxis ? 3 : 6;
    EXPECT_EQ(width, expected) << info.name;
  });
  EXPECT_EQ(names.size(), 30U);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  const std::vector<std::string> given_by_a_record = {"row",      "lap", "direction", "angle_rad", "angle_wrapped_rad",
                                                      "feed_mm_s"};
  EXPECT_EQ(filled.size() + given_by_a_record.size(), names.size());
}

TEST(State, OnlyWhatIsWantedIsDerived) {
  const Samples whole = moving_samples(Machine(), {CircleSpec()}, 60);
  for_each_column(whole.state, [&](const ColumnInfo& info, const auto& column) {
    if (column.size() == 0) return;
    Samples samples = whole;
    samples.state = State{};
    samples.state.time_s = whole.state.time_s;
    samples.state.sweep = whole.state.sweep;
    samples.state.angle_rad = Eigen::VectorXd::Zero(whole.size());
    const std::string name = info.name;
    if (name == "time_s" || name == "circle" || name == "sweep" || name == "temperature_c" || name == "warming_k") {
      EXPECT_NE(refusal([&] { derive(NominalGeometry(Machine()), samples, {name}); }).find(name), std::string::npos);
      return;
    }
    derive(NominalGeometry(Machine()), samples, {name});
    for_each_column(samples.state, [&](const ColumnInfo& found, const auto& derived) {
      if (name != found.name) return;
      ASSERT_EQ(derived.rows(), column.rows()) << name;
      for (Eigen::Index at = 0; at < derived.size(); ++at) {
        EXPECT_NEAR(static_cast<double>(derived.data()[at]), static_cast<double>(column.data()[at]), 1e-12) << name;
      }
    });
    if (name == "travel_direction") {
      EXPECT_EQ(samples.state.leg_force.size(), 0);
      EXPECT_EQ(samples.state.snap_mm_s4.size(), 0);
    }
  });
}

TEST(State, WhatIsDerivedTogetherIsTheSameInWhateverOrderItIsNamed) {
  const Samples whole = moving_samples(Machine(), {CircleSpec()}, 60);
  const std::vector<std::vector<std::string>> orders = {{"jerk_mm_s3", "since_reversal_s"},
                                                        {"since_reversal_s", "jerk_mm_s3"},
                                                        {"position_mm", "jerk_mm_s3", "speed_mm_s"}};
  for (const std::vector<std::string>& names : orders) {
    Samples samples = whole;
    samples.state = State{};
    samples.state.time_s = whole.state.time_s;
    samples.state.sweep = whole.state.sweep;
    derive(NominalGeometry(Machine()), samples, names);
    EXPECT_EQ(samples.state.jerk_mm_s3, whole.state.jerk_mm_s3);
    EXPECT_EQ(samples.state.since_reversal_s, whole.state.since_reversal_s);
    // Asked for afterwards, a part takes nothing away.
    derive(NominalGeometry(Machine()), samples, {"travel_direction"});
    EXPECT_EQ(samples.state.jerk_mm_s3, whole.state.jerk_mm_s3);
  }
}

TEST(State, SpeedIsThatOfTheCircle) {
  constexpr double kLap_s = 20.0, kRadius_mm = 100.0;
  const Samples samples = moving_samples(Machine(), {CircleSpec()}, 400, kLap_s);
  const double fed_mm_s = 2.0 * M_PI * kRadius_mm / kLap_s;
  EXPECT_LT((samples.state.speed_mm_s.array() - fed_mm_s).abs().maxCoeff(), 2e-3 * fed_mm_s);
}

TEST(State, VelocityOfThePlatformIsThatOfItsPlace) {
  const Samples samples = moving_samples(Machine(), {CircleSpec()}, 400, 20.0);
  const State& state = samples.state;
  for (Eigen::Index at = 1; at + 1 < samples.size(); ++at) {
    const double between_s = state.time_s[at + 1] - state.time_s[at - 1];
    const Eigen::RowVector3d moved_mm_s = (state.position_mm.row(at + 1) - state.position_mm.row(at - 1)) / between_s;
    EXPECT_LT((state.platform_velocity_mm_s.row(at) - moved_mm_s).norm(), 0.01 * state.speed_mm_s[at]) << at;
  }
}

TEST(State, ColumnOfAnotherLengthIsNamed) {
  Samples samples = moving_samples(Machine(), {CircleSpec()}, 20);
  samples.state.lap.setZero(7);
  EXPECT_EQ(refusal([&] { samples.validate(); }), "lap has 7 rows, expected 20 as in sliders_mm");
}

}  // namespace
}  // namespace hexdbb::testing
