// The minimum of a part of the readings, near which that of all is found.
#pragma once

#include "valley.hpp"

namespace hexdbb {

/// Find the minimum of a part of the readings from `near`, which becomes that minimum. Return whether there is one.
///
/// Three iterations of Ceres serve where the cost has no kinks. Of twenty records with play, those that took it twenty and
/// more then take half as many steps along geodesics. Where these leave much, as of a model that lacks something, Ceres
/// goes its own way from the start as well: of 74 records whose model lacked a fault, either was lower in some.
bool find_near(FewReadings& few, const Unknowns& unknowns, int max_iterations, double tolerance,
               const Eigen::VectorXd& bound, Eigen::VectorXd& near);

}  // namespace hexdbb
