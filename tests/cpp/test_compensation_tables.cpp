// Tables in the compensator: the function they state, what they depend on, and that they undo what they push.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compensating.hpp"

namespace hexdbb::testing {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep_s = 0.004;

CompensationData data_with(const std::vector<CompensationTable>& tables) {
  CompensationData out = data_of(Model{Machine()});
  out.tables = tables;
  return out;
}

/// Interpolate by the plainest search there is.
double interpolated(const CompensationTable& table, double x) {
  const std::vector<double>&knot = table.knots, &value = table.values_mm;
  if (table.period > 0.0) x -= table.period * std::floor(x / table.period);
  if (x <= knot.front()) return value.front();
  if (x >= knot.back()) return value.back();
  std::size_t at = 1;
  while (knot[at] < x) ++at;
  const double part = (x - knot[at - 1]) / (knot[at] - knot[at - 1]);
  return value[at - 1] + part * (value[at] - value[at - 1]);
}

TEST(TableFunction, IsLinearBetweenItsKnotsAndHeldBeyond) {
  std::mt19937_64 random(3);
  for (const CompensationTable& table : all_tables()) {
    const TableFunction function(table);
    const double low = table.knots.front(), high = table.knots.back(), span = std::max(high - low, 1.0);
    std::uniform_real_distribution<double> place(low - 0.3 * span, high + 0.3 * span);
    int warm = 0;
    for (int call = 0; call < 2000; ++call) {
      const double x =
          call % 50 == 0 ? table.knots[static_cast<std::size_t>(call / 50) % table.knots.size()] : place(random);
      int cold = 0;
      const double expected = table.variable.empty() ? table.values_mm[0] : interpolated(table, x);
      EXPECT_NEAR(function.at(x, warm), expected, 1e-14) << table.effect << " at " << x;
      EXPECT_NEAR(function.at(x, cold), expected, 1e-14);
    }
    EXPECT_EQ(function.at(kNaN, warm), 0.0);
    EXPECT_EQ(function.at(std::numeric_limits<double>::infinity(), warm), 0.0);
    EXPECT_NEAR(function.at(-1e300, warm), table.period > 0.0 ? function.at(-1e300, warm) : table.values_mm[0], 0.0);
  }
}

/// A table that reads out its variable: the correction of slider k is minus what pushes it.
CompensationTable readout(const std::string& variable, const std::string& times = "") {
  CompensationTable out;
  out.effect = "readout";
  out.port = "slider";
  out.variable = variable;
  out.times = times;
  for (int k = 0; k < kLegs; ++k) out.pushes.push_back({k, k, -1e-4});
  out.knots = {-1000.0, 1000.0};
  out.values_mm = {-1000.0, 1000.0};
  return out;
}

/// Drive the path, and return the variable that a table sees.
SliderTable read_along(const std::string& variable, const std::vector<Pose>& path) {
  CompensationTable table = readout(variable);
  Compensator compensator(data_with({table})), nominal{Machine()};
  return 1e4 * (drive(compensator, path, kStep_s, 23.5) - drive(nominal, path, kStep_s, 23.5));
}

/// Return the state of a record of the nominal machine on the path, as the prediction derives it.
State state_along(const std::vector<Pose>& path) {
  Compensator nominal{Machine()};
  Samples samples;
  samples.sliders_mm = drive(nominal, path, kStep_s);
  const Eigen::Index count = samples.sliders_mm.rows();
  samples.set_up.setZero(count);
  samples.mount.setZero(count);
  samples.set_ups = {hexdbb::SetUp()};
  samples.state.time_s = Eigen::VectorXd::LinSpaced(count, 0.0, kStep_s * double(count - 1));
  samples.state.sweep.setZero(count);
  derive(NominalGeometry(Machine()), samples);
  return samples.state;
}

class TableVariables : public ::testing::TestWithParam<const char*> {};

TEST_P(TableVariables, AreThoseOfTheRecordsState) {
  const std::vector<Pose> path = circle_path(kStep_s, 0.4);
  const State state = state_along(path);
  const SliderTable seen = read_along(GetParam(), path);
  const Eigen::Index count = seen.rows();
  bool is_found = false;
  for_each_column(state, [&](const ColumnInfo& info, const auto& column) {
    if constexpr (std::is_same_v<std::decay_t<decltype(column)>, SliderTable>) {
      if (std::string(info.name) != GetParam()) return;
      is_found = true;
      const double size = column.cwiseAbs().maxCoeff();
      // The record's rates are smoothed over 0.1 s; its ends are one-sided.
      const auto inside = Eigen::seqN(25, count - 50);
      EXPECT_LT((seen - column)(inside, Eigen::all).cwiseAbs().maxCoeff(), 2e-3 * size);
    }
  });
  EXPECT_TRUE(is_found);
}

INSTANTIATE_TEST_SUITE_P(Compensation, TableVariables,
                         ::testing::Values("velocity_mm_s", "acceleration_mm_s2", "leg_force", "slider_joint_angle_rad",
                                           "slider_joint_rate_rad_s", "platform_joint_angle_rad",
                                           "platform_joint_rate_rad_s"),
                         [](const ::testing::TestParamInfo<const char*>& info) { return std::string(info.param); });

TEST(CompensationTables, TravelSinceAReversalIsThatOfTheRecordsState) {
  constexpr double kNear_mm = 0.1;  // there the direction changes over, and a record smooths the turning point
  const std::vector<Pose> path = circle_path(kStep_s, 1.2);
  const State state = state_along(path);
  const SliderTable seen = read_along("since_reversal_mm", path);
  int reversed = 0;
  for (Eigen::Index row = 0; row < seen.rows(); ++row) {
    for (int k = 0; k < kLegs; ++k) {
      const double expected = state.since_reversal_mm(row, k);
      if (expected < kNear_mm || std::abs(state.velocity_mm_s(row, k)) < 1.0) continue;
      reversed += expected < kLongAgo;
      EXPECT_NEAR(seen(row, k), std::min(expected, 1000.0), 1e-3) << row << " " << k;  // held beyond the last knot
    }
  }
  EXPECT_GT(reversed, 6000);
}

/// A table with 5 um at a reversal and 20 um long after it, against the motion.
CompensationTable after_reversal() {
  CompensationTable out = readout("since_reversal_mm", "travel_direction");
  for (TablePush& each : out.pushes) each.weight = -1.0;
  out.knots = {0.0, 0.05};
  out.values_mm = {0.005, 0.02};
  return out;
}

/// Steps of 1 um back and forth, by 200 um and by 4 um, less than the reversal travel of 10 um.
TEST(CompensationTables, TravelSinceAReversalJumpsNowhere) {
  Compensator compensator(data_with({after_reversal()}));
  double x = 0.0;
  Vector6 before = Vector6::Zero(), last_mm = before, lowest = Vector6::Constant(1.0), highest = -lowest;
  for (int call = 0; call < 4000; ++call) {
    const int phase = call % 1000;
    const bool is_back = phase >= 500 || (phase >= 300 && phase < 304);
    x += is_back ? -1e-3 : 1e-3;
    const SliderTargets targets = compensator.sliders(make_pose(x, 0, 285, 0, 0, 0));
    ASSERT_EQ(targets.status, Status::kOk);
    const Vector6 nominal_mm = targets.sliders_mm - targets.correction_mm;
    for (int k = 0; call > 0 && k < kLegs; ++k) {
      // From 20 um one way to 5 um the other over 10 um of travel, and the function's own slope; at the first motion from
      // rest, which no reversal precedes, to 20 um over half that travel.
      const double steepest = call < 10 ? 0.02 / 0.005 : (0.02 + 0.005) / 0.01 + 2.0 * 0.015 / 0.05;
      EXPECT_LE(std::abs(targets.correction_mm[k] - before[k]), steepest * std::abs(nominal_mm[k] - last_mm[k]) + 1e-9);
    }
    last_mm = nominal_mm;
    before = targets.correction_mm;
    lowest = lowest.cwiseMin(before);
    highest = highest.cwiseMax(before);
  }
  EXPECT_NEAR(highest.maxCoeff(), 0.02, 1e-9);
  EXPECT_NEAR(lowest.minCoeff(), -0.02, 1e-9);
}

TEST(CompensationTables, ASliderThatTurnsBackWithinItsReversalTravelHasNotReversed) {
  Compensator straight(data_with({after_reversal()})), turning(data_with({after_reversal()}));
  const auto at = [](Compensator& compensator, double x) {
    return compensator.sliders(make_pose(x, 0, 285, 0, 0, 0)).correction_mm;
  };
  for (const double x : {0.0, 0.2, 0.1, 0.12, 0.3}) at(straight, x);
  for (const double x : {0.0, 0.2, 0.1, 0.12, 0.3, 0.299, 0.298, 0.299, 0.3}) at(turning, x);
  EXPECT_LT((at(straight, 0.31) - at(turning, 0.31)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(CompensationTables, TravelSinceAReversalMayBeStated) {
  Compensator compensator(data_with({after_reversal()}));
  Direction direction;
  direction.travel_direction << 1.0, 1.0, -1.0, 0.0, 0.5, -0.5;
  direction.since_reversal_mm = {Vector6::Constant(0.0), Vector6::Constant(0.05)};
  const Vector6 found = compensator.sliders(make_pose(0, 0, 285, 0, 0, 0), direction).correction_mm;
  Vector6 expected;  // (1 + sigma) / 2 of 20 um, less (1 - sigma) / 2 of 5 um
  expected << 0.02, 0.02, -0.005, 0.0075, 0.01375, 0.00125;
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(CompensationTables, AnAccelerationThatIsNotStatedPushesNothing) {
  CompensationTable table = readout("acceleration_mm_s2");
  table.values_mm = {-900.0, 1100.0};  // 100 at rest
  Compensator compensator(data_with({table}));
  Direction direction;
  const Pose pose = make_pose(10, 20, 285, 0, 0, 0);
  EXPECT_EQ(compensator.sliders(pose, direction).largest_correction_mm, 0.0);
  direction.acceleration_mm_s2.setZero();
  EXPECT_NEAR(compensator.sliders(pose, direction).largest_correction_mm, 0.01, 1e-9);
}

TEST(CompensationTables, SwingRateIsThatOfTheSwing) {
  const std::vector<Pose> path = circle_path(kStep_s, 0.4);
  const SliderTable angle = read_along("swing_angle_rad", path), rate = read_along("swing_rate_rad_s", path);
  for (Eigen::Index row = 1; row + 1 < angle.rows(); ++row) {
    const auto slope = (angle.row(row + 1) - angle.row(row - 1)) / (2.0 * kStep_s);
    EXPECT_LT((slope - rate.row(row)).cwiseAbs().maxCoeff(), 1e-5);
  }
  EXPECT_GT(rate.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_GT(angle.minCoeff(), -1.6);  // about the axis that points outward
}

TEST(CompensationTables, JointDirectionIsTheSignOfItsRate) {
  const std::vector<Pose> path = circle_path(kStep_s, 1.2);
  const SliderTable rate = read_along("slider_joint_rate_rad_s", path);
  const SliderTable direction = read_along("slider_joint_direction", path);
  Compensator without_velocities(data_with({readout("slider_joint_direction")})), nominal{Machine()};
  for (Eigen::Index row = 1; row < rate.rows(); ++row) {
    const Pose& pose = path[static_cast<std::size_t>(row)];
    const Vector6 derived = 1e4 * (without_velocities.sliders(pose).sliders_mm - nominal.sliders(pose).sliders_mm);
    for (int k = 0; k < kLegs; ++k) {
      EXPECT_LE(std::abs(direction(row, k)), 1.0 + 1e-6);
      if (std::abs(rate(row, k)) < 0.01) continue;
      EXPECT_NEAR(direction(row, k), std::copysign(1.0, rate(row, k)), 1e-6);
      EXPECT_TRUE(row < 5 || std::abs(derived[k] - direction(row, k)) < 1e-6) << row;
    }
  }
}

TEST(CompensationTables, TemperatureIsTheMeasuredOneAndNoneWhereItIsNot) {
  Compensator compensator(data_with({readout("temperature_c"), readout("warming_k")}));
  Direction direction;
  const Pose pose = make_pose(10, 20, 285, 0, 0, 0);
  EXPECT_EQ(compensator.sliders(pose, direction).largest_correction_mm, 0.0);
  direction.temperature_c = 23.0;  // 3 K above the reference
  EXPECT_NEAR(compensator.sliders(pose, direction).largest_correction_mm, 26e-4, 1e-9);
}

TEST(CompensationTables, AFactorMultiplies) {
  CompensationTable table = readout("sliders_mm", "travel_direction");
  Compensator compensator(data_with({table}));
  Direction direction;
  direction.travel_direction << 1.0, -1.0, 0.5, 0.0, -0.25, 1.0;
  const SliderTargets targets = compensator.sliders(make_pose(0, 0, 285, 0, 0, 0), direction);
  const Vector6 expected = 1e-4 * targets.sliders_mm.cwiseProduct(direction.travel_direction);
  EXPECT_LT((targets.correction_mm - expected).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(CompensationTables, PoseIsTheInverseOfSliders) {
  Model truth = wrong_machine(kGeometricNames, 7);
  CompensationData data = data_of(truth);
  data.tables = all_tables();
  Compensator compensator(data);
  const std::vector<Pose> path = circle_path(0.01, 1.2);
  for (std::size_t at = 0; at < path.size(); ++at) {
    Direction direction =
        direction_between(truth.nominal, path[at == 0 ? 0 : at - 1], path[std::min(at + 1, path.size() - 1)], 0.02);
    direction.temperature_c = 24.0;
    const SliderTargets targets = compensator.sliders(path[at], direction);
    ASSERT_EQ(targets.status, Status::kOk) << at;
    // pose() takes the joints at the drives' coordinates, sliders() those of the commanded pose: some 0.1 mrad apart.
    const PoseEstimate found = compensator.pose(targets.sliders_mm, direction);
    ASSERT_EQ(found.status, Status::kOk);
    const bool is_crossing = (direction.velocity_mm_s.cwiseAbs().array() < 3.0).any();
    if (is_crossing) continue;
    EXPECT_LT(distance_mm(truth.nominal, found.pose, path[at]), 2e-4) << at;
  }
}

TEST(CompensationTables, OfPositionAreSolvedExactly) {
  // The steepest that a drive can follow: knots everywhere, so that the iteration crosses some of them.
  CompensationTable table = table_of("slider", "sliders_mm", {{0, 0, 1.0}}, 30.0, 840.0, 801);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> size(-0.01, 0.01);
  for (double& value : table.values_mm) value = size(random);
  Compensator compensator(data_with({table}));
  const NominalGeometry nominal{Machine()};
  for (const Pose& pose : circle_path(0.01, 1.0)) {
    const SliderTargets targets = compensator.sliders(pose);
    ASSERT_EQ(targets.status, Status::kOk);
    const double nominal_mm = inverse(nominal, pose).sliders_mm[0];
    EXPECT_NEAR(targets.sliders_mm[0] + interpolated(table, targets.sliders_mm[0]), nominal_mm, 1e-6);
  }
}

TEST(CompensationTables, StandStillWithTheMachine) {
  Compensator compensator(data_with(all_tables()));
  for (int call = 0; call < 5; ++call) compensator.sliders(make_pose(2e-3 * call, 0, 285, 0, 0, 0));
  const Vector6 targets = compensator.sliders(make_pose(8e-3, 0, 285, 0, 0, 0)).sliders_mm;
  for (int call = 0; call < 100; ++call) {
    const Vector6 now = compensator.sliders(make_pose(8e-3, 0, 285, 0, 0, 0)).sliders_mm;
    EXPECT_LT((now - targets).cwiseAbs().maxCoeff(), Compensator::kTolerance_mm);
  }
}

TEST(CompensationTables, AreLeftOutWithTheirEffectAndTheReason) {
  std::vector<CompensationTable> tables = all_tables();
  const std::size_t good = tables.size();
  const auto add = [&](const char* effect, const char* port, const char* variable, const char* times) {
    tables.push_back(table_of(port, variable, {{0, 0, 1.0}}, 0.0, 1.0, 3));
    tables.back().effect = effect;
    tables.back().times = times;
  };
  add("both", "leg", "leg_force", "");
  add("both", "leg", "since_reversal_s", "");
  add("cup", "cup", "time_s", "");
  add("growing", "leg", "sliders_mm", "elapsed");
  add("steep", "leg", "sliders_mm", "since_reversal_mm");
  const CompensationData data = compensation_of(Model{Machine()}, "m", "", {1.0, 0.01}, 20.0, tables);
  EXPECT_EQ(data.tables.size(), good);
  ASSERT_EQ(data.left_out.size(), 4u);
  EXPECT_EQ(data.left_out[0].reason, "depends on since_reversal_s, which is not known to a controller");
  EXPECT_EQ(data.left_out[1].reason, "pushes the cup, not the machine");
  EXPECT_EQ(data.left_out[2].reason, "depends on time");
  EXPECT_EQ(data.left_out[3].reason, "depends on since_reversal_mm as a factor, which is not known to a controller");
  const CompensationData cold = compensation_of(Model{Machine()}, "m", "", {1.0, 0.01}, kNaN, tables);
  EXPECT_EQ(cold.tables.size(), good - 1) << "warming counts from a temperature that was not stated";
}

}  // namespace
}  // namespace hexdbb::testing
