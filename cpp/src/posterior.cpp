#include "posterior.hpp"

#include <algorithm>

namespace hexdbb {

Posterior posterior_of(const NormalEquations& equations, const Unknowns& unknowns, double noise_mm,
                       const Eigen::VectorXd& z) {
  Posterior out;
  if (equations.failure >= 0) return out;
  const Eigen::VectorXd per_noise = unknowns.scale / noise_mm;
  out.is_reachable = true;
  out.cost = 0.5 * (equations.squared / (noise_mm * noise_mm) + z.squaredNorm());
  if (equations.gradient.size() == 0) return out;
  out.downhill = per_noise.cwiseProduct(equations.gradient) / noise_mm - z;
  if (equations.information.size() == 0) return out;
  out.information = per_noise.asDiagonal() * equations.information * per_noise.asDiagonal();
  out.information.diagonal().array() += 1.0;
  return out;
}

Posterior posterior_at(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, double noise_mm,
                       const Eigen::VectorXd& z, Sums sums) {
  Model there = model;
  there.set_values(unknowns.values(z.data()));
  return posterior_of(accumulator.at(there, sums), unknowns, noise_mm, z);
}

BoundedStep::BoundedStep(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill, const Eigen::VectorXd& z,
                         const Eigen::VectorXd& lower, const Eigen::VectorXd& upper)
    : is_held_(z.size(), false), step_(Eigen::VectorXd::Zero(z.size())) {
  do {
    Eigen::MatrixXd free = matrix;
    Eigen::VectorXd right = downhill;
    for (Eigen::Index j = 0; j < z.size(); ++j) {
      if (!is_held_[j]) continue;
      right -= step_[j] * matrix.col(j);
      free.row(j).setZero();
      free.col(j).setZero();
      free(j, j) = 1.0;
    }
    factor_.compute(free);
    const Eigen::VectorXd moved = solve(right);
    for (Eigen::Index j = 0; j < z.size(); ++j) step_[j] = is_held_[j] ? step_[j] : moved[j];
  } while (hold_beyond_bounds(z, lower, upper));
  predicted_fall_ = step_.dot(2.0 * downhill - matrix * step_);
}

bool BoundedStep::hold_beyond_bounds(const Eigen::VectorXd& z, const Eigen::VectorXd& lower,
                                     const Eigen::VectorXd& upper) {
  bool any = false;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const double there = std::clamp(z[j] + step_[j], lower[j], upper[j]);
    if (is_held_[j] || there == z[j] + step_[j]) continue;
    step_[j] = there - z[j];
    is_held_[j] = any = true;
  }
  return any;
}

Eigen::VectorXd BoundedStep::solve(Eigen::VectorXd right) const {
  for (Eigen::Index j = 0; j < right.size(); ++j) {
    if (is_held_[j]) right[j] = 0.0;
  }
  return factor_.solve(right);
}

Eigen::VectorXd bounds_about(const Unknowns& unknowns, const Eigen::VectorXd& z) {
  return unknowns.limit.cwiseQuotient(unknowns.scale).cwiseMax(z.cwiseAbs());
}

}  // namespace hexdbb
