#include "geodesics.hpp"

#include <cmath>

#include "kinks.hpp"

namespace hexdbb {

LastSteps finish(const std::function<Posterior(const Eigen::VectorXd&, Sums)>& of_all, FewReadings& few,
                 const Eigen::VectorXd& near, const Eigen::VectorXd& bound, const EndOfSteps& limits) {
  constexpr int kMost = 12;            // steps along the geodesic
  constexpr double kDescended = 0.01;  // of chi-square: a tenth of a standard deviation, from which steps lead straight
  const LastSteps straight = take_last_steps(of_all, few, near, bound, limits);
  if (straight.is_at_rest) return straight;
  if (is_thin(few, near.size())) return straight;  // what bends a step is not determined either
  const Eigen::VectorXd& best = std::isfinite(straight.cost) ? straight.z : near;
  LastSteps out = settle_kinks(of_all, few, best, bound, limits);
  out.steps += straight.steps;
  if (out.is_at_rest) return out;
  const auto of_all_sums = [&](const Eigen::VectorXd& at) { return of_all(at, Sums::kAll); };
  const Descent down = descend(of_all_sums, few, best, bound, {kDescended, kMost});
  if (!down.is_reachable) return out;
  const int before = out.steps + down.steps;
  out = settle_kinks(of_all, few, down.z, bound, limits);
  out.steps += before;
  return out;
}

Eigen::VectorXd out_of_valley(FewReadings& few, const Eigen::VectorXd& start, const Eigen::VectorXd& reached,
                              const Eigen::VectorXd& bound) {
  constexpr int kMost = 100;  // steps of two passes over the part: both ways take as long as 100 over all readings
  constexpr double kDescended = 0.01;  // of chi-square: a tenth of a standard deviation, from which steps lead straight
  const auto from = [&](const Eigen::VectorXd& z) {
    return descend([&](const Eigen::VectorXd& at) { return few.at(at); }, few, z, bound, {kDescended, kMost});
  };
  const Descent one = from(start), other = from(reached);
  return one.cost < other.cost ? one.z : other.z;
}

}  // namespace hexdbb
