// Machines with errors to compensate, and paths to drive them along.
#pragma once

#include <string>
#include <vector>

#include "drawing.hpp"
#include "hexdbb/compensation.hpp"

namespace hexdbb::testing {

inline const std::vector<std::string> kGeometricNames = effect_names(group::kGeometry);
/// Effects beyond geometry that a controller can correct without a thermometer.
inline const std::vector<std::string> kCorrectable = {"backlash",  "pitch_cyclic", "lead_error",  "straightness",
                                                      "servo_lag", "gravity_sag",  "joint_offset"};

/// Return the SP-120 with these effects, values drawn: 50 um, 0.2 mrad, and the prior standard deviations of the
/// catalogue.
Model wrong_machine(const std::vector<std::string>& effects, std::uint64_t seed);

/// Return the compensation data of a model with wide limits.
CompensationData data_of(const Model& model, double reference_temperature_c = 20.0);

/// Return a table of this variable for the leg or slider of each push: `count` knots from `low` to `high`, unequal where
/// the count is even, values of some um.
CompensationTable table_of(const std::string& port, const std::string& variable, const std::vector<TablePush>& pushes,
                           double low, double high, int count);

/// Return tables of every port and of every variable that a controller knows.
std::vector<CompensationTable> all_tables();

/// Return poses along a tilted circle of 90 mm, one every `step_s`, over `laps` of 12 s each.
std::vector<Pose> circle_path(double step_s, double laps, const Vector3& rpy_rad = {0.05, -0.03, 0.1});

/// Compute the slider coordinates of a path of three poses or more, one row per pose, by a compensator that knows the
/// velocities and accelerations.
SliderTable drive(Compensator& compensator, const std::vector<Pose>& path, double step_s,
                  double temperature_c = std::numeric_limits<double>::quiet_NaN());

/// Return the distance of two poses: the largest error of the ball joints and the reference point, mm.
double distance_mm(const NominalGeometry& nominal, const Pose& one, const Pose& other);

}  // namespace hexdbb::testing
