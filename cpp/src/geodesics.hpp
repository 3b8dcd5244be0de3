// Ways along geodesics (valley.hpp) where the usual one of a diagnosis does not lead to the end: a model that leaves many
// times the noise bends its geometry along a narrow, curved valley.
#pragma once

#include <functional>

#include "last_steps.hpp"

namespace hexdbb {

/// Take the last steps to the minimum of all readings from one nearby: straight, between kinks, or, where these do not
/// come to rest, along the geodesic from the best point found and between kinks from there.
LastSteps finish(const std::function<Posterior(const Eigen::VectorXd&, Sums)>& of_all, FewReadings& few,
                 const Eigen::VectorXd& near, const Eigen::VectorXd& bound, const EndOfSteps& limits);

/// Descend along geodesics from where Ceres reached its limit, and from where it began: a model that leaves tens of times
/// the noise bends its geometry along a valley that Ceres follows in steps of a hundredth. Return the lower end.
Eigen::VectorXd out_of_valley(FewReadings& few, const Eigen::VectorXd& start, const Eigen::VectorXd& reached,
                              const Eigen::VectorXd& bound);

}  // namespace hexdbb
