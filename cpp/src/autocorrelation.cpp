#include <algorithm>
#include <stdexcept>
#include <string>

#include "hexdbb/diagnosis.hpp"

namespace hexdbb {

double autocorrelation_time(const Eigen::VectorXd& residual, const Eigen::VectorXi& sweep) {
  const Eigen::Index count = residual.size();
  if (sweep.size() != count) {
    throw std::invalid_argument("sweep has " + std::to_string(sweep.size()) + " entries, expected " +
                                std::to_string(count) + ", one per residual");
  }
  const auto covariance = [&](Eigen::Index lag) {
    double sum = 0.0;
    for (Eigen::Index row = lag; row < count; ++row) {
      if (sweep[row] == sweep[row - lag]) sum += residual[row] * residual[row - lag];
    }
    return sum;
  };
  const double variance = covariance(0);
  double length = 1.0;
  if (!(variance > 0.0)) return length;
  for (Eigen::Index lag = 1; lag + 1 < count; lag += 2) {
    const double pair = (covariance(lag) + covariance(lag + 1)) / variance;
    if (!(pair > 0.0)) break;
    length += 2.0 * pair;
  }
  return std::max(length, 1.0);
}

}  // namespace hexdbb
