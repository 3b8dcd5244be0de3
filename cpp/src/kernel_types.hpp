// Conversions between the engine's Eigen types and the types of the kernels.
#pragma once

#include "hexdbb/mechanism.hpp"
#include "sample_kernel.hpp"

namespace hexdbb::rssr {

inline Vec<double> vec(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

inline Vector3 vector(const Vec<double>& v) { return {v.x, v.y, v.z}; }

inline TriangleFrame<double> frame_of(const PlatformTriangle& triangle) {
  TriangleFrame<double> out;
  for (int i = 0; i < 3; ++i) {
    out.row[i] = vec(triangle.frame_inverse.row(i).transpose());
    out.side_squared[i] = triangle.side_squared[i];
  }
  return out;
}

inline PlacedPlatform<double> placed(const Pose& pose) {
  return {vec(pose.position), {vec(pose.rotation.col(0)), vec(pose.rotation.col(1)), vec(pose.rotation.col(2))}};
}

inline Pose pose_of(const PlacedPlatform<double>& platform) {
  Pose out;
  out.position = vector(platform.position);
  for (int i = 0; i < 3; ++i) out.rotation.col(i) = vector(platform.column[i]);
  return out;
}

/// Return slider joints and shared platform joints; leg lengths are not set.
inline Joints<double> joints_of(const Matrix36& slider_joint, const PlatformTriangle& triangle) {
  Joints<double> out;
  for (int k = 0; k < kLegs; ++k) out.base[k] = vec(slider_joint.col(k));
  for (int i = 0; i < kGuideways; ++i) out.platform[i] = vec(triangle.joints.col(i));
  return out;
}

}  // namespace hexdbb::rssr
