#include "hexdbb/machine.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

Matrix3 turn_about_z(double angle_rad) { return Eigen::AngleAxisd(angle_rad, Vector3::UnitZ()).toRotationMatrix(); }

Travel between(double least_mm, double largest_mm) {
  return {0.5 * (least_mm + largest_mm), 0.5 * (largest_mm - least_mm)};
}

}  // namespace

Vector3 guideway_vertex(const Machine& machine, int guideway) {
  const double br = machine.base_inradius_mm;
  return guideway_axes(machine, guideway) * Vector3(br, std::sqrt(3.0) * br, 0.0);
}

Vector3 guideway_direction(const Machine& machine, int guideway) {
  return guideway_axes(machine, guideway) * Vector3(0.0, -1.0, 0.0);
}

Vector3 guideway_midpoint(const Machine& machine, int guideway) {
  return guideway_axes(machine, guideway) * Vector3(machine.base_inradius_mm, 0.0, 0.0);
}

Matrix3 guideway_axes(const Machine& machine, int guideway) {
  return turn_about_z(machine.guideway_angle_rad[guideway]);
}

Vector3 platform_joint(const Machine& machine, int guideway) {
  const Vector3 in_plane(machine.platform_circumradius_mm, 0.0, 0.0);
  return turn_about_z(machine.joint_angle_rad[guideway]) * in_plane + Vector3(0.0, 0.0, machine.joint_plane_height_mm);
}

Travel slider_travel(const Machine& machine, int slider) {
  return between(machine.travel_min_mm[slider], machine.travel_max_mm[slider]);
}

Travel guideway_travel(const Machine& machine, int guideway) {
  const int a = 2 * guideway, b = a + 1;
  return between(std::min(machine.travel_min_mm[a], machine.travel_min_mm[b]),
                 std::max(machine.travel_max_mm[a], machine.travel_max_mm[b]));
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
