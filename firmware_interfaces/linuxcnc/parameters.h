/* Parameters of `loadrt hexdbb_kins NAME=VALUE ...`: the dimensions of the machine and its compensation file.
 *
 * Module parameters cannot be fractional numbers, so dimensions are given as text, in mm and kg. Those not given are
 * the dimensions assumed for the SP-120 (HEXDBB_DIMENSIONS_INIT).
 */
#ifndef HEXDBB_LINUXCNC_PARAMETERS_H
#define HEXDBB_LINUXCNC_PARAMETERS_H

#include <hexdbb/hexdbb.h>

/* Return the compensation file, or NULL where none is named. */
const char* named_compensation(void);

/* Return whether the module may run the nominal machine where there is no valid compensation file. */
int may_run_without_compensation(void);

/* Get the dimensions of the machine. Return 0, or -EINVAL after a message that names the parameter, its value and what
 * was expected. */
int stated_dimensions(hexdbb_dimensions* out);

#endif
