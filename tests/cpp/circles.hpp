// Circles of a ball-bar test as samples: the ball's path is exact for the nominal machine.
#pragma once

#include <vector>

#include "hexdbb/prediction.hpp"

namespace hexdbb::testing {

struct CircleSpec {
  Vector3 platform_rpy_rad = Vector3::Zero();
  Vector3 plane_rpy_rad = Vector3::Zero();
  int mount = 0;
};

/// Return the seven horizontal circles of the standard plan: level, roll and pitch +-12 deg, yaw +-15 deg.
std::vector<CircleSpec> seven_circles();

/// Return `count` samples per circle of 100 mm, ball 40 mm above the joint plane unless given.
Samples circle_samples(const Machine& machine, const std::vector<CircleSpec>& circles, int count,
                       const Vector3& cup_mm = {0.0, 0.0, 340.0}, const Vector3& ball_offset_mm = {0.0, 0.0, 60.0});

/// Return the same with their state: one sweep per circle, each of one lap that takes `lap_s`, an hour after the record
/// began; the temperature is measured in the second half only, and the bar is 0.1 mm shorter than the circle's radius.
Samples moving_samples(const Machine& machine, const std::vector<CircleSpec>& circles, int count, double lap_s = 2.0);

/// Return a model with every geometric and set-up effect, all values zero.
Model full_model(const Machine& machine, int mounts);

/// Return a model with every effect of the engine, all values zero.
Model model_of_everything(const Machine& machine, int mounts);

/// Compute central differences of the prediction for one value, `step` in its unit.
Eigen::VectorXd difference(Model model, const Samples& samples, int value, double step);

}  // namespace hexdbb::testing
