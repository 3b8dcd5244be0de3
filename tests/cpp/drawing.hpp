// Seeded random numbers, poses and pushes. The distributions are computed here: the same with every standard library.
#pragma once

#include <cstdint>
#include <random>

#include "hexdbb/kinematics.hpp"

namespace hexdbb::testing {

/// A value of a type for unevaluated expressions.
template <class T>
const T& any() noexcept;

class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high);
  double normal();
  Vector3 vector(double half_width);  // each component in +-half_width
  Eigen::VectorXd normals(Eigen::Index count);

 private:
  std::mt19937_64 engine_;
};

/// Range of poses: half widths in mm and rad.
struct Extent {
  double lateral_mm;
  double low_mm;  // height of the platform's reference point
  double high_mm;
  double tilt_rad;
  double yaw_rad;
};

constexpr Extent kCircleExtent{100.0, 200.0, 300.0, 0.21, 0.27};  // what circular tests use
constexpr Extent kWorkspace{300.0, 0.0, 420.0, 0.35, 0.45};       // every level height the legs allow, and all around

struct Reached {
  Pose pose;
  Vector6 sliders_mm;
};

/// Draw a pose that the sliders reach and hold: not closer than `smallest_hold` to a singular pose (smallest singular
/// value of the legs' Jacobian, rotations in units of the platform's circumradius) and on the same side of every
/// singular pose as home.
Reached draw_reachable(Drawing& drawing, const NominalGeometry& nominal, const Extent& extent,
                       double smallest_hold = 0.02);

/// Determinant and smallest singular value of the legs' Jacobian at a pose.
struct Hold {
  double determinant;
  double smallest;
};
Hold hold(const NominalGeometry& nominal, const Vector6& sliders_mm, const Pose& pose);

/// Draw a push of every port by up to `length_mm` and, in addition, a rotation of each guideway by up to `angle_rad`
/// about its midpoint; the ball joints of a pair stay shared, or not.
Ports draw_push(Drawing& drawing, const NominalGeometry& nominal, const Vector6& sliders_mm, double length_mm,
                double angle_rad, bool shared_joints);

Pose make_pose(double x, double y, double z, double roll, double pitch, double yaw);

}  // namespace hexdbb::testing
