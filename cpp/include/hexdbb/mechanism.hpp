// The actual mechanism in one sample: positions of the joints on the sliders, lengths of the legs, positions of the
// ball joints on the platform. Assembled from the nominal machine, six slider coordinates and a push at every port.
//
// Assumption: pushes add. The joint centre of slider k is V_i + (s_k + slider_k) d_i + slider_joint_k; products of two
// pushes (50 um on a guideway rotated by 0.2 mrad: 0.01 um) are neglected here; everything after it is exact.
#pragma once

#include "hexdbb/machine.hpp"
#include "hexdbb/ports.hpp"

namespace hexdbb {

/// Constant parts of a machine, computed once.
struct NominalGeometry {
  explicit NominalGeometry(const Machine& machine_in);

  Machine machine;
  Matrix36 vertex;          // V of slider k's guideway, base frame
  Matrix36 direction;       // d of slider k's guideway, base frame
  Matrix36 platform_joint;  // ball joint of leg k, platform frame
};

/// A triangle of ball joints, prepared for the loop equations and for computing the pose from three points.
struct PlatformTriangle {
  PlatformTriangle() = default;
  explicit PlatformTriangle(const Matrix3& joints_in);

  Matrix3 joints;         // ball joint i as column, platform frame
  Vector3 side_squared;   // |Q1Q2|^2, |Q2Q3|^2, |Q3Q1|^2, mm^2
  double mm_per_f;        // error of the shortest side per error of its square
  Matrix3 frame_inverse;  // of the columns Q2-Q1, Q3-Q1, (Q2-Q1) x (Q3-Q1)
};

struct Mechanism {
  Matrix36 slider_joint;    // base frame
  Vector6 leg_length;       // mm
  Matrix36 platform_joint;  // platform frame
};

/// Add slider coordinates and pushes to the nominal machine.
Mechanism assemble(const NominalGeometry& nominal, const Vector6& sliders_mm, const Ports& push) noexcept;

/// Return whether both legs of each pair end in one ball joint, as the RSSR solver requires.
bool joints_are_shared(const Mechanism& mechanism) noexcept;

/// Return the three shared ball joints of a mechanism, as columns.
Matrix3 shared_joints(const Mechanism& mechanism) noexcept;

}  // namespace hexdbb
