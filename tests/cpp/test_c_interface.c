/* The C interface compiled as C11: layout of every struct as version 1 has it, and every function called. */
#include <hexdbb/hexdbb.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define LAYOUT(type, member, offset) _Static_assert(offsetof(type, member) == (offset), #type "." #member " moved")
#define SIZE(type, size) _Static_assert(sizeof(type) == (size), #type " changed its size")

SIZE(hexdbb_status, 4);
SIZE(hexdbb_dimensions, 80);
LAYOUT(hexdbb_dimensions, base_inradius_mm, 8);
LAYOUT(hexdbb_dimensions, platform_circumradius_mm, 16);
LAYOUT(hexdbb_dimensions, joint_plane_height_mm, 24);
LAYOUT(hexdbb_dimensions, leg_length_mm, 32);
LAYOUT(hexdbb_dimensions, travel_min_mm, 40);
LAYOUT(hexdbb_dimensions, travel_max_mm, 48);
LAYOUT(hexdbb_dimensions, min_gap_mm, 56);
LAYOUT(hexdbb_dimensions, screw_lead_mm, 64);
LAYOUT(hexdbb_dimensions, moved_mass_kg, 72);
SIZE(hexdbb_pose, 48);
LAYOUT(hexdbb_pose, roll_rad, 24);
SIZE(hexdbb_motion, 112);
LAYOUT(hexdbb_motion, velocity_mm_s, 8);
LAYOUT(hexdbb_motion, temperature_c, 56);
LAYOUT(hexdbb_motion, acceleration_mm_s2, 64);
SIZE(hexdbb_target, 120);
LAYOUT(hexdbb_target, status, 4);
LAYOUT(hexdbb_target, sliders_mm, 8);
LAYOUT(hexdbb_target, correction_mm, 56);
LAYOUT(hexdbb_target, largest_correction_mm, 104);
LAYOUT(hexdbb_target, iterations, 112);
LAYOUT(hexdbb_target, slider, 116);
SIZE(hexdbb_estimate, 72);
LAYOUT(hexdbb_estimate, status, 4);
LAYOUT(hexdbb_estimate, pose, 8);
LAYOUT(hexdbb_estimate, residual_mm, 56);
LAYOUT(hexdbb_estimate, iterations, 64);
SIZE(hexdbb_value, 3 * sizeof(char*) + 8);
LAYOUT(hexdbb_constants, value_count, 4);
LAYOUT(hexdbb_constants, machine, 8);
LAYOUT(hexdbb_constants, max_correction_mm, 88);
LAYOUT(hexdbb_constants, values, 112);
LAYOUT(hexdbb_constants, table_count, 112 + sizeof(char*)); /* the struct's size before there were tables */
LAYOUT(hexdbb_constants, tables, 120 + sizeof(char*));
LAYOUT(hexdbb_constants, layout, 120 + 2 * sizeof(char*)); /* the struct's size before there were layouts */
SIZE(hexdbb_layout, 200);
LAYOUT(hexdbb_layout, joint_angle_rad, 32);
LAYOUT(hexdbb_layout, leg_length_mm, 56);
LAYOUT(hexdbb_layout, travel_max_mm, 152);
LAYOUT(hexdbb_table, period, 4 * sizeof(char*));
LAYOUT(hexdbb_table, push_count, 4 * sizeof(char*) + 8);
LAYOUT(hexdbb_table, elements, 4 * sizeof(char*) + 16);
SIZE(hexdbb_table, 9 * sizeof(char*) + 16);

static int failures = 0;

#define EXPECT(condition)                                             \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                     \
    }                                                                 \
  } while (0)

static const hexdbb_pose kPose = {10.0, -20.0, 285.0, 0.05, -0.02, 0.1};

static const hexdbb_value kValues[] = {
    {"leg_length", "1", "longer", 0.05}, {"leg_length", "2", "longer", 0.0}, {"leg_length", "3", "longer", 0.0},
    {"leg_length", "4", "longer", 0.0},  {"leg_length", "5", "longer", 0.0}, {"leg_length", "6", "longer", -0.02},
};

static hexdbb_constants constants(void) {
  const hexdbb_dimensions machine = HEXDBB_DIMENSIONS_INIT;
  const hexdbb_constants out = {sizeof(hexdbb_constants), 6, machine, 1.0, 0.01, NAN, kValues, 0, 0, NULL, NULL};
  return out;
}

static void nominal_kinematics_there_and_back(void) {
  const hexdbb_dimensions machine = HEXDBB_DIMENSIONS_INIT;
  hexdbb_compensator* nominal = NULL;
  hexdbb_target target = HEXDBB_TARGET_INIT;
  hexdbb_estimate estimate = HEXDBB_ESTIMATE_INIT;
  EXPECT(hexdbb_create_nominal(&machine, &nominal) == HEXDBB_OK);
  EXPECT(hexdbb_sliders_from_pose(nominal, &kPose, NULL, &target) == HEXDBB_OK);
  EXPECT(target.largest_correction_mm == 0.0 && target.iterations == 1 && target.slider == -1);
  EXPECT(hexdbb_pose_from_sliders(nominal, target.sliders_mm, NULL, &estimate) == HEXDBB_OK);
  EXPECT(fabs(estimate.pose.x_mm - kPose.x_mm) < 1e-9 && fabs(estimate.pose.z_mm - kPose.z_mm) < 1e-9);
  EXPECT(fabs(estimate.pose.roll_rad - kPose.roll_rad) < 1e-11 && fabs(estimate.pose.yaw_rad - kPose.yaw_rad) < 1e-11);
  EXPECT(hexdbb_enabled_part(nominal) == 0.0);
  hexdbb_destroy(nominal);
}

static void compensation_from_constants(void) {
  const hexdbb_constants data = constants();
  hexdbb_motion motion = {sizeof(hexdbb_motion), 0, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, NAN, {0.0}};
  hexdbb_compensator* compensator = NULL;
  hexdbb_target target = HEXDBB_TARGET_INIT, off = HEXDBB_TARGET_INIT;
  hexdbb_dimensions other = HEXDBB_DIMENSIONS_INIT, own = HEXDBB_DIMENSIONS_INIT;
  char message[200];
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_OK);
  EXPECT(message[0] == '\0' && hexdbb_enabled_part(compensator) == 1.0);
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, &motion, &target) == HEXDBB_OK);
  EXPECT(target.largest_correction_mm > 0.02 && target.largest_correction_mm < 0.2);
  EXPECT(target.correction_mm[1] == 0.0);
  EXPECT(hexdbb_enable(compensator, 0) == HEXDBB_OK);
  for (int call = 0; call < 501; ++call) hexdbb_sliders_from_pose(compensator, &kPose, &motion, &off);
  EXPECT(hexdbb_enabled_part(compensator) == 0.0 && off.largest_correction_mm < 1e-12);
  EXPECT(hexdbb_reset(compensator) == HEXDBB_OK);
  EXPECT(hexdbb_check_machine(compensator, &other) == HEXDBB_OK);
  other.leg_length_mm = 401.0;
  EXPECT(hexdbb_check_machine(compensator, &other) == HEXDBB_OTHER_MACHINE);
  own.leg_length_mm = 0.0;
  EXPECT(hexdbb_get_machine(compensator, &own) == HEXDBB_OK && own.leg_length_mm == 400.0);
  hexdbb_destroy(compensator);
  EXPECT(hexdbb_create_from_constants(&data, &other, &compensator, message, sizeof message) == HEXDBB_OTHER_MACHINE);
  EXPECT(compensator == NULL);
  EXPECT(strcmp(message, "compensation constants: of another machine: leg_length_mm is 400 (expected 401)") == 0);
}

static void accelerations_are_stated(void) {
  static const int32_t kFirst[] = {1};
  static const double kWeight[] = {1.0}, kKnots[] = {-100.0, 100.0}, kSizes[] = {-0.01, 0.03};
  const hexdbb_table table = {"learned", "slider", "acceleration_mm_s2", "", 0.0, 1, 2, kFirst, kFirst, kWeight,
                              kKnots,    kSizes};
  hexdbb_motion motion = {sizeof(hexdbb_motion), 0, {0.0}, NAN, {50.0}};
  hexdbb_constants data = constants();
  hexdbb_compensator* compensator = NULL;
  hexdbb_target target = HEXDBB_TARGET_INIT;
  char message[200];
  data.value_count = 0;
  data.table_count = 1;
  data.tables = &table;
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_OK);
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, &motion, &target) == HEXDBB_OK);
  EXPECT(fabs(target.correction_mm[0] + 0.02) < 1e-9);
  /* a program of before: what follows its struct is not read */
  motion.struct_size = (uint32_t)offsetof(hexdbb_motion, acceleration_mm_s2);
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, &motion, &target) == HEXDBB_OK);
  EXPECT(target.correction_mm[0] == 0.0);
  motion.struct_size = 1;
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, &motion, &target) == HEXDBB_BAD_ARGUMENT);
  hexdbb_destroy(compensator);
}

static void tables_in_constants(void) {
  static const int32_t kElements[] = {1, 1}, kColumns[] = {1, 2}, kWrong[] = {1, 7};
  static const double kWeights[] = {1.0, 0.5}, kKnots[] = {0.0, 1000.0}, kSizes[] = {0.02, 0.02};
  hexdbb_table table = {"learned", "slider",  "sliders_mm", "",       0.0,    2,
                        2,         kElements, kColumns,     kWeights, kKnots, kSizes};
  hexdbb_constants data = constants();
  hexdbb_compensator* compensator = NULL;
  hexdbb_target target = HEXDBB_TARGET_INIT;
  char message[200];
  data.value_count = 0;
  data.table_count = 1;
  data.tables = &table;
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_OK);
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, NULL, &target) == HEXDBB_OK);
  EXPECT(fabs(target.correction_mm[0] + 0.02) < 1e-9 && fabs(target.correction_mm[1] + 0.01) < 1e-9);
  EXPECT(target.correction_mm[2] == 0.0);
  hexdbb_destroy(compensator);
  /* a program of before: what follows its struct is not read */
  data.struct_size = (uint32_t)offsetof(hexdbb_constants, table_count);
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_OK);
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, NULL, &target) == HEXDBB_OK);
  EXPECT(target.largest_correction_mm == 0.0);
  hexdbb_destroy(compensator);
  data.struct_size = (uint32_t)sizeof data;
  table.columns = kWrong;
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_MALFORMED);
  EXPECT(strcmp(message, "compensation constants: table.1: column 7 (expected 1 to 6)") == 0);
  table.columns = kColumns;
  table.port = "knee";
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_UNKNOWN_EFFECT);
  table.port = NULL;
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_BAD_ARGUMENT);
  data.tables = NULL;
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, message, sizeof message) == HEXDBB_BAD_ARGUMENT);
  EXPECT(compensator == NULL);
}

static void refusals(void) {
  const hexdbb_dimensions machine = HEXDBB_DIMENSIONS_INIT;
  hexdbb_constants data = constants();
  hexdbb_dimensions short_struct = HEXDBB_DIMENSIONS_INIT, impossible = HEXDBB_DIMENSIONS_INIT;
  hexdbb_compensator* compensator = NULL;
  hexdbb_target target = HEXDBB_TARGET_INIT;
  hexdbb_pose far_up = {0.0, 0.0, 900.0, 0.0, 0.0, 0.0}, nowhere = {0.0, NAN, 285.0, 0.0, 0.0, 0.0};
  char cut[10];
  EXPECT(hexdbb_create_from_file("/no/such/file", &machine, &compensator, cut, sizeof cut) == HEXDBB_CANNOT_READ);
  EXPECT(compensator == NULL && strcmp(cut, "/no/such/") == 0);
  EXPECT(hexdbb_create_from_memory("schema = ", 9, NULL, &compensator, NULL, 0) == HEXDBB_TRUNCATED);
  EXPECT(hexdbb_create_from_memory("something else", 14, NULL, &compensator, NULL, 0) == HEXDBB_MALFORMED);
  EXPECT(hexdbb_create_from_file(NULL, NULL, &compensator, NULL, 0) == HEXDBB_BAD_ARGUMENT);
  data.value_count = 5;
  EXPECT(hexdbb_create_from_constants(&data, NULL, &compensator, NULL, 0) == HEXDBB_MALFORMED);
  short_struct.struct_size -= 8;
  EXPECT(hexdbb_create_nominal(&short_struct, &compensator) == HEXDBB_BAD_ARGUMENT);
  impossible.leg_length_mm = 10.0;
  EXPECT(hexdbb_create_nominal(&impossible, &compensator) == HEXDBB_BAD_ARGUMENT && compensator == NULL);
  EXPECT(hexdbb_sliders_from_pose(NULL, &kPose, NULL, &target) == HEXDBB_BAD_ARGUMENT);
  EXPECT(hexdbb_create_nominal(&machine, &compensator) == HEXDBB_OK);
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, NULL, &target) == HEXDBB_OK);
  const double held = target.sliders_mm[3];
  EXPECT(hexdbb_sliders_from_pose(compensator, &far_up, NULL, &target) == HEXDBB_UNREACHABLE);
  EXPECT(target.sliders_mm[3] == held && target.slider >= 0);
  EXPECT(hexdbb_sliders_from_pose(compensator, &nowhere, NULL, &target) == HEXDBB_NOT_A_NUMBER);
  target.struct_size = 0;
  EXPECT(hexdbb_sliders_from_pose(compensator, &kPose, NULL, &target) == HEXDBB_BAD_ARGUMENT);
  hexdbb_destroy(compensator);
  hexdbb_destroy(NULL);
}

static void names(void) {
  EXPECT(hexdbb_abi_version() == HEXDBB_ABI_VERSION);
  EXPECT(strlen(hexdbb_version()) >= 5);
  EXPECT(strcmp(hexdbb_status_name(HEXDBB_OTHER_MACHINE), "other_machine") == 0);
  EXPECT(strcmp(hexdbb_status_name(-5), "unknown") == 0);
  EXPECT(strlen(hexdbb_status_text(HEXDBB_ALTERED)) > 10);
}

int main(void) {
  nominal_kinematics_there_and_back();
  compensation_from_constants();
  accelerations_are_stated();
  tables_in_constants();
  refusals();
  names();
  return failures == 0 ? 0 : 1;
}
