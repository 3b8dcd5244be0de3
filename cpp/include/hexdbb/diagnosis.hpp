// Diagnosis: the values of a model's effects that explain measured readings best, how well they are known, and what cannot be.
//
// Nonlinear least squares (Levenberg-Marquardt in Ceres) on residuals divided by the noise, over the identifiable directions of the
// free unknowns only: z = z0 + V w, so that unknown combinations stay where they were instead of being given a value, and among
// all solutions that explain the readings equally well the one nearest to the nominal machine is returned (minimum norm in
// units of the expected sizes). Identifiability is judged at the nominal machine, where redundancies are exact to first order.
#pragma once

#include <string>

#include "hexdbb/identifiability.hpp"

namespace hexdbb {

struct FitOptions {
  double noise_mm = 0.5e-3;        // standard deviation of one reading, for the weights and for what counts as identifiable
  bool noise_is_stated = true;     // false: the noise is taken from the residuals
  std::vector<bool> free;          // one a value of the model; empty: all
  int max_iterations = 50;
  // A direction is identifiable where the readings narrow its expected size at least to this fraction.
  double prior_fraction = 0.5;
};

struct FitResult {
  Eigen::VectorXd values;      // of the whole model
  Eigen::MatrixXd covariance;  // of the identifiable part of the values, whole model; zero rows where not free
  std::vector<bool> identifiable;     // value is determined on its own, not only in combination
  Identifiability identifiability;    // directions of the free values, scaled by expected size
  std::vector<int> free_columns;      // which value each row of the directions is
  Eigen::VectorXd residual_mm;        // measured - predicted, after
  double rms_before_mm = 0.0;
  double rms_after_mm = 0.0;
  double noise_mm = 0.0;  // used for the covariance: the larger of the stated noise and the residuals' own
  int iterations = 0;
  bool usable = false;
  std::string termination;
};

/// Throws std::invalid_argument where shapes disagree, there are no readings, or a sample is unreachable at the start.
FitResult fit(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
              const FitOptions& options);

/// Expected size of each value of the model (its prior sigma).
Eigen::VectorXd expected_sizes(const Model& model);

}  // namespace hexdbb
