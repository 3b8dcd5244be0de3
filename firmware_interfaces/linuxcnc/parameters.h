/* What `loadrt hexdbb_kins NAME=VALUE ...` says: which machine is driven and what corrects it.
 *
 * Module parameters know no numbers with a fraction, so dimensions come as text, in mm and kg. What is not said is that
 * of the SP-120 as shipped (HEXDBB_DIMENSIONS_INIT).
 */
#ifndef HEXDBB_LINUXCNC_PARAMETERS_H
#define HEXDBB_LINUXCNC_PARAMETERS_H

#include <hexdbb/hexdbb.h>

/* The compensation file, or NULL where none is named. */
const char* named_compensation(void);

/* Whether the controller was told to run even where there is no compensation to be had. */
int may_run_without_compensation(void);

/* Dimensions of the machine. 0, or -EINVAL after a message that names the parameter, its value and what was expected.
 */
int stated_dimensions(hexdbb_dimensions* out);

#endif
