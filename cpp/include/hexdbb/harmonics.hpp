// The lowest harmonics of a sweep's angle: the smooth part of a contour, and what is left without it.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace hexdbb {

/// Values split into their harmonics and the rest.
struct SplitValues {
  Eigen::VectorXd taken;  // components along orthonormal columns, 1 + 2 highest
  Eigen::VectorXd left;   // values less their mean and harmonics
};

/// A constant and harmonics 1 to `highest` of some angles, to which values are fitted, any number of times.
///
/// With B the columns 1, cosines, sines and L L' = B'B (Cholesky), the columns of B L^-T are orthonormal; values y have
/// the components L^-1 B'y along them. B'B needs no product of columns: cos k t cos l t is half of
/// cos (k - l) t + cos (k + l) t, so that sums of the harmonics up to twice the highest determine it.
class Harmonics {
 public:
  /// Throws std::invalid_argument for a negative number of harmonics.
  Harmonics(const Eigen::Ref<const Eigen::VectorXd>& angle_rad, int highest);

  /// Fit values, one for each angle, by least squares. Where the angles are a short arc, harmonics depend on each other
  /// to rounding; the last components are then smaller than those of a basis of length one.
  SplitValues split(const Eigen::Ref<const Eigen::VectorXd>& values) const;

 private:
  Eigen::MatrixXd columns_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace hexdbb
