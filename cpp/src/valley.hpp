// The way to the most probable values of a model that may be wrong.
//
// A wrong model bends its geometry by many expected sizes to imitate what it lacks: the way there is a narrow, curved
// valley, on which Gauss-Newton steps go astray. Steps follow it by their acceleration along the geodesic (Transtrum,
// Sethna 2012): with v the damped Gauss-Newton step, a = -(J'J + damping)^-1 J' r_vv, r_vv the second derivative of the
// predictions along v, they are v + a / 2. About a thousand evenly spaced readings show the way and every step's
// acceleration: both are smooth along a circle.
#pragma once

#include <functional>
#include <limits>

#include "posterior.hpp"

namespace hexdbb {

/// Every so many of a fit's readings, their noise reduced so that they count as much as all.
class FewReadings {
 public:
  static constexpr Eigen::Index kRows = 1024;

  /// `noise_mm` is that of one reading of all.
  FewReadings(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, const Unknowns& unknowns,
              double noise_mm);
  FewReadings(const FewReadings&) = delete;
  FewReadings& operator=(const FewReadings&) = delete;

  Posterior at(const Eigen::VectorXd& z) { return posterior_at(model_, accumulator_, unknowns_, noise_mm_, z); }

  /// J' r_vv / noise^2 for predictions r along v.
  Eigen::VectorXd bend(const Eigen::VectorXd& z, const Eigen::VectorXd& v);

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
  bool is_at_rest = false;    // no further step is worth while
};

/// Go down from `z` until a step promises, or makes, chi-square fall by less than `worth_a_step`.
Descent descend(const std::function<Posterior(const Eigen::VectorXd&)>& at, FewReadings& few, Eigen::VectorXd z,
                const Eigen::VectorXd& bound, double worth_a_step, int most_steps);

}  // namespace hexdbb
