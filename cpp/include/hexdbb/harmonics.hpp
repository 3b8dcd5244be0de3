// The lowest harmonics of a sweep's angle as an orthonormal basis: the smooth part of a contour.
#pragma once

#include <Eigen/Core>

namespace hexdbb {

/// Return a constant and harmonics 1 to `highest` of some angles as orthonormal columns: 1, cosines, sines, each
/// orthogonal to those before it. They are nearly orthogonal already over whole turns, so that a Cholesky factor of
/// their products suffices; where the angles are a short arc they depend on each other to rounding, and the last ones
/// are shorter than 1. Throws std::invalid_argument for a negative number of harmonics.
Eigen::MatrixXd orthonormal_harmonics(const Eigen::Ref<const Eigen::VectorXd>& angle_rad, int highest);

}  // namespace hexdbb
