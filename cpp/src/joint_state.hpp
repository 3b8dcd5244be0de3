// Joints of the nominal machine in motion: angles and rates as state.hpp defines them, for one pose.
//
// The two legs of a guideway form a triangle over the distance D of their sliders. Along the guideway the ball joint is
// x_a = D / 2 + (l_a^2 - l_b^2) / (2 D) beyond slider a and x_b = D - x_a before slider b, at radius rho from the line of
// their joints. Hence
//   angle_a = acos(x_a / l_a),   its rate = -x_a' / rho;   angle_b = acos(-x_b / l_b),   its rate = x_b' / rho,
// without the pose. The swing about the guideway and all that turns at the platform follow from the ball joints'
// velocities: s_a' + x_a' along the guideway, -x_a x_a' / rho outward, and across it the speed that keeps the three sides
// of the platform, three cyclic linear equations.
#pragma once

#include "hexdbb/compensation_tables.hpp"

namespace hexdbb {

/// The two legs of a guideway, numbered 0 and 1.
struct LegPair {
  LegPair() = default;
  LegPair(const NominalGeometry& nominal, int guideway, const Vector6& sliders_mm,
          const Vector6& velocity_mm_s) noexcept;

  /// Angle between a leg and the guideway, and its rate; NaN where the legs do not meet.
  double angle_rad(int leg) const noexcept;
  double rate_rad_s(int leg) const noexcept;

  /// Parts of a unit force in a leg along the guideway and across it: cosine and sine of the angle.
  double along(int leg) const noexcept;
  double across(int leg) const noexcept;

  double length_mm[2] = {};
  double foot_mm[2] = {}, foot_mm_s[2] = {};  // of the ball joint beyond each slider, x_a and -x_b, and their rates
  double slider_mm_s[2] = {};
  double radius_squared = 0.0;  // rho^2; not positive where the legs do not meet
  double along_mm_s = 0.0;      // of the ball joint
};

/// Fill in the joints' columns of a state that tables need, of the legs that they name; `leg_force` is read where loads
/// of drives or carriages are among them. Where locked sliders do not
/// hold the platform, what turns at it is NaN.
void fill_joints(const NominalGeometry& nominal, const Pose& pose, const Vector6& sliders_mm,
                 const Vector6& velocity_mm_s, const Vector6& leg_force, const TableSet& tables,
                 TableState& state) noexcept;

}  // namespace hexdbb
