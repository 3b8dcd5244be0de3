// Sums of weighted rows by group: the cross products of a design with one entry a row and part, and a table.
//
// A variable in bins is a design matrix W of n rows with W(i, group(i, part)) = weight(i, part): with T a table of n
// rows, W'T is
//   sums(g, :) = sum over i, part with group(i, part) = g of weight(i, part) T(i, :).
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

using Groups = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Return W'T, shape (groups, columns of T). `group` and `weight` hold a row for each row of T and a column for each
/// part. Throws std::invalid_argument where shapes differ or a group is out of range.
RowMajorMatrix grouped_sums(const Eigen::Ref<const Groups>& group, const Eigen::Ref<const RowMajorMatrix>& weight,
                            const Eigen::Ref<const RowMajorMatrix>& table, Eigen::Index groups);

}  // namespace hexdbb
