#include "pins.h"

/* Exports one pin; HAL's functions differ by type, hence a macro. */
#define EXPORT(type, direction, member, name) \
  if (failed == 0) failed = hal_pin_##type##_newf(direction, &pins->member, component, "hexdbb-kins." name)

kins_pins* export_pins(int component) {
  kins_pins* pins = hal_malloc(sizeof(kins_pins));
  int failed = 0;
  if (pins == NULL) return NULL;

  EXPORT(bit, HAL_IN, enable, "enable");
  EXPORT(float, HAL_IN, temperature, "temperature");
  EXPORT(bit, HAL_IN, temperature_valid, "temperature-valid");
  EXPORT(bit, HAL_OUT, loaded, "loaded");
  EXPORT(float, HAL_OUT, active_part, "active-part");
  EXPORT(float, HAL_OUT, largest_correction, "largest-correction");
  EXPORT(s32, HAL_OUT, iterations, "iterations");
  EXPORT(s32, HAL_OUT, status, "status");
  EXPORT(s32, HAL_OUT, slider, "slider");
  EXPORT(u32, HAL_OUT, refused, "refused");
  EXPORT(s32, HAL_OUT, pose_status, "pose-status");
  EXPORT(s32, HAL_OUT, pose_iterations, "pose-iterations");
  EXPORT(float, HAL_OUT, pose_residual, "pose-residual");
  EXPORT(s32, HAL_OUT, time, "time");
  EXPORT(s32, HAL_IO, time_max, "time-max");
  for (int k = 0; k < HEXDBB_SLIDERS && failed == 0; ++k) {
    failed = hal_pin_float_newf(HAL_OUT, &pins->correction[k], component, "hexdbb-kins.correction.%d", k);
  }
  return failed == 0 ? pins : NULL;
}
