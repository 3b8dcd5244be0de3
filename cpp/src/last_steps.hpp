// The end of a diagnosis: steps from the minimum of a part of the readings to that of all.
//
// The gradient of all readings determines where their minimum is; J'J only determines how fast steps come there. J'J sums
// products that are smooth along a circle, so that evenly spaced readings yield it to some per cent. A step therefore
// takes the gradient from one pass over all readings and J'J from one over the part:
//   z += (J'J of the part / noise^2 + 1)^-1 downhill.
// The first step leads over some fifteen standard deviations and is bent along the geodesic (valley.hpp), by readings of
// the part: what it leaves is then ten times shorter. The others are small parts of one.
// Measured on six records of 20,000 readings with 45 values: each step divides the distance by three to eight, the same
// with J'J of all. What limits both is what J'J leaves out of the second derivative of the cost, residuals times the
// readings' second derivatives, along one or two directions that the readings determine weakly. Convergence is linear
// there, so that two steps tell the rest of the way: with f = step, D the change since the last point, the point is
//   z + f - g (Dz + Df),   g = <Df, f> / <Df, Df>,
// Anderson's mixing (1965) of depth one, products in the metric of J'J.
// A model with hundreds of learned values, of which each moves few readings, is not determined by a part of them: its
// J'J is then that of all readings, taken until convergence is linear and kept from there on (`is_thin`).
// With millions of readings what J'J leaves out, which grows with their square root, exceeds the prior along the
// directions that no reading determines: a step then divides the distance by less than two, and the way ends where what
// is left of it is no longer worth a pass over all readings (`EndOfSteps::slow_fall`).
#pragma once

#include <functional>

#include "valley.hpp"

namespace hexdbb {

struct LastSteps {
  Eigen::VectorXd z;
  double cost = std::numeric_limits<double>::infinity();
  int steps = 0;
  bool is_at_rest = false;  // false also where a step made all readings' cost worse, or steps do not get shorter
};

/// Where the way ends: where a step is predicted to lower chi-square by less; where convergence is slow, by less than the
/// second; where steps go back and forth across a kink of the cost, by less than the third.
struct EndOfSteps {
  double fall;
  double slow_fall;
  double kinked_fall;
};

/// Return whether a part of the readings is too small for its J'J to lead to the minimum of all.
bool is_thin(const FewReadings& few, Eigen::Index values);

/// Step to the minimum of all readings. `all_at` returns their posterior; the last one is mostly asked with its
/// information, so that an accumulator has it.
LastSteps take_last_steps(const std::function<Posterior(const Eigen::VectorXd&, Sums)>& all_at, FewReadings& few,
                          Eigen::VectorXd z, const Eigen::VectorXd& bound, const EndOfSteps& end);

}  // namespace hexdbb
