// Reading of the ball bar, and its sensitivity to a push at any port.
//
// Model: y = |p + R ball - cup| - L0 + reading push, mm.
// Sensitivity by the implicit function theorem: the legs hold the platform, so the unit vector n of the bar, taken as a
// force on the ball, is in equilibrium with axial forces lambda_k in the legs; then
//   dy = sum_k lambda_k (dl_k + u_k . dB_k - u_k . R dq_k) + n . R dball - n . dcup + dreading,
// with u_k the unit vector of leg k, l_k its length, B_k its slider joint, q_k its platform joint.
#pragma once

#include "hexdbb/kinematics.hpp"

namespace hexdbb {

/// One fixing of the bar: nominal positions of both ends and nominal length.
struct SetUp {
  Vector3 cup_mm = Vector3::Zero();          // base frame
  Vector3 ball_offset_mm = Vector3::Zero();  // platform frame
  double bar_length_mm = 100.0;
};

/// Return the reading at a pose of the platform.
double reading_mm(const Pose& pose, const SetUp& set_up, const Ports& push) noexcept;

/// Compute d reading / d push at every port (mm per mm) where each pair of legs shares its ball joint; `triangle` as
/// for forward(). Return false at a singular pose or where ball and cup coincide; `sensitivity` is then zero.
bool reading_sensitivity(const NominalGeometry& nominal, const Mechanism& mechanism, const PlatformTriangle& triangle,
                         const Pose& pose, const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept;

/// Compute the same for any platform, by a 6 x 6 solution: for platforms whose joints are not shared, and as the test
/// of the first.
bool reading_sensitivity_six(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose,
                             const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept;

}  // namespace hexdbb
