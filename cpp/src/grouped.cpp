#include "hexdbb/grouped.hpp"

#include <stdexcept>
#include <string>

namespace hexdbb {

RowMajorMatrix grouped_sums(const Eigen::Ref<const Groups>& group, const Eigen::Ref<const RowMajorMatrix>& weight,
                            const Eigen::Ref<const RowMajorMatrix>& table, Eigen::Index groups) {
  if (group.rows() != table.rows() || weight.rows() != table.rows() || group.cols() != weight.cols()) {
    throw std::invalid_argument("group (" + std::to_string(group.rows()) + ", " + std::to_string(group.cols()) +
                                ") and weight (" + std::to_string(weight.rows()) + ", " +
                                std::to_string(weight.cols()) + "), expected one shape of " +
                                std::to_string(table.rows()) + " rows, those of the table");
  }
  RowMajorMatrix sums = RowMajorMatrix::Zero(groups, table.cols());
  for (Eigen::Index row = 0; row < table.rows(); ++row) {
    for (Eigen::Index part = 0; part < group.cols(); ++part) {
      const int at = group(row, part);
      if (at < 0 || at >= groups) {
        throw std::invalid_argument("group[" + std::to_string(row) + "] is " + std::to_string(at) + ", expected 0 to " +
                                    std::to_string(groups - 1));
      }
      sums.row(at) += weight(row, part) * table.row(row);
    }
  }
  return sums;
}

}  // namespace hexdbb
