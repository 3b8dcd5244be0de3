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
  const Eigen::Index width = table.cols();
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (group[row] < 0) continue;
    if (group[row] >= groups) throw out_of_range("group[" + std::to_string(row) + "]", group[row], groups);
    const int* const at = place.data() + row * place.outerStride();
    const double *const own = weight.data() + row * weight.outerStride(), *const values =
                                                                              table.data() + row * table.outerStride();
    double* const square = sums.square.data() + group[row] * columns * columns;
    double* const cross = sums.cross.data() + group[row] * columns * width;
    for (Eigen::Index part = 0; part < parts; ++part) {
      if (at[part] < 0 || at[part] >= columns) {
        throw out_of_range("place[" + std::to_string(row) + "]", at[part], columns);
      }
      for (Eigen::Index k = 0; k < width; ++k) cross[at[part] * width + k] += own[part] * values[k];
      for (Eigen::Index other = 0; other < part; ++other) {
        square[at[part] * columns + at[other]] += own[part] * own[other];
        square[at[other] * columns + at[part]] += own[part] * own[other];
      }
      square[at[part] * (columns + 1)] += own[part] * own[part];
    }
  }
  return sums;
}

}  // namespace hexdbb
