#include "drawing.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace hexdbb::testing {

double Drawing::uniform(double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
}

double Drawing::normal() {  // Box-Muller
  const double radius = std::sqrt(-2.0 * std::log(uniform(0.0, 1.0) + 0x1p-54));
  return radius * std::cos(uniform(0.0, 2.0 * M_PI));
}

Vector3 Drawing::vector(double half_width) {
  const double x = uniform(-half_width, half_width);
  const double y = uniform(-half_width, half_width);
  return {x, y, uniform(-half_width, half_width)};
}

Eigen::VectorXd Drawing::normals(Eigen::Index count) {
  Eigen::VectorXd out(count);
  for (double& each : out) each = normal();
  return out;
}

Pose make_pose(double x, double y, double z, double roll, double pitch, double yaw) {
  return {Vector3(x, y, z), rotation_from_rpy(roll, pitch, yaw)};
}

Hold hold(const NominalGeometry& nominal, const Vector6& sliders_mm, const Pose& pose) {
  Eigen::Matrix<double, 6, 6> jacobian;
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 arm = pose.rotation * nominal.platform_joint.col(k);
    const Vector3 slider_joint = nominal.vertex.col(k) + sliders_mm[k] * nominal.direction.col(k);
    const Vector3 leg = (pose.position + arm - slider_joint).normalized();
    jacobian.row(k) << leg.transpose(), (arm / nominal.machine.platform_circumradius_mm).cross(leg).transpose();
  }
  return {jacobian.determinant(), jacobian.jacobiSvd().singularValues()[5]};
}

Reached draw_reachable(Drawing& drawing, const NominalGeometry& nominal, const Extent& extent, double smallest_hold) {
  const Pose home = home_pose(nominal);
  const double home_side = hold(nominal, inverse(nominal, home).sliders_mm, home).determinant;
  for (;;) {
    const double x = drawing.uniform(-extent.lateral_mm, extent.lateral_mm);
    const double y = drawing.uniform(-extent.lateral_mm, extent.lateral_mm);
    const double z = drawing.uniform(extent.low_mm, extent.high_mm);
    const double roll = drawing.uniform(-extent.tilt_rad, extent.tilt_rad);
    const double pitch = drawing.uniform(-extent.tilt_rad, extent.tilt_rad);
    const Pose pose = make_pose(x, y, z, roll, pitch, drawing.uniform(-extent.yaw_rad, extent.yaw_rad));
    const InverseResult result = inverse(nominal, pose);
    if (result.status != Status::kOk) continue;
    const Hold here = hold(nominal, result.sliders_mm, pose);
    if (here.determinant * home_side > 0.0 && here.smallest > smallest_hold) return {pose, result.sliders_mm};
  }
}

Ports draw_push(Drawing& drawing, const NominalGeometry& nominal, const Vector6& sliders_mm, double length_mm,
                double angle_rad, bool shared_joints) {
  Ports push;
  for (double& each : push.value) each = drawing.uniform(-length_mm, length_mm);
  for (int i = 0; i < kGuideways; ++i) {
    const Eigen::AngleAxisd turn(drawing.uniform(-angle_rad, angle_rad), drawing.vector(1.0).normalized());
    for (int k : {2 * i, 2 * i + 1}) {
      const Vector3 joint = nominal.vertex.col(k) + sliders_mm[k] * nominal.direction.col(k);
      const Vector3 lever = joint - guideway_midpoint(nominal.machine, i);
      push.slider_joint(k) += turn * lever - lever;
    }
    if (shared_joints) push.platform_joint(2 * i + 1) = push.platform_joint(2 * i).eval();
  }
  return push;
}

}  // namespace hexdbb::testing
