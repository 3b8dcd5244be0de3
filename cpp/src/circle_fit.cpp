#include "hexdbb/circle_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hexdbb {

namespace {

// Step or promised gain, as part of the radius, at which repetitions end: 0.1 pm of 100 mm, some times the rounding.
constexpr double kRelativeTolerance = 1e-12;
constexpr int kMostRepetitions = 50;     // paths of a ball bar need two or three
constexpr double kZeroWeight = 1e-13;    // weights and pivots below are rounding of zero: columns are of unit size
constexpr double kRounded = 1e-9;        // of the width, below any digit shown: steps that go round may end there
constexpr double kOneLine = 1e-9;        // ratio of the points' two spreads below which they lie on one line
constexpr double kSameAngle_rad = 1e-9;  // directions that differ by less are one

using Points = Eigen::Ref<const PlanePoints>;
using Column = Eigen::VectorXd;

/// Distances from a centre, and unit directions.
struct Polar {
  Column rho;
  PlanePoints direction;

  Polar(const Points& points, const Eigen::Vector2d& centre) : direction(points.rowwise() - centre.transpose()) {
    rho = direction.rowwise().norm();
    direction.array().colwise() /= rho.array();
  }

  double width() const { return rho.maxCoeff() - rho.minCoeff(); }
};

void require_plane(const PlanePoints& centred) {
  if (centred.rows() < 3) {
    throw std::invalid_argument("a circle needs at least 3 points, got " + std::to_string(centred.rows()));
  }
  // The triangular factor has the singular values of the points.
  const Eigen::HouseholderQR<PlanePoints> qr(centred);
  const Eigen::Matrix2d factor = qr.matrixQR().topRows<2>().triangularView<Eigen::Upper>();
  const Eigen::Vector2d spread = Eigen::JacobiSVD<Eigen::Matrix2d>(factor).singularValues();
  if (!(spread[1] > kOneLine * spread[0])) {
    throw std::invalid_argument("a circle cannot be fitted: all points lie on one line");
  }
}

/// Compute the slopes of the plane through values at places, least squares. By normal equations: a circle's places are
/// nearly orthogonal columns, and on a short arc what they round is repaired by the next repetition.
Eigen::Vector2d plane(const PlanePoints& places, const Column& values) {
  const PlanePoints centred = places.rowwise() - places.colwise().mean();
  const Column off = values.array() - values.mean();
  return (centred.transpose() * centred).eval().partialPivLu().solve(centred.transpose() * off);
}

/// Numbers of the four columns of the dual that are the basis: i for point i that touches the outer circle, n + i for
/// point i that touches the inner one.
using Contacts = std::array<Eigen::Index, 4>;

/// The linear programme about one centre. Dual: max sum l_i rho_i - sum m_i rho_i with sum l = sum m = 1,
/// sum l_i u_i = sum m_i u_i, all >= 0.
class LinearZone {
 public:
  explicit LinearZone(const Polar& polar)
      : direction_(polar.direction), rho_(polar.rho.array() - polar.rho.mean()), count_(rho_.size()) {
    tolerance_ = 1e-12 * polar.width() + 1e-15 * polar.rho.maxCoeff();
    rounded_ = std::max(tolerance_, kRounded * polar.width());
  }

  Eigen::Vector2d step() const { return multipliers_.tail<2>(); }
  double promised() const { return multipliers_[0] + multipliers_[1]; }
  const Contacts& contacts() const { return basis_; }

  /// Solve, beginning at the contacts of a centre near this one where they still touch from both sides. Contacts of
  /// nearly one angle round so that steps may come back to where they were: the best of these serve.
  void solve(const std::optional<Contacts>& near) {
    double least = std::numeric_limits<double>::infinity();
    Contacts best{};
    Eigen::RowVector4d at_best = Eigen::RowVector4d::Zero();
    basis_ = near && is_balanced(*near) ? *near : first_basis();
    for (Eigen::Index left = 100 + 2 * count_; left > 0; --left) {
      const Eigen::Matrix4d inverse = columns_of(basis_).inverse();
      Eigen::RowVector4d gain;
      for (int k = 0; k < 4; ++k) gain[k] = gain_of(basis_[k]);
      multipliers_ = gain * inverse;
      const auto [entering, violation] = worst();
      if (violation <= tolerance_) return;
      if (violation < least) {
        least = violation;
        best = basis_;
        at_best = multipliers_;
      }
      basis_[leaving(inverse, inverse * column(entering))] = entering;
    }
    if (!(least <= rounded_)) {
      throw std::runtime_error("the minimum zone of " + std::to_string(count_) +
                               " points was not found within the iteration limit");
    }
    basis_ = best;
    multipliers_ = at_best;
  }

 private:
  Eigen::Vector4d column(Eigen::Index i) const {
    if (i < count_) return {1.0, 0.0, direction_(i, 0), direction_(i, 1)};
    return {0.0, 1.0, -direction_(i - count_, 0), -direction_(i - count_, 1)};
  }

  double gain_of(Eigen::Index i) const { return i < count_ ? rho_[i] : -rho_[i - count_]; }

  Eigen::Matrix4d columns_of(const Contacts& basis) const {
    Eigen::Matrix4d out;
    for (int k = 0; k < 4; ++k) out.col(k) = column(basis[k]);
    return out;
  }

  /// Check whether four contacts have weights above zero: a basis to begin from.
  bool is_balanced(const Contacts& contacts) const {
    const Eigen::Vector4d weights = columns_of(contacts).partialPivLu().solve(Eigen::Vector4d(1.0, 1.0, 0.0, 0.0));
    return (weights.array() > kZeroWeight).all();
  }

  /// Return the column that violates the dual's prices most, and by how much.
  std::pair<Eigen::Index, double> worst() const {
    const Column off = rho_ - direction_ * multipliers_.tail<2>().transpose();
    Eigen::Index outer = 0, inner = 0;
    const double above = off.maxCoeff(&outer) - multipliers_[0];
    const double below = -off.minCoeff(&inner) - multipliers_[1];
    return above >= below ? std::pair{outer, above} : std::pair{count_ + inner, below};
  }

  /// Return the row of the basis that reaches zero first; ties (two points at one angle) go by the lexicographic rule.
  /// `change` holds the basic weights per unit of the entering one.
  static std::size_t leaving(const Eigen::Matrix4d& inverse, const Eigen::Vector4d& change) {
    std::size_t out = 0;
    std::array<double, 5> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (int row = 0; row < 4; ++row) {
      if (!(change[row] > kZeroWeight)) continue;
      const double weight = inverse(row, 0) + inverse(row, 1);
      std::array<double, 5> ratios = {std::abs(weight) < kZeroWeight ? 0.0 : weight / change[row]};
      for (int k = 0; k < 4; ++k) ratios[k + 1] = inverse(row, k) / change[row];
      if (ratios < least) {
        least = ratios;
        out = static_cast<std::size_t>(row);
      }
    }
    return out;
  }

  /// Return four contacts a quarter of the points apart, outer and inner in turn, so that the two chords cross.
  Contacts first_basis() const {
    std::vector<std::pair<double, Eigen::Index>> angles;
    for (Eigen::Index i = 0; i < count_; ++i) {
      const double angle_rad = std::atan2(direction_(i, 1), direction_(i, 0));
      angles.emplace_back(std::rint(angle_rad / kSameAngle_rad), i);
    }
    std::sort(angles.begin(), angles.end());
    const auto is_same = [](const auto& one, const auto& other) { return one.first == other.first; };
    angles.erase(std::unique(angles.begin(), angles.end(), is_same), angles.end());
    if (angles.size() < 4) {
      throw std::invalid_argument("a minimum zone needs points at 4 angles or more, got " +
                                  std::to_string(angles.size()));
    }
    Contacts out;
    for (std::size_t k = 0; k < 4; ++k) out[k] = angles[k * angles.size() / 4].second + (k % 2 == 1 ? count_ : 0);
    return out;
  }

  const PlanePoints& direction_;
  Column rho_;
  Eigen::Index count_;
  double tolerance_ = 0.0, rounded_ = 0.0;
  Contacts basis_ = {};
  Eigen::RowVector4d multipliers_ = Eigen::RowVector4d::Zero();  // prices: Ro, -Ri, then the step
};

}  // namespace

FittedCircle least_squares_circle(const Points& points_mm) {
  const Eigen::Vector2d origin = points_mm.colwise().mean().transpose();
  const PlanePoints centred = points_mm.rowwise() - origin.transpose();
  require_plane(centred);
  Eigen::Vector2d centre = 0.5 * plane(centred, centred.rowwise().squaredNorm());
  for (int repetition = 0; repetition < kMostRepetitions; ++repetition) {
    const Polar polar(centred, centre);
    const Eigen::Vector2d step = plane(polar.direction, polar.rho);
    centre += step;
    if (step.norm() <= kRelativeTolerance * polar.rho.mean()) break;
  }
  return {centre + origin, Polar(centred, centre).rho.mean()};
}

Zone minimum_zone(const Points& points_mm) {
  Eigen::Vector2d centre = least_squares_circle(points_mm).centre_mm;
  Polar polar(points_mm, centre);
  const double tolerance_mm = kRelativeTolerance * polar.rho.mean();
  std::optional<Contacts> contacts;
  for (int repetition = 0; repetition < kMostRepetitions; ++repetition) {
    LinearZone zone(polar);
    zone.solve(contacts);
    contacts = zone.contacts();
    Eigen::Vector2d step = zone.step();
    double promised_mm = zone.promised();
    const double width_mm = polar.width();
    Polar candidate(points_mm, centre + step);
    while (!(candidate.width() < width_mm) && width_mm - promised_mm > tolerance_mm) {
      step /= 2.0;
      promised_mm = (promised_mm + width_mm) / 2.0;
      candidate = Polar(points_mm, centre + step);
    }
    if (width_mm - promised_mm <= tolerance_mm) break;
    centre += step;
    polar = std::move(candidate);
  }
  return {centre, polar.rho.minCoeff(), polar.rho.maxCoeff()};
}

}  // namespace hexdbb
