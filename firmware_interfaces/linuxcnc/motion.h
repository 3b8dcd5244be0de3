/* Kinematics in the servo thread: the functions called by motmod, computed by the engine.
 *
 * Which calls are motion. motmod calls kinematicsInverse from two functions: motion-controller, once per period, for
 * the pose the trajectory has reached; and motion-command-handler, once per move, to check whether its end point is
 * within the joints' limits. Only the first is motion: it determines the direction of travel of each slider, and an end
 * point mistaken for a position of the machine would reverse the correction for the play of every slider. The call
 * itself does not show its origin, so the HAL file brackets the controller with two functions of this module:
 *
 *   addf motion-command-handler servo-thread
 *   addf hexdbb-kins.begin      servo-thread
 *   addf motion-controller      servo-thread
 *   addf hexdbb-kins.end        servo-thread
 *
 * A pose outside the bracket is only checked. Where begin never runs, compensation never acts.
 *
 * Velocity: nominal slider coordinates of this pose minus those of the pose before, divided by the time between; the
 * acceleration likewise from two velocities. A step beyond MOTION_STEP_MM is not a motion of this thread (joints were
 * jogged meanwhile) and has zero velocity and no acceleration.
 *
 * The pose of the platform (kinematicsForward) is computed by the same compensator, with the part of the correction in
 * force and the present directions of travel: the joints of a pose lead back to that pose.
 */
#ifndef HEXDBB_LINUXCNC_MOTION_H
#define HEXDBB_LINUXCNC_MOTION_H

#include <hexdbb/hexdbb.h>

#include "pins.h"

/* As the engine's own limit of what it follows (hexdbb_sliders_from_pose). */
#define MOTION_STEP_MM 2.0

typedef struct {
  hexdbb_compensator* following; /* the trajectory */
  hexdbb_compensator* checking;  /* end points; its correction is always on */
  hexdbb_compensator* nominal;   /* the machine without errors */
} kins_engines;

/* Before any of the others. */
void motion_start(const kins_engines* engines, kins_pins* pins);

/* The HAL functions. */
void motion_begin(void* unused, long period_ns);
void motion_end(void* unused, long period_ns);

#endif
