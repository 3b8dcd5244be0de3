// The unknowns of a fit: a model's free values in units of their prior standard deviations, within their limits.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hexdbb/diagnosis.hpp"

namespace hexdbb {

struct Unknowns {
  Eigen::VectorXd start;     // values of the whole model
  std::vector<int> columns;  // of the free ones
  Eigen::VectorXd scale;     // prior standard deviations of the free ones
  Eigen::VectorXd limit;     // their limits, engine units
  std::vector<bool> shapes;  // ParameterInfo::is_shape

  Eigen::Index size() const { return scale.size(); }

  Eigen::VectorXd values(const double* z) const {
    Eigen::VectorXd out = start;
    for (Eigen::Index j = 0; j < size(); ++j) out[columns[j]] = z[j] * scale[j];
    return out;
  }

  Eigen::VectorXd scaled_start() const { return start(columns).cwiseQuotient(scale); }

  /// Return the values most probable a priori; shapes keep their start.
  Eigen::VectorXd scaled_expected() const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
    for (Eigen::Index j = 0; j < size(); ++j) {
      if (shapes[static_cast<std::size_t>(j)]) out[j] = start[columns[j]] / scale[j];
    }
    return out;
  }
};

/// Return the unknowns of a fit. Throws std::invalid_argument where options have other lengths than the model's values.
Unknowns make_unknowns(const Model& model, const FitOptions& options);

}  // namespace hexdbb
