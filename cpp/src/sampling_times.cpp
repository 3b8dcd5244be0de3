#include "sampling_times.hpp"

#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

// Rows: fewer may be within rounding of a line by chance, however uneven they are.
constexpr Eigen::Index kFewest = 8;
// Of the last digit: half is the rounding's own, the rest is how well the least-squares line through as few rows is known.
constexpr double kOff = 0.75;
constexpr double kCoarsest_s = 0.1, kFinest_s = 1e-6;  // a finer last digit is nothing to any slider
constexpr double kWhole = 1e-3;  // of the last digit: as binary fractions are; by chance eight rows do not have it

/// Return the power of ten that all times are whole multiples of, the greatest; 0 where there is none.
double last_digit_s(const Eigen::VectorXd& time_s) {
  for (double digit_s = kCoarsest_s; digit_s > 0.5 * kFinest_s; digit_s /= 10.0) {
    const Eigen::ArrayXd multiple = time_s.array() / digit_s;
    if (((multiple - multiple.round()).abs() < kWhole).all()) return digit_s;
  }
  return 0.0;
}

/// Return the number of steps from the first row to each, of the median length.
Eigen::VectorXd steps(const Eigen::VectorXd& time_s) {
  const Eigen::Index count = time_s.size() - 1;
  const Eigen::VectorXd step_s = time_s.tail(count) - time_s.head(count);
  Eigen::VectorXd sorted_s = step_s;
  std::nth_element(sorted_s.data(), sorted_s.data() + count / 2, sorted_s.data() + count);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(count + 1);
  const double median_s = sorted_s[count / 2];
  for (Eigen::Index row = 0; row < count; ++row) out[row + 1] = out[row] + std::round(step_s[row] / median_s);
  return out;
}

}  // namespace

Eigen::VectorXd without_rounding(const Eigen::VectorXd& time_s) {
  if (time_s.size() < kFewest) return time_s;
  const double digit_s = last_digit_s(time_s);
  if (digit_s == 0.0) return time_s;
  const Eigen::VectorXd step = steps(time_s);
  const Eigen::ArrayXd step_about = step.array() - step.mean(), time_about_s = time_s.array() - time_s.mean();
  const double period_s = (step_about * time_about_s).sum() / step_about.square().sum();
  const Eigen::ArrayXd even_s = period_s * step_about;
  if (((even_s - time_about_s).abs() > kOff * digit_s).any()) return time_s;
  return even_s + time_s.mean();
}

}  // namespace hexdbb
