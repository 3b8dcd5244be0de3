// Sensitivity of the reading to a push at each of the 55 ports, against central differences and against the
// six-coordinate form.
#include <gtest/gtest.h>

#include <cmath>

#include "drawing.hpp"
#include "hexdbb/ball_bar.hpp"

namespace hexdbb::testing {
namespace {

static_assert(noexcept(reading_mm(any<Pose>(), any<SetUp>(), any<Ports>())));
static_assert(noexcept(reading_sensitivity(any<NominalGeometry>(), any<Mechanism>(), any<PlatformTriangle>(),
                                           any<Pose>(), any<SetUp>(), any<Ports>(), std::declval<Ports&>())));
static_assert(noexcept(reading_sensitivity_six(any<NominalGeometry>(), any<Mechanism>(), any<Pose>(), any<SetUp>(),
                                               any<Ports>(), std::declval<Ports&>())));

class BallBar : public ::testing::Test {
 protected:
  NominalGeometry nominal{Machine()};
  // The ball is off the platform's axis and the bar points slightly down, so that no port is without effect.
  const hexdbb::SetUp set_up{{3.0, -4.0, 325.0}, {5.0, -7.0, 60.0}, 100.0};

  /// Compute the reading of the machine under this push, by the six-coordinate solver from a neighbouring pose.
  double reading(const Vector6& sliders_mm, const Ports& push, const Pose& near) const {
    const ForwardResult result = forward_six(assemble(nominal, sliders_mm, push), near);
    EXPECT_EQ(result.status, Status::kOk);
    return reading_mm(result.pose, set_up, push);
  }

  void expect_differences(const Ports& sensitivity, const Vector6& sliders_mm, const Ports& push,
                          const Pose& pose) const {
    constexpr double kStep_mm = 1e-3;
    for (int p = 0; p < port::kCount; ++p) {
      Ports above = push, below = push;
      above.value[p] += kStep_mm;
      below.value[p] -= kStep_mm;
      const double slope = (reading(sliders_mm, above, pose) - reading(sliders_mm, below, pose)) / (2.0 * kStep_mm);
      EXPECT_NEAR(sensitivity.value[p], slope, 1e-6 * std::max(std::abs(slope), 1e-2)) << "port " << p;
    }
  }
};

TEST_F(BallBar, ReadingIsDistanceMinusNominalLength) {
  const Pose pose = make_pose(30, 40, 260, 0, 0, M_PI / 2);
  const hexdbb::SetUp plain{{0, 0, 320}, {0, 0, 60}, 100.0};
  EXPECT_NEAR(reading_mm(pose, plain, Ports()), 50.0 - 100.0, 1e-12);
  Ports push;
  push.reading() = 0.25;
  push.ball() << 0.0, -10.0, 0.0;  // platform y is base -x after a quarter turn: 10 mm further along x
  push.cup() << 0.0, 10.0, 0.0;
  EXPECT_NEAR(reading_mm(pose, plain, push), 50.0 - 100.0 + 0.25, 1e-12);
}

TEST_F(BallBar, SensitivityAtEveryPort) {
  Drawing drawing(31);
  for (int i = 0; i < 40; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent, 0.2);
    const Ports push = draw_push(drawing, nominal, reached.sliders_mm, 0.1, 1e-3, true);
    const Mechanism mechanism = assemble(nominal, reached.sliders_mm, push);
    const PlatformTriangle triangle(shared_joints(mechanism));
    RssrAngles angles;
    const ForwardResult solved = forward(mechanism, triangle, angles);
    ASSERT_EQ(solved.status, Status::kOk);
    Ports sensitivity;
    ASSERT_TRUE(reading_sensitivity(nominal, mechanism, triangle, solved.pose, set_up, push, sensitivity));
    expect_differences(sensitivity, reached.sliders_mm, push, solved.pose);
  }
}

TEST_F(BallBar, SensitivityOfAPlatformWithSixJoints) {
  Drawing drawing(32);
  for (int i = 0; i < 40; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent, 0.2);
    const Ports push = draw_push(drawing, nominal, reached.sliders_mm, 0.5, 1e-3, false);
    const Mechanism mechanism = assemble(nominal, reached.sliders_mm, push);
    ASSERT_FALSE(joints_are_shared(mechanism));
    const ForwardResult solved = forward_six(mechanism, reached.pose);
    ASSERT_EQ(solved.status, Status::kOk);
    Ports sensitivity;
    ASSERT_TRUE(reading_sensitivity_six(nominal, mechanism, solved.pose, set_up, push, sensitivity));
    expect_differences(sensitivity, reached.sliders_mm, push, solved.pose);
  }
}

TEST_F(BallBar, BothFormsAgree) {
  Drawing drawing(33);
  for (int i = 0; i < 300; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kWorkspace, 0.05);
    const Mechanism mechanism = assemble(nominal, reached.sliders_mm, Ports());
    const PlatformTriangle triangle(shared_joints(mechanism));
    Ports three, six;
    ASSERT_TRUE(reading_sensitivity(nominal, mechanism, triangle, reached.pose, set_up, Ports(), three));
    ASSERT_TRUE(reading_sensitivity_six(nominal, mechanism, reached.pose, set_up, Ports(), six));
    EXPECT_LT((three.value - six.value).lpNorm<Eigen::Infinity>(), 1e-9 * six.value.lpNorm<Eigen::Infinity>());
  }
}

TEST_F(BallBar, MovingEverythingTogetherChangesNoReading) {
  Drawing drawing(34);
  const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
  const Mechanism mechanism = assemble(nominal, reached.sliders_mm, Ports());
  Ports sensitivity;
  ASSERT_TRUE(reading_sensitivity_six(nominal, mechanism, reached.pose, set_up, Ports(), sensitivity));
  Vector3 base = sensitivity.cup(), platform = sensitivity.ball();
  for (int k = 0; k < kLegs; ++k) {
    base += sensitivity.slider_joint(k);
    platform += sensitivity.platform_joint(k);
  }
  EXPECT_LT(base.norm(), 1e-12);      // slider joints and cup
  EXPECT_LT(platform.norm(), 1e-12);  // ball joints and ball
}

TEST_F(BallBar, BallOnTheCupHasNoDirection) {
  const Pose pose = make_pose(0, 0, 280, 0, 0, 0);
  const hexdbb::SetUp touching{{0, 0, 340}, {0, 0, 60}, 100.0};
  const Mechanism mechanism = assemble(nominal, inverse(nominal, pose).sliders_mm, Ports());
  Ports sensitivity;
  sensitivity.value.setOnes();
  EXPECT_FALSE(reading_sensitivity(nominal, mechanism, PlatformTriangle(shared_joints(mechanism)), pose, touching,
                                   Ports(), sensitivity));
  EXPECT_TRUE(sensitivity.value.isZero());
  sensitivity.value.setOnes();
  EXPECT_FALSE(reading_sensitivity_six(nominal, mechanism, pose, touching, Ports(), sensitivity));
  EXPECT_TRUE(sensitivity.value.isZero());
}

TEST_F(BallBar, FlatMachineHasNoSensitivity) {
  const Pose flat = make_pose(0, 0, -nominal.machine.joint_plane_height_mm, 0, 0, 0);
  const Mechanism mechanism = assemble(nominal, inverse(nominal, flat).sliders_mm, Ports());
  Ports sensitivity;
  EXPECT_FALSE(reading_sensitivity(nominal, mechanism, PlatformTriangle(shared_joints(mechanism)), flat, set_up,
                                   Ports(), sensitivity));
  EXPECT_FALSE(reading_sensitivity_six(nominal, mechanism, flat, set_up, Ports(), sensitivity));
  EXPECT_TRUE(sensitivity.value.isZero());
}

}  // namespace
}  // namespace hexdbb::testing
