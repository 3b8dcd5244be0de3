// Inverse kinematics: legs of the right length, and a named status where there is no solution.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drawing.hpp"

namespace hexdbb::testing {
namespace {

static_assert(noexcept(inverse(any<NominalGeometry>(), any<Pose>(), any<Ports>())));

class Inverse : public ::testing::Test {
 protected:
  Machine machine;
  NominalGeometry nominal{machine};
  Pose level(double z) const { return make_pose(0, 0, z, 0, 0, 0); }
};

TEST_F(Inverse, LegsHaveTheirLength) {
  Drawing drawing(1);
  for (int i = 0; i < 300; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kWorkspace);
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 slider = nominal.vertex.col(k) + reached.sliders_mm[k] * nominal.direction.col(k);
      const Vector3 joint = reached.pose.position + reached.pose.rotation * nominal.platform_joint.col(k);
      EXPECT_NEAR((joint - slider).norm(), machine.leg_length_mm[k], 1e-10);
    }
    for (int i2 = 0; i2 < kGuideways; ++i2) EXPECT_LT(reached.sliders_mm[2 * i2], reached.sliders_mm[2 * i2 + 1]);
  }
}

TEST_F(Inverse, PushedMachineReachesTheSamePose) {
  Drawing drawing(2);
  for (int i = 0; i < 100; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
    const Ports push = draw_push(drawing, nominal, reached.sliders_mm, 0.1, 0.0, true);
    const InverseResult result = inverse(nominal, reached.pose, push);
    ASSERT_EQ(result.status, Status::kOk);
    RssrAngles angles;
    const ForwardResult back = forward(assemble(nominal, result.sliders_mm, push), angles);
    ASSERT_EQ(back.status, Status::kOk);
    EXPECT_LT((back.pose.position - reached.pose.position).norm(), 1e-10);
    EXPECT_LT((back.pose.rotation - reached.pose.rotation).norm(), 1e-12);
  }
}

TEST_F(Inverse, UnreachableNamesTheFirstLegTooShort) {
  const InverseResult result = inverse(nominal, level(1000.0));
  EXPECT_EQ(result.status, Status::kUnreachable);
  EXPECT_EQ(result.leg, 0);
  EXPECT_TRUE(result.sliders_mm.allFinite());
  // Rolled far over, the third joint drops out of reach of legs 4 and 5 only.
  const InverseResult tilted = inverse(nominal, make_pose(0, 0, 320, -0.5, 0, 0));
  EXPECT_EQ(tilted.status, Status::kUnreachable);
  EXPECT_EQ(tilted.leg, 4);
}

TEST_F(Inverse, BeyondTravel) {
  const InverseResult result = inverse(nominal, make_pose(0, 150, 150, 0, 0, 0));
  EXPECT_EQ(result.status, Status::kTravel);
  EXPECT_EQ(result.leg, 0);
  EXPECT_LT(result.sliders_mm[0], machine.travel_min_mm[0]);
}

TEST_F(Inverse, SlidersTooClose) {
  const double lean = machine.base_inradius_mm - machine.platform_circumradius_mm;
  const double radius = std::sqrt(400.0 * 400.0 - 29.0 * 29.0);  // sliders 58 mm apart, 60 allowed
  const InverseResult result = inverse(nominal, level(std::sqrt(radius * radius - lean * lean) - 20.0));
  EXPECT_EQ(result.status, Status::kGap);
  EXPECT_EQ(result.leg, 1);
  EXPECT_NEAR(result.sliders_mm[1] - result.sliders_mm[0], 58.0, 1e-9);
}

TEST_F(Inverse, NotANumberIsUnreachable) {
  for (double wild : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                      -std::numeric_limits<double>::infinity(), 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      Pose pose = level(240.0);
      pose.position[axis] = wild;
      const InverseResult result = inverse(nominal, pose);
      EXPECT_NE(result.status, Status::kOk);
      EXPECT_GE(result.leg, 0);
      EXPECT_TRUE(result.sliders_mm.allFinite());
      Pose turned = level(240.0);
      turned.rotation(axis, axis) = wild;
      EXPECT_NE(inverse(nominal, turned).status, Status::kOk);
      EXPECT_TRUE(inverse(nominal, turned).sliders_mm.allFinite());
    }
  }
}

TEST_F(Inverse, EveryStatusHasAName) {
  for (Status status :
       {Status::kOk, Status::kUnreachable, Status::kSingular, Status::kIterationLimit, Status::kTravel, Status::kGap}) {
    EXPECT_STRNE(status_name(status), "unknown status");
  }
  EXPECT_STREQ(status_name(static_cast<Status>(99)), "unknown status");
}

TEST_F(Inverse, OrientationRoundTrip) {
  Drawing drawing(3);
  for (int i = 0; i < 100; ++i) {
    const Vector3 rpy = drawing.vector(1.5);
    EXPECT_LT((rpy_from_rotation(rotation_from_rpy(rpy[0], rpy[1], rpy[2])) - rpy).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace hexdbb::testing
