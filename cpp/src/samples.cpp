#include "hexdbb/samples.hpp"

#include <stdexcept>
#include <string>

namespace hexdbb {

Samples Samples::every(Eigen::Index stride) const {
  std::vector<Eigen::Index> which;
  for (Eigen::Index row = 0; row < size(); row += stride) which.push_back(row);
  return rows(which);
}

Samples Samples::rows(const std::vector<Eigen::Index>& which) const {
  for (const Eigen::Index row : which) {
    if (row < 0 || row >= size()) {
      throw std::invalid_argument("row " + std::to_string(row) + " is not there, expected 0 to " +
                                  std::to_string(size() - 1));
    }
  }
  Samples out{sliders_mm(which, Eigen::all), set_up(which), mount(which), set_ups, state.rows(which)};
  if (moved_on_mm.rows() > 0) out.moved_on_mm = moved_on_mm(which, Eigen::all);
  if (state.row.size() == 0) {
    out.state.row.resize(out.size());
    for (Eigen::Index row = 0; row < out.size(); ++row) out.state.row[row] = static_cast<int>(which[row]);
  }
  return out;
}

void Samples::validate() const {
  const auto require_length = [this](const char* column, Eigen::Index length) {
    if (length != size()) {
      throw std::invalid_argument(std::string(column) + " has " + std::to_string(length) + " rows, expected " +
                                  std::to_string(size()) + " as in sliders_mm");
    }
  };
  require_length("set_up", set_up.size());
  require_length("mount", mount.size());
  for_each_column(state, [&](const ColumnInfo& info, const auto& column) {
    if (column.size() > 0) require_length(info.name, column.rows());
  });
  for (Eigen::Index row = 0; row < size(); ++row) {
    if (set_up[row] < 0 || set_up[row] >= static_cast<int>(set_ups.size())) {
      throw std::invalid_argument("set_up[" + std::to_string(row) + "] is " + std::to_string(set_up[row]) +
                                  ", expected 0 to " + std::to_string(static_cast<int>(set_ups.size()) - 1));
    }
    if (mount[row] < 0) throw std::invalid_argument("mount[" + std::to_string(row) + "] is negative");
    if (!sliders_mm.row(row).allFinite()) {
      throw std::invalid_argument("sliders_mm[" + std::to_string(row) + "] is not finite");
    }
  }
}

}  // namespace hexdbb
