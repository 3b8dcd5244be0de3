// The catalogue: every effect the engine knows, one line each, in the order in which lists show them.
//
// The line makes the name known to find_effect() and effect_names(), declares the function that builds the effect, and
// thereby adds it to the derivative tests, the handbook, the Python package and the command line. The function stands
// in the source of the same name in this folder.
#pragma once

#include "hexdbb/effect.hpp"

// clang-format off
#define HEXDBB_CATALOGUE(EFFECT)     \
  EFFECT(leg_length)                 \
  EFFECT(slider_offset)              \
  EFFECT(guideway_translation)       \
  EFFECT(guideway_rotation_xy)       \
  EFFECT(guideway_rotation_yz)       \
  EFFECT(guideway_rotation_centre)   \
  EFFECT(platform_side)              \
  EFFECT(cup_position)               \
  EFFECT(ball_offset)                \
  EFFECT(bar_length)                 \
  EFFECT(backlash)                   \
  EFFECT(reversal_spike)             \
  EFFECT(pitch_cyclic)               \
  EFFECT(lead_error)                 \
  EFFECT(straightness)               \
  EFFECT(servo_lag)                  \
  EFFECT(leg_thermal)                \
  EFFECT(screw_thermal)              \
  EFFECT(gravity_sag)                \
  EFFECT(joint_offset)               \
  EFFECT(joint_friction)             \
  EFFECT(bar_drift)                  \
  EFFECT(bar_gain)                   \
  EFFECT(sample_delay)               \
  EFFECT(ball_eccentricity)          \
  EFFECT(ball_rotation)
// clang-format on

namespace hexdbb::effects {

/// What an effect is built for: the machine, and the number of fixings of the tool cup.
struct Context {
  const Machine& machine;
  int mounts;
};

#define HEXDBB_DECLARE_EFFECT(name) EffectPtr name(const Context& context);
HEXDBB_CATALOGUE(HEXDBB_DECLARE_EFFECT)
#undef HEXDBB_DECLARE_EFFECT

}  // namespace hexdbb::effects
