// The nominal HexGlider: three guideways about a base centre, two sliders on each, six legs, one platform.
//
// Base frame: origin at the base centre, z up. Guideway i (0..2) is the horizontal line at distance BR from the centre
// whose nearest point lies in the direction a_i. Its slider coordinate counts from
//   V_i = Rz(a_i) (BR, sqrt(3) BR, 0)   along   d_i = Rz(a_i) (0, -1, 0).
// In the machine of the thesis a_i = 120 deg * i: the guideways form a triangle with the vertices V_i.
// Slider coordinate s_k: distance from V_i along d_i; sliders 2i and 2i+1 ride on guideway i, s_{2i} < s_{2i+1}.
// Platform frame: ball joint Q_i at Rz(b_i) (UR, 0, 0) + (0, 0, IH), b_i = 120 deg * i in the thesis.
// Legs and travels may be of six lengths; in the thesis they are equal.
// Source: thesis sections 2-1 and 2-2, Figure 2.2. (Indices count from 0 here, from 1 in files and reports.)
#pragma once

#include <array>
#include <cmath>

#include "hexdbb/sp120.h"
#include "hexdbb/types.hpp"

namespace hexdbb {

using PerGuideway = std::array<double, kGuideways>;
using PerLeg = std::array<double, kLegs>;

/// Return one value for all six legs or sliders.
constexpr PerLeg six_of(double value) { return {value, value, value, value, value, value}; }

/// The angles of the thesis' guideways and ball joints about z, rad: thirds of a turn.
constexpr PerGuideway kThirds_rad = {0.0, 2.0 * M_PI / 3.0, 4.0 * M_PI / 3.0};

/// Nominal dimensions; by default those assumed for the SP-120 (sp120.h).
struct Machine {
  double base_inradius_mm = HEXDBB_SP120_BASE_INRADIUS_MM;                  // BR
  double platform_circumradius_mm = HEXDBB_SP120_PLATFORM_CIRCUMRADIUS_MM;  // UR
  double joint_plane_height_mm = HEXDBB_SP120_JOINT_PLANE_HEIGHT_MM;        // IH
  PerLeg leg_length_mm = six_of(HEXDBB_SP120_LEG_LENGTH_MM);                // l
  PerLeg travel_min_mm = six_of(HEXDBB_SP120_TRAVEL_MIN_MM);
  PerLeg travel_max_mm = six_of(HEXDBB_SP120_TRAVEL_MAX_MM);
  double min_gap_mm = HEXDBB_SP120_MIN_GAP_MM;  // smallest distance of the two sliders of a guideway
  double screw_lead_mm = HEXDBB_SP120_SCREW_LEAD_MM;
  double moved_mass_kg = HEXDBB_SP120_MOVED_MASS_KG;
  PerGuideway guideway_angle_rad = kThirds_rad;  // a
  PerGuideway joint_angle_rad = kThirds_rad;     // b
};

/// Return V_i, mm, base frame. Here and below, guideways are 0 to 2.
Vector3 guideway_vertex(const Machine& machine, int guideway);

/// Return d_i, a unit vector, base frame.
Vector3 guideway_direction(const Machine& machine, int guideway);

/// Return the point of the guideway nearest to the base centre: s = sqrt(3) BR.
Vector3 guideway_midpoint(const Machine& machine, int guideway);

/// Return the guideway's local axes as columns: x outward from the base centre, y = -d_i, z up.
Matrix3 guideway_axes(const Machine& machine, int guideway);

/// Return the nominal ball joint i in the platform frame.
Vector3 platform_joint(const Machine& machine, int guideway);

/// Middle and half of a travel, mm.
struct Travel {
  double middle_mm, half_mm;
};

/// Return the travel of slider k.
Travel slider_travel(const Machine& machine, int slider);

/// Return the part of a guideway that its two sliders travel.
Travel guideway_travel(const Machine& machine, int guideway);

}  // namespace hexdbb
