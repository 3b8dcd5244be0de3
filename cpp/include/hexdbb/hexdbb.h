/* The C interface: kinematics of a HexGlider and the compensation of its measured errors, for motion controllers.
 *
 * Model: pose of the platform <-> coordinates of the six sliders, of the nominal machine or, where a compensation file
 * is loaded, of the machine as diagnosed (see hexdbb/compensation.hpp).
 * Units: mm, rad, s, degrees Celsius. R = Rz(yaw) Ry(pitch) Rx(roll). Sliders are numbered 0 to 5 here.
 *
 * Ownership: a hexdbb_create_... function creates a compensator, hexdbb_destroy frees it; nothing else is owned or
 * kept. Returned strings are constants of the library. Threads: one compensator belongs to one thread. After creation
 * no function allocates, locks, waits or calls the system, so that all but the hexdbb_create_... functions and
 * hexdbb_destroy may be called from a real-time thread. Errors: every function that can fail returns a hexdbb_status, 0
 * for success, and never throws. Versions: structs that may grow begin with struct_size; set it to sizeof the struct
 * (the HEXDBB_..._INIT macros do). A library never reads or writes beyond that size.
 */
#ifndef HEXDBB_HEXDBB_H
#define HEXDBB_HEXDBB_H

#include <stddef.h>
#include <stdint.h>

#include "hexdbb/sp120.h"

#ifdef __cplusplus
#define HEXDBB_NOEXCEPT noexcept
extern "C" {
#else
#define HEXDBB_NOEXCEPT
#endif

#define HEXDBB_ABI_VERSION 1
#define HEXDBB_SLIDERS 6
#define HEXDBB_GUIDEWAYS 3

typedef int32_t hexdbb_status;

enum {
  HEXDBB_OK = 0,
  /* of a pose or a set of slider coordinates; the numbers of hexdbb::Status */
  HEXDBB_UNREACHABLE = 1,
  HEXDBB_SINGULAR = 2,
  HEXDBB_ITERATION_LIMIT = 3,
  HEXDBB_TRAVEL = 4,
  HEXDBB_GAP = 5,
  /* of a correction */
  HEXDBB_CORRECTION_LIMIT = 6, /* larger than the compensation file allows */
  HEXDBB_NOT_A_NUMBER = 7,     /* a pose, coordinate or velocity that is not finite */
  /* of a compensation file */
  HEXDBB_CANNOT_READ = 20,
  HEXDBB_MALFORMED = 21,
  HEXDBB_TRUNCATED = 22,
  HEXDBB_ALTERED = 23, /* the checksum does not match */
  HEXDBB_LATER_VERSION = 24,
  HEXDBB_OTHER_MACHINE = 25,
  HEXDBB_UNKNOWN_EFFECT = 26,
  /* of a call */
  HEXDBB_BAD_ARGUMENT = 40, /* a null pointer, a struct_size this library does not know, an impossible machine */
  HEXDBB_OUT_OF_MEMORY = 41
};

/* Nominal dimensions of a machine, as in its machine file. Where its legs, travels or angles are not all alike, these
 * are the values of leg 1 and slider 1, and a hexdbb_layout has all. */
typedef struct hexdbb_dimensions {
  uint32_t struct_size;
  uint32_t reserved;
  double base_inradius_mm;
  double platform_circumradius_mm;
  double joint_plane_height_mm;
  double leg_length_mm;
  double travel_min_mm;
  double travel_max_mm;
  double min_gap_mm;
  double screw_lead_mm;
  double moved_mass_kg;
} hexdbb_dimensions;

/* The dimensions assumed for the SP-120. */
#define HEXDBB_DIMENSIONS_INIT            \
  {(uint32_t)sizeof(hexdbb_dimensions),   \
   0u,                                    \
   HEXDBB_SP120_BASE_INRADIUS_MM,         \
   HEXDBB_SP120_PLATFORM_CIRCUMRADIUS_MM, \
   HEXDBB_SP120_JOINT_PLANE_HEIGHT_MM,    \
   HEXDBB_SP120_LEG_LENGTH_MM,            \
   HEXDBB_SP120_TRAVEL_MIN_MM,            \
   HEXDBB_SP120_TRAVEL_MAX_MM,            \
   HEXDBB_SP120_MIN_GAP_MM,               \
   HEXDBB_SP120_SCREW_LEAD_MM,            \
   HEXDBB_SP120_MOVED_MASS_KG}

/* What a machine has for each guideway, leg and slider; since 0.2.0. A machine without a layout has guideways and ball
 * joints at thirds of a turn, six equal legs and six equal travels. */
typedef struct hexdbb_layout {
  uint32_t struct_size;
  uint32_t reserved;
  double guideway_angle_rad[HEXDBB_GUIDEWAYS]; /* about z, from the x axis to the direction of the guideway */
  double joint_angle_rad[HEXDBB_GUIDEWAYS];    /* of the ball joints, in the platform frame */
  double leg_length_mm[HEXDBB_SLIDERS];
  double travel_min_mm[HEXDBB_SLIDERS];
  double travel_max_mm[HEXDBB_SLIDERS];
} hexdbb_layout;

/* Pose of the platform frame in the base frame. */
typedef struct hexdbb_pose {
  double x_mm, y_mm, z_mm;
  double roll_rad, pitch_rad, yaw_rad;
} hexdbb_pose;

/* How the machine moves at a pose. */
typedef struct hexdbb_motion {
  uint32_t struct_size;
  uint32_t reserved;
  double velocity_mm_s[HEXDBB_SLIDERS]; /* commanded; its sign is the direction of travel, 0: see below */
  double temperature_c;                 /* measured; NAN where it is not */
  /* commanded; NAN where it is not known: functions of it are then not corrected, because a compensator knows no cycle
   * time. Since 0.2.0; a smaller struct_size: not known */
  double acceleration_mm_s2[HEXDBB_SLIDERS];
} hexdbb_motion;

/* Slider coordinates to command. */
typedef struct hexdbb_target {
  uint32_t struct_size;
  hexdbb_status status;
  double sliders_mm[HEXDBB_SLIDERS];    /* where status is not 0, those of the last successful call */
  double correction_mm[HEXDBB_SLIDERS]; /* the part of them that compensation adds to the nominal coordinates */
  double largest_correction_mm;         /* magnitude */
  int32_t iterations;                   /* inverse solutions taken, 1 to 4 */
  int32_t slider;                       /* at fault, or -1 */
} hexdbb_target;

#define HEXDBB_TARGET_INIT {(uint32_t)sizeof(hexdbb_target), 0, {0.0}, {0.0}, 0.0, 0, -1}

/* Pose of the platform at given slider coordinates. */
typedef struct hexdbb_estimate {
  uint32_t struct_size;
  hexdbb_status status;
  hexdbb_pose pose;   /* where status is not 0, that of the last successful call */
  double residual_mm; /* of the loop equations */
  int32_t iterations; /* Newton steps taken */
  int32_t reserved;
} hexdbb_estimate;

#define HEXDBB_ESTIMATE_INIT {(uint32_t)sizeof(hexdbb_estimate), 0, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0, 0, 0}

/* Compensation data as constants of a program, for firmware without a file system, as written by
 * `hexdbb compensate MODEL --header FILE.h`. */
typedef struct hexdbb_value {
  const char* effect;
  const char* element;
  const char* parameter;
  double value; /* mm, rad, s, N, K and their ratios */
} hexdbb_value;

/* A function of a variable: linear between the knots, held beyond them. It pushes column columns[i] of its port by
 * weights[i] times the column `times` times its value at the variable of slider or leg elements[i]; elements and columns
 * count from 1 as in files. Names are those of compensation files. */
typedef struct hexdbb_table {
  const char* effect;
  const char* port;
  const char* variable; /* "": the value is one number */
  const char* times;    /* "": none */
  double period;        /* of the variable; 0: not periodic */
  uint32_t push_count;
  uint32_t knot_count;
  const int32_t* elements;
  const int32_t* columns;
  const double* weights;
  const double* knots;
  const double* values_mm;
} hexdbb_table;

typedef struct hexdbb_constants {
  uint32_t struct_size;
  uint32_t value_count;
  hexdbb_dimensions machine;
  double max_correction_mm;
  double reversal_travel_mm;
  double reference_temperature_c; /* NAN where none was stated */
  const hexdbb_value* values;
  uint32_t table_count; /* this and what follows: since 0.2.0; a smaller struct_size has no tables */
  uint32_t reserved;
  const hexdbb_table* tables;
  const hexdbb_layout* layout; /* since 0.2.0; NULL, or a smaller struct_size: none */
} hexdbb_constants;

typedef struct hexdbb_compensator hexdbb_compensator;

/* Return HEXDBB_ABI_VERSION of the linked library; a program should refuse to run where it differs from the header. */
uint32_t hexdbb_abi_version(void) HEXDBB_NOEXCEPT;

/* Return the version of the library, as "0.1.0". */
const char* hexdbb_version(void) HEXDBB_NOEXCEPT;

/* Return the name of a status, as "other_machine", and its meaning in words. Never NULL. */
const char* hexdbb_status_name(hexdbb_status status) HEXDBB_NOEXCEPT;
const char* hexdbb_status_text(hexdbb_status status) HEXDBB_NOEXCEPT;

/* Create the kinematics of the nominal machine, without compensation. *out is NULL where it fails. */
hexdbb_status hexdbb_create_nominal(const hexdbb_dimensions* machine, hexdbb_compensator** out) HEXDBB_NOEXCEPT;

/* Create the kinematics of a nominal machine with a layout; NULL: without one. */
hexdbb_status hexdbb_create_nominal_layout(const hexdbb_dimensions* machine, const hexdbb_layout* layout,
                                           hexdbb_compensator** out) HEXDBB_NOEXCEPT;

/* Create a compensator from a compensation file, from the text of one in memory, or from constants.
 * machine: the machine the controller drives; a file of another machine is refused, and so is every file of a machine
 * with a layout: give NULL, which checks nothing, and call hexdbb_check_layout.
 * message: receives one line stating what is wrong (empty where nothing is), cut to message_size; may be NULL.
 * *out is NULL where it fails; a controller should then run without compensation only if configured to. */
hexdbb_status hexdbb_create_from_file(const char* path, const hexdbb_dimensions* machine, hexdbb_compensator** out,
                                      char* message, size_t message_size) HEXDBB_NOEXCEPT;
hexdbb_status hexdbb_create_from_memory(const char* text, size_t length, const hexdbb_dimensions* machine,
                                        hexdbb_compensator** out, char* message, size_t message_size) HEXDBB_NOEXCEPT;
hexdbb_status hexdbb_create_from_constants(const hexdbb_constants* constants, const hexdbb_dimensions* machine,
                                           hexdbb_compensator** out, char* message,
                                           size_t message_size) HEXDBB_NOEXCEPT;

/* Free a compensator; NULL is allowed. */
void hexdbb_destroy(hexdbb_compensator* compensator) HEXDBB_NOEXCEPT;

/* Return HEXDBB_OTHER_MACHINE where a dimension differs by more than 1e-9 of its size. */
hexdbb_status hexdbb_check_machine(const hexdbb_compensator* compensator,
                                   const hexdbb_dimensions* machine) HEXDBB_NOEXCEPT;

/* The same of a machine with a layout; NULL: without one. */
hexdbb_status hexdbb_check_layout(const hexdbb_compensator* compensator, const hexdbb_dimensions* machine,
                                  const hexdbb_layout* layout) HEXDBB_NOEXCEPT;

/* Get the dimensions the compensator was created for; machine->struct_size must be set. */
hexdbb_status hexdbb_get_machine(const hexdbb_compensator* compensator, hexdbb_dimensions* machine) HEXDBB_NOEXCEPT;

/* Get its layout, also where all is alike; layout->struct_size must be set. */
hexdbb_status hexdbb_get_layout(const hexdbb_compensator* compensator, hexdbb_layout* layout) HEXDBB_NOEXCEPT;

/* Switch compensation off (0) or on (any other value; on after creation). It fades over the next 500 calls of
 * hexdbb_sliders_from_pose, so that no slider jumps. */
hexdbb_status hexdbb_enable(hexdbb_compensator* compensator, int on) HEXDBB_NOEXCEPT;

/* Return the part of the correction in force, 0 to 1; 0 for the nominal machine. */
double hexdbb_enabled_part(const hexdbb_compensator* compensator) HEXDBB_NOEXCEPT;

/* Forget the motion so far, as after homing: no slider has a direction of travel, all starts are cold. */
hexdbb_status hexdbb_reset(hexdbb_compensator* compensator) HEXDBB_NOEXCEPT;

/* Compute the slider coordinates to command for a pose. Call it with poses in order of motion.
 * motion: NULL where unknown, equivalent to velocities of 0, no temperature and no accelerations. The direction of
 * travel of a slider whose velocity is 0 follows from the call before; a pose more than 2 mm of slider travel away then
 * changes no direction, unless the next call is near it, so that a controller may check end points in between.
 * out->struct_size must be set. Returns out->status. */
hexdbb_status hexdbb_sliders_from_pose(hexdbb_compensator* compensator, const hexdbb_pose* pose,
                                       const hexdbb_motion* motion, hexdbb_target* out) HEXDBB_NOEXCEPT;

/* Compute the pose at slider coordinates, starting from the pose of the call before: the inverse of
 * hexdbb_sliders_from_pose with the part of the correction in force.
 * motion: NULL where unknown; directions of travel are then those of the last hexdbb_sliders_from_pose.
 * out->struct_size must be set. Returns out->status. */
hexdbb_status hexdbb_pose_from_sliders(hexdbb_compensator* compensator, const double sliders_mm[HEXDBB_SLIDERS],
                                       const hexdbb_motion* motion, hexdbb_estimate* out) HEXDBB_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
