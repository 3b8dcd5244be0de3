// Joints of the nominal machine in motion: angles and rates as state.hpp defines them, for one pose.
//
// All legs are equally long, so that the two of a guideway form an isosceles triangle: along the guideway the ball joint
// is half-way between the two sliders, at radius rho from the line of their joints. Hence, with h half the distance of
// the sliders (of the first leg; -h of the second),
//   angle = acos(h / l),   its rate = -h' / rho,
// without the pose. The swing about the guideway and all that turns at the platform follow from the ball joints'
// velocities: (s_a' + s_b') / 2 along the guideway, -h h' / rho outward, and across it the speed that keeps the three
// sides of the platform, three cyclic linear equations.
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

  double length_mm = 0.0;
  double half_mm = 0.0, half_mm_s = 0.0;  // h and its rate
  double radius_squared = 0.0;            // rho^2; not positive where the legs do not meet
  double along_mm_s = 0.0;                // of the ball joint
};

/// Fill in the joints' columns of a state that tables need, of the legs that they name. Where locked sliders do not
/// hold the platform, what turns at it is NaN.
void fill_joints(const NominalGeometry& nominal, const Pose& pose, const Vector6& sliders_mm,
                 const Vector6& velocity_mm_s, const TableSet& tables, TableState& state) noexcept;

}  // namespace hexdbb
