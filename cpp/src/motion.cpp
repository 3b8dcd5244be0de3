// Derivatives by local polynomials; reversals by a dead band on smoothed positions.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "hexdbb/run_up.hpp"
#include "hexdbb/state.hpp"
#include "local_polynomial.hpp"
#include "sampling_times.hpp"

namespace hexdbb {

namespace {

using Rows = std::vector<Eigen::Index>;

constexpr double kHalfWindow_s = 0.05;  // see state.hpp
// Neighbours on either side: two determine a parabola and one degree of freedom; 64 bound the work at high rates.
constexpr Eigen::Index kFewest = 2, kMost = 64;
constexpr Eigen::Index kFewestRows = 2 * kFewest + 1;

/// Return the rows of each sweep, in order.
std::vector<Rows> rows_by_sweep(const Eigen::VectorXi& sweep) {
  std::map<int, std::size_t> place;
  std::vector<Rows> out;
  for (Eigen::Index row = 0; row < sweep.size(); ++row) {
    const auto [at, is_new] = place.try_emplace(sweep[row], out.size());
    if (is_new) out.emplace_back();
    out[at->second].push_back(row);
  }
  return out;
}

/// Six smoothed coordinates in one sweep; derivatives by time, the first in front.
struct Smooth {
  Eigen::VectorXd time_s;
  Track place_mm;
  std::vector<Track> derivative;

  const Track& velocity_mm_s() const { return derivative.front(); }
};

/// Return the first and last row of the window about `row`; at the ends of a sweep it extends further to the other
/// side.
std::pair<Eigen::Index, Eigen::Index> window(const Eigen::VectorXd& time_s, Eigen::Index row) {
  const Eigen::Index end = time_s.size() - 1;
  const auto reaches = [&](Eigen::Index other) { return std::abs(time_s[other] - time_s[row]) <= kHalfWindow_s; };
  Eigen::Index first = std::max<Eigen::Index>(row - kFewest, 0), last = std::min(row + kFewest, end);
  while (first > 0 && row - first < kMost && reaches(first - 1)) --first;
  while (last < end && last - row < kMost && reaches(last + 1)) ++last;
  while (first > 0 && last - first + 1 < kFewestRows) --first;
  while (last < end && last - first + 1 < kFewestRows) ++last;
  return {first, last};
}

/// Weights of the rows of a window; its maximum size is fixed, so that nothing is allocated.
using Weights = Eigen::Array<double, Eigen::Dynamic, 1, 0, 2 * kMost + 1, 1>;

/// Compute the rows of the inverse normal matrix for value and slope at u = 0 of the polynomial of degree `degree` in
/// u. Of a parabola only: slopes of so few rows are not used.
std::array<Vector3, 2> value_and_slope(const std::array<double, 5>& moment, int degree) {
  std::array<Vector3, 2> out = {Vector3::Zero(), Vector3::Zero()};
  const auto& s = moment;
  if (degree == 2) {
    const double c00 = s[2] * s[4] - s[3] * s[3], c01 = s[2] * s[3] - s[1] * s[4], c02 = s[1] * s[3] - s[2] * s[2];
    const double c11 = s[0] * s[4] - s[2] * s[2], c12 = s[1] * s[2] - s[0] * s[3];
    const double determinant = s[0] * c00 + s[1] * c01 + s[2] * c02;
    out = {Vector3(c00, c01, c02) / determinant, Vector3(c01, c11, c12) / determinant};
  } else if (degree == 1) {
    const double determinant = s[0] * s[2] - s[1] * s[1];
    out[0] = Vector3(s[2], -s[1], 0.0) / determinant;
  } else {
    out[0] = Vector3(1.0, 0.0, 0.0);
  }
  return out;
}

/// Weights for the value and the slope in one row, of the rows from `first` on.
struct Stencil {
  Eigen::Index first;
  Weights value, slope;
};

/// Compute the stencil of the least-squares parabola through a window.
Stencil stencil(const Eigen::VectorXd& time_s, Eigen::Index row) {
  const auto [first, last] = window(time_s, row);
  const Eigen::Index count = last - first + 1;
  const double half_s = std::max(time_s[last] - time_s[row], time_s[row] - time_s[first]);
  const double per_s = half_s > 0.0 ? 1.0 / half_s : 1.0;
  const Weights u = (time_s.segment(first, count).array() - time_s[row]) * per_s;
  std::array<double, 5> moment = {static_cast<double>(count), 0.0, 0.0, 0.0, 0.0};
  for (Eigen::Index at = 0; at < count; ++at) {
    double power = u[at];
    for (int order = 1; order < 5; ++order, power *= u[at]) moment[order] += power;
  }
  const auto [value, slope] = value_and_slope(moment, static_cast<int>(std::min<Eigen::Index>(last - first, 2)));
  return {first, value[0] + u * (value[1] + u * value[2]), per_s * (slope[0] + u * (slope[1] + u * slope[2]))};
}

/// The stencils of all rows of a sweep, one after another: windows are mostly short, and a sweep may be long.
class Stencils {
 public:
  explicit Stencils(const Eigen::VectorXd& time_s) {
    begin_.push_back(0);
    for (Eigen::Index row = 0; row < time_s.size(); ++row) {
      const Stencil each = stencil(time_s, row);
      first_.push_back(each.first);
      value_.insert(value_.end(), each.value.data(), each.value.data() + each.value.size());
      slope_.insert(slope_.end(), each.slope.data(), each.slope.data() + each.slope.size());
      begin_.push_back(value_.size());
    }
  }

  Track values(const Track& of) const {
    Track out = Track::Zero(of.rows(), kLegs);
    for (std::size_t row = 0; row < first_.size(); ++row) apply(value_, row, of, out);
    return out;
  }

  /// Add slopes, but where sampling is so slow that a window has the minimum number of rows.
  void add_slopes(const Track& of, Track& to) const {
    for (std::size_t row = 0; row < first_.size(); ++row) {
      if (begin_[row + 1] - begin_[row] > kFewestRows) apply(slope_, row, of, to);
    }
  }

 private:
  void apply(const std::vector<double>& weights, std::size_t row, const Track& of, Track& to) const {
    auto sum = to.row(static_cast<Eigen::Index>(row));
    for (std::size_t at = begin_[row]; at < begin_[row + 1]; ++at) {
      sum += weights[at] * of.row(first_[row] + static_cast<Eigen::Index>(at - begin_[row]));
    }
  }

  std::vector<Eigen::Index> first_;  // row of each stencil's first weight
  std::vector<std::size_t> begin_;   // of each stencil's weights, and their end
  std::vector<double> value_, slope_;
};

/// The velocity is that of the longer polynomial, which a parabola alone would flatten (by 0.1 % at 8 Hz on a circle of
/// 20 s), and of the parabola over what the polynomial leaves, unless sampling is so slow that this is noise.
Smooth smooth(const Eigen::VectorXd& time_s, const Stencils& stencils, const Track& raw_mm, int derivatives) {
  std::vector<Track> longer = local_polynomials(time_s, raw_mm, derivatives);
  stencils.add_slopes(raw_mm - longer.front(), longer[1]);
  longer.erase(longer.begin());
  return {time_s, stencils.values(raw_mm), std::move(longer)};
}

/// A reversal of a slider.
struct Turn {
  double time_s, place_mm;
};

/// Compute the turning point near row `extreme`, between rows: the zero of the velocity, assumed linear between two
/// rows, and the vertex of the corresponding parabola.
Turn turn_near(const Smooth& track, int k, Eigen::Index extreme, double direction) {
  const auto velocity = [&](Eigen::Index row) { return direction * track.velocity_mm_s()(row, k); };
  const Eigen::Index end = track.time_s.size() - 1;
  Eigen::Index before = extreme;
  if (velocity(extreme) <= 0.0 && extreme > 0) --before;
  if (before < end && velocity(before) > 0.0 && velocity(before + 1) <= 0.0) {
    const double step_s = track.time_s[before + 1] - track.time_s[before];
    const double ahead_s = step_s * velocity(before) / (velocity(before) - velocity(before + 1));
    return {track.time_s[before] + ahead_s,
            track.place_mm(before, k) + 0.5 * ahead_s * track.velocity_mm_s()(before, k)};
  }
  return {track.time_s[extreme], track.place_mm(extreme, k)};
}

/// Turning points of slider k and its first direction of travel; 0 where it never moves.
struct Turns {
  double first_direction = 0.0;
  std::vector<Turn> at;
};

Turns turns_of(const Smooth& track, int k) {
  Turns out;
  const auto place = track.place_mm.col(k);
  double direction = 0.0, low = place[0], high = place[0];
  Eigen::Index extreme = 0;
  for (Eigen::Index row = 1; row < place.size(); ++row) {
    if (direction == 0.0) {
      low = std::min(low, place[row]);
      high = std::max(high, place[row]);
      if (high - low <= kReversal_mm) continue;
      direction = out.first_direction = place[row] > low + kReversal_mm ? 1.0 : -1.0;
      extreme = row;
    } else if (direction * (place[row] - place[extreme]) > 0.0) {
      extreme = row;
    } else if (direction * (place[extreme] - place[row]) > kReversal_mm) {
      out.at.push_back(turn_near(track, k, extreme, direction));
      direction = -direction;
      extreme = row;
    }
  }
  return out;
}

/// Return a sweep's track behind that of its run-up; of the derivatives the velocity alone.
Smooth with_run_up(const Smooth& track, const RunUp& up) {
  const auto joined = [&](const Track& of) {
    Track out(up.size() + of.rows(), kLegs);
    out << of.middleRows(up.first, up.size()), of;
    return out;
  };
  Eigen::VectorXd time_s(up.size() + track.time_s.size());
  time_s << track.time_s.segment(up.first, up.size()).array() - up.lap_s, track.time_s;
  return {time_s, joined(track.place_mm), {joined(track.velocity_mm_s())}};
}

void fill_reversals(const Smooth& track, const Turns& turns, const Rows& rows, int k, Motion& out) {
  double direction = turns.first_direction;
  std::size_t passed = 0;
  for (Eigen::Index at = 0; at < track.time_s.size(); ++at) {
    const Eigen::Index row = rows[static_cast<std::size_t>(at)];
    while (passed < turns.at.size() && track.time_s[at] > turns.at[passed].time_s) {
      direction = -direction;
      ++passed;
    }
    out.travel_direction(row, k) = direction;
    if (passed > 0) {
      const Turn& last = turns.at[passed - 1];
      out.since_reversal_s(row, k) = track.time_s[at] - last.time_s;
      out.since_reversal_mm(row, k) = std::max(direction * (track.place_mm(at, k) - last.place_mm), 0.0);
    }
  }
}

constexpr SliderTable Motion::* kDerivatives[kMostDerivatives] = {&Motion::velocity_mm_s, &Motion::acceleration_mm_s2,
                                                                  &Motion::jerk_mm_s3, &Motion::snap_mm_s4};

Motion unfilled(Eigen::Index count, int derivatives) {
  Motion out;
  for (int order = 0; order < derivatives; ++order) (out.*kDerivatives[order]).resize(count, kLegs);
  out.travel_direction.resize(count, kLegs);
  out.since_reversal_s.setConstant(count, kLegs, kLongAgo);
  out.since_reversal_mm.setConstant(count, kLegs, kLongAgo);
  return out;
}

}  // namespace

std::vector<Motion> motions(const Eigen::VectorXd& time_s, const Eigen::VectorXi& sweep,
                            const Eigen::VectorXd& angle_rad, const std::vector<Coordinates>& coordinates) {
  std::vector<Motion> out;
  for (const Coordinates& each : coordinates) out.push_back(unfilled(each.table.rows(), each.derivatives));
  for (const Rows& rows : rows_by_sweep(sweep)) {
    for (std::size_t at = 1; at < rows.size(); ++at) {
      if (!(time_s[rows[at]] > time_s[rows[at - 1]])) {
        throw std::invalid_argument("time_s[" + std::to_string(rows[at]) + "] is not after the sample before it");
      }
    }
    const Eigen::VectorXd times_s = without_rounding(time_s(rows));
    const Stencils stencils(times_s);
    const RunUp up = angle_rad.size() > 0 ? run_up(times_s, angle_rad(rows)) : RunUp();
    for (std::size_t which = 0; which < coordinates.size(); ++which) {
      const Coordinates& each = coordinates[which];
      const Smooth track = smooth(times_s, stencils, each.table(rows, Eigen::all), each.derivatives);
      for (int order = 0; order < each.derivatives; ++order) {
        (out[which].*kDerivatives[order])(rows, Eigen::all) = track.derivative[static_cast<std::size_t>(order)];
      }
      const std::optional<Smooth> longer = up.size() > 0 ? std::optional(with_run_up(track, up)) : std::nullopt;
      for (int k = 0; k < kLegs; ++k) fill_reversals(track, turns_of(longer ? *longer : track, k), rows, k, out[which]);
    }
  }
  return out;
}

Motion motion(const Eigen::VectorXd& time_s, const Eigen::VectorXi& sweep, const SliderTable& sliders_mm) {
  return std::move(motions(time_s, sweep, Eigen::VectorXd(), {{sliders_mm, kMostDerivatives}}).front());
}

}  // namespace hexdbb
