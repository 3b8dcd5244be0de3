// The nominal HexGlider: three guideways forming a triangle, two sliders on each, six legs of equal length, one
// platform.
//
// Base frame: origin at the centre of the base triangle, z up. Guideway i (0..2) is the line through the vertex
//   V_i = Rz(120 deg * i) (BR, sqrt(3) BR, 0)   along   d_i = Rz(120 deg * i) (0, -1, 0).
// Slider coordinate s_k: distance from V_i along d_i; sliders 2i and 2i+1 ride on guideway i, s_{2i} < s_{2i+1}.
// Platform frame: ball joint Q_i at Rz(120 deg * i) (UR, 0, 0) + (0, 0, IH).
// Source: thesis sections 2-1 and 2-2, Figure 2.2. (Indices count from 0 here, from 1 in files and reports.)
#pragma once

#include "hexdbb/types.hpp"

namespace hexdbb {

struct Machine {
  double base_inradius_mm = 250.0;          // BR
  double platform_circumradius_mm = 120.0;  // UR
  double joint_plane_height_mm = 20.0;      // IH
  double leg_length_mm = 400.0;             // l
  double travel_min_mm = 20.0;
  double travel_max_mm = 846.0;
  double min_gap_mm = 60.0;  // smallest distance of the two sliders of a guideway
  double screw_lead_mm = 5.0;
  double moved_mass_kg = 12.0;
};

Vector3 guideway_vertex(const Machine& machine, int guideway);
Vector3 guideway_direction(int guideway);

/// The point of the guideway nearest to the base centre: s = sqrt(3) BR.
Vector3 guideway_midpoint(const Machine& machine, int guideway);

/// Guideway-local axes as columns: x outward from the base centre, y = -d_i, z up.
Matrix3 guideway_axes(int guideway);

/// Nominal ball joint i in the platform frame.
Vector3 platform_joint(const Machine& machine, int guideway);

}  // namespace hexdbb
