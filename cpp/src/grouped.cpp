#include "hexdbb/grouped.hpp"

#include <stdexcept>
#include <string>

#include "multiversion.hpp"

namespace hexdbb {

namespace {

std::string shape(Eigen::Index rows, Eigen::Index columns) {
  return "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")";
}

std::invalid_argument out_of_range(const std::string& where, int value, Eigen::Index count) {
  return std::invalid_argument(where + " is " + std::to_string(value) + ", expected less than " +
                               std::to_string(count));
}

/// Rows of a design and of a table, and where their sums are added.
struct Entries {
  Eigen::Index rows, parts, columns, groups, width;
  const int* place;
  Eigen::Index place_stride;
  const double* weight;
  Eigen::Index weight_stride;
  const int* group;
  const double* table;
  Eigen::Index table_stride;
  double* square;
  double* cross;
};

/// Add the products of all rows; return the first row with a place or a group out of range, the number of rows where
/// there is none.
HEXDBB_MULTIVERSION
Eigen::Index add_rows(const Entries& of) noexcept {
  for (Eigen::Index row = 0; row < of.rows; ++row) {
    if (of.group[row] < 0) continue;
    if (of.group[row] >= of.groups) return row;
    const int* const at = of.place + row * of.place_stride;
    const double* const own = of.weight + row * of.weight_stride;
    const double* const __restrict values = of.table + row * of.table_stride;
    double* const square = of.square + of.group[row] * of.columns * of.columns;
    double* const cross = of.cross + of.group[row] * of.columns * of.width;
    for (Eigen::Index part = 0; part < of.parts; ++part) {
      if (at[part] < 0 || at[part] >= of.columns) return row;
      const double weight = own[part];
      if (weight == 0.0) continue;  // no entry
      double* const __restrict sums = cross + at[part] * of.width;
      for (Eigen::Index k = 0; k < of.width; ++k) sums[k] += weight * values[k];
      for (Eigen::Index other = 0; other < part; ++other) {
        square[at[part] * of.columns + at[other]] += weight * own[other];
        square[at[other] * of.columns + at[part]] += weight * own[other];
      }
      square[at[part] * (of.columns + 1)] += weight * weight;
    }
  }
  return of.rows;
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
  const Eigen::Index wrong = add_rows({rows, parts, columns, groups, table.cols(), place.data(), place.outerStride(),
                                       weight.data(), weight.outerStride(), group.data(), table.data(),
                                       table.outerStride(), sums.square.data(), sums.cross.data()});
  if (wrong == rows) return sums;
  if (group[wrong] >= groups) throw out_of_range("group[" + std::to_string(wrong) + "]", group[wrong], groups);
  for (const int at : place.row(wrong)) {
    if (at < 0 || at >= columns) throw out_of_range("place[" + std::to_string(wrong) + "]", at, columns);
  }
  return sums;
}

}  // namespace hexdbb
