// The minimum of a quadratic between bounds, against every set of values that could be held on one.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "posterior.hpp"

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr Eigen::Index kSize = 5;

/// Chi-square's fall along a step.
double fall(const MatrixXd& matrix, const VectorXd& downhill, const VectorXd& step) {
  return step.dot(2.0 * downhill - matrix * step);
}

/// Return the largest fall between bounds, of all sets of values held on the one or the other.
double largest_fall(const MatrixXd& matrix, const VectorXd& downhill, const VectorXd& lower, const VectorXd& upper) {
  double out = -std::numeric_limits<double>::infinity();
  for (int set = 0, sets = static_cast<int>(std::pow(3, kSize)); set < sets; ++set) {
    MatrixXd free = matrix;
    VectorXd right = downhill;
    for (Eigen::Index j = 0, digits = set; j < kSize; ++j, digits /= 3) {
      if (digits % 3 == 0) continue;
      free.row(j).setZero();
      free(j, j) = 1.0;
      right[j] = digits % 3 == 1 ? lower[j] : upper[j];
    }
    const VectorXd step = free.partialPivLu().solve(right);
    const bool is_between =
        (step.array() >= lower.array() - 1e-12).all() && (step.array() <= upper.array() + 1e-12).all();
    if (is_between) out = std::max(out, fall(matrix, downhill, step));
  }
  return out;
}

/// Two values undo each other but for a part of the matrix.
MatrixXd matrix_of(std::mt19937& random, double part) {
  std::normal_distribution<double> normal;
  MatrixXd columns = MatrixXd::NullaryExpr(2 * kSize, kSize, [&] { return normal(random); });
  columns.col(1) = columns.col(0) + part * columns.col(1);
  return columns.transpose() * columns;
}

class BoundedStepTest : public testing::TestWithParam<double> {};

TEST_P(BoundedStepTest, ReachesTheMinimumBetweenBounds) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const MatrixXd matrix = matrix_of(random, GetParam());
    const VectorXd downhill = VectorXd::NullaryExpr(kSize, [&] { return 10.0 * normal(random); });
    const VectorXd z = VectorXd::NullaryExpr(kSize, [&] { return std::tanh(normal(random)); });
    const VectorXd bound = VectorXd::Ones(kSize);
    const hexdbb::BoundedStep step(matrix, downhill, z, -bound, bound);
    const double expected = largest_fall(matrix, downhill, -bound - z, bound - z);
    EXPECT_NEAR(step.predicted_fall(), expected, 1e-8 * expected);
    EXPECT_TRUE(((z + step.step()).cwiseAbs().array() <= 1.0 + 1e-12).all());
    const auto cautious = hexdbb::BoundedStep::cautious(matrix, downhill, z, bound);
    EXPECT_LE(cautious.predicted_fall(), expected * (1.0 + 1e-8));
    EXPECT_TRUE(((z + cautious.step()).cwiseAbs().array() <= 1.0 + 1e-12).all());
  }
}

INSTANTIATE_TEST_SUITE_P(ValuesThatUndoEachOther, BoundedStepTest, testing::Values(1.0, 1e-2, 1e-4));

TEST(BoundedStep, IsThatOfNewtonWhereNoBoundIsNear) {
  std::mt19937 random(8);
  const MatrixXd matrix = matrix_of(random, 1.0);
  const VectorXd downhill = VectorXd::LinSpaced(kSize, -1.0, 1.0), bound = VectorXd::Constant(kSize, 1e3);
  const hexdbb::BoundedStep step(matrix, downhill, VectorXd::Zero(kSize), -bound, bound);
  EXPECT_LT((step.step() - matrix.llt().solve(downhill)).norm(), 1e-12);
  const auto cautious = hexdbb::BoundedStep::cautious(matrix, downhill, VectorXd::Zero(kSize), bound);
  EXPECT_LT((cautious.step() - step.step()).norm(), 1e-12);
}

TEST(BoundedStep, LeavesAloneWhatMayNotMove) {
  std::mt19937 random(9);
  const MatrixXd matrix = matrix_of(random, 1.0);
  const VectorXd z = VectorXd::LinSpaced(kSize, -0.5, 0.5), downhill = VectorXd::Ones(kSize);
  VectorXd lower = VectorXd::Constant(kSize, -1.0), upper = -lower;
  lower[2] = upper[2] = z[2];
  const hexdbb::BoundedStep step(matrix, downhill, z, lower, upper);
  EXPECT_EQ(step.step()[2], 0.0);
  EXPECT_EQ(step.solve(downhill)[2], 0.0);
  EXPECT_GT(step.predicted_fall(), 0.0);
}

}  // namespace
