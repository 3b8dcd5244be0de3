#include "hexdbb/ball_bar.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "multiversion.hpp"
#include "sample_kernel.hpp"

namespace hexdbb {

namespace {

constexpr double kSingularRatio = 1e-9;

rssr::Vec<double> vec(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

struct Bar {
  Vector3 ball;       // platform frame
  Vector3 arm;        // R ball, base frame
  Vector3 direction;  // unit vector from cup to ball, base frame
  double length_mm;
};

Bar bar(const Pose& pose, const SetUp& set_up, const Ports& push) {
  Bar out;
  out.ball = set_up.ball_offset_mm + push.ball();
  out.arm = pose.rotation * out.ball;
  const Vector3 along = pose.position + out.arm - set_up.cup_mm - push.cup();
  out.length_mm = along.norm();
  out.direction = along / (out.length_mm > 0.0 ? out.length_mm : 1.0);
  return out;
}

/// Fill the sensitivities; `share[k] * leg_k` is the force in leg k, leg_k the vector from slider joint to ball joint.
void fill(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose, const Bar& along,
          const Matrix36& leg, const Vector6& share, Ports& out) {
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 force = share[k] * leg.col(k);
    out.slider()[k] = force.dot(nominal.direction.col(k));
    out.leg()[k] = share[k] * mechanism.leg_length[k];
    out.slider_joint(k) = force;
    out.platform_joint(k).noalias() = -pose.rotation.transpose() * force;
  }
  out.ball().noalias() = pose.rotation.transpose() * along.direction;
  out.cup() = -along.direction;
  out.reading() = 1.0;
}

}  // namespace

double reading_mm(const Pose& pose, const SetUp& set_up, const Ports& push) noexcept {
  const Vector3 ball = set_up.ball_offset_mm + push.ball();
  return (pose.position + pose.rotation * ball - set_up.cup_mm - push.cup()).norm() - set_up.bar_length_mm +
         push.reading();
}

bool reading_sensitivity(const NominalGeometry& nominal, const Mechanism& mechanism, const PlatformTriangle& triangle,
                         const Pose& pose, const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept {
  sensitivity.value.setZero();
  const Bar along = bar(pose, set_up, push);
  if (!(along.length_mm > 0.0)) return false;
  rssr::Joints<double> joints;
  for (int k = 0; k < kLegs; ++k) joints.base[k] = vec(mechanism.slider_joint.col(k));
  for (int i = 0; i < kGuideways; ++i) joints.platform[i] = vec(triangle.joints.col(i));
  rssr::TriangleFrame<double> frame;
  rssr::PlacedPlatform<double> platform;
  platform.position = vec(pose.position);
  for (int i = 0; i < 3; ++i) {
    frame.row[i] = vec(triangle.frame_inverse.row(i).transpose());
    frame.side_squared[i] = triangle.side_squared[i];
    platform.column[i] = vec(pose.rotation.col(i));
  }
  const rssr::LegForces<double> forces =
      rssr::leg_forces(joints, frame, platform, vec(along.ball), vec(along.direction));
  if (!(forces.determinant * forces.determinant > kSingularRatio * kSingularRatio * forces.scale)) return false;
  Matrix36 leg;
  Vector6 share;
  for (int k = 0; k < kLegs; ++k) {
    leg.col(k) << forces.leg[k].x, forces.leg[k].y, forces.leg[k].z;
    share[k] = forces.share[k];
  }
  fill(nominal, mechanism, pose, along, leg, share, sensitivity);
  return true;
}

bool reading_sensitivity_six(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose,
                             const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept {
  sensitivity.value.setZero();
  const Bar along = bar(pose, set_up, push);
  if (!(along.length_mm > 0.0)) return false;
  Matrix36 leg;
  Eigen::Matrix<double, 6, 6> wrench;  // of a unit force per mm of leg, about the platform's reference point
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 arm = pose.rotation * mechanism.platform_joint.col(k);
    leg.col(k) = pose.position + arm - mechanism.slider_joint.col(k);
    wrench.col(k) << leg.col(k), arm.cross(Vector3(leg.col(k)));
  }
  Vector6 wanted;
  wanted << along.direction, along.arm.cross(along.direction);
  const Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>> lu(wrench);
  const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff<Eigen::PropagateNaN>() > kSingularRatio * pivots.maxCoeff())) return false;
  fill(nominal, mechanism, pose, along, leg, lu.solve(wanted), sensitivity);
  return true;
}

}  // namespace hexdbb
