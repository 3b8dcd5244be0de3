#include "hexdbb/machine.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace hexdbb {

namespace {

Matrix3 third_turns(int count) {
  return Eigen::AngleAxisd(count * 2.0 * M_PI / 3.0, Vector3::UnitZ()).toRotationMatrix();
}

}  // namespace

Vector3 guideway_vertex(const Machine& machine, int guideway) {
  const double br = machine.base_inradius_mm;
  return third_turns(guideway) * Vector3(br, std::sqrt(3.0) * br, 0.0);
}

Vector3 guideway_direction(int guideway) { return third_turns(guideway) * Vector3(0.0, -1.0, 0.0); }

Vector3 guideway_midpoint(const Machine& machine, int guideway) {
  return third_turns(guideway) * Vector3(machine.base_inradius_mm, 0.0, 0.0);
}

Matrix3 guideway_axes(int guideway) { return third_turns(guideway); }

Vector3 platform_joint(const Machine& machine, int guideway) {
  const Vector3 in_plane(machine.platform_circumradius_mm, 0.0, 0.0);
  return third_turns(guideway) * in_plane + Vector3(0.0, 0.0, machine.joint_plane_height_mm);
}

Matrix3 rotation_from_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  using Eigen::AngleAxisd;
  return (AngleAxisd(yaw_rad, Vector3::UnitZ()) * AngleAxisd(pitch_rad, Vector3::UnitY()) *
          AngleAxisd(roll_rad, Vector3::UnitX()))
      .toRotationMatrix();
}

Vector3 rpy_from_rotation(const Matrix3& r) {
  const double pitch = std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2)));
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace hexdbb
