// Minimum of the posterior's cost by Ceres, which no other source includes.
#pragma once

#include <string>

#include "posterior.hpp"

namespace hexdbb {

struct Minimum {
  bool is_usable = false;
  int iterations = 0;
  std::string message;  // why Ceres ended
  double cost = 0.0;    // at the end
};

/// Run Ceres from scaled values `z`, which become those of the end. `function_tolerance` is relative.
Minimum minimize(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, double noise_mm,
                 int max_iterations, double function_tolerance, Eigen::VectorXd& z);

}  // namespace hexdbb
