/* A controller in C: load a compensation file for its machine, compute slider targets, compute the pose from them. */
#include <hexdbb/hexdbb.h>
#include <stdio.h>

int main(int argc, char** argv) {
  const hexdbb_dimensions machine = HEXDBB_DIMENSIONS_INIT;
  hexdbb_compensator* compensator = NULL;
  char message[200];
  hexdbb_status status;

  if (argc != 2 || hexdbb_abi_version() != HEXDBB_ABI_VERSION) return 2;
  status = hexdbb_create_from_file(argv[1], &machine, &compensator, message, sizeof message);
  if (status != HEXDBB_OK) { /* run without compensation only if configured to: hexdbb_create_nominal */
    fprintf(stderr, "%s: %s\n", hexdbb_status_name(status), message);
    return 1;
  }

  for (int step = 0; step < 100 && status == HEXDBB_OK; ++step) { /* the real-time loop */
    const hexdbb_pose pose = {-50.0 + step, 20.0, 285.0, 0.0, 0.0, 0.1};
    hexdbb_target target = HEXDBB_TARGET_INIT;
    hexdbb_estimate estimate = HEXDBB_ESTIMATE_INIT;
    status = hexdbb_sliders_from_pose(compensator, &pose, NULL, &target);
    if (status != HEXDBB_OK) break; /* target.sliders_mm holds those of the last successful call */
    status = hexdbb_pose_from_sliders(compensator, target.sliders_mm, NULL, &estimate);
    if (step % 33 == 0) {
      printf("slider 1 at %.4f mm, corrected by %.1f um; platform at x = %.6f mm\n", target.sliders_mm[0],
             1e3 * target.correction_mm[0], estimate.pose.x_mm);
    }
  }
  if (status != HEXDBB_OK) fprintf(stderr, "%s: %s\n", hexdbb_status_name(status), hexdbb_status_text(status));
  hexdbb_destroy(compensator);
  return status == HEXDBB_OK ? 0 : 1;
}
