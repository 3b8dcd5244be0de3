// For any input the output is finite, and the status is ok only where the legs have their lengths.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drawing.hpp"
#include "hexdbb/ball_bar.hpp"

namespace hexdbb::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double wild(Drawing& drawing) {
  constexpr double kSpecial[] = {kNan, kInfinity, -kInfinity, 0.0, -0.0, 1e300, -1e300, 1e160, 1e100, 5e-324, 433.0};
  const double choice = drawing.uniform(0.0, 1.0);
  if (choice < 0.3) return kSpecial[static_cast<int>(drawing.uniform(0.0, 10.999))];
  if (choice < 0.6) return drawing.uniform(-1e4, 1e4);
  return drawing.uniform(20.0, 846.0);
}

/// Expect a finite pose and a residual that is not NaN (infinite where legs are pulled apart beyond all numbers).
bool finite(const ForwardResult& result) {
  return result.pose.position.allFinite() && result.pose.rotation.allFinite() && !std::isnan(result.residual_mm);
}

void expect_legs_fit(const Mechanism& mechanism, const Pose& pose) {
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 joint = pose.position + pose.rotation * mechanism.platform_joint.col(k);
    EXPECT_NEAR((joint - mechanism.slider_joint.col(k)).norm(), mechanism.leg_length[k], 1e-6);
  }
}

class ForwardFuzz : public ::testing::Test {
 protected:
  NominalGeometry nominal{Machine()};
};

TEST_F(ForwardFuzz, WildSliders) {
  Drawing drawing(21);
  for (int i = 0; i < 5000; ++i) {
    SCOPED_TRACE(i);
    Vector6 sliders;
    for (double& each : sliders) each = wild(drawing);
    const Mechanism mechanism = assemble(nominal, sliders, Ports());
    RssrAngles angles;
    const ForwardResult rssr = forward(mechanism, angles);
    ASSERT_TRUE(finite(rssr)) << sliders.transpose() << ": " << status_name(rssr.status);
    ASSERT_TRUE(angles.cosine.allFinite() && angles.sine.allFinite());
    const ForwardResult six = forward_six(mechanism, home_pose(nominal));
    ASSERT_TRUE(finite(six)) << sliders.transpose() << ": " << status_name(six.status);
    if (!sliders.allFinite()) {
      EXPECT_NE(rssr.status, Status::kOk);
      EXPECT_NE(six.status, Status::kOk);
    }
    if (rssr.status == Status::kOk) expect_legs_fit(mechanism, rssr.pose);
    if (six.status == Status::kOk) expect_legs_fit(mechanism, six.pose);
  }
}

TEST_F(ForwardFuzz, WildPushAtOnePort) {
  Drawing drawing(22);
  const Pose home = home_pose(nominal);
  const Vector6 sliders = inverse(nominal, home).sliders_mm;
  for (int p = 0; p < port::kBall; ++p) {
    for (double value : {kNan, kInfinity, -kInfinity, 1e300, -1e300, 1e160, 1e80}) {
      Ports push;
      push.value[p] = value;
      const Mechanism mechanism = assemble(nominal, sliders, push);
      RssrAngles angles;
      const ForwardResult rssr = forward(mechanism, angles);
      ASSERT_TRUE(finite(rssr)) << "port " << p << " pushed by " << value << ": " << status_name(rssr.status);
      // The pose before the push fits every leg but one: the solver must check all six.
      const ForwardResult six = forward_six(mechanism, home);
      ASSERT_TRUE(finite(six)) << "port " << p << " pushed by " << value << ": " << status_name(six.status);
      ASSERT_NE(six.status, Status::kOk) << "port " << p << " pushed by " << value;
    }
  }
}

TEST_F(ForwardFuzz, StretchedAndTurnedStartAngles) {
  Drawing drawing(23);
  for (int i = 0; i < 1000; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
    RssrAngles angles;
    angles.cosine = drawing.vector(3.0);
    angles.sine = drawing.vector(3.0);
    const Mechanism mechanism = assemble(nominal, reached.sliders_mm, Ports());
    const ForwardResult result = forward(mechanism, angles);
    ASSERT_TRUE(finite(result));
    if (result.status == Status::kOk) expect_legs_fit(mechanism, result.pose);
  }
}

TEST_F(ForwardFuzz, PlatformOfNoSize) {
  Machine machine;
  machine.platform_circumradius_mm = 0.0;
  const NominalGeometry point(machine);
  RssrAngles angles;
  const ForwardResult result = forward(assemble(point, inverse(point, home_pose(point)).sliders_mm, Ports()), angles);
  EXPECT_NE(result.status, Status::kOk);
  EXPECT_TRUE(finite(result));
}

TEST_F(ForwardFuzz, SensitivityIsFiniteEvenWhereThereIsNoPose) {
  Drawing drawing(24);
  const hexdbb::SetUp set_up{{0, 0, 340}, {0, 0, 60}, 100.0};
  for (int i = 0; i < 1000; ++i) {
    Vector6 sliders;
    for (double& each : sliders) each = drawing.uniform(-1e4, 1e4);
    const Mechanism mechanism = assemble(nominal, sliders, Ports());
    const PlatformTriangle triangle(shared_joints(mechanism));
    RssrAngles angles;
    const Pose pose = forward(mechanism, triangle, angles).pose;
    Ports sensitivity;
    reading_sensitivity(nominal, mechanism, triangle, pose, set_up, Ports(), sensitivity);
    ASSERT_TRUE(sensitivity.value.allFinite()) << sliders.transpose();
    reading_sensitivity_six(nominal, mechanism, pose, set_up, Ports(), sensitivity);
    ASSERT_TRUE(sensitivity.value.allFinite()) << sliders.transpose();
  }
}

}  // namespace
}  // namespace hexdbb::testing
