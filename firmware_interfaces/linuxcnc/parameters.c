#include "parameters.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

#include "rtapi.h"

static char* compensation = NULL;
RTAPI_MP_STRING(compensation, "compensation file (NAME.hexcomp) that `hexdbb compensate` wrote");
static int without_compensation = 0;
RTAPI_MP_INT(without_compensation, "1: run the nominal machine where there is no compensation, or it is refused");

static char* base_inradius_mm = NULL;
RTAPI_MP_STRING(base_inradius_mm, "inradius of the base triangle");
static char* platform_circumradius_mm = NULL;
RTAPI_MP_STRING(platform_circumradius_mm, "circumradius of the platform's joints");
static char* joint_plane_height_mm = NULL;
RTAPI_MP_STRING(joint_plane_height_mm, "height of the joints above the platform's reference point");
static char* leg_length_mm = NULL;
RTAPI_MP_STRING(leg_length_mm, "length of a leg");
static char* travel_min_mm = NULL;
RTAPI_MP_STRING(travel_min_mm, "smallest slider coordinate");
static char* travel_max_mm = NULL;
RTAPI_MP_STRING(travel_max_mm, "largest slider coordinate");
static char* min_gap_mm = NULL;
RTAPI_MP_STRING(min_gap_mm, "smallest distance of two sliders on a guideway");
static char* screw_lead_mm = NULL;
RTAPI_MP_STRING(screw_lead_mm, "lead of the screws");
static char* moved_mass_kg = NULL;
RTAPI_MP_STRING(moved_mass_kg, "mass of the platform and what is on it");

typedef struct {
  const char* name;
  char* const* text;
  size_t offset;
} dimension;

#define DIMENSION(name) {#name, &name, offsetof(hexdbb_dimensions, name)}

static const dimension dimensions[] = {
    DIMENSION(base_inradius_mm),
    DIMENSION(platform_circumradius_mm),
    DIMENSION(joint_plane_height_mm),
    DIMENSION(leg_length_mm),
    DIMENSION(travel_min_mm),
    DIMENSION(travel_max_mm),
    DIMENSION(min_gap_mm),
    DIMENSION(screw_lead_mm),
    DIMENSION(moved_mass_kg),
};

const char* named_compensation(void) { return compensation; }

int may_run_without_compensation(void) { return without_compensation != 0; }

int stated_dimensions(hexdbb_dimensions* out) {
  const hexdbb_dimensions shipped = HEXDBB_DIMENSIONS_INIT;
  *out = shipped;
  for (size_t k = 0; k < sizeof dimensions / sizeof dimensions[0]; ++k) {
    const char* text = *dimensions[k].text;
    char* end = NULL;
    if (text == NULL) continue;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value)) {
      rtapi_print_msg(RTAPI_MSG_ERR, "hexdbb_kins: %s=%s (expected a finite number)\n", dimensions[k].name, text);
      return -EINVAL;
    }
    *(double*)((char*)out + dimensions[k].offset) = value;
  }
  return 0;
}
