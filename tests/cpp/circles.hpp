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

/// The seven horizontal circles of the standard plan: level, roll and pitch +-12 deg, yaw +-15 deg.
std::vector<CircleSpec> seven_circles();

/// `count` samples a circle of 100 mm, ball 40 mm above the joint plane unless said otherwise.
Samples circle_samples(const Machine& machine, const std::vector<CircleSpec>& circles, int count,
                       const Vector3& cup_mm = {0.0, 0.0, 340.0}, const Vector3& ball_offset_mm = {0.0, 0.0, 60.0});

/// Some rows of some samples.
Samples rows(const Samples& samples, const std::vector<Eigen::Index>& which);

/// A model with every effect the engine knows, all values zero.
Model full_model(const Machine& machine, int mounts);

/// Central differences of the prediction for one value, `step` in its unit.
Eigen::VectorXd difference(Model model, const Samples& samples, int value, double step);

}  // namespace hexdbb::testing
