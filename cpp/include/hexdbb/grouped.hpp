// Sums of a design matrix with few entries a row, over groups of its rows.
//
// A variable in bins is a design W of n rows with W(i, place(i, part)) = weight(i, part), parts of one place added up.
// With T a table of n rows, a fit to some of the rows needs W'W and W'T over these rows and no more. Both follow from
// one pass over the entries.
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

using Places = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sums of a design over each group of rows; group g has the rows from g * columns on.
struct DesignSums {
  RowMajorMatrix square;  ///< W'W, shape (groups * columns, columns)
  RowMajorMatrix cross;   ///< W'T, shape (groups * columns, columns of T)
};

/// Return W'W and W'T over each group. `place` and `weight` hold a row for each row of T and a column for each part,
/// `group` the group of each row, below 0 for rows that belong to none. Throws std::invalid_argument where shapes differ
/// or a place or group is out of range.
DesignSums design_sums(const Eigen::Ref<const Places>& place, const Eigen::Ref<const RowMajorMatrix>& weight,
                       const Eigen::Ref<const Eigen::VectorXi>& group, const Eigen::Ref<const RowMajorMatrix>& table,
                       Eigen::Index columns, Eigen::Index groups);

}  // namespace hexdbb
