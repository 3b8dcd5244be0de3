// Diagnosis: the values of a model's effects that explain measured readings best, how well they are known, and what
// cannot be.
//
// Model: reading = predict(values) + noise, and every free value has an expected size, its prior: value ~ N(0, prior
// sigma). Estimate: the most probable values (Levenberg-Marquardt in Ceres, analytic derivatives), minimizing
//   sum ((measured - predicted) / noise)^2 + sum (value / prior sigma)^2.
// Where the readings speak, the prior is thousands of times weaker than they are; along combinations that no reading
// can tell it keeps the values near the nominal machine, and it carries into the covariance what those unknown
// combinations do to the others through second-order geometry, which a fit restricted to the identifiable directions
// would leave out.
#pragma once

#include <string>

#include "hexdbb/identifiability.hpp"

namespace hexdbb {

struct FitOptions {
  double noise_mm = 0.5e-3;  // standard deviation of one reading
  std::vector<bool> free;    // one a value of the model; empty: all
  int max_iterations = 50;
  // Huber's loss: residuals beyond this many mm count linearly, so that a gauge glitch cannot bend the fit. 0: least
  // squares.
  double robust_mm = 0.0;
  // A fit that only judges a model ends where a further step would change chi-square by less than a verdict hangs on;
  // its covariance is to first order, and it says nothing of the machine's identifiability or the residual before.
  bool judging = false;
  // Number of the capture each sample belongs to; neighbours within one may be correlated. Empty: all independent.
  Eigen::VectorXi sweep;
  // Readings say something of a direction where they narrow its expected size to at most this part.
  double telling_part = 0.5;
};

struct FitResult {
  Eigen::VectorXd values;      // of the whole model
  Eigen::MatrixXd covariance;  // of the whole model's values, prior included; zero where not free
  std::vector<int> free_columns;
  // Of the machine's own free values at the nominal machine, after all that unknowns of the set-up can explain is taken
  // out, columns scaled by expected sizes: rank and condition by which plans are compared.
  Identifiability machine;
  Eigen::VectorXd residual_mm;  // measured - predicted, after
  double rms_before_mm = 0.0;
  double rms_after_mm = 0.0;
  double noise_mm = 0.0;     // used for the covariance: the larger of the given noise and the residuals' own
  double correlation = 1.0;  // correlated neighbours: this many readings tell as much as one independent one
  int iterations = 0;
  bool usable = false;
  std::string termination;
};

/// Throws std::invalid_argument where shapes disagree, there are no readings, or a sample is unreachable at the start.
FitResult fit(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
              const FitOptions& options);

/// How many neighbouring residuals tell as much as one: 1 + 2 sum of autocorrelations, summed while pairs of them stay
/// positive (Geyer's initial positive sequence), within sweeps; at least 1.
double correlation_length(const Eigen::VectorXd& residual, const Eigen::VectorXi& sweep);

/// Expected size of each value of the model (its prior sigma).
Eigen::VectorXd expected_sizes(const Model& model);

}  // namespace hexdbb
