#include "hexdbb/grouped.hpp"

#include <stdexcept>
#include <string>

namespace hexdbb {

namespace {

std::string shape(Eigen::Index rows, Eigen::Index columns) {
  return "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")";
}

std::invalid_argument out_of_range(const std::string& where, int value, Eigen::Index count) {
  return std::invalid_argument(where + " is " + std::to_string(value) + ", expected less than " +
                               std::to_string(count));
}

}  // namespace

DesignSums design_sums(const Eigen::Ref<const Places>& place, const Eigen::Ref<const RowMajorMatrix>& weight,
                       const Eigen::Ref<const Eigen::VectorXi>& group, const Eigen::Ref<const RowMajorMatrix>& table,
                       Eigen::Index columns, Eigen::Index groups) {
  const Eigen::Index rows = table.rows(), parts = place.cols();
  if (place.rows() != rows || weight.rows() != rows || group.size() != rows || weight.cols() != parts) {
    throw std::invalid_argument("place " + shape(place.rows(), parts) + ", weight " +
                                shape(weight.rows(), weight.cols()) + " and group of " + std::to_string(group.size()) +
                                ", expected one shape of " + std::to_string(rows) + " rows, those of the table");
  }
  DesignSums sums{RowMajorMatrix::Zero(groups * columns, columns),
                  RowMajorMatrix::Zero(groups * columns, table.cols())};
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (group[row] < 0) continue;
    if (group[row] >= groups) throw out_of_range("group[" + std::to_string(row) + "]", group[row], groups);
    const Eigen::Index first = group[row] * columns;
    for (Eigen::Index part = 0; part < parts; ++part) {
      const int at = place(row, part);
      if (at < 0 || at >= columns) throw out_of_range("place[" + std::to_string(row) + "]", at, columns);
      const double own = weight(row, part);
      sums.cross.row(first + at) += own * table.row(row);
      for (Eigen::Index other = 0; other < parts; ++other) {
        // A place out of range is met by the loop outside at the latest.
        const int beside = place(row, other);
        if (beside >= 0 && beside < columns) sums.square(first + at, beside) += own * weight(row, other);
      }
    }
  }
  return sums;
}

}  // namespace hexdbb
