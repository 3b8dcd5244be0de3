#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>

#include "hexdbb/compensation.hpp"
#include "hexdbb/hexdbb.h"

struct hexdbb_compensator {
  hexdbb::Compensator engine;
};

namespace {

using hexdbb::CompensationFault;
using hexdbb::Machine;
using hexdbb::Status;

struct StatusText {
  hexdbb_status status;
  const char* name;
  const char* text;
};

constexpr StatusText kTexts[] = {
    {HEXDBB_OK, "ok", "ok"},
    {HEXDBB_UNREACHABLE, "unreachable", "a leg is too short"},
    {HEXDBB_SINGULAR, "singular", "locked sliders do not hold the platform"},
    {HEXDBB_ITERATION_LIMIT, "iteration_limit", "no solution found"},
    {HEXDBB_TRAVEL, "travel", "a slider would leave its travel"},
    {HEXDBB_GAP, "gap", "two sliders would come closer than the smallest gap"},
    {HEXDBB_CORRECTION_LIMIT, "correction_limit", "more correction than the compensation file allows"},
    {HEXDBB_NOT_A_NUMBER, "not_a_number", "pose, coordinates and velocities must be finite"},
    {HEXDBB_CANNOT_READ, "cannot_read", "the compensation file cannot be read"},
    {HEXDBB_MALFORMED, "malformed", "not a compensation file, or a wrong key or value in it"},
    {HEXDBB_TRUNCATED, "truncated", "the compensation file ends before its checksum"},
    {HEXDBB_ALTERED, "altered", "the compensation file's checksum does not match its content"},
    {HEXDBB_LATER_VERSION, "later_version", "the compensation file is of a later version"},
    {HEXDBB_OTHER_MACHINE, "other_machine", "the compensation is of another machine"},
    {HEXDBB_UNKNOWN_EFFECT, "unknown_effect",
     "an effect, port or variable that this version does not know or cannot correct"},
    {HEXDBB_BAD_ARGUMENT, "bad_argument", "a null pointer, an unknown struct_size or an impossible machine"},
    {HEXDBB_OUT_OF_MEMORY, "out_of_memory", "out of memory"},
};

const StatusText& text_of(hexdbb_status status) {
  static constexpr StatusText kUnknown = {-1, "unknown", "no such status"};
  const auto found = std::find_if(std::begin(kTexts), std::end(kTexts),
                                  [status](const StatusText& each) { return each.status == status; });
  return found == std::end(kTexts) ? kUnknown : *found;
}

/// Version 1 of the interface has one size of each struct; a larger one is that of a later version.
template <class Struct>
bool is_known(const Struct* given) {
  return given != nullptr && given->struct_size == sizeof(Struct);
}

constexpr size_t kConstantsWithoutTables = offsetof(hexdbb_constants, table_count);
constexpr size_t kConstantsWithoutLayout = offsetof(hexdbb_constants, layout);

/// Constants have grown twice.
bool is_known(const hexdbb_constants* given) {
  return given != nullptr &&
         (given->struct_size == sizeof(hexdbb_constants) || given->struct_size == kConstantsWithoutTables ||
          given->struct_size == kConstantsWithoutLayout);
}

constexpr size_t kMotionWithoutAcceleration = offsetof(hexdbb_motion, acceleration_mm_s2);

/// A motion has grown once.
bool is_known(const hexdbb_motion* given) {
  return given->struct_size == sizeof(hexdbb_motion) || given->struct_size == kMotionWithoutAcceleration;
}

/// Return the layout of constants, or null.
const hexdbb_layout* layout_of(const hexdbb_constants& constants) {
  return constants.struct_size == sizeof(hexdbb_constants) ? constants.layout : nullptr;
}

bool has_pointers(const hexdbb_table& t) {
  return t.effect != nullptr && t.port != nullptr && t.variable != nullptr && t.times != nullptr &&
         (t.push_count == 0 || (t.elements != nullptr && t.columns != nullptr && t.weights != nullptr)) &&
         (t.knot_count == 0 || (t.knots != nullptr && t.values_mm != nullptr));
}

/// Return the tables of constants and their number.
const hexdbb_table* tables_of(const hexdbb_constants& constants, uint32_t& count) {
  const bool has_tables = constants.struct_size != kConstantsWithoutTables;
  count = has_tables ? constants.table_count : 0;
  return has_tables ? constants.tables : nullptr;
}

bool is_complete(const hexdbb_constants& constants) {
  uint32_t count = 0;
  const hexdbb_table* tables = tables_of(constants, count);
  if (constants.values == nullptr && constants.value_count > 0) return false;
  if (tables == nullptr) return count == 0;
  return std::all_of(tables, tables + count, has_pointers);
}

/// Return the machine of dimensions and a layout, which may be null.
Machine to_machine(const hexdbb_dimensions& d, const hexdbb_layout* layout = nullptr) {
  Machine out;
  out.base_inradius_mm = d.base_inradius_mm;
  out.platform_circumradius_mm = d.platform_circumradius_mm;
  out.joint_plane_height_mm = d.joint_plane_height_mm;
  out.leg_length_mm = hexdbb::six_of(d.leg_length_mm);
  out.travel_min_mm = hexdbb::six_of(d.travel_min_mm);
  out.travel_max_mm = hexdbb::six_of(d.travel_max_mm);
  out.min_gap_mm = d.min_gap_mm;
  out.screw_lead_mm = d.screw_lead_mm;
  out.moved_mass_kg = d.moved_mass_kg;
  if (layout == nullptr) return out;
  std::copy_n(layout->guideway_angle_rad, HEXDBB_GUIDEWAYS, out.guideway_angle_rad.begin());
  std::copy_n(layout->joint_angle_rad, HEXDBB_GUIDEWAYS, out.joint_angle_rad.begin());
  std::copy_n(layout->leg_length_mm, HEXDBB_SLIDERS, out.leg_length_mm.begin());
  std::copy_n(layout->travel_min_mm, HEXDBB_SLIDERS, out.travel_min_mm.begin());
  std::copy_n(layout->travel_max_mm, HEXDBB_SLIDERS, out.travel_max_mm.begin());
  return out;
}

/// Return whether dimensions and a layout, which may be null, can be read.
bool is_known_machine(const hexdbb_dimensions* machine, const hexdbb_layout* layout) {
  return is_known(machine) && (layout == nullptr || is_known(layout));
}

void report(const char* what, char* message, size_t message_size) {
  if (message == nullptr || message_size == 0) return;
  const size_t length = std::min(std::strlen(what), message_size - 1);
  std::memcpy(message, what, length);
  message[length] = '\0';
}

/// Create a compensator from what `data` returns; `data` may throw.
template <class Data>
hexdbb_status create(Data data, const char* source, const hexdbb_dimensions* machine, hexdbb_compensator** out,
                     char* message, size_t message_size) {
  report("", message, message_size);
  if (out == nullptr) return HEXDBB_BAD_ARGUMENT;
  *out = nullptr;
  if (machine != nullptr && !is_known(machine)) return HEXDBB_BAD_ARGUMENT;
  try {
    const hexdbb::CompensationData loaded = data();
    if (machine != nullptr) hexdbb::require_machine(loaded.machine, to_machine(*machine), source);
    *out = new hexdbb_compensator{hexdbb::Compensator(loaded, source)};
    return HEXDBB_OK;
  } catch (const hexdbb::CompensationError& error) {
    report(error.what(), message, message_size);
    return static_cast<hexdbb_status>(error.fault());
  } catch (const std::bad_alloc&) {
    return HEXDBB_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    report(error.what(), message, message_size);
    return HEXDBB_MALFORMED;
  }
}

hexdbb::CompensationTable to_table(const hexdbb_table& given) {
  hexdbb::CompensationTable out{given.effect, given.port, given.variable, given.times, given.period, {}, {}, {}};
  for (uint32_t at = 0; at < given.push_count; ++at) {
    const auto from_zero = [](int32_t number) { return number > 0 ? number - 1 : -1; };
    out.pushes.push_back({from_zero(given.elements[at]), from_zero(given.columns[at]), given.weights[at]});
  }
  out.knots.assign(given.knots, given.knots + given.knot_count);
  out.values_mm.assign(given.values_mm, given.values_mm + given.knot_count);
  return out;
}

/// Convert constants, in which the values of one effect are consecutive.
hexdbb::CompensationData from_constants(const hexdbb_constants& constants) {
  hexdbb::CompensationData out;
  out.machine = to_machine(constants.machine, layout_of(constants));
  out.limits = {constants.max_correction_mm, constants.reversal_travel_mm};
  out.reference_temperature_c = constants.reference_temperature_c;
  for (uint32_t at = 0; at < constants.value_count; ++at) {
    const hexdbb_value& value = constants.values[at];
    if (out.effects.empty() || out.effects.back().name != value.effect) out.effects.push_back({value.effect, {}});
    out.effects.back().values.push_back({value.element, value.parameter, value.value});
  }
  uint32_t count = 0;
  const hexdbb_table* tables = tables_of(constants, count);
  for (uint32_t at = 0; at < count; ++at) out.tables.push_back(to_table(tables[at]));
  return out;
}

bool to_direction(const hexdbb_motion* motion, hexdbb::Direction& out) {
  if (motion == nullptr) return true;
  if (!is_known(motion)) return false;
  out.velocity_mm_s = Eigen::Map<const hexdbb::Vector6>(motion->velocity_mm_s);
  out.temperature_c = motion->temperature_c;
  if (motion->struct_size != kMotionWithoutAcceleration) {
    out.acceleration_mm_s2 = Eigen::Map<const hexdbb::Vector6>(motion->acceleration_mm_s2);
  }
  return true;
}

}  // namespace

extern "C" {

uint32_t hexdbb_abi_version(void) noexcept { return HEXDBB_ABI_VERSION; }

const char* hexdbb_version(void) noexcept { return HEXDBB_VERSION; }

const char* hexdbb_status_name(hexdbb_status status) noexcept { return text_of(status).name; }

const char* hexdbb_status_text(hexdbb_status status) noexcept { return text_of(status).text; }

hexdbb_status hexdbb_create_nominal(const hexdbb_dimensions* machine, hexdbb_compensator** out) noexcept {
  return hexdbb_create_nominal_layout(machine, nullptr, out);
}

hexdbb_status hexdbb_create_nominal_layout(const hexdbb_dimensions* machine, const hexdbb_layout* layout,
                                           hexdbb_compensator** out) noexcept {
  if (out == nullptr) return HEXDBB_BAD_ARGUMENT;
  *out = nullptr;
  if (!is_known_machine(machine, layout)) return HEXDBB_BAD_ARGUMENT;
  const Machine wanted = to_machine(*machine, layout);
  if (!hexdbb::is_possible(wanted)) return HEXDBB_BAD_ARGUMENT;
  try {
    *out = new hexdbb_compensator{hexdbb::Compensator(wanted)};
    return HEXDBB_OK;
  } catch (const std::bad_alloc&) {
    return HEXDBB_OUT_OF_MEMORY;
  }
}

hexdbb_status hexdbb_create_from_file(const char* path, const hexdbb_dimensions* machine, hexdbb_compensator** out,
                                      char* message, size_t message_size) noexcept {
  if (path == nullptr) return HEXDBB_BAD_ARGUMENT;
  return create([path] { return hexdbb::read_compensation(path); }, path, machine, out, message, message_size);
}

hexdbb_status hexdbb_create_from_memory(const char* text, size_t length, const hexdbb_dimensions* machine,
                                        hexdbb_compensator** out, char* message, size_t message_size) noexcept {
  constexpr const char* kSource = "compensation in memory";
  if (text == nullptr) return HEXDBB_BAD_ARGUMENT;
  return create([=] { return hexdbb::parse_compensation(std::string(text, length), kSource); }, kSource, machine, out,
                message, message_size);
}

hexdbb_status hexdbb_create_from_constants(const hexdbb_constants* constants, const hexdbb_dimensions* machine,
                                           hexdbb_compensator** out, char* message, size_t message_size) noexcept {
  if (!is_known(constants)) return HEXDBB_BAD_ARGUMENT;
  if (!is_known_machine(&constants->machine, layout_of(*constants)) || !is_complete(*constants))
    return HEXDBB_BAD_ARGUMENT;
  return create([constants] { return from_constants(*constants); }, "compensation constants", machine, out, message,
                message_size);
}

void hexdbb_destroy(hexdbb_compensator* compensator) noexcept { delete compensator; }

hexdbb_status hexdbb_check_machine(const hexdbb_compensator* compensator, const hexdbb_dimensions* machine) noexcept {
  return hexdbb_check_layout(compensator, machine, nullptr);
}

hexdbb_status hexdbb_check_layout(const hexdbb_compensator* compensator, const hexdbb_dimensions* machine,
                                  const hexdbb_layout* layout) noexcept {
  if (compensator == nullptr || !is_known_machine(machine, layout)) return HEXDBB_BAD_ARGUMENT;
  const bool is_same = hexdbb::is_same_machine(compensator->engine.machine(), to_machine(*machine, layout));
  return is_same ? HEXDBB_OK : HEXDBB_OTHER_MACHINE;
}

hexdbb_status hexdbb_get_machine(const hexdbb_compensator* compensator, hexdbb_dimensions* machine) noexcept {
  if (compensator == nullptr || !is_known(machine)) return HEXDBB_BAD_ARGUMENT;
  const Machine& m = compensator->engine.machine();
  *machine = {machine->struct_size,
              0,
              m.base_inradius_mm,
              m.platform_circumradius_mm,
              m.joint_plane_height_mm,
              m.leg_length_mm[0],
              m.travel_min_mm[0],
              m.travel_max_mm[0],
              m.min_gap_mm,
              m.screw_lead_mm,
              m.moved_mass_kg};
  return HEXDBB_OK;
}

hexdbb_status hexdbb_get_layout(const hexdbb_compensator* compensator, hexdbb_layout* layout) noexcept {
  if (compensator == nullptr || !is_known(layout)) return HEXDBB_BAD_ARGUMENT;
  const Machine& m = compensator->engine.machine();
  std::copy(m.guideway_angle_rad.begin(), m.guideway_angle_rad.end(), layout->guideway_angle_rad);
  std::copy(m.joint_angle_rad.begin(), m.joint_angle_rad.end(), layout->joint_angle_rad);
  std::copy(m.leg_length_mm.begin(), m.leg_length_mm.end(), layout->leg_length_mm);
  std::copy(m.travel_min_mm.begin(), m.travel_min_mm.end(), layout->travel_min_mm);
  std::copy(m.travel_max_mm.begin(), m.travel_max_mm.end(), layout->travel_max_mm);
  return HEXDBB_OK;
}

hexdbb_status hexdbb_enable(hexdbb_compensator* compensator, int on) noexcept {
  if (compensator == nullptr) return HEXDBB_BAD_ARGUMENT;
  compensator->engine.enable(on != 0);
  return HEXDBB_OK;
}

double hexdbb_enabled_part(const hexdbb_compensator* compensator) noexcept {
  return compensator == nullptr ? 0.0 : compensator->engine.enabled_part();
}

hexdbb_status hexdbb_reset(hexdbb_compensator* compensator) noexcept {
  if (compensator == nullptr) return HEXDBB_BAD_ARGUMENT;
  compensator->engine.reset();
  return HEXDBB_OK;
}

hexdbb_status hexdbb_sliders_from_pose(hexdbb_compensator* compensator, const hexdbb_pose* pose,
                                       const hexdbb_motion* motion, hexdbb_target* out) noexcept {
  hexdbb::Direction direction;
  if (compensator == nullptr || pose == nullptr || !is_known(out) || !to_direction(motion, direction)) {
    return HEXDBB_BAD_ARGUMENT;
  }
  const hexdbb::Pose wanted{{pose->x_mm, pose->y_mm, pose->z_mm},
                            hexdbb::rotation_from_rpy(pose->roll_rad, pose->pitch_rad, pose->yaw_rad)};
  const hexdbb::SliderTargets targets = compensator->engine.sliders(wanted, direction);
  out->status = static_cast<hexdbb_status>(targets.status);
  Eigen::Map<hexdbb::Vector6>(out->sliders_mm) = targets.sliders_mm;
  Eigen::Map<hexdbb::Vector6>(out->correction_mm) = targets.correction_mm;
  out->largest_correction_mm = targets.largest_correction_mm;
  out->iterations = targets.iterations;
  out->slider = targets.slider;
  return out->status;
}

hexdbb_status hexdbb_pose_from_sliders(hexdbb_compensator* compensator, const double sliders_mm[HEXDBB_SLIDERS],
                                       const hexdbb_motion* motion, hexdbb_estimate* out) noexcept {
  hexdbb::Direction direction;
  if (compensator == nullptr || sliders_mm == nullptr || !is_known(out) || !to_direction(motion, direction)) {
    return HEXDBB_BAD_ARGUMENT;
  }
  const hexdbb::PoseEstimate found = compensator->engine.pose(Eigen::Map<const hexdbb::Vector6>(sliders_mm), direction);
  const hexdbb::Vector3 rpy = hexdbb::rpy_from_rotation(found.pose.rotation);
  const hexdbb::Vector3& at = found.pose.position;
  out->status = static_cast<hexdbb_status>(found.status);
  out->pose = {at.x(), at.y(), at.z(), rpy.x(), rpy.y(), rpy.z()};
  out->residual_mm = found.residual_mm;
  out->iterations = found.iterations;
  return out->status;
}

}  // extern "C"
