#include "minimum.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

/// Residuals and prior, compressed. With r the whitened readings' residuals and J their Jacobian, Ceres sees the n + p
/// numbers only through |r|^2, J'r and J'J. A triangular factor U of J'J, U^-T J'r and the part of |r| outside J's
/// range have the same three, so that a problem of 20,000 residuals becomes one of p + 1, and its dense algebra takes
/// no time.
class CompressedCost : public ceres::CostFunction {
 public:
  CompressedCost(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, double noise_mm)
      : model_(model), accumulator_(accumulator), unknowns_(unknowns), noise_mm_(noise_mm) {
    set_num_residuals(static_cast<int>(unknowns.size()) + 1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index size = unknowns_.size();
    const Eigen::Map<const Eigen::VectorXd> z(parameters[0], size);
    // Ceres evaluates the cost of a step first, and its derivatives where it accepts it: both result from one pass.
    Model model = model_;
    model.set_values(unknowns_.values(parameters[0]));
    const NormalEquations& now = accumulator_.at(model);
    if (now.failure >= 0) return false;                                 // Ceres then takes a shorter step
    const Posterior here = posterior_of(now, unknowns_, noise_mm_, z);  // the prior's residuals are z themselves
    const Eigen::LLT<Eigen::MatrixXd> factor(here.information);
    const Eigen::VectorXd inside = -factor.matrixL().solve(here.downhill);
    Eigen::Map<Eigen::VectorXd>(residuals, size) = inside;
    residuals[size] = std::sqrt(std::max(2.0 * here.cost - inside.squaredNorm(), 0.0));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorMatrix> out(jacobians[0], size + 1, size);
      out.topRows(size) = factor.matrixU();
      out.row(size).setZero();
    }
    return true;
  }

 private:
  const Model& model_;
  Accumulator& accumulator_;
  const Unknowns& unknowns_;
  double noise_mm_;
};

}  // namespace

Minimum minimize(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, double noise_mm,
                 int max_iterations, double function_tolerance, Eigen::VectorXd& z) {
  ceres::Problem problem;
  problem.AddResidualBlock(new CompressedCost(model, accumulator, unknowns, noise_mm), nullptr, z.data());
  ceres::Solver::Options solver;
  // The Jacobian is a triangular factor already: its product with itself is the information it came from.
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = max_iterations;
  solver.function_tolerance = function_tolerance;
  solver.gradient_tolerance = 1e-9;
  solver.parameter_tolerance = 1e-9;
  solver.initial_trust_region_radius = 1e8;  // the problem is nearly linear: start with Gauss-Newton steps
  solver.logging_type = ceres::SILENT;
  const Eigen::VectorXd bound = bounds_about(unknowns, z);
  for (Eigen::Index j = 0; j < unknowns.size(); ++j) {
    problem.SetParameterLowerBound(z.data(), static_cast<int>(j), -bound[j]);
    problem.SetParameterUpperBound(z.data(), static_cast<int>(j), bound[j]);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return {summary.IsSolutionUsable(), static_cast<int>(summary.iterations.size()) - 1, summary.message,
          summary.final_cost};
}

}  // namespace hexdbb
