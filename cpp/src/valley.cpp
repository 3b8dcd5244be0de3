#include "valley.hpp"

#include <algorithm>
#include <cmath>

#include "hexdbb/tabulated_effect.hpp"

namespace hexdbb {

namespace {

// Damping after Nielsen (1999): it grows ever faster while steps fail, and falls the more the closer the last step came
// to its predicted fall; constants as there.
constexpr double kMoreDamping = 3.0, kFaster = 2.0, kLeastPart = 0.1, kMostDamping = 1e9;
constexpr double kProbe = 0.1;          // fraction of a step at which its acceleration is measured (Transtrum, Sethna)
constexpr double kMostCurvature = 1.0;  // acceleration over velocity beyond which the expansion of a step is not valid

Eigen::VectorXd every(const Eigen::VectorXd& column, Eigen::Index stride) {
  return column(Eigen::seq(0, column.size() - 1, stride));
}

/// Return a model for a part of the samples that it is tabulated for, which then states no rows.
Model of_part(const Model& model, Samples& part) {
  if (!has_table(model)) return model;
  Model out = of_rows(model, part.state.row);
  part.state.row.resize(0);
  return out;
}

}  // namespace

FewReadings::FewReadings(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
                         const Unknowns& unknowns, double noise_mm, Eigen::Index rows)
    : unknowns_(unknowns),
      stride_(std::max<Eigen::Index>(1, samples.size() / rows)),
      samples_(samples.every(stride_)),
      model_(of_part(model, samples_)),
      measured_mm_(every(measured_mm, stride_)),
      noise_mm_(noise_mm / std::sqrt(static_cast<double>(stride_))),
      accumulator_(samples_, measured_mm_, unknowns.columns) {}

Eigen::VectorXd FewReadings::curvature(const Eigen::VectorXd& z, const Eigen::VectorXd& v) {
  if (accumulator_.jacobian().rows() == 0) accumulator_.keep_jacobian();
  at(z);
  const Eigen::VectorXd here = measured_mm_ - accumulator_.residual_mm();
  const Eigen::VectorXd probed = z + kProbe * v;
  Model there = model_;
  there.set_values(unknowns_.values(probed.data()));
  const Eigen::VectorXd change = (accumulator_.reading_mm(there) - here) / kProbe;
  const Eigen::VectorXd second = (2.0 / kProbe) * (change - accumulator_.jacobian() * unknowns_.scale.cwiseProduct(v));
  return unknowns_.scale.cwiseProduct(accumulator_.jacobian().transpose() * second) / (noise_mm_ * noise_mm_);
}

Descent descend(const std::function<Posterior(const Eigen::VectorXd&)>& at, FewReadings& few, Eigen::VectorXd z,
                const Eigen::VectorXd& bound, const EndOfDescent& end, double damping) {
  Descent out;
  Posterior now = at(z);
  out.is_reachable = now.is_reachable;
  double more = kMoreDamping;
  for (; now.is_reachable && out.steps < end.most_steps && damping < kMostDamping; ++out.steps) {
    const double least_fall = end.fall * std::max(1.0, 2.0 * now.cost / few.weight());
    Eigen::MatrixXd damped = now.information;
    damped.diagonal().array() += damping;
    const BoundedStep straight = BoundedStep::cautious(damped, now.downhill, z, bound);
    out.is_at_rest = straight.predicted_fall() < least_fall;
    if (out.is_at_rest) break;
    const double used = damping;
    damping *= more;
    more *= kFaster;
    const Eigen::VectorXd acceleration = -straight.solve(few.curvature(z, straight.step()));
    if (!(acceleration.norm() < kMostCurvature * straight.step().norm())) continue;
    Eigen::VectorXd further = z + straight.step() + 0.5 * acceleration;
    if ((further.cwiseAbs().array() > bound.array()).any()) further = z + straight.step();
    const Posterior next = at(further);
    if (!next.is_reachable || !(next.cost < now.cost)) continue;
    const double achieved = 2.0 * (now.cost - next.cost) / straight.predicted_fall();
    out.is_at_rest = now.cost - next.cost < 0.5 * least_fall;
    z = further;
    now = next;
    damping = used * std::max(kLeastPart, 1.0 - std::pow(2.0 * std::min(achieved, 1.0) - 1.0, 3.0));
    more = kMoreDamping;
    if (out.is_at_rest) break;
  }
  out.z = z;
  out.damping = damping;
  if (out.is_reachable) out.cost = now.cost;
  return out;
}

}  // namespace hexdbb
