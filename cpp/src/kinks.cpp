#include "kinks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hexdbb {

namespace {

// Width of a bracket, in standard deviations of its value, at which the value rests: what all values together may be off
// where the cost has no kinks.
constexpr double kNarrow = 1e-3;
// Part of a bracket that a step leaves on its far side; its square after the second step to the same side, and so on.
constexpr double kFewer = 0.5;
constexpr double kAstray = 1.0;  // of the cost above the lowest: where steps lead there, the minimum is not near
constexpr int kMost = 80;        // steps: brackets begin some hundredths of a standard deviation wide, and begin anew

/// Places to both sides of a value at which its step pointed to the other side.
class Bracket {
 public:
  /// Learn where a value is and by how much it would step.
  void learn(double at, double step) {
    double& own = step > 0.0 ? low_ : high_;
    double& other = step > 0.0 ? high_ : low_;
    const bool is_outside = step > 0.0 ? at >= high_ : at <= low_;
    if (is_outside) other = step > 0.0 ? kNone : -kNone;  // the other values have moved since
    again_ = std::isfinite(other) && is_up_ == (step > 0.0) ? again_ + 1 : 0;
    is_up_ = step > 0.0;
    own = at;
  }

  bool is_narrow(double sigma) const { return high_ - low_ < kNarrow * sigma; }

  /// Return how far up, or down, a value may go that would step to `there`.
  double upper(double there) const { return is_up_ && there >= high_ ? divided(low_, high_) : high_; }
  double lower(double there) const { return !is_up_ && there <= low_ ? divided(high_, low_) : low_; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  double divided(double near, double far) const { return far - (far - near) * std::pow(kFewer, again_ + 1); }

  double low_ = -kNone, high_ = kNone;
  bool is_up_ = true;
  int again_ = 0;  // steps to the same side since it last turned
};

}  // namespace

LastSteps settle_kinks(const std::function<Posterior(const Eigen::VectorXd&, Sums)>& all_at, FewReadings& few,
                       Eigen::VectorXd z, const Eigen::VectorXd& bound, const EndOfSteps& end) {
  LastSteps out;
  const Posterior part = few.at(z);
  if (!part.is_reachable) return out;
  const Eigen::Index size = z.size();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
  const Eigen::VectorXd sigma = part.information.llt().solve(identity).diagonal().cwiseSqrt();
  const std::vector<Bracket> none(static_cast<std::size_t>(size));
  std::vector<Bracket> brackets = none;
  double rested = std::numeric_limits<double>::infinity();  // cost where brackets began anew last
  for (; out.steps < kMost; ++out.steps) {
    const Posterior all = all_at(z, Sums::kGradient);
    if (!all.is_reachable || all.cost > out.cost + kAstray) return out;
    if (out.steps == 0) rested = all.cost;
    if (all.cost < out.cost) {
      out.cost = all.cost;
      out.z = z;
    }
    const Eigen::VectorXd wish = BoundedStep(part.information, all.downhill, z, -bound, bound).step();
    Eigen::VectorXd lower = -bound, upper = bound;
    bool any_rests = false;
    for (Eigen::Index j = 0; j < size; ++j) {
      Bracket& own = brackets[static_cast<std::size_t>(j)];
      own.learn(z[j], wish[j]);
      const bool rests = own.is_narrow(sigma[j]);
      any_rests |= rests;
      lower[j] = rests ? z[j] : std::max(lower[j], own.lower(z[j] + wish[j]));
      upper[j] = rests ? z[j] : std::min(upper[j], own.upper(z[j] + wish[j]));
    }
    const BoundedStep step(part.information, all.downhill, z, lower, upper);
    if (step.predicted_fall() >= end.kinked_fall) {
      z += step.step();
      continue;
    }
    // What a bracket was learned from is out of date as far as other values have moved since: it begins anew, until that
    // lowers the cost no more.
    out.is_at_rest = !any_rests || rested - out.cost < 0.5 * end.kinked_fall;
    if (out.is_at_rest) break;
    rested = out.cost;
    z = out.z;
    brackets = none;
  }
  return out;
}

}  // namespace hexdbb
