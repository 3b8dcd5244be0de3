// The compensator against prediction: a machine with the errors of the model, driven to the targets, takes the
// commanded poses. The truth is forward_table(), which shares the effects with the compensator but neither its
// directions of travel, its folding of effects nor its iteration.
#include <gtest/gtest.h>

#include <cmath>

#include "compensating.hpp"

namespace hexdbb::testing {
namespace {

constexpr double kStep_s = 0.004;  // a lap at 2800 mm/min takes 12 s
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Driven {
  std::vector<double> error_mm;
  SliderTable since_reversal_mm;

  /// Largest error where every slider is further than that from its last reversal, now and over the next 0.2 s: the
  /// record finds reversals on positions smoothed over such a time. The first 0.4 s do not count.
  double worst(double away_mm) const {
    constexpr Eigen::Index kAround = 50;
    double out = 0.0;
    for (Eigen::Index row = 2 * kAround; row + kAround < since_reversal_mm.rows(); ++row) {
      const bool is_away = since_reversal_mm.middleRows(row, kAround + 1).minCoeff() >= away_mm;
      if (is_away) out = std::max(out, error_mm[static_cast<std::size_t>(row)]);
    }
    return out;
  }
};

/// Return the poses of the machine with errors, its drives at these coordinates, one every kStep_s, with the state of a
/// record.
Driven run(const Model& truth, const std::vector<Pose>& path, const SliderTable& sliders_mm, double warming_k = kNaN) {
  Samples samples;
  samples.sliders_mm = sliders_mm;
  samples.set_up.setZero(sliders_mm.rows());
  samples.mount.setZero(sliders_mm.rows());
  samples.set_ups = {SetUp()};
  samples.state.time_s = Eigen::VectorXd::LinSpaced(sliders_mm.rows(), 0.0, kStep_s * double(sliders_mm.rows() - 1));
  samples.state.sweep.setZero(sliders_mm.rows());
  samples.state.warming_k.setConstant(sliders_mm.rows(), warming_k);
  derive(truth.nominal, samples);
  const PoseTable table = forward_table(truth, samples);
  Driven out;
  out.since_reversal_mm = samples.state.since_reversal_mm;
  for (Eigen::Index row = 0; row < sliders_mm.rows(); ++row) {
    EXPECT_EQ(table.status[row], 0);
    Pose pose;
    pose.position = table.pose.row(row).head<3>().transpose();
    for (int i = 0; i < 9; ++i) pose.rotation(i / 3, i % 3) = table.pose(row, 3 + i);
    out.error_mm.push_back(distance_mm(truth.nominal, pose, path[static_cast<std::size_t>(row)]));
  }
  return out;
}

TEST(Compensation, OfTheNominalMachineIsItsInverse) {
  Compensator compensator{Machine()};
  const NominalGeometry nominal{Machine()};
  for (const Pose& pose : circle_path(0.1, 1.0)) {
    const SliderTargets targets = compensator.sliders(pose);
    ASSERT_EQ(targets.status, Status::kOk);
    EXPECT_EQ(targets.sliders_mm, inverse(nominal, pose).sliders_mm);
    EXPECT_EQ(targets.largest_correction_mm, 0.0);
    EXPECT_LT(distance_mm(nominal, compensator.pose(targets.sliders_mm).pose, pose), 1e-9);
  }
  EXPECT_EQ(compensator.enabled_part(), 0.0);
}

TEST(LegPorts, HoldEveryPortOfTheLegsOnce) {
  LegPorts ports;
  for (int column = 0; column < port::kBall; ++column) ports.value[LegPorts::place(column)] = column + 1.0;
  ports.repeat();
  const Ports back = ports.ports();
  for (int column = 0; column < port::kCount; ++column) {
    EXPECT_EQ(back.value[column], column < port::kBall ? column + 1.0 : 0.0);
  }
  for (int quantity = 0; quantity < LegPorts::kQuantities; ++quantity) {
    EXPECT_EQ(ports.row(quantity)[6], ports.row(quantity)[4]);
    EXPECT_EQ(ports.row(quantity)[7], ports.row(quantity)[5]);
  }
}

TEST(SliderWaves, TakeWhatRepeatsWithTheScrewAndNothingElse) {
  const Machine machine;
  for (const std::string name :
       {"pitch_cyclic", "leg_length", "lead_error", "backlash", "guideway_rotation_xy", "gravity_sag"}) {
    Model model(machine);
    model.add(find_effect(machine, 1, name));
    model.terms[0].values.setConstant(1e-3);
    EXPECT_EQ(SliderWaves(machine).fold(model.terms[0]), name == "pitch_cyclic") << name;
    EXPECT_EQ(SliderPolynomials(machine).fold(model.terms[0]), name != "pitch_cyclic") << name;
  }
}

TEST(Compensation, OfGeometryIsExact) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Model truth = wrong_machine(kGeometricNames, seed);
    Compensator compensator(data_of(truth));
    const std::vector<Pose> path = circle_path(kStep_s, 0.2);
    EXPECT_LT(run(truth, path, drive(compensator, path, kStep_s)).worst(0.0), 1e-6);
  }
}

TEST(Compensation, WithoutItTheMachineErrs) {
  const Model truth = wrong_machine(kGeometricNames, 1);
  Compensator nominal{Machine()};
  const std::vector<Pose> path = circle_path(kStep_s, 0.2);
  EXPECT_GT(run(truth, path, drive(nominal, path, kStep_s)).worst(0.0), 0.03);
}

TEST(Compensation, OfEveryCorrectableEffect) {
  std::vector<std::string> names = kGeometricNames;
  names.insert(names.end(), kCorrectable.begin(), kCorrectable.end());
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Model truth = wrong_machine(names, seed);
    const std::vector<Pose> path = circle_path(kStep_s, 1.5);
    Compensator off{Machine()};
    EXPECT_GT(run(truth, path, drive(off, path, kStep_s)).worst(0.5), 0.05);
    // A lag follows the drive's speed, of which the controller's velocities leave out the correction's own: below 1 um.
    Compensator compensator(data_of(truth));
    EXPECT_LT(run(truth, path, drive(compensator, path, kStep_s)).worst(0.5), 1e-3);
    for (Term& term : truth.terms) {
      if (term.effect->info().name == "servo_lag") term.values.setZero();
    }
    Compensator without_lag(data_of(truth));
    EXPECT_LT(run(truth, path, drive(without_lag, path, kStep_s)).worst(0.5), 1e-4);
  }
}

TEST(Compensation, OfEachCorrectableEffectAlone) {
  for (const std::string& name : kCorrectable) {
    const Model truth = wrong_machine({name}, 4);
    Compensator compensator(data_of(truth));
    const std::vector<Pose> path = circle_path(kStep_s, 1.5);
    EXPECT_LT(run(truth, path, drive(compensator, path, kStep_s)).worst(0.5), 1e-4) << name;
  }
}

TEST(Compensation, ErrsByLessThanTheReversalTravelWhileThePlayIsCrossed) {
  const Model truth = wrong_machine({"backlash"}, 5);
  Compensator compensator(data_of(truth));
  const std::vector<Pose> path = circle_path(kStep_s, 1.5);
  const Driven on = run(truth, path, drive(compensator, path, kStep_s));
  EXPECT_GT(on.worst(0.0), on.worst(0.5));
  EXPECT_LT(on.worst(0.0), 0.015);
}

TEST(Compensation, OfMeasuredTemperature) {
  const Model truth = wrong_machine({"leg_thermal", "screw_thermal"}, 6);
  Compensator compensator(data_of(truth, 21.0));
  const std::vector<Pose> path = circle_path(kStep_s, 0.2);
  EXPECT_LT(run(truth, path, drive(compensator, path, kStep_s, 24.5), 3.5).worst(0.0), 1e-6);
  EXPECT_EQ(compensator.sliders(path[0]).largest_correction_mm, 0.0) << "no temperature, no growth";
}

TEST(Compensation, PoseIsTheInverseOfSliders) {
  std::vector<std::string> names = kGeometricNames;
  names.insert(names.end(), kCorrectable.begin(), kCorrectable.end());
  const Model truth = wrong_machine(names, 7);
  Compensator compensator(data_of(truth));
  const std::vector<Pose> path = circle_path(0.01, 1.5);
  for (std::size_t at = 1; at < path.size(); ++at) {
    const SliderTargets targets = compensator.sliders(path[at]);
    const PoseEstimate found = compensator.pose(targets.sliders_mm);
    ASSERT_EQ(found.status, Status::kOk);
    EXPECT_LT(distance_mm(truth.nominal, found.pose, path[at]), 1e-5);
  }
}

/// Steps of 1 um back and forth over a reversal.
TEST(Compensation, IsContinuousOverReversals) {
  Model truth{Machine()};
  truth.add(find_effect(Machine(), 1, "backlash"));
  truth.terms[0].values.setConstant(0.04);
  Compensator compensator(data_of(truth));
  double x = 0.0;
  Vector6 before = Vector6::Zero(), last_mm = before, lowest = Vector6::Constant(1.0), highest = -lowest;
  for (int call = 0; call < 2000; ++call) {
    x += call % 400 < 200 ? 1e-3 : -1e-3;
    const SliderTargets targets = compensator.sliders(make_pose(x, 0, 285, 0, 0, 0));
    ASSERT_EQ(targets.status, Status::kOk);
    // The whole play, 40 um, over the reversal travel of 10 um of each slider's own nominal travel.
    const Vector6 nominal_mm = targets.sliders_mm - targets.correction_mm;
    for (int k = 0; call > 0 && k < kLegs; ++k) {
      EXPECT_LE(std::abs(targets.correction_mm[k] - before[k]), 4.0 * std::abs(nominal_mm[k] - last_mm[k]) + 1e-9);
    }
    last_mm = nominal_mm;
    before = targets.correction_mm;
    lowest = lowest.cwiseMin(before);
    highest = highest.cwiseMax(before);
  }
  EXPECT_NEAR(highest.maxCoeff(), 0.02, 1e-9);
  EXPECT_NEAR(lowest.minCoeff(), -0.02, 1e-9);
}

TEST(Compensation, StandsStillWithTheMachine) {
  const Model truth = wrong_machine({"backlash"}, 8);
  Compensator compensator(data_of(truth));
  for (int call = 0; call < 5; ++call) compensator.sliders(make_pose(2e-3 * call, 0, 285, 0, 0, 0));
  const Vector6 targets = compensator.sliders(make_pose(8e-3, 0, 285, 0, 0, 0)).sliders_mm;
  for (int call = 0; call < 100; ++call) {
    EXPECT_EQ(compensator.sliders(make_pose(8e-3, 0, 285, 0, 0, 0)).sliders_mm, targets);
  }
}

TEST(Compensation, APoseOnlyCheckedIsNotFollowed) {
  const Model truth = wrong_machine({"backlash"}, 9);
  Compensator straight(data_of(truth)), looking(data_of(truth));
  for (int call = 0; call < 200; ++call) {
    const Pose pose = make_pose(-20.0 + 0.1 * call, 0, 285, 0, 0, 0);
    const Vector6 expected = straight.sliders(pose).sliders_mm;
    EXPECT_LT((looking.sliders(pose).sliders_mm - expected).cwiseAbs().maxCoeff(), 1e-9);
    if (call % 10 == 5) {
      EXPECT_EQ(looking.sliders(make_pose(-60, 20, 280, 0, 0, 0)).status, Status::kOk);
    }
  }
}

TEST(Compensation, UsesDirectionsOfTravelFromAControllerThatLooksAhead) {
  const Model truth = wrong_machine({"backlash"}, 14);
  Compensator compensator(data_of(truth));
  const std::vector<Pose> path = circle_path(kStep_s, 0.1);
  const NominalGeometry nominal{Machine()};
  Direction stated;
  stated.travel_direction << 1.0, -1.0, 0.5, 0.0, -0.25, 1.0;
  for (const Pose& pose : path) {
    const SliderTargets targets = compensator.sliders(pose, stated);
    ASSERT_EQ(targets.status, Status::kOk);
    const Vector6 expected = 0.5 * stated.travel_direction.cwiseProduct(truth.terms[0].values);
    EXPECT_LT((targets.sliders_mm - inverse(nominal, pose).sliders_mm - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
  // What is not stated follows from the motion again, starting from the directions stated last.
  const SliderTargets after = compensator.sliders(path.back());
  EXPECT_LT(
      (after.correction_mm - 0.5 * stated.travel_direction.cwiseProduct(truth.terms[0].values)).cwiseAbs().maxCoeff(),
      1e-9);
}

TEST(Compensation, IsRefusedBeyondItsLimitAndHolds) {
  const Model truth = wrong_machine(kGeometricNames, 10);
  CompensationData data = data_of(truth);
  Compensator free(data);
  const Pose here = make_pose(0, 0, 285, 0, 0, 0), there = make_pose(60, 40, 270, 0.1, 0, 0.1);
  const double at_here = free.sliders(here).largest_correction_mm, at_there = free.sliders(there).largest_correction_mm;
  data.limits.max_correction_mm = 0.5 * (at_here + at_there);
  const Pose& allowed = at_here < at_there ? here : there;
  const Pose& refused = at_here < at_there ? there : here;
  Compensator compensator(data);
  const SliderTargets good = compensator.sliders(allowed);
  ASSERT_EQ(good.status, Status::kOk);
  const SliderTargets held = compensator.sliders(refused);
  EXPECT_EQ(held.status, Status::kCorrectionLimit);
  EXPECT_GE(held.slider, 0);
  EXPECT_EQ(held.sliders_mm, good.sliders_mm);
  EXPECT_EQ(compensator.sliders(make_pose(0, 0, 900, 0, 0, 0)).status, Status::kUnreachable);
  EXPECT_EQ(compensator.sliders(make_pose(0, kNaN, 285, 0, 0, 0)).status, Status::kNotANumber);
  EXPECT_EQ(compensator.pose(Vector6::Constant(kNaN)).status, Status::kNotANumber);
  EXPECT_EQ(compensator.sliders(allowed).status, Status::kOk);
}

TEST(Compensation, FadesWhenSwitched) {
  const Model truth = wrong_machine(kGeometricNames, 11);
  Compensator compensator(data_of(truth));
  const Pose pose = make_pose(10, 20, 285, 0, 0, 0);
  const SliderTargets full = compensator.sliders(pose);
  Vector6 before = full.sliders_mm;
  for (const bool on : {false, true}) {
    compensator.enable(on);
    for (int call = 0; call < Compensator::kFadeCalls + 1; ++call) {
      const Vector6 now = compensator.sliders(pose).sliders_mm;
      EXPECT_LE((now - before).cwiseAbs().maxCoeff(), 1.1 * full.largest_correction_mm / Compensator::kFadeCalls);
      EXPECT_LT(distance_mm(truth.nominal, compensator.pose(now).pose, pose), 1e-6);
      before = now;
    }
    EXPECT_EQ(compensator.enabled_part(), on ? 1.0 : 0.0);
    const Vector6 expected = on ? full.sliders_mm : inverse(truth.nominal, pose).sliders_mm;
    EXPECT_LT((before - expected).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Compensation, LeavesOutWhatIsNotTheMachinesOrUnknownToControllers) {
  const std::vector<std::string> out = {"cup_position", "ball_offset", "bar_length",   "reversal_spike",
                                        "bar_drift",    "bar_gain",    "sample_delay", "ball_eccentricity"};
  std::vector<std::string> all = kGeometricNames;
  all.insert(all.end(), kCorrectable.begin(), kCorrectable.end());
  const std::size_t kept = all.size();
  all.insert(all.end(), out.begin(), out.end());
  const CompensationData data = data_of(wrong_machine(all, 12));
  EXPECT_EQ(data.effects.size(), kept);
  ASSERT_EQ(data.left_out.size(), out.size());
  for (std::size_t at = 0; at < out.size(); ++at) {
    EXPECT_EQ(data.left_out[at].effect, out[at]);
    EXPECT_FALSE(data.left_out[at].reason.empty());
  }
}

TEST(Compensation, OfGrowthNeedsAReferenceTemperature) {
  const Model truth = wrong_machine({"leg_thermal"}, 13);
  EXPECT_TRUE(data_of(truth, kNaN).effects.empty());
  EXPECT_EQ(data_of(truth, kNaN).left_out.size(), 1u);
  EXPECT_EQ(data_of(truth, 20.0).effects.size(), 1u);
  EXPECT_EQ(data_of(truth, 20.0).left_out.size(), 1u) << "its growth with time";
}

}  // namespace
}  // namespace hexdbb::testing
