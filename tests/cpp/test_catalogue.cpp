// Pushes of every effect of the catalogue against formulas written here from its physics; no other port is pushed.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "circles.hpp"
#include "drawing.hpp"
#include "hexdbb/tabulated_effect.hpp"
#include "refusal.hpp"

namespace hexdbb::testing {
namespace {

constexpr Eigen::Index kRow = 131;  // measured rows are those from 160 on

class Catalogue : public ::testing::Test {
 protected:
  Machine machine;
  Samples samples = moving_samples(machine, seven_circles(), 46);

  /// Compute the push of an effect in one row.
  Ports pushed(const std::string& name, const Eigen::VectorXd& values, Eigen::Index row = kRow) const {
    Eigen::Matrix<double, Eigen::Dynamic, port::kCount> out(1, int{port::kCount});
    out.setZero();
    find_effect(machine, 1, name)->push({samples, row, 1}, values, out);
    Ports ports;
    ports.value = out.transpose();
    return ports;
  }

  /// Expect a push to 1e-12 of its largest entry.
  static void expect_same(const Ports& found, const Ports& expected) {
    EXPECT_GT(expected.value.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_LT((found.value - expected.value).cwiseAbs().maxCoeff(), 1e-12 * expected.value.cwiseAbs().maxCoeff());
  }

  Eigen::VectorXd some(const std::string& name, double size) const {
    Drawing drawing(7);
    return size * drawing.normals(find_effect(machine, 1, name)->info().size());
  }

  double slider(int k, Eigen::Index row = kRow) const { return samples.sliders_mm(row, k); }
  const State& state() const { return samples.state; }
};

TEST_F(Catalogue, IsCompleteAndInOrder) {
  const std::vector<std::string> expected = {"backlash",     "reversal_spike", "pitch_cyclic",     "lead_error",
                                             "straightness", "servo_lag",      "leg_thermal",      "screw_thermal",
                                             "gravity_sag",  "joint_offset",   "joint_friction",   "bar_drift",
                                             "bar_gain",     "sample_delay",   "ball_eccentricity"};
  EXPECT_EQ(effect_names(group::kCatalogue), expected);
  EXPECT_EQ(effect_names(group::kGeometry).size(), 7U);
  EXPECT_EQ(effect_names(group::kSetUp).size(), 3U);
  EXPECT_EQ(effect_names(group::kPlaces), std::vector<std::string>{"ball_rotation"});
  EXPECT_EQ(effect_names().size(), 11U + expected.size());
}

class Description : public ::testing::TestWithParam<std::string> {
 protected:
  Machine machine;
  Samples samples = moving_samples(machine, seven_circles(), 46);
  EffectPtr effect = find_effect(machine, 1, GetParam());
  const EffectInfo& info = effect->info();
};

TEST_P(Description, IsComplete) {
  EXPECT_EQ(info.name, GetParam());
  EXPECT_FALSE(info.source.empty());
  EXPECT_FALSE(info.formula.empty());
  EXPECT_EQ(info.physics.back(), '.');
  EXPECT_GT(info.size(), 0);
  EXPECT_EQ(info.is_free_at_first, GetParam() != "bar_length") << "the bar's length is calibrated, no other value is";
  for (const ParameterInfo& parameter : info.parameters) {
    EXPECT_GT(parameter.prior_sigma, 0.0);
    EXPECT_LT(parameter.prior_sigma, parameter.limit);
    EXPECT_LE(parameter.lower(), 0.0);
    EXPECT_EQ(parameter.upper(), parameter.limit);
  }
  for (const std::string& column : info.needs) EXPECT_NO_THROW(require_column(samples.state, column, info.name));
}

TEST_P(Description, PortsAreThoseItPushes) {
  const Eigen::VectorXd values = Eigen::VectorXd::Constant(info.size(), 1e-3);
  const std::vector<Eigen::MatrixXd> pushes = push_derivatives(*effect, samples, values);
  for (const PortSpan& span : port::kSpans) {
    bool pushed = false;
    for (int port = span.first; port < span.first + span.size; ++port) {
      pushed = pushed || !pushes[static_cast<std::size_t>(port)].isZero(0.0);
    }
    const bool listed = std::find(info.ports.begin(), info.ports.end(), span.name) != info.ports.end();
    EXPECT_EQ(pushed, listed) << span.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Description, ::testing::ValuesIn(effect_names()),
                         [](const auto& info) { return info.param; });

TEST(PhysicalDomain, IsOneSidedWherePhysicsIs) {
  const Machine machine;
  const auto lower = [&](const std::string& effect, const std::string& name) {
    const EffectInfo info = find_effect(machine, 1, effect)->info();
    for (const ParameterInfo& each : info.parameters) {
      if (each.name == name) return each.lower();
    }
    throw std::logic_error("no parameter " + name);
  };
  EXPECT_EQ(lower("backlash", "play"), 0.0);
  EXPECT_EQ(lower("reversal_spike", "height"), 0.0);
  EXPECT_EQ(lower("servo_lag", "lag"), 0.0);
  EXPECT_EQ(lower("sample_delay", "delay"), 0.0);
  EXPECT_EQ(lower("gravity_sag", "compliance"), 0.0);
  EXPECT_EQ(lower("leg_length", "longer"), -5.0);
}

TEST_F(Catalogue, PushDerivativesAreThoseOfThePush) {
  Drawing drawing(17);
  for (const std::string name :
       {"guideway_rotation_xy", "platform_side", "pitch_cyclic", "reversal_spike", "ball_rotation"}) {
    const EffectPtr effect = find_effect(machine, 1, name);
    const int size = effect->info().size();
    const double step = 1e-6;
    const Eigen::VectorXd values = 1e-3 * drawing.normals(size);
    const std::vector<Eigen::MatrixXd> found = push_derivatives(*effect, samples, values);
    for (int value = 0; value < size; ++value) {
      const Eigen::VectorXd forward = step * Eigen::VectorXd::Unit(size, value);
      const Eigen::VectorXd change =
          (pushed(name, values + forward).value - pushed(name, values - forward).value) / (2.0 * step);
      for (int port = 0; port < port::kCount; ++port) {
        EXPECT_NEAR(found[static_cast<std::size_t>(port)](kRow, value), change[port],
                    1e-7 * std::max(1.0, change.cwiseAbs().maxCoeff()))
            << name << " value " << value << " port " << port;
      }
    }
  }
  EXPECT_THROW(push_derivatives(*find_effect(machine, 1, "backlash"), samples, Eigen::VectorXd::Zero(5)),
               std::invalid_argument);
}

TEST_F(Catalogue, WithoutTheStateItNeedsAnEffectIsRefused) {
  Samples bare = samples;
  bare.state = State();
  for (const std::string& name : effect_names(group::kCatalogue)) {
    Model model(machine);
    model.add(find_effect(machine, 1, name));
    const EffectInfo& info = model.terms[0].effect->info();
    if (info.needs.empty()) {
      EXPECT_NO_THROW(predict(model, bare, false)) << name;
    } else {
      const std::string said = refusal([&] { predict(model, bare, false); });
      EXPECT_TRUE(contains(said, "effect " + name + " needs the samples' " + info.needs[0])) << said;
    }
  }
}

TEST_F(Catalogue, ColumnWithANaNIsRefused) {
  samples.state.velocity_mm_s(17, 2) = std::nan("");
  Model model(machine);
  model.add(find_effect(machine, 1, "servo_lag"));
  EXPECT_EQ(refusal([&] { predict(model, samples, false); }),
            "effect servo_lag needs velocity_mm_s[17], which is not a number");
}

// Play operator stepped through time: the slider is dragged by the edges of the play.
TEST_F(Catalogue, BacklashIsThePlayOperator) {
  samples = moving_samples(machine, {CircleSpec()}, 1800, 20.0);
  for (const double play : {0.03, 2.0, -0.03}) {
    const Eigen::VectorXd values = Eigen::VectorXd::Constant(kLegs, play);
    for (int k = 0; k < kLegs; ++k) {
      const double half = 0.5 * std::abs(play), turned = play < 0.0 ? -1.0 : 1.0;
      double place = slider(k, 0) - half * state().travel_direction(0, k);
      for (Eigen::Index row = 0; row < samples.size(); ++row) {
        place = std::min(std::max(place, slider(k, row) - half), slider(k, row) + half);
        // The operator misses the travel between two samples: up to 1 um at a reversal.
        ASSERT_NEAR(pushed("backlash", values, row).slider()[k], turned * (place - slider(k, row)), 1e-3)
            << "row " << row << " slider " << k;
      }
    }
  }
}

TEST_F(Catalogue, ReversalSpike) {
  const Eigen::VectorXd values = some("reversal_spike", 0.3);
  Ports expected;
  for (const double since_s : {0.01, 0.5}) {
    // Constant acceleration: the slider breaks away at the breakaway travel.
    const double acceleration_mm_s2 = 10.0;
    const double travelled_mm = 0.5 * acceleration_mm_s2 * since_s * since_s;
    samples.state.since_reversal_s.row(kRow).setConstant(since_s);
    samples.state.since_reversal_mm.row(kRow).setConstant(travelled_mm);
    samples.state.acceleration_mm_s2.row(kRow).setConstant(-acceleration_mm_s2);
    for (int k = 0; k < kLegs; ++k) {
      const double height = std::abs(values[3 * k]), breakaway_mm = height * std::exp(values[3 * k + 2]);
      const double breakaway_s = std::sqrt(2.0 * breakaway_mm / acceleration_mm_s2);
      const double windup_mm = since_s < breakaway_s
                                   ? height * travelled_mm / breakaway_mm
                                   : height * std::exp(-(since_s - breakaway_s) / (0.05 * std::exp(values[3 * k + 1])));
      expected.slider()[k] = -state().travel_direction(kRow, k) * std::copysign(windup_mm, values[3 * k]);
    }
    expect_same(pushed("reversal_spike", values), expected);
    // An encoder whose steps are longer than the travel shows none of it: the acceleration does.
    samples.state.since_reversal_mm.row(kRow).setZero();
    expect_same(pushed("reversal_spike", values), expected);
  }
  samples.state.since_reversal_s.row(kRow).setConstant(kLongAgo);
  samples.state.since_reversal_mm.row(kRow).setConstant(kLongAgo);
  EXPECT_TRUE(pushed("reversal_spike", values).value.isZero(0.0));
}

TEST_F(Catalogue, PitchCyclic) {
  const Eigen::VectorXd values = some("pitch_cyclic", 0.01);
  Ports expected;
  for (int k = 0; k < kLegs; ++k) {
    for (int harmonic = 1; harmonic <= 2; ++harmonic) {
      const double angle = 2.0 * M_PI * harmonic * slider(k) / 5.0;
      const int at = 4 * k + 2 * (harmonic - 1);
      expected.slider()[k] += values[at] * std::cos(angle) + values[at + 1] * std::sin(angle);
    }
  }
  expect_same(pushed("pitch_cyclic", values), expected);
}

TEST_F(Catalogue, LeadServoAndDelay) {
  const Eigen::VectorXd values = some("lead_error", 1e-3);
  Ports lead, lag;
  for (int k = 0; k < kLegs; ++k) {
    lead.slider()[k] = values[k] * (slider(k) - 433.0);  // travel 20 to 846
    lag.slider()[k] = -values[k] * state().velocity_mm_s(kRow, k);
  }
  expect_same(pushed("lead_error", values), lead);
  expect_same(pushed("servo_lag", values), lag);
  const Ports delayed = pushed("sample_delay", Eigen::Vector2d(1e-6, 0.0));
  for (int k = 0; k < kLegs; ++k) {
    EXPECT_NEAR(delayed.slider()[k] / 1e-6, state().velocity_mm_s(kRow, k), 1e-3) << "to first order in the delay";
  }
}

TEST_F(Catalogue, AFilterMakesAPartOfADelay) {
  for (const double part : {0.0, 0.3, 1.0}) {
    const double delay = 0.2;
    const Ports delayed = pushed("sample_delay", Eigen::Vector2d(delay, part * part));
    // What the sliders are, for a dead time and a filter of first order: exp(dead d/dt) (1 + filter d/dt) of what is
    // said.
    const double dead = (1.0 - part) * delay, filter = part * delay;
    for (int k = 0; k < kLegs; ++k) {
      const double expected =
          (dead + filter) * state().velocity_mm_s(kRow, k) +
          (dead * dead / 2.0 + dead * filter) * state().acceleration_mm_s2(kRow, k) +
          (std::pow(dead, 3) / 6.0 + dead * dead / 2.0 * filter) * state().jerk_mm_s3(kRow, k) +
          (std::pow(dead, 4) / 24.0 + std::pow(dead, 3) / 6.0 * filter) * state().snap_mm_s4(kRow, k);
      EXPECT_NEAR(delayed.slider()[k], expected, 1e-9 * std::max(1.0, std::abs(expected))) << part;
    }
  }
}

TEST_F(Catalogue, StraightnessIsLevelAtTheEndsAndFullAtMidSpan) {
  const Eigen::VectorXd values = some("straightness", 0.1);
  Ports expected;
  for (int k = 0; k < kLegs; ++k) {
    const int guideway = k / 2;
    const double shape = (slider(k) - 20.0) * (846.0 - slider(k)) / (413.0 * 413.0);
    const double turn = 2.0 * M_PI / 3.0 * guideway;
    expected.slider_joint(k) = shape * Vector3(values[2 * guideway] * std::cos(turn),
                                               values[2 * guideway] * std::sin(turn), values[2 * guideway + 1]);
  }
  expect_same(pushed("straightness", values), expected);
}

TEST_F(Catalogue, ThermalGrowthTakesTemperatureWhereThereIsOneElseTime) {
  const Eigen::VectorXd values = some("screw_thermal", 1e-6);
  const Eigen::Index measured = samples.size() - 5;
  for (const Eigen::Index row : {kRow, measured}) {
    const bool is_measured = row == measured;
    const auto grown = [&](double log_time) {
      const double tau = 1800.0 * std::exp(log_time);
      return is_measured ? state().temperature_c[row] - 20.0 : tau * (1.0 - std::exp(-state().time_s[row] / tau));
    };
    ASSERT_EQ(std::isfinite(state().temperature_c[row]), is_measured);
    Ports legs, screws;
    legs.leg().setConstant((is_measured ? 2e-3 : 3e-6) * grown(-0.5));
    for (int k = 0; k < kLegs; ++k) {
      screws.slider()[k] = values[3 * k + (is_measured ? 0 : 1)] * grown(values[3 * k + 2]) * (slider(k, row) - 433.0);
    }
    expect_same(pushed("leg_thermal", Eigen::Vector3d(2e-3, 3e-6, -0.5), row), legs);
    expect_same(pushed("screw_thermal", values, row), screws);
  }
}

TEST_F(Catalogue, SagLowersThePlatform) {
  Model model(machine);
  model.add(find_effect(machine, 1, "gravity_sag"));
  const double before = forward_table(model, samples).pose(kRow, 2);
  model.set_values(Eigen::VectorXd::Constant(1, 1e-4));
  const double sag = before - forward_table(model, samples).pose(kRow, 2);
  // Castigliano: the load sinks by compliance x load x sum of squared forces per load.
  const double load_n = 12.0 * 9.80665;
  EXPECT_NEAR(sag, 1e-4 * load_n * state().leg_force.row(kRow).squaredNorm(), 1e-3 * sag);
  EXPECT_GT(sag, 0.0);
  for (int k = 0; k < kLegs; ++k) {
    EXPECT_NEAR(pushed("gravity_sag", Eigen::VectorXd::Constant(1, 1e-4)).leg()[k],
                1e-4 * load_n * state().leg_force(kRow, k), 1e-12);
  }
}

TEST_F(Catalogue, JointOffsetMovesOneLegsJoint) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(18);
  values.segment<3>(9) << 0.01, -0.02, 0.03;
  Ports expected;
  expected.platform_joint(3) << 0.01, -0.02, 0.03;
  expect_same(pushed("joint_offset", values), expected);
}

// The leg's inclination to its guideway from the geometry of the drawing, no engine: law of cosines in the triangle of
// slider joint, foot of the perpendicular on the guideway, and ball joint. Friction lags behind it by a mrad.
TEST_F(Catalogue, JointFrictionFollowsTheInclinationOfTheLeg) {
  samples = moving_samples(machine, {CircleSpec()}, 900, 20.0);
  const PoseTable poses = forward_table(Model(machine), samples);
  const Eigen::VectorXd deflections = some("joint_friction", 0.01);
  int reversals = 0;
  for (int k = 0; k < kLegs; ++k) {
    double turned = 0.0, sense = 0.0, before = 0.0;
    for (Eigen::Index row = 0; row < samples.size(); ++row) {
      const Pose pose = poses.at(row);
      const Vector3 joint = pose.position + pose.rotation * platform_joint(machine, k / 2);
      const Vector3 from_vertex = joint - guideway_vertex(machine, k / 2);
      const double along_mm = from_vertex.dot(guideway_direction(machine, k / 2)) - slider(k, row);
      const double angle = std::acos(along_mm / 400.0);
      ASSERT_NEAR(state().slider_joint_angle_rad(row, k), angle, 1e-9);
      const double change = row == 0 ? 0.0 : angle - before;
      before = angle;
      if (row < 2) continue;
      if (sense != 0.0 && change * sense < 0.0) {
        turned = 0.0;
        ++reversals;
      } else if (sense == 0.0) {
        turned = 1.0;  // long before the sweep
      }
      sense = std::copysign(1.0, change);
      turned += std::abs(change);
      const double expected = deflections[k] * sense * (1.0 - 2.0 * std::exp(-turned / 1e-3));
      // Between two samples at a reversal the joint turns up to 0.1 mrad unseen.
      if (turned < 3e-4) continue;
      ASSERT_NEAR(pushed("joint_friction", deflections, row).leg()[k], expected, 0.12 * std::abs(deflections[k]))
          << "row " << row << " leg " << k;
      if (turned > 5e-3) {
        ASSERT_NEAR(pushed("joint_friction", deflections, row).leg()[k], sense * deflections[k],
                    0.02 * std::abs(deflections[k]));
      }
    }
  }
  // A leg is steepest where its ball joint is nearest to the guideway and reverses there and opposite. Guideway 1 has
  // one of the two at the polar angle 0, the end of the sweep.
  EXPECT_EQ(reversals, 2 * kLegs - 2);
}

TEST_F(Catalogue, WhatTheGaugeAdds) {
  Ports drift, gain;
  drift.reading() = 1e-6 * state().time_s[kRow];
  gain.reading() = 0.01 * 0.1;  // circle of 100 mm, bar of 99.9 mm
  expect_same(pushed("bar_drift", Eigen::VectorXd::Constant(1, 1e-6)), drift);
  const Ports found = pushed("bar_gain", Eigen::VectorXd::Constant(1, 0.01));
  EXPECT_NEAR(found.reading(), gain.reading(), 1e-12);
}

TEST_F(Catalogue, BallOfEachSetUp) {
  const EffectPtr effect = find_effect(machine, 3, "ball_eccentricity");
  const Eigen::VectorXd values = 0.05 * Drawing(7).normals(effect->info().size());
  samples.mount[kRow] = 2;
  Eigen::Matrix<double, Eigen::Dynamic, port::kCount> out(1, int{port::kCount});
  out.setZero();
  effect->push({samples, kRow, 1}, values, out);
  Ports expected;
  expected.ball() = values.segment<3>(3 * 2);
  EXPECT_TRUE(out.row(0).transpose().isApprox(expected.value, 1e-12));
  samples.mount[5] = 3;
  EXPECT_EQ(refusal([&] { effect->require(samples); }),
            "mount[5] is 3, expected 0 to 2, the mounts of ball_eccentricity");
}

// The ball's place about the platform's origin, turned exactly: by hand with an elementary rotation, and by what turns
// do not change.
TEST_F(Catalogue, BallTurnsWithItsHolder) {
  const auto index = static_cast<std::size_t>(samples.set_up[kRow]);
  const Vector3 place(3.0, -4.0, 50.0);
  samples.set_ups[index].ball_offset_mm = place;
  const double angle = 0.05;
  Ports expected;
  expected.ball() << 0.0, std::cos(angle) * place.y() - std::sin(angle) * place.z() - place.y(),
      std::sin(angle) * place.y() + std::cos(angle) * place.z() - place.z();
  expect_same(pushed("ball_rotation", Vector3(angle, 0.0, 0.0)), expected);
  const Vector3 turn(0.02, -0.03, 0.01);
  const Vector3 moved = place + pushed("ball_rotation", turn).ball();
  EXPECT_NEAR(moved.norm(), place.norm(), 1e-12 * place.norm());
  EXPECT_NEAR(moved.dot(turn), place.dot(turn), 1e-12);
  EXPECT_LT((moved - place - turn.cross(place)).norm(), turn.squaredNorm() * place.norm());
}

TEST_F(Catalogue, TableIsTheEffectItWasMadeOf) {
  std::vector<TabulatedLink> links;
  EffectInfo info = find_effect(machine, 1, "servo_lag")->info();
  for (int k = 0; k < kLegs; ++k) links.push_back({k, port::kSlider + k, -state().velocity_mm_s.col(k)});
  Model built_in(machine), tabulated(machine);
  built_in.add(find_effect(machine, 1, "servo_lag"));
  tabulated.add(std::make_shared<TabulatedEffect>(info, links));
  const Eigen::VectorXd values = some("servo_lag", 2e-3);
  built_in.set_values(values);
  tabulated.set_values(values);
  for (const Samples& part : {samples, samples.every(7), samples.every(5).every(3)}) {
    const Prediction expected = predict(built_in, part, true), found = predict(tabulated, part, true);
    EXPECT_LT((expected.reading_mm - found.reading_mm).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((expected.jacobian - found.jacobian).cwiseAbs().maxCoeff(), 1e-9);
  }
  const Samples other = moving_samples(machine, {CircleSpec()}, 30);
  EXPECT_TRUE(contains(refusal([&] { predict(tabulated, other, false); }), "is tabulated for 322 samples"));
  links[2].per_unit[4] = std::nan("");
  EXPECT_THROW(TabulatedEffect(info, links), std::invalid_argument);
}

}  // namespace
}  // namespace hexdbb::testing
