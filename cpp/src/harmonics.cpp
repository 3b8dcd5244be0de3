#include "hexdbb/harmonics.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "turns.hpp"

namespace hexdbb {

namespace {

// Added to the mean square of a column: the harmonics of a short arc depend on each other to rounding.
constexpr double kRidge = 1e-9;

/// Sums of the cosines and sines of the multiples 0 to 2 highest of the angles; `columns` become the multiples up to the
/// highest.
struct Sums {
  Eigen::VectorXd cosine, sine;

  Sums(const Eigen::Ref<const Eigen::VectorXd>& angle_rad, int highest, Eigen::MatrixXd& columns)
      : cosine(1 + 2 * highest), sine(1 + 2 * highest) {
    Eigen::ArrayXd c(angle_rad.size()), s(angle_rad.size());
    for (Eigen::Index row = 0; row < angle_rad.size(); ++row) {
      const CosSin<double> at = cos_sin_of_turns(angle_rad[row] * (0.5 / M_PI));
      c[row] = at.cosine;
      s[row] = at.sine;
    }
    Eigen::ArrayXd cosines = Eigen::ArrayXd::Ones(angle_rad.size()), sines = Eigen::ArrayXd::Zero(angle_rad.size());
    Eigen::ArrayXd turned(angle_rad.size());
    for (int order = 0; order <= 2 * highest; ++order) {
      if (order > 0) {  // one turn further than the harmonic before
        turned = cosines * c - sines * s;
        sines = sines * c + cosines * s;
        cosines.swap(turned);
      }
      cosine[order] = cosines.sum();
      sine[order] = sines.sum();
      if (order > highest) continue;
      columns.col(order) = cosines;
      if (order > 0) columns.col(highest + order) = sines;
    }
  }

  /// Return the products of the columns, lower triangle.
  Eigen::MatrixXd products(int highest) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(1 + 2 * highest, 1 + 2 * highest);
    for (int one = 0; one <= highest; ++one) {
      for (int other = 0; other <= highest; ++other) {
        const int apart = std::abs(one - other), both = one + other;
        if (other <= one) out(one, other) = 0.5 * (cosine[apart] + cosine[both]);
        if (one == 0) continue;
        if (other > 0 && other <= one) out(highest + one, highest + other) = 0.5 * (cosine[apart] - cosine[both]);
        out(highest + one, other) = 0.5 * (sine[both] + (one < other ? -sine[apart] : sine[apart]));
      }
    }
    return out;
  }
};

}  // namespace

Harmonics::Harmonics(const Eigen::Ref<const Eigen::VectorXd>& angle_rad, int highest) {
  if (highest < 0) throw std::invalid_argument("highest: " + std::to_string(highest) + " (expected 0 or more)");
  columns_.resize(angle_rad.size(), 1 + 2 * highest);
  Eigen::MatrixXd products = Sums(angle_rad, highest, columns_).products(highest);
  products.diagonal().array() += kRidge * static_cast<double>(angle_rad.size());
  factor_.compute(products);
}

SplitValues Harmonics::split(const Eigen::Ref<const Eigen::VectorXd>& values) const {
  if (values.size() != columns_.rows()) {
    throw std::invalid_argument("values has " + std::to_string(values.size()) + " rows, expected " +
                                std::to_string(columns_.rows()) + ", one per angle");
  }
  SplitValues out{factor_.matrixL().solve(columns_.transpose() * values), values};
  out.left.noalias() -= columns_ * factor_.matrixU().solve(out.taken);
  return out;
}

}  // namespace hexdbb
