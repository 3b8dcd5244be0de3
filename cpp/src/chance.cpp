#include "hexdbb/chance.hpp"

#include <cmath>
#include <unsupported/Eigen/SpecialFunctions>

namespace hexdbb {

double f_tail(double numerator, double denominator, double value) {
  return Eigen::numext::betainc(0.5 * denominator, 0.5 * numerator, denominator / (denominator + numerator * value));
}

double chi_square_tail(double freedom, double value) { return Eigen::numext::igammac(0.5 * freedom, 0.5 * value); }

double log_normal_below(double value) {
  // erfc is above the smallest normal number to 37 standard deviations; from 30 on five terms of its asymptotic series
  // (Abramowitz and Stegun 26.2.12) leave a relative error of 1e-12 of the probability.
  constexpr double kFar = -30.0, kHalfLogTwoPi = 0.91893853320467274178;
  const double root = std::sqrt(0.5);
  if (value > 0.0) return std::log1p(-0.5 * std::erfc(value * root));
  if (value > kFar) return std::log(0.5 * std::erfc(-value * root));
  const double each = 1.0 / (value * value);
  const double series = each * (-1.0 + each * (3.0 + each * (-15.0 + each * (105.0 - 945.0 * each))));
  return -0.5 * value * value - std::log(-value) - kHalfLogTwoPi + std::log1p(series);
}

}  // namespace hexdbb
