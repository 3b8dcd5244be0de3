// What is evaluated capture by capture, for all captures of a table of samples at once: the rows of each are chosen from
// whole columns, so that a caller need not cut columns into pieces.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "hexdbb/contour_path.hpp"
#include "hexdbb/harmonics.hpp"

namespace hexdbb {

/// Rows of a table.
using Rows = Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1>;

/// Mean and harmonics of each capture, a row each, along orthonormal columns; and what is left of a column, zero in rows
/// of no capture.
struct SplitColumn {
  Eigen::MatrixXd taken;
  Eigen::VectorXd left;
};

/// The lowest harmonics of several captures, fitted to any number of columns.
class CaptureHarmonics {
 public:
  /// Throws std::invalid_argument for a row that is not there, or a negative number of harmonics.
  CaptureHarmonics(const Numbers& angle_rad, std::vector<Rows> captures, int highest);

  /// Throws std::invalid_argument for a column of another length.
  SplitColumn split(const Numbers& values) const;

 private:
  Eigen::Index size_;
  int highest_;
  std::vector<Rows> captures_;
  std::vector<Harmonics> harmonics_;
};

/// Return the differences of consecutive laps (`lap_differences`) of every capture. `highest` has the number of harmonics
/// that are removed from each. Throws std::invalid_argument for lengths that differ, or a row that is not there.
std::vector<Eigen::VectorXd> lap_differences(const Numbers& angle_rad, const Ordinals& lap, const Numbers& values,
                                             const std::vector<Rows>& captures, const std::vector<int>& highest);

/// Return the mean path of every capture's laps (`mean_path`). Throws std::invalid_argument as it does, and for a row
/// that is not there.
std::vector<ContourPath> mean_paths(const Numbers& angle_rad, const Numbers& deviation_mm, const Ordinals& turn,
                                    const std::vector<Rows>& captures, double most_gap_rad);

/// Where readings of a capture are looked for that differ from their neighbours.
struct NeighbourTest {
  int neighbours;    // readings to each side whose median is expected
  double dense_rad;  // median angle between readings, up to which neighbours say what to expect
  double doubtful;   // standard deviations from the middle of both neighbours from which a reading is looked at
  double alone;      // standard deviations from the median of all neighbours beyond which it stands alone
};

/// How far each value is from the middle of its two neighbours, in standard deviations (at a capture's ends from lines
/// through those behind it), and whether it stands alone; zero
/// and false in captures that are too short or not dense.
struct Neighbours {
  Eigen::VectorXd off;
  Eigen::Matrix<bool, Eigen::Dynamic, 1> alone;
};

/// Compare values with their neighbours in a capture. The standard deviation of one is `noise`, or what the capture shows
/// where that is more: the median size of a difference from the middle of both neighbours, of normal noise. Throws
/// std::invalid_argument for lengths that differ, or a row that is not there.
Neighbours compare_with_neighbours(const Numbers& angle_rad, const Numbers& values, const std::vector<Rows>& captures,
                                   double noise, const NeighbourTest& test);

}  // namespace hexdbb
