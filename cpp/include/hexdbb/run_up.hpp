// What a slider did along the run-up to a circle, which no record holds: what it does a lap later.
#pragma once

#include <Eigen/Core>

#include "hexdbb/state.hpp"

namespace hexdbb {

/// Rows of a sweep, [first, end), that lie a lap behind its run-up, and the time of that lap; none where it is less than
/// a lap.
struct RunUp {
  Eigen::Index first = 0;
  Eigen::Index end = 0;
  double lap_s = 0.0;

  Eigen::Index size() const { return end - first; }
};

/// Compute the run-up to a sweep along an angle of at most a turn, from its times, which rise, and its polar angles, with
/// or without their turns. A lap may lack its last sample, which would close it.
RunUp run_up(const Eigen::VectorXd& time_s, const Eigen::VectorXd& angle_rad, double run_up_rad = kRunUp_rad);

}  // namespace hexdbb
