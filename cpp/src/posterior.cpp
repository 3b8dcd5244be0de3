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
    : BoundedStep(z.size()) {
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    is_held_[j] = lower[j] == upper[j] || (downhill[j] > 0.0 ? z[j] >= upper[j] : z[j] <= lower[j]);
  }
  // Primal active sets: every change lowers the quadratic, so that even the last of too many leaves a good step.
  const Eigen::Index most_changes = 4 * z.size();  // each value held and freed twice: beyond, rounding changes them
  for (Eigen::Index changes = 0; changes <= most_changes; ++changes) {
    const Eigen::Index stopped = move_free(matrix, downhill, z, lower, upper);
    const Eigen::Index other = stopped >= 0 ? stopped : pulled_inwards(matrix, downhill, z, lower, upper);
    if (other < 0) break;
    is_held_[other] = stopped >= 0;
  }
  predicted_fall_ = step_.dot(2.0 * downhill - matrix * step_);
}

BoundedStep BoundedStep::cautious(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill,
                                  const Eigen::VectorXd& z, const Eigen::VectorXd& bound) {
  BoundedStep out(z.size());
  for (bool any_beyond = true; any_beyond;) {
    out.factor_free(matrix);
    const Eigen::VectorXd way = out.solve(downhill - matrix * out.step_);
    any_beyond = false;
    for (Eigen::Index j = 0; j < z.size(); ++j) {
      if (!out.is_held_[j]) out.step_[j] += way[j];
    }
    for (Eigen::Index j = 0; j < z.size(); ++j) {
      const double there = std::clamp(z[j] + out.step_[j], -bound[j], bound[j]);
      if (out.is_held_[j] || there == z[j] + out.step_[j]) continue;
      out.step_[j] = there - z[j];
      out.is_held_[j] = any_beyond = true;
    }
  }
  out.predicted_fall_ = out.step_.dot(2.0 * downhill - matrix * out.step_);
  return out;
}

void BoundedStep::factor_free(const Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd free = matrix;
  for (Eigen::Index j = 0; j < step_.size(); ++j) {
    if (!is_held_[j]) continue;
    free.row(j).setZero();
    free.col(j).setZero();
    free(j, j) = 1.0;
  }
  factor_.compute(free);
}

Eigen::Index BoundedStep::move_free(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill,
                                    const Eigen::VectorXd& z, const Eigen::VectorXd& lower,
                                    const Eigen::VectorXd& upper) {
  factor_free(matrix);
  const Eigen::VectorXd way = solve(downhill - matrix * step_);
  double part = 1.0;
  Eigen::Index stopped = -1;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const double room = (way[j] > 0.0 ? upper[j] : lower[j]) - z[j] - step_[j];
    if (is_held_[j] || std::abs(way[j]) * part <= std::abs(room)) continue;
    part = room / way[j];
    stopped = j;
  }
  step_ += part * way;
  if (stopped >= 0) step_[stopped] = (way[stopped] > 0.0 ? upper[stopped] : lower[stopped]) - z[stopped];
  return stopped;
}

Eigen::Index BoundedStep::pulled_inwards(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& downhill,
                                         const Eigen::VectorXd& z, const Eigen::VectorXd& lower,
                                         const Eigen::VectorXd& upper) const {
  constexpr double kRounding = 1e-12;  // of the terms that a pull is the sum of: some thousand times a double's own
  Eigen::Index out = -1;
  double strongest = 0.0;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    if (!is_held_[j] || lower[j] == upper[j]) continue;
    const Eigen::VectorXd terms = matrix.col(j).cwiseProduct(step_);
    const double there = z[j] + step_[j], outwards = upper[j] - there < there - lower[j] ? 1.0 : -1.0;
    const double inwards = outwards * (terms.sum() - downhill[j]);
    if (inwards <= kRounding * (terms.cwiseAbs().sum() + std::abs(downhill[j])) || inwards <= strongest) continue;
    strongest = inwards;
    out = j;
  }
  return out;
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
