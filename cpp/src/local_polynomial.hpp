// Derivatives by time of six coordinates over a sweep, up to the fourth.
//
// Slopes of slopes over a few rows do not do. Time stamps rounded to 0.1 ms make a slider at 60 mm/s uncertain by 2 um,
// and windows of five rows turn these into a snap that at 0.2 s of delay is worth 30 um, and 5 mm at the ends of a sweep
// where windows extend to one side. One polynomial over a third of a radian of the motion on either side has all three;
// at the ends of a sweep they are its own. It is determined once for a stretch of rows and used for all of them, so that
// the cost does not grow with the rate of sampling. Where it does not follow, as where a sweep starts from rest, shorter
// ones do.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hexdbb/types.hpp"

namespace hexdbb {

using Track = Eigen::Matrix<double, Eigen::Dynamic, kLegs, Eigen::RowMajor>;  // of one sweep, a row per instant

/// Compute smooth coordinates and their derivatives up to order `highest` (at most 4) at rising times. In fewer rows than
/// 7 the polynomial is that through all; NaN in one row.
std::vector<Track> local_polynomials(const Eigen::VectorXd& time_s, const Track& coordinates, int highest);

}  // namespace hexdbb
