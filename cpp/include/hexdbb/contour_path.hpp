// Paths of a circular test as ISO 230-4 evaluates them: radial deviations by commanded angle, and what laps of them have
// in common. `python/hexdbb/comparison/iso230.py` states the standard's names and the choices it leaves open.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hexdbb/circle_fit.hpp"

namespace hexdbb {

/// One direction's path: commanded angles in [0, 2 pi), rising, and actual minus nominal radius at each.
struct ContourPath {
  Eigen::VectorXd angle_rad, deviation_mm;
};

using Numbers = Eigen::Ref<const Eigen::VectorXd>;
using Ordinals = Eigen::Ref<const Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>>;

/// Make a path of samples in any order; angles are taken modulo one turn, samples at one angle keep their order.
ContourPath make_path(const Numbers& angle_rad, const Numbers& deviation_mm);

/// Return the largest arc without a sample, rad. Throws std::invalid_argument for a path without samples.
double largest_gap_rad(const Numbers& angle_rad);

/// Interpolate a path's deviations linearly and periodically at other angles. Throws std::invalid_argument for lengths
/// that differ, or a path without samples.
Eigen::VectorXd deviation_at(const Numbers& angle_rad, const Numbers& deviation_mm, const Numbers& at_rad);

/// Return the mean of laps: at evenly spaced angles, as many as the shortest lap has samples. `turn` numbers the lap of
/// each sample. A lap with an arc of more than `most_gap_rad` without a sample does not count as long as another one
/// does; the longest stands alone where none does. A single lap is returned as it is. Throws std::invalid_argument for
/// lengths that differ or no samples.
ContourPath mean_path(const Numbers& angle_rad, const Numbers& deviation_mm, const Ordinals& turn, double most_gap_rad);

/// Return the largest difference, unsigned, of two paths at an angle that either has a sample at, mm.
double circular_hysteresis_mm(const ContourPath& one, const ContourPath& other);

/// Return a path's places in its plane, mm, about the nominal centre.
PlanePoints path_points_mm(const Numbers& angle_rad, const Numbers& deviation_mm, double nominal_radius_mm);

/// Return values less their mean and their harmonics 1 to `highest` of the angle.
Eigen::VectorXd without_harmonics(const Numbers& angle_rad, const Numbers& values, int highest);

/// Compute the differences of each two consecutive laps of one sweep at one angle, in units of one reading's noise.
///
/// The sweep's lowest harmonics, 1 to `highest`, and its mean are removed from the values first. The earlier lap is
/// interpolated linearly between two readings at part f; white noise s makes differences of variance
/// s^2 (1 + f^2 + (1 - f)^2), by whose root they are divided. Laps of fewer than three values do not count. Throws
/// std::invalid_argument for lengths that differ.
std::vector<Eigen::VectorXd> lap_differences(const Numbers& angle_rad, const Ordinals& lap, const Numbers& values,
                                             int highest);

}  // namespace hexdbb
