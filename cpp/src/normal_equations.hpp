// Accumulation of the normal equations in one pass over the samples, on all cores.
#pragma once

#include <vector>

#include "block_solver.hpp"
#include "hexdbb/normal_equations.hpp"

namespace hexdbb {

/// What a pass sums: each includes those before it. A gradient takes half the time of all, residuals alone a third.
enum class Sums { kResidual, kGradient, kAll };

/// Accumulates over the same samples repeatedly, as a fit requires; remembers every solution as the start of the next.
/// All models have the same effects, at other values.
class Accumulator {
 public:
  /// `columns`: values of the model that count, in order. All must outlive the accumulator.
  /// `robust_mm`: residuals beyond it count linearly (Huber); 0: least squares.
  Accumulator(const Samples& samples, const Eigen::VectorXd& measured_mm, const std::vector<int>& columns,
              double robust_mm = 0.0);

  /// Return the normal equations at a model's values; what is not summed is empty. Those of the last values are kept: the
  /// start of a fit, its first iteration and the nominal machine often coincide.
  const NormalEquations& at(const Model& model, Sums sums = Sums::kAll);

  /// Residuals of the last at(), mm.
  const Eigen::VectorXd& residual_mm() const { return residual_mm_; }

  /// Start from the solutions of all samples, of which these are every `stride`-th: far apart, they are no neighbours of
  /// each other.
  void start_from(const Accumulator& all, Eigen::Index stride);

  /// Keep the Jacobian of all readings at every pass from now on; for few samples.
  void keep_jacobian();
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }

  /// Predict readings alone, mm; zero for a sample without a solution.
  Eigen::VectorXd reading_mm(const Model& model);

 private:
  NormalEquations sum(const Model& model, Sums sums);
  bool takes_all(const Model& model) const;
  class Gathered;
  class GradientSums;
  void check(const Model& model);
  void keep(const SampleBlock& rows, const Eigen::Ref<const Eigen::MatrixXd>& columns);
  void chunk(const Model& model, Eigen::Index first, Eigen::Index last, Sums sums, NormalEquations& out);

  const Samples& samples_;
  const Eigen::VectorXd& measured_mm_;
  const std::vector<int>& columns_;
  double robust_mm_;
  AngleMemory memory_;
  Eigen::VectorXd residual_mm_;
  Eigen::MatrixXd jacobian_;  // of the chosen values; no rows where it is not kept
  bool is_checked_ = false;   // the samples have what the model's effects need
  Eigen::VectorXd last_values_;
  Sums last_sums_ = Sums::kAll;
  NormalEquations last_;
};

}  // namespace hexdbb
