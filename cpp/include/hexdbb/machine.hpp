// The nominal HexGlider: three guideways forming a triangle, two sliders on each, six legs of equal length, one
// platform.
//
// Base frame: origin at the centre of the base triangle, z up. Guideway i (0..2) is the line through the vertex
//   V_i = Rz(120 deg * i) (BR, sqrt(3) BR, 0)   along   d_i = Rz(120 deg * i) (0, -1, 0).
// Slider coordinate s_k: distance from V_i along d_i; sliders 2i and 2i+1 ride on guideway i, s_{2i} < s_{2i+1}.
// Platform frame: ball joint Q_i at Rz(120 deg * i) (UR, 0, 0) + (0, 0, IH).
// Source: thesis sections 2-1 and 2-2, Figure 2.2. (Indices count from 0 here, from 1 in files and reports.)
#pragma once

#include "hexdbb/sp120.h"
#include "hexdbb/types.hpp"

namespace hexdbb {

/// Nominal dimensions; by default those assumed for the SP-120 (sp120.h).
struct Machine {
  double base_inradius_mm = HEXDBB_SP120_BASE_INRADIUS_MM;                  // BR
  double platform_circumradius_mm = HEXDBB_SP120_PLATFORM_CIRCUMRADIUS_MM;  // UR
  double joint_plane_height_mm = HEXDBB_SP120_JOINT_PLANE_HEIGHT_MM;        // IH
  double leg_length_mm = HEXDBB_SP120_LEG_LENGTH_MM;                        // l
  double travel_min_mm = HEXDBB_SP120_TRAVEL_MIN_MM;
  double travel_max_mm = HEXDBB_SP120_TRAVEL_MAX_MM;
  double min_gap_mm = HEXDBB_SP120_MIN_GAP_MM;  // smallest distance of the two sliders of a guideway
  double screw_lead_mm = HEXDBB_SP120_SCREW_LEAD_MM;
  double moved_mass_kg = HEXDBB_SP120_MOVED_MASS_KG;
};

/// Return V_i, mm, base frame. Here and below, guideways are 0 to 2.
Vector3 guideway_vertex(const Machine& machine, int guideway);

/// Return d_i, a unit vector, base frame.
Vector3 guideway_direction(int guideway);

/// Return the point of the guideway nearest to the base centre: s = sqrt(3) BR.
Vector3 guideway_midpoint(const Machine& machine, int guideway);

/// Return the guideway's local axes as columns: x outward from the base centre, y = -d_i, z up.
Matrix3 guideway_axes(int guideway);

/// Return the nominal ball joint i in the platform frame.
Vector3 platform_joint(const Machine& machine, int guideway);

}  // namespace hexdbb
