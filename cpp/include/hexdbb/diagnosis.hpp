// Diagnosis: the most probable values of a model's effects given measured readings, their covariance, and which
// combinations of them are not identifiable.
//
// Model: reading = predict(values) + noise, and every free value has a prior: value ~ N(0, prior sigma). The estimate
// minimizes
//   sum ((measured - predicted) / noise)^2 + sum (value / prior sigma)^2.
// Where the readings determine a combination of values, the prior is thousands of times weaker than they are. Along
// combinations that no reading determines it keeps the values near the nominal machine, and it propagates into the
// covariance how those affect the others through second-order geometry, which a fit restricted to the identifiable
// directions would leave out.
//
// Two optimisers. A diagnosis is minimized by Levenberg-Marquardt in Ceres with analytic derivatives, the full fit of a
// hypothesis by Levenberg-Marquardt with geodesic acceleration (src/valley.hpp, with the measurement behind this).
// Of many readings, Ceres takes a diagnosis to the minimum of about two thousand of them; the end is a few steps with the
// gradient of all readings (src/last_steps.hpp), between kinks of the cost where these go back and forth (src/kinks.hpp),
// or with geodesic acceleration where they lead astray. Where none come to rest, Ceres starts again on all.
// Ceres supports Huber's loss, on which a diagnosis of readings with glitches depends, and converges to 1e-9; the
// geodesic method is three times faster on the incomplete models of which a discovery fits many. Neither is the more
// robust: each ends in the worse minimum in about a sixth of the incomplete models.
#pragma once

#include <string>

#include "hexdbb/identifiability.hpp"

namespace hexdbb {

struct FitOptions {
  double noise_mm = 0.5e-3;  // standard deviation of one reading
  std::vector<bool> free;    // one per value of the model; empty: all
  // Factors on the prior standard deviations, one per value of the model; empty: 1. A heavy-tailed prior is a normal one
  // whose standard deviation follows the value (West 1987).
  Eigen::VectorXd prior_scale;
  int max_iterations = 50;
  // Huber's loss: residuals beyond this many mm count linearly, so that a gauge glitch cannot bend the fit. 0: least
  // squares.
  double robust_mm = 0.0;
  // Full fit of a hypothesis: it ends where a further step would change chi-square by less than a verdict depends on;
  // its covariance is to first order; `machine` and `rms_before_mm` of the result are not filled.
  bool hypothesis = false;
  // Of a hypothesis: the model's values are the minimum of nearly the same readings, as where some circles are held out,
  // and the minimum that a few steps from there lead to is wanted. Makes no difference for few readings.
  bool from_minimum = false;
  // Of a hypothesis: further values of the whole model from which to begin, a column each, where there may be several
  // minima, as of a time constant; held ones stay the model's. Coarse descents begin from each; the lowest of their minima
  // is the one refined.
  Eigen::MatrixXd starts;
  // Number of the capture each sample belongs to; neighbours within one may be correlated. Empty: all independent.
  Eigen::VectorXi sweep;
  // A direction is identifiable where the readings alone determine it to at most this fraction of its prior standard
  // deviation. At one half they carry four times the information of the prior.
  double identified_fraction = 0.5;
  // Without the covariance J'J of all readings is not summed once more at the end, half the time of a hypothesis from its
  // minimum: `covariance` and `correlation` of the result are not filled.
  bool covariance = true;
};

struct FitResult {
  Eigen::VectorXd values;      // of the whole model
  Eigen::MatrixXd covariance;  // of the whole model's values, prior included; zero where not free
  std::vector<int> free_columns;
  // Of the machine's own free values at the nominal machine, what unknowns of the set-up can explain projected out,
  // columns scaled by prior standard deviations: rank and condition by which plans are compared.
  Identifiability machine;
  Eigen::VectorXd residual_mm;  // measured - predicted, after
  double rms_before_mm = 0.0;
  double rms_after_mm = 0.0;
  double noise_mm = 0.0;     // used for the covariance: the larger of the given noise and the residuals' own
  double correlation = 1.0;  // integrated autocorrelation time of the residuals, in samples
  int iterations = 0;        // on all readings
  bool usable = false;
  std::string termination;
};

/// Fit the free values of a model to measured readings, from the model's values. Throws std::invalid_argument where
/// shapes disagree, there are no readings, nothing is free, or a sample is unreachable at the start.
FitResult fit(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
              const FitOptions& options);

/// Compute the integrated autocorrelation time of residuals within sweeps, in samples: 1 + 2 sum of autocorrelations,
/// summed while pairs of them stay positive (initial positive sequence, Geyer 1992); at least 1.
/// Throws std::invalid_argument where lengths differ.
double autocorrelation_time(const Eigen::VectorXd& residual, const Eigen::VectorXi& sweep);

/// Return the prior standard deviation of each value of a model.
Eigen::VectorXd prior_sigmas(const Model& model);

}  // namespace hexdbb
