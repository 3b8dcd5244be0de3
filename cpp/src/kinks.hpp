// The end of a fit whose cost has kinks.
//
// Readings of an effect may bend at once as a value passes a threshold: the play of a screw passes the travel since the
// reversal at some readings, and their derivatives change sign there. The cost of all readings is then a smooth function
// with a small kink for each of them, and its minimum often lies in one, where the gradient jumps from one sign to the
// other and vanishes nowhere. Steps of Gauss and Newton go back and forth across it; those of Levenberg and Marquardt
// shrink, all values together, in tens of passes.
// Here each value has a bracket of its own: the nearest places to both sides at which its step pointed to the other. A
// step that would leave it is cut so that it divides the bracket, the other values' steps are solved for that, and all
// brackets shrink in the same passes. Where a value's bracket is a small part of its standard deviation, it rests.
#pragma once

#include "last_steps.hpp"

namespace hexdbb {

/// Step to the minimum near `z`, from which `take_last_steps` does not go on. `all_at` and `few` are as there.
LastSteps settle_kinks(const std::function<Posterior(const Eigen::VectorXd&, Sums)>& all_at, FewReadings& few,
                       Eigen::VectorXd z, const Eigen::VectorXd& bound, const EndOfSteps& end);

}  // namespace hexdbb
