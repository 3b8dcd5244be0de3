#include "hexdbb/run_up.hpp"

#include <cmath>
#include <vector>

namespace hexdbb {

namespace {

constexpr double kTurn_rad = 2.0 * M_PI;
// Of a step: a lap without the sample that would close it ends one step before, a rate that varies a little more.
constexpr double kOpenSteps = 1.5;

/// Return the angles turned since the first row, as far as the first row that is a turn from it.
std::vector<double> turned_rad(const Eigen::VectorXd& angle_rad) {
  std::vector<double> out = {0.0};
  double signed_rad = 0.0;
  for (Eigen::Index row = 1; row < angle_rad.size() && out.back() < kTurn_rad; ++row) {
    signed_rad += std::remainder(angle_rad[row] - angle_rad[row - 1], kTurn_rad);
    out.push_back(std::abs(signed_rad));
  }
  return out;
}

}  // namespace

RunUp run_up(const Eigen::VectorXd& time_s, const Eigen::VectorXd& angle_rad, double run_up_rad) {
  if (angle_rad.size() < 2) return {};
  const std::vector<double> turned = turned_rad(angle_rad);
  const auto last = static_cast<Eigen::Index>(turned.size()) - 1;
  const auto at = [&](Eigen::Index row) { return turned[static_cast<std::size_t>(row)]; };
  const double step_rad = at(last) - at(last - 1), step_s = time_s[last] - time_s[last - 1];
  const double left_rad = kTurn_rad - at(last);  // negative where the lap is closed before that row
  if (!(step_rad > 0.0) || left_rad > kOpenSteps * step_rad) return {};
  RunUp out;
  out.lap_s = time_s[last] - time_s[0] + step_s * left_rad / step_rad;
  // What is nearer to the start than half a step is the start again.
  out.end = last + 1;
  while (out.end > 0 && at(out.end - 1) > kTurn_rad - 0.5 * step_rad) --out.end;
  out.first = out.end;
  while (out.first > 0 && at(out.first - 1) >= kTurn_rad - run_up_rad) --out.first;
  return out;
}

}  // namespace hexdbb
