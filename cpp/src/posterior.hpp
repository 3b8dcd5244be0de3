// How probable values are, and where they become more so: minus the logarithm of the probability of a model's free
// values, to second order by Gauss and Newton. Everything is in units of the values' expected sizes.
//   cost = (sum ((measured - predicted) / noise)^2 + sum z^2) / 2
#pragma once

#include <Eigen/Cholesky>

#include "normal_equations.hpp"
#include "unknowns.hpp"

namespace hexdbb {

struct Posterior {
  bool is_reachable = false;  // the rest is meaningless where a sample has no solution
  double cost = 0.0;
  Eigen::VectorXd downhill;     // minus the gradient of the cost
  Eigen::MatrixXd information;  // J'J / noise^2 + 1
};

/// Of readings' normal equations at scaled values z.
Posterior posterior_of(const NormalEquations& equations, const Unknowns& unknowns, double noise_mm,
                       const Eigen::VectorXd& z);

/// One pass over an accumulator's samples.
Posterior posterior_at(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, double noise_mm,
                       const Eigen::VectorXd& z);

/// Where a quadratic is least between bounds: step' downhill - step' matrix step / 2 is largest. Values that a step
/// would take beyond their bound stop there, and the others make up for it.
class BoundedStep {
 public:
  BoundedStep(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill, const Eigen::VectorXd& z,
              const Eigen::VectorXd& bound);

  const Eigen::VectorXd& step() const { return step_; }
  double promised() const { return promised_; }  // twice the fall of cost, that is of chi-square

  /// Solve matrix x = right for the values that are free to move; the others' x is zero.
  Eigen::VectorXd solve(Eigen::VectorXd right) const;

 private:
  bool hold_what_leaves(const Eigen::VectorXd& z, const Eigen::VectorXd& bound);

  std::vector<bool> is_held_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd step_;
  double promised_ = 0.0;
};

/// Limits of scaled values; a start beyond them is one itself.
Eigen::VectorXd bounds_about(const Unknowns& unknowns, const Eigen::VectorXd& z);

}  // namespace hexdbb
