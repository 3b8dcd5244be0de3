// Rank and condition of matrices with known ones.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <stdexcept>

#include "drawing.hpp"
#include "hexdbb/identifiability.hpp"

namespace hexdbb::testing {
namespace {

RowMajorMatrix random_matrix(Drawing& drawing, int rows, int columns) {
  RowMajorMatrix out(rows, columns);
  for (int i = 0; i < rows; ++i) out.row(i) = drawing.normals(columns).transpose();
  return out;
}

/// Return a matrix of rows x sizes.size() with these singular values and random directions.
RowMajorMatrix with_singular_values(Drawing& drawing, int rows, const Eigen::VectorXd& sizes,
                                    Eigen::MatrixXd& directions) {
  const int count = static_cast<int>(sizes.size());
  const Eigen::HouseholderQR<Eigen::MatrixXd> left(random_matrix(drawing, rows, count));
  const Eigen::HouseholderQR<Eigen::MatrixXd> right(random_matrix(drawing, count, count));
  directions = right.householderQ();
  const Eigen::MatrixXd u = left.householderQ() * Eigen::MatrixXd::Identity(rows, count);
  return u * sizes.asDiagonal() * directions.transpose();
}

TEST(Identifiability, RankConditionAndDirections) {
  Drawing drawing(71);
  Eigen::VectorXd sizes(5);
  sizes << 8.0, 4.0, 2.0, 1e-13, 0.0;
  Eigen::MatrixXd directions;
  const Identifiability found = identifiability(with_singular_values(drawing, 40, sizes, directions), 1e-9, 0.0);
  EXPECT_EQ(found.rank, 3);
  EXPECT_NEAR(found.condition, 4.0, 1e-12);
  EXPECT_LT((found.singular_values - sizes).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_EQ(found.identifiable().cols(), 3);
  EXPECT_EQ(found.unidentifiable().cols(), 2);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(std::abs(found.identifiable().col(j).dot(directions.col(j))), 1.0, 1e-12);
  EXPECT_LT((found.identifiable().transpose() * directions.rightCols(2)).norm(), 1e-12);
}

TEST(Identifiability, AbsoluteLimitCountsToo) {
  const RowMajorMatrix diagonal = Eigen::Vector3d(3.0, 2.0, 1.0).asDiagonal().toDenseMatrix();
  EXPECT_EQ(identifiability(diagonal, 1e-9, 0.0).rank, 3);
  EXPECT_EQ(identifiability(diagonal, 1e-9, 1.5).rank, 2);
  EXPECT_EQ(identifiability(diagonal, 0.9, 0.0).rank, 1);
  EXPECT_EQ(identifiability(diagonal, 1e-9, 1.5).condition, 1.5);
}

TEST(Identifiability, FewerReadingsThanUnknowns) {
  Drawing drawing(72);
  const Identifiability found = identifiability(random_matrix(drawing, 2, 6), 1e-9, 0.0);
  EXPECT_EQ(found.rank, 2);
  EXPECT_EQ(found.directions.rows(), 6);
  EXPECT_EQ(found.unidentifiable().cols(), 4);
}

TEST(Identifiability, NoUnknowns) {
  const Identifiability nothing = identifiability(RowMajorMatrix::Zero(10, 3), 1e-9, 0.0);
  EXPECT_EQ(nothing.rank, 0);
  EXPECT_EQ(nothing.condition, 0.0);
  EXPECT_EQ(nothing.unidentifiable().cols(), 3);
  EXPECT_EQ(identifiability(RowMajorMatrix(10, 0), 1e-9, 0.0).rank, 0);
}

TEST(SchurComplement, IsTheInformationOfTheProjectedJacobian) {
  Drawing drawing(74);
  RowMajorMatrix jacobian = random_matrix(drawing, 30, 9);
  jacobian.col(8) = jacobian.col(6) - 3.0 * jacobian.col(7);  // a redundant nuisance unknown
  const std::vector<Eigen::Index> wanted = {0, 2, 4}, nuisance = {1, 6, 7, 8};
  const Eigen::MatrixXd found = schur_complement(jacobian.transpose() * jacobian, wanted, nuisance);
  const RowMajorMatrix rest = project_out(jacobian(Eigen::all, wanted), jacobian(Eigen::all, nuisance));
  EXPECT_LT((found - rest.transpose() * rest).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_THROW(schur_complement(found, {0, 3}, {}), std::invalid_argument);
  EXPECT_THROW(schur_complement(found, {0}, {-1}), std::invalid_argument);
}

TEST(ProjectOut, RestIsOrthogonalToTheNuisance) {
  Drawing drawing(73);
  const RowMajorMatrix jacobian = random_matrix(drawing, 30, 5);
  RowMajorMatrix nuisance = random_matrix(drawing, 30, 4);
  nuisance.col(3) = 2.0 * nuisance.col(0) - nuisance.col(1);  // dependent columns must do no harm
  const RowMajorMatrix rest = project_out(jacobian, nuisance);
  EXPECT_LT((nuisance.transpose() * rest).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((project_out(rest, nuisance) - rest).cwiseAbs().maxCoeff(), 1e-13);
  // The removed part lies in the nuisance's span.
  EXPECT_LT(project_out(jacobian - rest, nuisance).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(project_out(jacobian, RowMajorMatrix(30, 0)), jacobian);
  EXPECT_THROW(project_out(jacobian, random_matrix(drawing, 29, 4)), std::invalid_argument);
}

}  // namespace
}  // namespace hexdbb::testing
