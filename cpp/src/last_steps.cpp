#include "last_steps.hpp"

#include <cmath>

namespace hexdbb {

namespace {

// Of chi-square: below, a step is a tenth of a standard deviation long, and convergence is linear.
constexpr double kLinearFall = 1e-2;
constexpr double kMostMixing = 1.0;  // |g|: a distance that halves with each step has 1, a slower one is not linear
constexpr double kRounding = 1e-11;  // of the cost, relative: thousand times that of its sum
constexpr double kStalled = 0.5;     // of the last fall: convergence is linear with less than a half
constexpr double kSlow = 0.1;  // of the last fall: four to seven steps that each divide it by more lead to the end
// Readings of the part for each value, below which it is thin: the plans measured have 28 for each of 37 values.
constexpr Eigen::Index kRowsPerValue = 8;
constexpr int kMost = 24;  // steps; sixteen were needed for 2,000,000 readings from the other sign of a value

/// A point of the way: where, how steep, and the fall of chi-square that its step was predicted to bring.
struct Point {
  Eigen::VectorXd z, downhill;
  double fall = std::numeric_limits<double>::infinity();
  Eigen::VectorXd step;  // unmixed
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

/// Bend the first step along the geodesic (valley.hpp): it leads over several standard deviations, the others over small
/// parts of one.
Eigen::VectorXd bent(const BoundedStep& step, FewReadings& few, const Eigen::VectorXd& z,
                     const Eigen::VectorXd& bound) {
  const Eigen::VectorXd acceleration = -step.solve(few.curvature(z, step.step()));
  const Eigen::VectorXd out = step.step() + 0.5 * acceleration;
  const bool is_valid = acceleration.norm() < step.step().norm();
  return is_valid && ((z + out).cwiseAbs().array() <= bound.array()).all() ? out : step.step();
}

/// Return whether there is no further step to take: what it is predicted to bring is nothing, or too little for a slow one.
bool is_at_rest(const Point& last, const Point& now, const EndOfSteps& end) {
  return now.fall < end.fall || (now.fall < end.slow_fall && now.fall > kSlow * last.fall);
}

/// Return whether the next point's step will bring less than the last fall, where falls go on as between the last two.
bool is_end_near(const Point& last, const Point& now, const EndOfSteps& end) {
  return std::isfinite(last.fall) && now.fall * now.fall < end.fall * last.fall;
}

}  // namespace

bool is_thin(const FewReadings& few, Eigen::Index values) {
  return few.stride() > 1 && few.measured_mm().size() < kRowsPerValue * values;
}

LastSteps take_last_steps(const std::function<Posterior(const Eigen::VectorXd&, Sums)>& all_at, FewReadings& few,
                          Eigen::VectorXd z, const Eigen::VectorXd& bound, const EndOfSteps& end) {
  LastSteps out;
  Point last;
  Posterior part;
  const bool thin = is_thin(few, z.size());
  bool is_near_end = false;
  for (; out.steps < kMost; ++out.steps) {
    // J'J of all readings is only wanted at the end, where it is that of the covariance.
    const bool is_linear = last.fall < kLinearFall;
    const Posterior all = all_at(z, is_near_end || (thin && !is_linear) ? Sums::kAll : Sums::kGradient);
    const bool is_worse = all.is_reachable && all.cost > out.cost * (1.0 + kRounding);
    if (is_worse && z != last.z + last.step) {
      z = last.z + last.step;  // mixed with the one before, it led too far
      continue;
    }
    if (!is_linear) part = thin ? all : few.at(z);
    if (!all.is_reachable || !part.is_reachable || is_worse) break;
    const BoundedStep step(part.information, all.downhill, z, -bound, bound);
    Point now{z, all.downhill, step.predicted_fall(), step.step()};
    out.cost = all.cost;
    out.z = z;
    out.is_at_rest = is_at_rest(last, now, end);
    if (out.is_at_rest) break;
    if (last.fall < kLinearFall && now.fall > kStalled * last.fall) {  // back and forth across a kink
      out.is_at_rest = now.fall < end.kinked_fall;
      break;
    }
    is_near_end = is_end_near(last, now, end);
    z += std::isinf(last.fall) ? bent(step, few, z, bound) : mixed(step, last, now, bound);
    last = std::move(now);
  }
  return out;
}

}  // namespace hexdbb
