#include "hexdbb/contour_path.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "hexdbb/harmonics.hpp"

namespace hexdbb {

namespace {

constexpr double kTurn = 2.0 * M_PI;
constexpr Eigen::Index kLeastValues = 3;  // of a lap that is compared: below, most lie beyond the other's ends

void require_length(const char* what, Eigen::Index length, Eigen::Index expected) {
  if (length == expected) return;
  throw std::invalid_argument(std::string(what) + " has " + std::to_string(length) + " rows, expected " +
                              std::to_string(expected) + ", one per angle");
}

void require_samples(const Numbers& angle_rad) {
  if (angle_rad.size() == 0) throw std::invalid_argument("a path has no samples, expected at least one");
}

double wrapped(double angle_rad) {
  double out = std::fmod(angle_rad, kTurn);
  if (out < 0.0) out += kTurn;
  return out < kTurn ? out : 0.0;  // of -1e-17 the sum rounds to a whole turn
}

/// Return the rows of each number, in the order of the numbers.
std::vector<std::vector<Eigen::Index>> rows_by_number(const Ordinals& number) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(number.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto one, auto other) { return number[one] < number[other]; });
  std::vector<std::vector<Eigen::Index>> out;
  for (const Eigen::Index row : order) {
    if (out.empty() || number[out.back().front()] != number[row]) out.emplace_back();
    out.back().push_back(row);
  }
  return out;
}

/// Compute the differences of a later lap from an earlier one, where the earlier one has readings to both sides.
Eigen::VectorXd differences(const ContourPath& earlier, const Numbers& angle_rad, const Numbers& values) {
  const Eigen::VectorXd& at = earlier.angle_rad;
  Eigen::VectorXd out(angle_rad.size());
  Eigen::Index count = 0;
  for (Eigen::Index row = 0; row < angle_rad.size(); ++row) {
    const double wanted = wrapped(angle_rad[row]);
    const Eigen::Index right = std::lower_bound(at.begin(), at.end(), wanted) - at.begin();
    if (right == 0 || right == at.size()) continue;
    const double gap = at[right] - at[right - 1], part = gap > 0.0 ? (wanted - at[right - 1]) / gap : 0.0;
    const double between = (1.0 - part) * earlier.deviation_mm[right - 1] + part * earlier.deviation_mm[right];
    out[count++] = (values[row] - between) / std::sqrt(1.0 + part * part + (1.0 - part) * (1.0 - part));
  }
  return out.head(count);
}

}  // namespace

ContourPath make_path(const Numbers& angle_rad, const Numbers& deviation_mm) {
  require_length("deviation_mm", deviation_mm.size(), angle_rad.size());
  const Eigen::VectorXd turned = angle_rad.unaryExpr(&wrapped);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(turned.size()));
  std::iota(order.begin(), order.end(), 0);
  // Laps are mostly in order already, one way or the other, but for where they begin.
  if (turned.size() > 1 && turned[1] < turned[0]) std::reverse(order.begin(), order.end());
  const auto begin =
      std::min_element(order.begin(), order.end(), [&](auto a, auto b) { return turned[a] < turned[b]; });
  std::rotate(order.begin(), begin, order.end());
  const auto is_before = [&](Eigen::Index one, Eigen::Index other) {
    return turned[one] != turned[other] ? turned[one] < turned[other] : one < other;
  };
  if (!std::is_sorted(order.begin(), order.end(), is_before)) std::sort(order.begin(), order.end(), is_before);
  return {turned(order), deviation_mm(order)};
}

double largest_gap_rad(const Numbers& angle_rad) {
  require_samples(angle_rad);
  const Eigen::Index last = angle_rad.size() - 1;
  double out = angle_rad[0] + kTurn - angle_rad[last];
  for (Eigen::Index row = 0; row < last; ++row) out = std::max(out, angle_rad[row + 1] - angle_rad[row]);
  return out;
}

Eigen::VectorXd deviation_at(const Numbers& angle_rad, const Numbers& deviation_mm, const Numbers& at_rad) {
  require_samples(angle_rad);
  require_length("deviation_mm", deviation_mm.size(), angle_rad.size());
  const Eigen::Index last = angle_rad.size() - 1;
  Eigen::VectorXd out(at_rad.size());
  Eigen::Index right = 0;  // mostly that of the angle before, or the next
  for (Eigen::Index row = 0; row < at_rad.size(); ++row) {
    const double at = wrapped(at_rad[row]);
    if (right > 0 && at < angle_rad[right - 1]) right = 0;
    if (right + 8 <= last && angle_rad[right + 8] <= at) {
      right = std::upper_bound(angle_rad.begin() + right, angle_rad.end(), at) - angle_rad.begin();
    }
    while (right <= last && angle_rad[right] <= at) ++right;
    const double from = right > 0 ? angle_rad[right - 1] : angle_rad[last] - kTurn;
    const double to = right <= last ? angle_rad[right] : angle_rad[0] + kTurn;
    const double left_mm = deviation_mm[right > 0 ? right - 1 : last],
                 right_mm = deviation_mm[right <= last ? right : 0];
    out[row] = left_mm + (at - from) * ((right_mm - left_mm) / (to - from));
  }
  return out;
}

ContourPath mean_path(const Numbers& angle_rad, const Numbers& deviation_mm, const Ordinals& turn,
                      double most_gap_rad) {
  require_samples(angle_rad);
  require_length("deviation_mm", deviation_mm.size(), angle_rad.size());
  require_length("turn", turn.size(), angle_rad.size());
  std::vector<ContourPath> laps;
  for (const auto& rows : rows_by_number(turn)) laps.push_back(make_path(angle_rad(rows), deviation_mm(rows)));
  const auto is_shorter = [](const ContourPath& one, const ContourPath& other) {
    return one.angle_rad.size() < other.angle_rad.size();
  };
  std::vector<const ContourPath*> whole;
  for (const ContourPath& lap : laps) {
    if (largest_gap_rad(lap.angle_rad) <= most_gap_rad) whole.push_back(&lap);
  }
  if (whole.empty()) return *std::max_element(laps.begin(), laps.end(), is_shorter);
  if (whole.size() == 1) return *whole.front();
  Eigen::Index count = whole.front()->angle_rad.size();
  for (const ContourPath* lap : whole) count = std::min(count, lap->angle_rad.size());
  ContourPath out{
      Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1)) * (kTurn / static_cast<double>(count)),
      Eigen::VectorXd::Zero(count)};
  for (const ContourPath* lap : whole) {
    out.deviation_mm += deviation_at(lap->angle_rad, lap->deviation_mm, out.angle_rad);
  }
  out.deviation_mm /= static_cast<double>(whole.size());
  return out;
}

double circular_hysteresis_mm(const ContourPath& one, const ContourPath& other) {
  const auto largest = [&](const Eigen::VectorXd& at_rad) {
    return (deviation_at(one.angle_rad, one.deviation_mm, at_rad) -
            deviation_at(other.angle_rad, other.deviation_mm, at_rad))
        .cwiseAbs()
        .maxCoeff();
  };
  return std::max(largest(one.angle_rad), largest(other.angle_rad));
}

PlanePoints path_points_mm(const Numbers& angle_rad, const Numbers& deviation_mm, double nominal_radius_mm) {
  require_length("deviation_mm", deviation_mm.size(), angle_rad.size());
  const Eigen::ArrayXd radius_mm = nominal_radius_mm + deviation_mm.array();
  PlanePoints out(angle_rad.size(), 2);
  out.col(0) = radius_mm * angle_rad.array().cos();
  out.col(1) = radius_mm * angle_rad.array().sin();
  return out;
}

Eigen::VectorXd without_harmonics(const Numbers& angle_rad, const Numbers& values, int highest) {
  return Harmonics(angle_rad, highest).split(values).left;
}

std::vector<Eigen::VectorXd> lap_differences(const Numbers& angle_rad, const Ordinals& lap, const Numbers& values,
                                             int highest) {
  require_length("lap", lap.size(), angle_rad.size());
  require_length("values", values.size(), angle_rad.size());
  const auto laps = rows_by_number(lap);
  std::vector<Eigen::VectorXd> out;
  if (laps.size() < 2) return out;
  const Eigen::VectorXd left = without_harmonics(angle_rad, values, highest);
  const auto counts = [](const auto& rows) { return static_cast<Eigen::Index>(rows.size()) >= kLeastValues; };
  for (std::size_t later = 1; later < laps.size(); ++later) {
    const auto &first = laps[later - 1], &second = laps[later];
    if (!counts(first) || !counts(second)) continue;
    out.push_back(differences(make_path(angle_rad(first), left(first)), angle_rad(second), left(second)));
  }
  return out;
}

}  // namespace hexdbb
