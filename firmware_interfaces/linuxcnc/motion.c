#include "motion.h"

#include <math.h>

#include "kinematics.h"
#include "rtapi.h"

#define RAD_PER_DEG 0.017453292519943295

static kins_engines engines;
static kins_pins* pins;

static bool has_begun, is_moving, has_reported_bracket;
static double since_followed_s;
static double followed_mm[HEXDBB_SLIDERS];   /* nominal; NAN before the first */
static double followed_mm_s[HEXDBB_SLIDERS]; /* velocities then; NAN where there was no motion before */
static hexdbb_status reported;

void motion_start(const kins_engines* given, kins_pins* given_pins) {
  engines = *given;
  pins = given_pins;
  for (int k = 0; k < HEXDBB_SLIDERS; ++k) followed_mm[k] = followed_mm_s[k] = NAN;
}

void motion_begin(void* unused, long period_ns) {
  (void)unused;
  has_begun = is_moving = true;
  since_followed_s += 1e-9 * (double)period_ns;
  hexdbb_enable(engines.following, *pins->enable);
}

void motion_end(void* unused, long period_ns) {
  (void)unused;
  (void)period_ns;
  is_moving = false;
}

static hexdbb_pose to_pose(const EmcPose* world) {
  const hexdbb_pose pose = {world->tran.x,          world->tran.y,          world->tran.z,
                            world->a * RAD_PER_DEG, world->b * RAD_PER_DEG, world->c * RAD_PER_DEG};
  return pose;
}

static hexdbb_motion at_rest(void) {
  hexdbb_motion motion = {(uint32_t)sizeof(hexdbb_motion), 0u, {0.0}, NAN, {0.0}};
  for (int k = 0; k < HEXDBB_SLIDERS; ++k) motion.acceleration_mm_s2[k] = NAN;
  if (*pins->temperature_valid) motion.temperature_c = *pins->temperature;
  return motion;
}

/* Report a status, once until it changes. */
static void report(hexdbb_status status, int slider) {
  if (status == reported) return;
  reported = status;
  if (status == HEXDBB_OK) return;
  rtapi_print_msg(RTAPI_MSG_ERR, "hexdbb_kins: joint %d: %s: %s\n", slider, hexdbb_status_name(status),
                  hexdbb_status_text(status));
}

/* Velocities and accelerations of the sliders, from the nominal machine; see the header. */
static void find_motion(const hexdbb_pose* pose, hexdbb_motion* motion) {
  hexdbb_target now = HEXDBB_TARGET_INIT;
  double largest_mm = 0.0;
  const double step_s = since_followed_s;
  since_followed_s = 0.0;
  if (hexdbb_sliders_from_pose(engines.nominal, pose, NULL, &now) != HEXDBB_OK) return;
  for (int k = 0; k < HEXDBB_SLIDERS; ++k) {
    const double step_mm = now.sliders_mm[k] - followed_mm[k];
    followed_mm[k] = now.sliders_mm[k];
    motion->velocity_mm_s[k] = step_s > 0.0 ? step_mm / step_s : 0.0;
    motion->acceleration_mm_s2[k] = step_s > 0.0 ? (motion->velocity_mm_s[k] - followed_mm_s[k]) / step_s : NAN;
    followed_mm_s[k] = motion->velocity_mm_s[k];
    /* false where there was no position before (NAN) */
    largest_mm = fabs(step_mm) <= MOTION_STEP_MM ? largest_mm : 2.0 * MOTION_STEP_MM;
  }
  if (largest_mm > MOTION_STEP_MM) {
    for (int k = 0; k < HEXDBB_SLIDERS; ++k) {
      motion->velocity_mm_s[k] = 0.0;
      motion->acceleration_mm_s2[k] = followed_mm_s[k] = NAN;
    }
  }
}

static void show(const hexdbb_target* target, long long begun_ns) {
  const int taken_ns = (int)(rtapi_get_time() - begun_ns);
  *pins->time = taken_ns;
  if (taken_ns > *pins->time_max) *pins->time_max = taken_ns;
  *pins->status = target->status;
  *pins->slider = target->slider;
  *pins->iterations = target->iterations;
  *pins->active_part = hexdbb_enabled_part(engines.following);
  if (target->status != HEXDBB_OK) {
    *pins->refused += 1;
    return;
  }
  *pins->largest_correction = target->largest_correction_mm;
  for (int k = 0; k < HEXDBB_SLIDERS; ++k) *pins->correction[k] = target->correction_mm[k];
}

static hexdbb_status follow(const hexdbb_pose* pose, hexdbb_target* target) {
  const long long begun_ns = rtapi_get_time();
  hexdbb_motion motion = at_rest();
  find_motion(pose, &motion);
  hexdbb_sliders_from_pose(engines.following, pose, &motion, target);
  show(target, begun_ns);
  return target->status;
}

static hexdbb_status check(const hexdbb_pose* pose, hexdbb_target* target) {
  const hexdbb_motion motion = at_rest();
  if (!has_begun && *pins->enable && !has_reported_bracket) {
    has_reported_bracket = true;
    rtapi_print_msg(RTAPI_MSG_ERR,
                    "hexdbb_kins: no compensation: hexdbb-kins.begin does not run (expected addf of hexdbb-kins.begin "
                    "before motion-controller, of hexdbb-kins.end after it)\n");
  }
  return hexdbb_sliders_from_pose(has_begun && *pins->enable ? engines.checking : engines.nominal, pose, &motion,
                                  target);
}

int kinematicsInverse(const EmcPose* world, double* joints, const KINEMATICS_INVERSE_FLAGS* iflags,
                      KINEMATICS_FORWARD_FLAGS* fflags) {
  const hexdbb_pose pose = to_pose(world);
  hexdbb_target target = HEXDBB_TARGET_INIT;
  const hexdbb_status status = is_moving ? follow(&pose, &target) : check(&pose, &target);
  (void)iflags;
  (void)fflags;
  report(status, target.slider);
  if (status != HEXDBB_OK) return -1;
  for (int k = 0; k < HEXDBB_SLIDERS; ++k) joints[k] = target.sliders_mm[k];
  return 0;
}

int kinematicsForward(const double* joints, EmcPose* world, const KINEMATICS_FORWARD_FLAGS* fflags,
                      KINEMATICS_INVERSE_FLAGS* iflags) {
  const hexdbb_motion motion = at_rest();
  hexdbb_estimate found = HEXDBB_ESTIMATE_INIT;
  const hexdbb_status status = hexdbb_pose_from_sliders(engines.following, joints, &motion, &found);
  (void)fflags;
  (void)iflags;
  *pins->pose_status = status;
  *pins->pose_iterations = found.iterations;
  *pins->pose_residual = found.residual_mm;
  if (status != HEXDBB_OK) return -1;
  world->tran.x = found.pose.x_mm;
  world->tran.y = found.pose.y_mm;
  world->tran.z = found.pose.z_mm;
  world->a = found.pose.roll_rad / RAD_PER_DEG;
  world->b = found.pose.pitch_rad / RAD_PER_DEG;
  world->c = found.pose.yaw_rad / RAD_PER_DEG;
  world->u = world->v = world->w = 0.0;
  return 0;
}

KINEMATICS_TYPE kinematicsType(void) { return KINEMATICS_BOTH; }

/* There is only one kinematics, so nothing to switch to. (kinematics.h defines these in a macro of K&R style.) */
int kinematicsSwitchable(void) { return 0; }

int kinematicsSwitch(int type) {
  (void)type;
  return 0;
}
