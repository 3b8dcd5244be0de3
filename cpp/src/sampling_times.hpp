// Times of samples, of which a file says but a few digits.
#pragma once

#include <Eigen/Core>

namespace hexdbb {

/// Return the times of a sweep without their rounding where samples are even: stamps that are all whole multiples of a
/// power of ten, and within three quarters of it of equal steps (or whole multiples of a step, where samples are
/// missing). Others are returned as they are. 0.1 ms is 5 um of a slider at 50 mm/s.
Eigen::VectorXd without_rounding(const Eigen::VectorXd& time_s);

}  // namespace hexdbb
