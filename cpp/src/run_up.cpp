#include "hexdbb/run_up.hpp"

#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

constexpr double kTurn_rad = 2.0 * M_PI;
// Of a step: a lap without the sample that would close it ends one step before, a rate that varies a little more.
constexpr double kOpenSteps = 1.5;

/// Return the angles turned since the first row.
Eigen::VectorXd turned_rad(const Eigen::VectorXd& angle_rad) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(angle_rad.size());
  for (Eigen::Index row = 1; row < out.size(); ++row) {
    out[row] = out[row - 1] + std::remainder(angle_rad[row] - angle_rad[row - 1], kTurn_rad);
  }
  return out.cwiseAbs();
}

}  // namespace

RunUp run_up(const Eigen::VectorXd& time_s, const Eigen::VectorXd& angle_rad, double run_up_rad) {
  const Eigen::Index count = angle_rad.size();
  if (count < 2) return {};
  const Eigen::VectorXd turned = turned_rad(angle_rad);
  Eigen::Index closed = 0;  // the first row a lap behind the first
  while (closed < count && turned[closed] < kTurn_rad) ++closed;
  const Eigen::Index after = std::min(closed, count - 1);
  const double step_rad = turned[after] - turned[after - 1], step_s = time_s[after] - time_s[after - 1];
  const double left_rad = kTurn_rad - turned[after];  // negative where the lap is closed before that row
  if (!(step_rad > 0.0) || left_rad > kOpenSteps * step_rad) return {};
  RunUp out;
  out.lap_s = time_s[after] - time_s[0] + step_s * left_rad / step_rad;
  // What is nearer to the start than half a step is the start again.
  out.end = closed;
  while (out.end > 0 && turned[out.end - 1] > kTurn_rad - 0.5 * step_rad) --out.end;
  out.first = out.end;
  while (out.first > 0 && turned[out.first - 1] >= kTurn_rad - run_up_rad) --out.first;
  return out;
}

}  // namespace hexdbb
