#include "local_polynomial.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hexdbb {

namespace {

// Of the motion, from the middle of a window to its ends, where a polynomial of degree 6 leaves less than 0.1 um of a
// slider's motion on a circle (harmonics of 91, 11, 1.4, 0.3, 0.1 mm). By it, a delay of 0.23 s at 56 mm/s is predicted
// to 0.1 um, and to 3 um in the last row of a sweep; 0.3 and 0.5 rad are no better, degree 5 is three times as far off.
constexpr double kHalfWindow_rad = 0.4;
constexpr int kTerms = 7;
constexpr double kUsed = 0.75;  // of a window, in its middle: with 0.9, the delay is predicted to 0.8 um only
// How far a polynomial may be from the coordinates that it describes, of their standard deviation: 7 um of a slider on a
// circle of 100 mm. Where a sweep of 16.7 mm/s starts from rest, one over five seconds predicts a delay of 25 ms to 97 um,
// with this it is to 8 um, with 3e-5 to 5 um; but then higher harmonics of some steady circles shorten it as well.
constexpr double kFollows = 1e-4;
// Half of the shortest window: of positions to 0.1 um, a delay of 0.23 s is predicted to 1 to 2 um (root mean square) by
// windows of 0.2 s, to 1 to 27 um by those of 0.1 s.
constexpr double kLeastHalf_s = 0.2;

using Basis = Eigen::Matrix<double, Eigen::Dynamic, kTerms>;  // a row per instant, a column per polynomial
using Coefficients = Eigen::Matrix<double, kTerms, kLegs>;

/// Compute Legendre polynomials at u within -1 to 1, and their derivatives up to order `highest`: nearly orthogonal over
/// a window's rows, so that normal equations are accurate.
std::vector<Basis> legendre(const Eigen::ArrayXd& u, int highest) {
  std::vector<Basis> out(static_cast<std::size_t>(highest) + 1, Basis::Zero(u.size(), kTerms));
  out[0].col(0).setOnes();
  out[0].col(1) = u;
  if (highest > 0) out[1].col(1).setOnes();
  for (std::size_t order = 0; order < out.size(); ++order) {
    for (int n = 1; n + 1 < kTerms; ++n) {
      auto next = out[order].col(n + 1).array();
      next = (2 * n + 1) * u * out[order].col(n).array() - n * out[order].col(n - 1).array();
      if (order > 0) next += (2 * n + 1) * static_cast<double>(order) * out[order - 1].col(n).array();
      next /= n + 1;
    }
  }
  return out;
}

/// Rows from `first` to `last`, both included.
struct Window {
  Eigen::Index first, last;

  Eigen::Index count() const { return last - first + 1; }
};

/// A least-squares polynomial of each coordinate over a window, of lower degree where there are fewer rows.
class Polynomial {
 public:
  Polynomial(const Eigen::VectorXd& time_s, const Track& coordinates, Window window)
      : middle_s_(0.5 * (time_s[window.first] + time_s[window.last])),
        per_s_(2.0 / (time_s[window.last] - time_s[window.first])) {
    const Eigen::Index terms = std::min<Eigen::Index>(window.count(), kTerms);
    const Basis basis = legendre(u(time_s, window), 0).front();
    const Eigen::Matrix<double, Eigen::Dynamic, kLegs> rows = coordinates.middleRows(window.first, window.count());
    Eigen::Matrix<double, kTerms, kTerms> normal;
    Coefficients moment;
    for (Eigen::Index i = 0; i < kTerms; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) normal(i, j) = basis.col(i).dot(basis.col(j));
      for (Eigen::Index k = 0; k < kLegs; ++k) moment(i, k) = basis.col(i).dot(rows.col(k));
    }
    if (terms == kTerms) {
      coefficients_ = normal.ldlt().solve(moment);
    } else {
      coefficients_.topRows(terms) = normal.topLeftCorner(terms, terms).ldlt().solve(moment.topRows(terms));
    }
  }

  /// Set rows of coordinates and of their derivatives, in the order of `out`.
  void fill(const Eigen::VectorXd& time_s, Window rows, std::vector<Track>& out) const {
    const std::vector<Basis> basis = legendre(u(time_s, rows), static_cast<int>(out.size()) - 1);
    double scale = 1.0;
    for (std::size_t order = 0; order < out.size(); ++order, scale *= per_s_) {
      out[order].middleRows(rows.first, rows.count()).noalias() =
          basis[order].lazyProduct(Coefficients(scale * coefficients_));
    }
  }

 private:
  Eigen::ArrayXd u(const Eigen::VectorXd& time_s, Window rows) const {
    return (time_s.segment(rows.first, rows.count()).array() - middle_s_) * per_s_;
  }

  double middle_s_, per_s_;
  Coefficients coefficients_ = Coefficients::Zero();
};

/// Root mean square of coordinates about their means, all six together.
double spread_of(const Track& coordinates) {
  return std::sqrt((coordinates.rowwise() - coordinates.colwise().mean()).rowwise().squaredNorm().mean());
}

/// Half the length of a window: a harmonic's coordinate is its velocity by its angular frequency. Steps of a lap to its
/// twentieth part are as good as velocities for that.
double half_window_s(const Eigen::VectorXd& time_s, const Track& coordinates, double spread) {
  const Eigen::Index steps = time_s.size() - 1;
  const Eigen::ArrayXd squared_step =
      (coordinates.bottomRows(steps) - coordinates.topRows(steps)).rowwise().squaredNorm();
  const Eigen::ArrayXd step_s = time_s.tail(steps) - time_s.head(steps);
  return kHalfWindow_rad * spread / std::sqrt((squared_step / step_s.square()).mean());
}

/// Return the window of a stretch of rows: half_s to either side of its middle, or as much to one side as is lacking on
/// the other.
Window window_about(const Eigen::VectorXd& time_s, Window stretch, double half_s) {
  const Eigen::Index end = time_s.size() - 1;
  const double middle_s = 0.5 * (time_s[stretch.first] + time_s[stretch.last]);
  double from_s = middle_s - half_s, to_s = middle_s + half_s;
  if (from_s < time_s[0]) to_s += time_s[0] - from_s;
  if (to_s > time_s[end]) from_s -= to_s - time_s[end];
  const auto* begin = time_s.data();
  Window out{std::lower_bound(begin, begin + end, from_s) - begin, std::upper_bound(begin, begin + end, to_s) - begin};
  if (out.last > stretch.last && time_s[out.last] > to_s) --out.last;
  while (out.count() < std::min<Eigen::Index>(kTerms, end + 1)) {
    if (out.first > 0) --out.first;
    if (out.last < end && out.count() < kTerms) ++out.last;
  }
  return {std::min(out.first, stretch.first), std::max(out.last, stretch.last)};
}

/// Return the rows that a polynomial is used for, from `first` on.
Window stretch_from(const Eigen::VectorXd& time_s, Eigen::Index first, double half_s) {
  const auto* begin = time_s.data();
  const auto* beyond = std::upper_bound(begin + first, begin + time_s.size(), time_s[first] + 2.0 * kUsed * half_s);
  return {first, std::max<Eigen::Index>(beyond - begin - 1, first)};
}

/// Fill the rows of one stretch, and return the last of them. A stretch is halved until its polynomial follows.
Eigen::Index fill_from(Eigen::Index first, const Eigen::VectorXd& time_s, const Track& coordinates, double half_s,
                       double most_off, std::vector<Track>& out) {
  for (;; half_s /= 2.0) {
    const Window stretch = stretch_from(time_s, first, half_s);
    const Window window = window_about(time_s, stretch, half_s);
    Polynomial(time_s, coordinates, window).fill(time_s, stretch, out);
    const auto off = (coordinates - out.front()).middleRows(stretch.first, stretch.count());
    const bool is_short = half_s < 2.0 * kLeastHalf_s || window.count() <= kTerms;
    if (is_short || off.cwiseAbs().maxCoeff() <= most_off) return stretch.last;
  }
}

}  // namespace

std::vector<Track> local_polynomials(const Eigen::VectorXd& time_s, const Track& coordinates, int highest) {
  const Eigen::Index count = time_s.size();
  std::vector<Track> out(static_cast<std::size_t>(highest) + 1,
                         Track::Constant(count, kLegs, std::numeric_limits<double>::quiet_NaN()));
  if (count < 2) return out;
  const double whole_s = time_s[count - 1] - time_s[0];
  const double spread = spread_of(coordinates), sought_s = half_window_s(time_s, coordinates, spread);
  const bool moves = sought_s < whole_s;  // of a sweep that hardly does, one polynomial describes the whole
  const double half_s = moves ? sought_s : whole_s;
  const double most_off = moves ? kFollows * spread : std::numeric_limits<double>::infinity();
  for (Eigen::Index first = 0; first < count;) {
    first = fill_from(first, time_s, coordinates, half_s, most_off, out) + 1;
  }
  return out;
}

}  // namespace hexdbb
