// Minimization for a model that may be wrong: Levenberg-Marquardt with geodesic acceleration.
//
// A wrong model distorts its geometry by many prior standard deviations to imitate the effect it lacks: its minimum
// lies at the end of a narrow, curved valley, which Gauss-Newton steps leave. Steps follow the valley by their
// acceleration along the geodesic (Transtrum, Sethna 2012): with v the damped Gauss-Newton step, r_vv the second
// derivative of the predictions along v and a = -(J'J + damping)^-1 J' r_vv, the step is v + a / 2. About a thousand
// evenly spaced readings determine the coarse minimum and the acceleration of every step: both are smooth along a
// circle.
//
// Beside Ceres (diagnosis.hpp), because neither replaces the other. Measured on 19,600 readings of four random
// machines, geometry, cup and ball free, one effect of the catalogue at a time at its prior size:
//   problem                             same chi-square (+-1)   geodesic lower   Ceres lower   median time, ms
//   complete model, from nominal                       4 of 4                -             -         123 : 122
//   complete model, from the incomplete              60 of 60                -             -         185 : 268
//   model that lacks the effect                      38 of 60               12            10         223 : 731
// Ceres reached its limit of 50 iterations in 12 of the last 60. Incomplete models with large residuals have several
// minima. Huber's loss is supported by Ceres alone.
#pragma once

#include <functional>
#include <limits>

#include "posterior.hpp"

namespace hexdbb {

/// A regular part of a fit's readings, their noise reduced so that they have the weight of all.
class FewReadings {
 public:
  static constexpr Eigen::Index kRows = 1024;  // 36 per sweep of a plan of seven circles, two directions, two feeds

  /// `noise_mm` is that of one reading of all; `rows` is how many of them about.
  FewReadings(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, const Unknowns& unknowns,
              double noise_mm, Eigen::Index rows = kRows);
  FewReadings(const FewReadings&) = delete;
  FewReadings& operator=(const FewReadings&) = delete;

  Eigen::Index stride() const { return stride_; }
  double noise_mm() const { return noise_mm_; }
  /// How many readings of the noise given they count as: all of which they are a part.
  double weight() const { return static_cast<double>(stride_ * samples_.size()); }
  const Eigen::VectorXd& measured_mm() const { return measured_mm_; }
  const Model& model() const { return model_; }  // for these readings: tables have their rows alone
  Accumulator& accumulator() { return accumulator_; }

  Posterior at(const Eigen::VectorXd& z) { return posterior_at(model_, accumulator_, unknowns_, noise_mm_, z); }

  /// Compute J' r_vv / noise^2 for predictions r along v.
  Eigen::VectorXd curvature(const Eigen::VectorXd& z, const Eigen::VectorXd& v);

 private:
  const Unknowns& unknowns_;
  Eigen::Index stride_;
  Samples samples_;
  Model model_;
  Eigen::VectorXd measured_mm_;
  double noise_mm_;
  Accumulator accumulator_;
};

/// Damping of a first step, where nothing is known of the valley (Nielsen 1999).
constexpr double kFirstDamping = 1e-3;

struct Descent {
  Eigen::VectorXd z;
  double damping = kFirstDamping;  // of the next step
  double cost = std::numeric_limits<double>::infinity();
  int steps = 0;
  bool is_reachable = false;  // false where a sample has no solution at the start
  bool is_at_rest = false;    // no further step lowers chi-square by the least fall
};

/// Where a descent ends: where a step lowers chi-square by less, times the mean square of what is left in units of the
/// noise where that is more than one. Where a model leaves many times the noise, its own error decides, not the noise, and
/// the last units of a chi-square of hundreds of thousands take most of the steps.
struct EndOfDescent {
  double fall;
  int most_steps;
};

/// Minimize from `z` until a step is predicted, or found, to fall short. `damping` is that of the first step.
Descent descend(const std::function<Posterior(const Eigen::VectorXd&)>& at, FewReadings& few, Eigen::VectorXd z,
                const Eigen::VectorXd& bound, const EndOfDescent& end, double damping = kFirstDamping);

}  // namespace hexdbb
