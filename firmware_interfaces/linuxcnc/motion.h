/* Kinematics in the servo thread: what motmod asks, answered by the engine.
 *
 * Which calls are motion. motmod asks for joints from two places: motion-controller, once a period, for the pose the
 * trajectory has reached; and motion-command-handler, once a move, to see whether its end point is within the joints'
 * limits. Only the first may be followed: from it comes the direction of each slider, and an end point taken for a
 * place the machine was at would turn the play of every slider about. The call itself does not say where it comes from,
 * so the HAL file brackets the controller with two functions of this module:
 *
 *   addf motion-command-handler servo-thread
 *   addf hexdbb-kins.begin      servo-thread
 *   addf motion-controller      servo-thread
 *   addf hexdbb-kins.end        servo-thread
 *
 * What is asked outside of the bracket is only looked at. Where begin never runs, compensation never acts.
 *
 * Direction: nominal slider coordinates of this pose less those of the pose before, over the time between. A step
 * beyond MOTION_STEP_MM is no motion of this thread (joints were jogged meanwhile) and has none.
 *
 * Where the platform stands (kinematicsForward) follows from the same compensator, with the part of the correction in
 * force and the sides the sliders are on: joints asked for a pose give that pose back.
 */
#ifndef HEXDBB_LINUXCNC_MOTION_H
#define HEXDBB_LINUXCNC_MOTION_H

#include <hexdbb/hexdbb.h>

#include "pins.h"

/* As the engine's own limit of what it follows (hexdbb_sliders_from_pose). */
#define MOTION_STEP_MM 2.0

typedef struct {
  hexdbb_compensator* following; /* the trajectory */
  hexdbb_compensator* looking;   /* at end points; its correction is always on */
  hexdbb_compensator* nominal;   /* the machine without errors */
} kins_engines;

/* Before any of the others. */
void motion_start(const kins_engines* engines, kins_pins* pins);

/* The HAL functions. */
void motion_begin(void* unused, long period_ns);
void motion_end(void* unused, long period_ns);

#endif
