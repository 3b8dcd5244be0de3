// Wrong machines to compensate, and paths to drive them along.
#pragma once

#include <string>
#include <vector>

#include "drawing.hpp"
#include "hexdbb/compensation.hpp"

namespace hexdbb::testing {

inline const std::vector<std::string> kGeometricNames = effect_names(group::kGeometry);
/// What a controller can correct beyond geometry, without a thermometer.
inline const std::vector<std::string> kCorrectable = {"backlash",  "pitch_cyclic", "lead_error",  "straightness",
                                                      "servo_lag", "gravity_sag",  "joint_offset"};

/// The SP-120 with these effects, values drawn: 50 um, 0.2 mrad, and the sizes the catalogue expects.
Model wrong_machine(const std::vector<std::string>& effects, std::uint64_t seed);

/// Data of a model with wide limits.
CompensationData data_of(const Model& model, double reference_temperature_c = 20.0);

/// Poses along a circle of 90 mm, tilted, one every `step_s` over `laps` of 12 s each.
std::vector<Pose> circle_path(double step_s, double laps, const Vector3& rpy_rad = {0.05, -0.03, 0.1});

/// Slider coordinates of a path, one row a pose, as a compensator gives them with velocities ahead.
SliderTable drive(Compensator& compensator, const std::vector<Pose>& path, double step_s,
                  double temperature_c = std::numeric_limits<double>::quiet_NaN());

/// Distance of two poses: the largest error of the ball joints and the reference point, mm.
double distance_mm(const NominalGeometry& nominal, const Pose& one, const Pose& other);

}  // namespace hexdbb::testing
