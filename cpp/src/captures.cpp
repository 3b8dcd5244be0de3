#include "hexdbb/captures.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hexdbb {

namespace {

// Standard deviation of a normal variable over the median of its size.
constexpr double kMedianToSigma = 1.4826;
// Standard deviation of a value minus the mean of its two neighbours, over that of one value: the root of 1 + 1/4 + 1/4.
const double kOfDifference = std::sqrt(1.5);
// The same of a value minus one told by a line through two behind it: the root of 1 + 4 + 1.
const double kOfExtrapolation = std::sqrt(6.0);

// Readings of a capture, needed behind its first one to tell what to expect there (`from_behind`).
constexpr Eigen::Index kFewest = 6;

void require_length(const char* what, Eigen::Index length, Eigen::Index expected) {
  if (length == expected) return;
  throw std::invalid_argument(std::string(what) + " has " + std::to_string(length) + " rows, expected " +
                              std::to_string(expected) + ", one per angle");
}

void require_rows(const std::vector<Rows>& captures, Eigen::Index size) {
  for (const Rows& rows : captures) {
    if (rows.size() > 0 && (rows.minCoeff() < 0 || rows.maxCoeff() >= size)) {
      throw std::invalid_argument("a capture has a row that is not there, expected 0 to " + std::to_string(size - 1));
    }
  }
}

/// Return the median, of an even number the mean of the middle two.
double median(Eigen::VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle : 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

/// Return whether the median angle between readings is at most `most_rad`.
bool is_dense(const Eigen::VectorXd& angle_rad, double most_rad) {
  constexpr double kTurn = 2.0 * M_PI;
  const Eigen::Index gaps = angle_rad.size() - 1;
  Eigen::VectorXd apart = angle_rad.tail(gaps) - angle_rad.head(gaps);
  apart = (apart.array() - kTurn * (apart.array() / kTurn).round()).abs();  // within half a turn of zero
  return apart.maxCoeff() <= most_rad || median(std::move(apart)) <= most_rad;
}

/// Return the median of a value and its neighbours; at the ends, the value there stands for those that are missing.
double median_near(const Eigen::VectorXd& values, Eigen::Index place, int neighbours) {
  Eigen::VectorXd near(2 * neighbours + 1);
  for (int step = -neighbours; step <= neighbours; ++step) {
    near[step + neighbours] = values[std::clamp<Eigen::Index>(place + step, 0, values.size() - 1)];
  }
  return median(std::move(near));
}

/// Return how far each value is from what lines through two behind it tell: the median of the nearest three such lines, so
/// that neither of the two counts for much. `values` has kFewest + 1 rows at least; the last kFewest have none.
Eigen::VectorXd from_behind(const Eigen::VectorXd& values) {
  Eigen::VectorXd out(values.size() - kFewest);
  for (Eigen::Index row = 0; row < out.size(); ++row) {
    const auto behind = [&](int step) { return 2.0 * values[row + step] - values[row + 2 * step]; };
    out[row] = values[row] - median(Eigen::Vector3d(behind(1), behind(2), behind(3)));
  }
  return out;
}

/// Return how far the first of some values is from what those behind tell of it, in standard deviations of that: those of
/// noise, or of what the capture shows, which bends as it does at its end.
double first_off(const Eigen::VectorXd& values, double noise) {
  const Eigen::VectorXd off = from_behind(values);
  return off[0] / std::max(kOfExtrapolation * noise, kMedianToSigma * median(off.cwiseAbs()));
}

}  // namespace

CaptureHarmonics::CaptureHarmonics(const Numbers& angle_rad, std::vector<Rows> captures, int highest)
    : size_(angle_rad.size()), highest_(highest), captures_(std::move(captures)) {
  require_rows(captures_, size_);
  for (const Rows& rows : captures_) harmonics_.emplace_back(angle_rad(rows).eval(), highest);
}

SplitColumn CaptureHarmonics::split(const Numbers& values) const {
  require_length("values", values.size(), size_);
  SplitColumn out{Eigen::MatrixXd(captures_.size(), 1 + 2 * highest_), Eigen::VectorXd::Zero(size_)};
  for (std::size_t each = 0; each < captures_.size(); ++each) {
    const SplitValues parts = harmonics_[each].split(values(captures_[each]).eval());
    out.taken.row(static_cast<Eigen::Index>(each)) = parts.taken;
    out.left(captures_[each]) = parts.left;
  }
  return out;
}

std::vector<Eigen::VectorXd> lap_differences(const Numbers& angle_rad, const Ordinals& lap, const Numbers& values,
                                             const std::vector<Rows>& captures, const std::vector<int>& highest) {
  require_length("lap", lap.size(), angle_rad.size());
  require_length("values", values.size(), angle_rad.size());
  require_rows(captures, angle_rad.size());
  if (highest.size() != captures.size()) throw std::invalid_argument("highest: expected a number for each capture");
  std::vector<Eigen::VectorXd> out;
  for (std::size_t each = 0; each < captures.size(); ++each) {
    const Rows& rows = captures[each];
    for (auto& found : lap_differences(angle_rad(rows).eval(), lap(rows).eval(), values(rows).eval(), highest[each])) {
      out.push_back(std::move(found));
    }
  }
  return out;
}

std::vector<ContourPath> mean_paths(const Numbers& angle_rad, const Numbers& deviation_mm, const Ordinals& turn,
                                    const std::vector<Rows>& captures, double most_gap_rad) {
  require_length("deviation_mm", deviation_mm.size(), angle_rad.size());
  require_length("turn", turn.size(), angle_rad.size());
  require_rows(captures, angle_rad.size());
  std::vector<ContourPath> out;
  for (const Rows& rows : captures) {
    out.push_back(mean_path(angle_rad(rows).eval(), deviation_mm(rows).eval(), turn(rows).eval(), most_gap_rad));
  }
  return out;
}

Neighbours compare_with_neighbours(const Numbers& angle_rad, const Numbers& values, const std::vector<Rows>& captures,
                                   double noise, const NeighbourTest& test) {
  require_length("values", values.size(), angle_rad.size());
  require_rows(captures, angle_rad.size());
  Neighbours out{Eigen::VectorXd::Zero(values.size()), decltype(Neighbours::alone)::Constant(values.size(), false)};
  for (const Rows& rows : captures) {
    const Eigen::Index inside = rows.size() - 2;
    if (rows.size() <= std::max<Eigen::Index>(2 * test.neighbours, kFewest) ||
        !is_dense(angle_rad(rows), test.dense_rad))
      continue;
    const Eigen::VectorXd own = values(rows);
    Eigen::VectorXd apart = Eigen::VectorXd::Zero(rows.size());
    apart.segment(1, inside) = own.segment(1, inside) - 0.5 * (own.head(inside) + own.tail(inside));
    const double usual = std::max(noise, kMedianToSigma * median(apart.cwiseAbs()) / kOfDifference);
    apart /= kOfDifference * usual;
    for (Eigen::Index row = 0; row < rows.size(); ++row) {
      out.off[rows[row]] = apart[row];
      if (!(std::abs(apart[row]) > test.doubtful)) continue;
      out.alone[rows[row]] = std::abs(own[row] - median_near(own, row, test.neighbours)) > test.alone * usual;
    }
    const double ends[] = {first_off(own, usual), first_off(own.reverse(), usual)};
    for (const int last : {0, 1}) {
      const Eigen::Index row = rows[last == 0 ? 0 : inside + 1];
      out.off[row] = ends[last], out.alone[row] = std::abs(ends[last]) > test.alone;
    }
  }
  return out;
}

}  // namespace hexdbb
