#include "last_steps.hpp"

#include <cmath>

namespace hexdbb {

namespace {

// Of chi-square: a step that is predicted to lower it by less is the last. It is then 3e-4 standard deviations long over
// all values together, and what remains after it a third of that at most.
constexpr double kLastFall = 1e-7;
// Of chi-square: below, a step is a tenth of a standard deviation long, and convergence is linear.
constexpr double kLinearFall = 1e-2;
constexpr double kMostMixing = 1.0;  // |g|: a distance that halves with each step has 1, a slower one is not linear
constexpr double kRounding = 1e-11;  // of the cost, relative: thousand times that of its sum
constexpr int kMost = 12;            // steps; four to seven suffice where the model is complete

/// A point of the way: where, how steep, and the fall of chi-square that its step was predicted to bring.
struct Point {
  Eigen::VectorXd z, downhill;
  double fall = std::numeric_limits<double>::infinity();
};

/// Mix a step with the last one; the step itself where the last two do not converge linearly, or a value would pass its
/// bound.
Eigen::VectorXd mixed(const BoundedStep& step, const Point& last, const Point& now, const Eigen::VectorXd& bound) {
  if (last.fall > kLinearFall) return step.step();
  const Eigen::VectorXd change = now.downhill - last.downhill, of_step = step.solve(change);
  const double g = change.dot(step.step()) / change.dot(of_step);
  if (!(std::abs(g) <= kMostMixing)) return step.step();
  const Eigen::VectorXd out = step.step() - g * (now.z - last.z + of_step);
  return ((now.z + out).cwiseAbs().array() > bound.array()).any() ? step.step() : out;
}

}  // namespace

LastSteps take_last_steps(const std::function<Posterior(const Eigen::VectorXd&)>& downhill_at, FewReadings& few,
                          Eigen::VectorXd z, const Eigen::VectorXd& bound) {
  LastSteps out;
  Point last;
  for (; out.steps < kMost; ++out.steps) {
    const Posterior all = downhill_at(z), part = few.at(z);
    if (!all.is_reachable || !part.is_reachable || all.cost > out.cost * (1.0 + kRounding)) break;
    const BoundedStep step(part.information, all.downhill, z, bound);
    Point now{z, all.downhill, step.predicted_fall()};
    out.cost = all.cost;
    out.z = z;
    out.is_at_rest = now.fall < kLastFall;
    z += out.is_at_rest ? step.step() : mixed(step, last, now, bound);
    if (out.is_at_rest) {
      out.z = z;
      break;
    }
    last = std::move(now);
  }
  return out;
}

}  // namespace hexdbb
