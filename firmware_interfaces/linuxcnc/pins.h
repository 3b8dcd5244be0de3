/* The module's HAL pins, hexdbb-kins.NAME; README.md has the table. */
#ifndef HEXDBB_LINUXCNC_PINS_H
#define HEXDBB_LINUXCNC_PINS_H

#include <hexdbb/hexdbb.h>

#include "hal.h"
#include "rtapi.h"

typedef struct {
  hal_bit_t* enable;
  hal_float_t* temperature;
  hal_bit_t* temperature_valid;

  hal_bit_t* loaded;
  hal_float_t* active_part;
  hal_float_t* correction[HEXDBB_SLIDERS];
  hal_float_t* largest_correction;
  hal_s32_t* iterations;
  hal_s32_t* status;
  hal_s32_t* slider;
  hal_u32_t* refused;
  hal_s32_t* pose_status;
  hal_s32_t* pose_iterations;
  hal_float_t* pose_residual;
  hal_s32_t* time;
  hal_s32_t* time_max;
} kins_pins;

/* Export the pins in HAL's shared memory, all zero; NULL where that fails. */
kins_pins* export_pins(int component);

#endif
