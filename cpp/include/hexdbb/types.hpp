// Fixed-size vectors and matrices of the engine. Lengths in mm, angles in rad, time in s, forces in N.
#pragma once

#include <Eigen/Core>

namespace hexdbb {

constexpr int kGuideways = 3;
constexpr int kLegs = 6;

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, kLegs, 1>;
using Matrix36 = Eigen::Matrix<double, 3, kLegs>;

/// Return the guideway (0..2) of slider or leg k (0..5).
constexpr int guideway_of(int leg) { return leg / 2; }

/// Position and orientation of the platform frame in the base frame: a point x of the platform is at
/// `position + rotation * x`.
struct Pose {
  Vector3 position = Vector3::Zero();
  Matrix3 rotation = Matrix3::Identity();
};

/// Compute R = Rz(yaw) Ry(pitch) Rx(roll), thesis (2.27).
Matrix3 rotation_from_rpy(double roll_rad, double pitch_rad, double yaw_rad);

/// Compute (roll, pitch, yaw) in rad, the inverse of rotation_from_rpy: thesis (2.31)-(2.33), for any orientation with
/// |pitch| below 90 deg.
Vector3 rpy_from_rotation(const Matrix3& rotation);

}  // namespace hexdbb
