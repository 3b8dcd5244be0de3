// Normal equations J'J, J'r and r'r of all readings in one pass over the samples, on all cores: what a least-squares
// step or a screening of further effects requires. The Jacobian itself is never stored.
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

struct NormalEquations {
  Eigen::MatrixXd information;  // J'J, symmetric, for the selected values
  Eigen::VectorXd gradient;     // J'r, r = measured - predicted, J = d predicted / d value
  double squared = 0.0;  // r'r, mm^2; under Huber's loss the sum of losses, and J, r are those of the weighted rows
  Eigen::Index failure = -1;  // first sample without a solution, or -1; the rest is then meaningless
  Status failure_status = Status::kOk;
};

/// Compute the normal equations for all values of a model. Throws std::invalid_argument where shapes disagree.
NormalEquations normal_equations(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm);

/// Limit the threads that sum normal equations, for the whole process; 0: as many as cores. Sums are added in another
/// order by another number of threads, so that values may differ in their last digits.
/// Throws std::invalid_argument for a negative number.
void limit_threads(int most);

}  // namespace hexdbb
