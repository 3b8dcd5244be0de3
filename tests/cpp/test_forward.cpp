// Forward kinematics: both solvers against inverse kinematics and against each other, and their statuses.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "drawing.hpp"

namespace hexdbb::testing {
namespace {

static_assert(noexcept(assemble(any<NominalGeometry>(), any<Vector6>(), any<Ports>())));
static_assert(noexcept(joints_are_shared(any<Mechanism>())) && noexcept(shared_joints(any<Mechanism>())));
static_assert(noexcept(forward(any<Mechanism>(), std::declval<RssrAngles&>())));
static_assert(noexcept(forward(any<Mechanism>(), any<PlatformTriangle>(), std::declval<RssrAngles&>())));
static_assert(noexcept(forward_six(any<Mechanism>(), any<Pose>())));

class Forward : public ::testing::Test {
 protected:
  Machine machine;
  NominalGeometry nominal{machine};
  const Ports none;

  void expect_same(const Pose& found, const Pose& wanted, double mm) const {
    EXPECT_LT((found.position - wanted.position).norm(), mm);
    // An orientation error counts as the displacement of a ball joint.
    EXPECT_LT((found.rotation - wanted.rotation).norm() * machine.platform_circumradius_mm, mm);
  }
};

TEST_F(Forward, RoundTripFromHomeInTheRangeOfCircles) {
  Drawing drawing(11);
  int iterations = 0;
  for (int i = 0; i < 500; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
    RssrAngles angles;
    const ForwardResult result = forward(assemble(nominal, reached.sliders_mm, none), angles);
    ASSERT_EQ(result.status, Status::kOk);
    expect_same(result.pose, reached.pose, 1e-10);
    EXPECT_LE(result.residual_mm, kResidualTolerance_mm);
    EXPECT_LE(result.iterations, 50);
    iterations += result.iterations;
  }
  EXPECT_LE(iterations, 7 * 500);
}

TEST_F(Forward, RoundTripFromHomeOverTheWholeWorkspace) {
  Drawing drawing(12);
  int failed = 0, elsewhere = 0;
  for (int i = 0; i < 1000; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kWorkspace);
    RssrAngles angles;
    const ForwardResult result = forward(assemble(nominal, reached.sliders_mm, none), angles);
    if (result.status != Status::kOk) {
      ++failed;
    } else if ((result.pose.position - reached.pose.position).norm() > 1e-6) {
      ++elsewhere;
    } else {
      expect_same(result.pose, reached.pose, 1e-10);
    }
  }
  EXPECT_EQ(failed, 0) << "no pose found, of 1000";
  EXPECT_EQ(elsewhere, 0) << "another way to assemble the machine was taken for the pose, of 1000";
}

TEST_F(Forward, StartFromAnotherCornerOfTheWorkspace) {
  // Consecutive records, or omitted rows: the last solution is then not a neighbour of the next.
  Drawing drawing(16);
  RssrAngles angles;
  int failed = 0, elsewhere = 0;
  for (int i = 0; i < 1000; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, i % 2 == 0 ? kWorkspace : kCircleExtent);
    const ForwardResult result = forward(assemble(nominal, reached.sliders_mm, none), angles);
    if (result.status != Status::kOk) {
      ++failed;
    } else if ((result.pose.position - reached.pose.position).norm() > 1e-6) {
      ++elsewhere;
    }
  }
  EXPECT_EQ(failed, 0) << "no pose found, of 1000";
  EXPECT_EQ(elsewhere, 0) << "another way to assemble the machine was taken for the pose, of 1000";
}

TEST_F(Forward, OtherMachines) {
  Drawing drawing(17);
  for (const auto& [inradius, circumradius, leg] : {std::tuple{300.0, 80.0, 380.0}, std::tuple{200.0, 180.0, 420.0},
                                                    std::tuple{250.0, 60.0, 330.0}, std::tuple{150.0, 200.0, 300.0}}) {
    Machine other;
    other.base_inradius_mm = inradius;
    other.platform_circumradius_mm = circumradius;
    other.leg_length_mm = six_of(leg);
    other.travel_max_mm = six_of(2.0 * std::sqrt(3.0) * inradius - 20.0);
    const NominalGeometry geometry(other);
    for (int i = 0; i < 100; ++i) {
      const Reached reached = draw_reachable(drawing, geometry, {80.0, 60.0, 400.0, 0.15, 0.15}, 0.05);
      RssrAngles angles;
      const ForwardResult result = forward(assemble(geometry, reached.sliders_mm, none), angles);
      ASSERT_EQ(result.status, Status::kOk) << inradius << " " << circumradius << " " << leg;
      EXPECT_LT((result.pose.position - reached.pose.position).norm(), 1e-10);
    }
  }
}

TEST_F(Forward, RoundTripWarmOverTheWholeWorkspace) {
  Drawing drawing(13);
  int most = 0;
  for (int i = 0; i < 500; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kWorkspace, 0.05);
    RssrAngles angles;  // of the pose itself, then sliders move on by up to 0.1 mm
    const Matrix3 axes[3] = {guideway_axes(machine, 0), guideway_axes(machine, 1), guideway_axes(machine, 2)};
    for (int g = 0; g < kGuideways; ++g) {
      const Vector3 joint = reached.pose.position + reached.pose.rotation * nominal.platform_joint.col(2 * g);
      const Vector3 local = axes[g].transpose() * (joint - nominal.vertex.col(2 * g));
      angles.cosine[g] = local.z() / std::hypot(local.x(), local.z());
      angles.sine[g] = -local.x() / std::hypot(local.x(), local.z());
    }
    const Pose there = {reached.pose.position + drawing.vector(0.1), reached.pose.rotation};
    const InverseResult wanted = inverse(nominal, there);
    if (wanted.status != Status::kOk) continue;  // at the very end of a travel
    const ForwardResult result = forward(assemble(nominal, wanted.sliders_mm, none), angles);
    ASSERT_EQ(result.status, Status::kOk);
    expect_same(result.pose, there, 1e-10);
    most = std::max(most, result.iterations);
    const ForwardResult again = forward(assemble(nominal, wanted.sliders_mm, none), angles);
    EXPECT_LE(again.iterations, 1);  // the solution is kept for the next
  }
  EXPECT_LE(most, 5);
}

TEST_F(Forward, SolversAgreeUnderPushesAtEveryPort) {
  Drawing drawing(14);
  for (int i = 0; i < 300; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
    const Ports push = draw_push(drawing, nominal, reached.sliders_mm, 0.1, 1e-3, true);
    const Mechanism mechanism = assemble(nominal, reached.sliders_mm, push);
    ASSERT_TRUE(joints_are_shared(mechanism));
    RssrAngles angles;
    const ForwardResult rssr = forward(mechanism, angles);
    const ForwardResult six = forward_six(mechanism, home_pose(nominal));
    ASSERT_EQ(rssr.status, Status::kOk);
    ASSERT_EQ(six.status, Status::kOk);
    expect_same(rssr.pose, six.pose, 1e-9);
    // The pushes are not negligible, and no leg is stretched.
    EXPECT_GT((rssr.pose.position - reached.pose.position).norm(), 1e-3);
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 joint = rssr.pose.position + rssr.pose.rotation * mechanism.platform_joint.col(k);
      EXPECT_NEAR((joint - mechanism.slider_joint.col(k)).norm(), mechanism.leg_length[k], 1e-10);
    }
    EXPECT_NEAR(rssr.pose.rotation.determinant(), 1.0, 1e-12);
  }
}

TEST_F(Forward, SixCoordinatesSolveAPlatformWithSixJoints) {
  Drawing drawing(15);
  for (int i = 0; i < 100; ++i) {
    const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
    const Ports push = draw_push(drawing, nominal, reached.sliders_mm, 0.1, 1e-3, false);
    const Mechanism mechanism = assemble(nominal, reached.sliders_mm, push);
    ASSERT_FALSE(joints_are_shared(mechanism));
    const ForwardResult six = forward_six(mechanism, home_pose(nominal));
    ASSERT_EQ(six.status, Status::kOk);
    EXPECT_LE(six.iterations, 10);
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 joint = six.pose.position + six.pose.rotation * mechanism.platform_joint.col(k);
      EXPECT_NEAR((joint - mechanism.slider_joint.col(k)).norm(), mechanism.leg_length[k], 1e-11);
    }
  }
}

TEST_F(Forward, LegsThatDoNotMeetAreUnreachable) {
  Vector6 sliders = inverse(nominal, home_pose(nominal)).sliders_mm;
  sliders[0] = 20.0;
  sliders[1] = 830.0;  // two legs of 400 mm do not span 810 mm
  RssrAngles angles;
  const RssrAngles before = angles;
  EXPECT_EQ(forward(assemble(nominal, sliders, none), angles).status, Status::kUnreachable);
  EXPECT_EQ(angles.cosine, before.cosine);  // the start is kept where there is no solution
  EXPECT_EQ(angles.sine, before.sine);
  sliders[1] = sliders[0];  // both sliders in one place: a sphere, not a circle
  EXPECT_EQ(forward(assemble(nominal, sliders, none), angles).status, Status::kUnreachable);
}

TEST_F(Forward, LoopsThatCannotCloseAreReported) {
  // Legs nearly flat along their guideways: the ball joints stay 9 mm from them, 415 mm and more apart, where sides are
  // 208 mm.
  Vector6 sliders;
  sliders << 33.1, 832.9, 33.1, 832.9, 33.1, 832.9;
  RssrAngles angles;
  const ForwardResult result = forward(assemble(nominal, sliders, none), angles);
  EXPECT_TRUE(result.status == Status::kSingular || result.status == Status::kIterationLimit)
      << status_name(result.status);
  EXPECT_GT(result.residual_mm, 1.0);
  const ForwardResult six = forward_six(assemble(nominal, sliders, none), home_pose(nominal));
  EXPECT_TRUE(six.status == Status::kSingular || six.status == Status::kIterationLimit) << status_name(six.status);
}

TEST_F(Forward, FlatMachineIsSingular) {
  // All ball joints at the guideways' height: the platform can rise and sink with the sliders locked.
  const Pose flat = make_pose(0, 0, -machine.joint_plane_height_mm, 0, 0, 0);
  const InverseResult sliders = inverse(nominal, flat);
  ASSERT_EQ(sliders.status, Status::kOk);
  RssrAngles angles;
  angles.cosine.setZero();
  angles.sine.setOnes();
  EXPECT_EQ(forward(assemble(nominal, sliders.sliders_mm, none), angles).status, Status::kSingular);
}

TEST_F(Forward, AnglesAreThoseOfTheThesis) {
  const InverseResult sliders = inverse(nominal, home_pose(nominal));
  RssrAngles angles;
  ASSERT_EQ(forward(assemble(nominal, sliders.sliders_mm, none), angles).status, Status::kOk);
  const double half_span = 0.5 * (sliders.sliders_mm[1] - sliders.sliders_mm[0]);
  const double lean = std::asin((machine.base_inradius_mm - machine.platform_circumradius_mm) /
                                std::sqrt(400.0 * 400.0 - half_span * half_span));
  for (int i = 0; i < kGuideways; ++i) EXPECT_NEAR(angles.angle_rad()[i], lean, 1e-12);
}

}  // namespace
}  // namespace hexdbb::testing
