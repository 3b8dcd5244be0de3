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

/// Descend along geodesics from where Ceres reached its limit. Where that does not come to rest, descend to a finer end from
/// there and from where Ceres began, and return the lower end: a model that leaves tens of times the noise bends its
/// geometry along a valley that Ceres follows in steps of a hundredth.
Eigen::VectorXd onwards(FewReadings& few, const Eigen::VectorXd& start, const Eigen::VectorXd& reached,
                        const Eigen::VectorXd& bound);

}  // namespace hexdbb
