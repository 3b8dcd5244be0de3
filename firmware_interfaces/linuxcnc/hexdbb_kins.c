/* Kinematics module of the HexGlider for LinuxCNC, its measured errors compensated: joints 0 to 5 are sliders 1 to 6 in
 * mm, X Y Z A B C the platform's pose in mm and degrees, R = Rz(C) Ry(B) Rx(A).
 *
 * This file: loading and unloading, outside of the servo thread; all files are read and all memory is allocated here.
 */
#include <errno.h>

#include "hal.h"
#include "motion.h"
#include "parameters.h"
#include "pins.h"
#include "rtapi.h"
#include "rtapi_app.h"

MODULE_AUTHOR("hexdbb");
MODULE_DESCRIPTION("kinematics of the HexGlider with compensation of its measured errors");
MODULE_LICENSE("Apache-2.0");

#define MESSAGE_SIZE 600

static int component = -1;
static kins_engines engines;

static void destroy_engines(void) {
  hexdbb_destroy(engines.following);
  hexdbb_destroy(engines.checking);
  hexdbb_destroy(engines.nominal);
}

static hexdbb_status create_nominal(const hexdbb_dimensions* machine, hexdbb_compensator** out) {
  const hexdbb_status status = hexdbb_create_nominal(machine, out);
  if (status != HEXDBB_OK) {
    rtapi_print_msg(RTAPI_MSG_ERR, "hexdbb_kins: %s: no machine of these dimensions can be assembled\n",
                    hexdbb_status_name(status));
  }
  return status;
}

/* Create the compensator of the file, or of the nominal machine where that is allowed; a fault of the file is reported
 * in both cases. */
static hexdbb_status create_compensated(const hexdbb_dimensions* machine, hexdbb_compensator** out, int* is_loaded) {
  char message[MESSAGE_SIZE] = "";
  hexdbb_status status = HEXDBB_CANNOT_READ;
  *is_loaded = 0;
  if (named_compensation() != NULL) {
    status = hexdbb_create_from_file(named_compensation(), machine, out, message, sizeof message);
    *is_loaded = status == HEXDBB_OK;
    if (*is_loaded) return HEXDBB_OK;
    rtapi_print_msg(RTAPI_MSG_ERR, "hexdbb_kins: compensation refused: %s: %s\n", hexdbb_status_name(status), message);
  } else if (!may_run_without_compensation()) {
    rtapi_print_msg(
        RTAPI_MSG_ERR,
        "hexdbb_kins: no compensation named (expected compensation=FILE.hexcomp or without_compensation=1)\n");
  }
  if (!may_run_without_compensation()) return status;
  return create_nominal(machine, out);
}

/* A compensator starts with its correction in force; the pin decides about it, and no joint may jump. */
static void fade_out(hexdbb_compensator* compensator) {
  const hexdbb_pose anywhere = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  hexdbb_target target = HEXDBB_TARGET_INIT;
  hexdbb_enable(compensator, 0);
  while (hexdbb_enabled_part(compensator) > 0.0) hexdbb_sliders_from_pose(compensator, &anywhere, NULL, &target);
  hexdbb_reset(compensator);
}

static int create_engines(int* is_loaded) {
  hexdbb_dimensions machine;
  const int failed = stated_dimensions(&machine);
  int is_loaded_again;
  if (failed != 0) return failed;
  if (create_nominal(&machine, &engines.nominal) != HEXDBB_OK) return -EINVAL;
  if (create_compensated(&machine, &engines.following, is_loaded) != HEXDBB_OK) return -EINVAL;
  if (!*is_loaded) return hexdbb_create_nominal(&machine, &engines.checking) == HEXDBB_OK ? 0 : -ENOMEM;
  if (create_compensated(&machine, &engines.checking, &is_loaded_again) != HEXDBB_OK) return -EINVAL;
  fade_out(engines.following);
  return 0;
}

static int abort_loading(int failed) {
  destroy_engines();
  if (component >= 0) hal_exit(component);
  return failed;
}

int rtapi_app_main(void) {
  int is_loaded = 0, failed;
  kins_pins* pins;
  if (hexdbb_abi_version() != HEXDBB_ABI_VERSION) return -EINVAL;
  failed = create_engines(&is_loaded);
  if (failed != 0) return abort_loading(failed);
  component = hal_init("hexdbb_kins");
  if (component < 0) return abort_loading(component);
  pins = export_pins(component);
  if (pins == NULL) return abort_loading(-ENOMEM);
  *pins->loaded = is_loaded;
  *pins->slider = -1;
  motion_start(&engines, pins);
  failed = hal_export_funct("hexdbb-kins.begin", motion_begin, NULL, 1, 0, component);
  if (failed == 0) failed = hal_export_funct("hexdbb-kins.end", motion_end, NULL, 1, 0, component);
  if (failed == 0) failed = hal_ready(component);
  return failed == 0 ? 0 : abort_loading(failed);
}

void rtapi_app_exit(void) {
  hal_exit(component);
  destroy_engines();
}
