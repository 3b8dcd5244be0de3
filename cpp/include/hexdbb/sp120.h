/* The dimensions assumed for the SP-120, whose own are not published: the one place where they stand, for C and C++.
 * The shipped machine file (python/hexdbb/data/sp120.toml) holds the same numbers for users to edit.
 */
#ifndef HEXDBB_SP120_H
#define HEXDBB_SP120_H

#define HEXDBB_SP120_BASE_INRADIUS_MM 250.0
#define HEXDBB_SP120_PLATFORM_CIRCUMRADIUS_MM 120.0
#define HEXDBB_SP120_JOINT_PLANE_HEIGHT_MM 20.0
#define HEXDBB_SP120_LEG_LENGTH_MM 400.0
#define HEXDBB_SP120_TRAVEL_MIN_MM 20.0
#define HEXDBB_SP120_TRAVEL_MAX_MM 846.0
#define HEXDBB_SP120_MIN_GAP_MM 60.0
#define HEXDBB_SP120_SCREW_LEAD_MM 5.0
#define HEXDBB_SP120_MOVED_MASS_KG 12.0

#endif
