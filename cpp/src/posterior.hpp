// Minus the logarithm of the posterior probability of a model's free values, to second order by Gauss and Newton.
// Everything is in units of the values' prior standard deviations.
//   cost = (sum ((measured - predicted) / noise)^2 + sum z^2) / 2
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "normal_equations.hpp"
#include "unknowns.hpp"

namespace hexdbb {

struct Posterior {
  bool is_reachable = false;  // the rest is meaningless where a sample has no solution
  double cost = 0.0;
  Eigen::VectorXd downhill;     // minus the gradient of the cost
  Eigen::MatrixXd information;  // J'J / noise^2 + 1; empty where it was not summed
};

/// Compute the posterior from the readings' normal equations at scaled values z.
Posterior posterior_of(const NormalEquations& equations, const Unknowns& unknowns, double noise_mm,
                       const Eigen::VectorXd& z);

/// Compute the posterior at scaled values z, in one pass over an accumulator's samples; of it what `sums` yield.
Posterior posterior_at(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, double noise_mm,
                       const Eigen::VectorXd& z, Sums sums = Sums::kAll);

/// Minimum of a quadratic between bounds: step' downhill - step' matrix step / 2 is largest. The values go to the minimum
/// as far as the first bound, its value is held there, and the others go on; one that the gradient then pulls off its
/// bound is free again. Were none freed, one of two values that all but undo each other would stop both.
class BoundedStep {
 public:
  BoundedStep(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill, const Eigen::VectorXd& z,
              const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

  /// Return a step for which every value that would pass its bound stays on it, whatever the others do then: shorter, and
  /// from afar, where the quadratic holds for a part of the way alone, less often into a minimum aside.
  static BoundedStep cautious(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& bound);

  const Eigen::VectorXd& step() const { return step_; }
  double predicted_fall() const { return predicted_fall_; }  // of chi-square, twice that of the cost

  /// Solve matrix x = right for the values that are free to move; the others' x is zero.
  Eigen::VectorXd solve(Eigen::VectorXd right) const;

 private:
  explicit BoundedStep(Eigen::Index size) : is_held_(size, false), step_(Eigen::VectorXd::Zero(size)) {}

  /// Factor the matrix of the values that are free.
  void factor_free(const Eigen::MatrixXd& matrix);
  /// Move the values that are free towards their minimum, as far as the first bound. Return which value stops there, -1
  /// where none does.
  Eigen::Index move_free(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill, const Eigen::VectorXd& z,
                         const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  /// Return the held value that the gradient pulls off its bound most, -1 where there is none.
  Eigen::Index pulled_inwards(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) const;

  std::vector<bool> is_held_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd step_;
  double predicted_fall_ = 0.0;
};

/// Return the bounds of scaled values; where the start is beyond its limit, it becomes the bound.
Eigen::VectorXd bounds_about(const Unknowns& unknowns, const Eigen::VectorXd& z);

}  // namespace hexdbb
