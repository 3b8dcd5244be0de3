#include "near_minimum.hpp"

#include <algorithm>

#include "geodesics.hpp"
#include "minimum.hpp"

namespace hexdbb {

bool find_near(FewReadings& few, const Unknowns& unknowns, int max_iterations, double tolerance,
               const Eigen::VectorXd& bound, Eigen::VectorXd& near) {
  constexpr int kFirst = 3;  // iterations: what a cost without kinks takes
  // Mean square left, noise variances: complete models leave 1, the least that was found to have two minima 23.
  constexpr double kComplete = 4.0;
  constexpr EndOfDescent kCoarse{1.0, 60};  // of chi-square: the remaining readings move the minimum by more
  const Eigen::VectorXd start = near;
  const auto by_ceres = [&](int most, Eigen::VectorXd& z) {
    return minimize(few.model(), few.accumulator(), unknowns, few.noise_mm(), most, tolerance, z);
  };
  const Minimum first = by_ceres(std::min(kFirst, max_iterations), near);
  if (!first.is_usable || first.iterations < kFirst) return first.is_usable;
  const Descent down = descend([&](const Eigen::VectorXd& at) { return few.at(at); }, few, near, bound, kCoarse);
  if (down.is_reachable) near = down.z;
  if (down.is_at_rest && 2.0 * down.cost < kComplete * few.weight()) return true;
  Eigen::VectorXd other = start;
  const Minimum whole = by_ceres(max_iterations, other);
  if (!whole.is_usable) return down.is_reachable;
  if (whole.iterations >= max_iterations) other = out_of_valley(few, start, other, bound);
  if (!(down.cost < few.at(other).cost)) near = other;
  return true;
}

}  // namespace hexdbb
