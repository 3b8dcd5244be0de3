// Minimization for a model that may be wrong: Levenberg-Marquardt with geodesic acceleration.
//
// A wrong model distorts its geometry by many prior standard deviations to imitate the effect it lacks: its minimum
// lies at the end of a narrow, curved valley, which Gauss-Newton steps leave. Steps follow the valley by their
// acceleration along the geodesic (Transtrum, Sethna 2012): with v the damped Gauss-Newton step, r_vv the second
// derivative of the predictions along v and a = -(J'J + damping)^-1 J' r_vv, the step is v + a / 2. About a thousand
// evenly spaced readings determine the coarse minimum and the acceleration of every step: both are smooth along a
// circle.
#pragma once

#include <functional>
#include <limits>

#include "posterior.hpp"

namespace hexdbb {

/// A regular part of a fit's readings, their noise reduced so that they have the weight of all.
class FewReadings {
 public:
  static constexpr Eigen::Index kRows = 1024;  // 36 per sweep of a plan of seven circles, two directions, two feeds

  /// `noise_mm` is that of one reading of all.
  FewReadings(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, const Unknowns& unknowns,
              double noise_mm);
  FewReadings(const FewReadings&) = delete;
  FewReadings& operator=(const FewReadings&) = delete;

  Posterior at(const Eigen::VectorXd& z) { return posterior_at(model_, accumulator_, unknowns_, noise_mm_, z); }

  /// Compute J' r_vv / noise^2 for predictions r along v.
  Eigen::VectorXd curvature(const Eigen::VectorXd& z, const Eigen::VectorXd& v);

 private:
  const Model& model_;
  const Unknowns& unknowns_;
  Eigen::Index stride_;
  Samples samples_;
  Eigen::VectorXd measured_mm_;
  double noise_mm_;
  Accumulator accumulator_;
};

struct Descent {
  Eigen::VectorXd z;
  double cost = std::numeric_limits<double>::infinity();
  int steps = 0;
  bool is_reachable = false;  // false where a sample has no solution at the start
  bool is_at_rest = false;    // no further step lowers chi-square by the least fall
};

/// Minimize from `z` until a step is predicted, or found, to lower chi-square by less than `least_fall`.
Descent descend(const std::function<Posterior(const Eigen::VectorXd&)>& at, FewReadings& few, Eigen::VectorXd z,
                const Eigen::VectorXd& bound, double least_fall, int most_steps);

}  // namespace hexdbb
