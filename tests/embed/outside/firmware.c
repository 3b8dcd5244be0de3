/* A controller in C without files: data as constants, with the same targets as from the file. */
#include <stdio.h>

#include "compensation_constants.h"

int main(void) {
  const hexdbb_dimensions machine = HEXDBB_DIMENSIONS_INIT;
  const hexdbb_pose pose = {10.0, 20.0, 285.0, 0.05, 0.0, 0.1};
  hexdbb_compensator* compensator = NULL;
  hexdbb_target target = HEXDBB_TARGET_INIT;
  char message[200];
  if (hexdbb_create_from_constants(&hexdbb_compensation, &machine, &compensator, message, sizeof message) !=
      HEXDBB_OK) {
    fprintf(stderr, "%s\n", message);
    return 1;
  }
  if (hexdbb_sliders_from_pose(compensator, &pose, NULL, &target) != HEXDBB_OK) return 1;
  printf("%.9f %.9f\n", target.sliders_mm[0], target.largest_correction_mm);
  hexdbb_destroy(compensator);
  return target.largest_correction_mm > 1e-3 ? 0 : 1;
}
