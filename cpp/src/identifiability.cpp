#include "hexdbb/identifiability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <stdexcept>
#include <string>

namespace hexdbb {

namespace {

constexpr double kNuisanceRank = 1e-6;  // as kRedundant of diagnosis.cpp: ratios that J'J still resolves

void count_rank(Identifiability& out, double relative, double absolute) {
  const double limit = std::max(relative * out.singular_values[0], absolute);
  while (out.rank < out.singular_values.size() && out.singular_values[out.rank] > limit) ++out.rank;
  if (out.rank > 0) out.condition = out.singular_values[0] / out.singular_values[out.rank - 1];
}

}  // namespace

Identifiability identifiability(const RowMajorMatrix& scaled_jacobian, double relative, double absolute) {
  Identifiability out;
  const Eigen::Index unknowns = scaled_jacobian.cols();
  if (unknowns == 0 || scaled_jacobian.rows() == 0) return out;
  // The triangular factor has the singular values and directions of the tall matrix, at a fraction of the work.
  const Eigen::Index rows = std::min(scaled_jacobian.rows(), unknowns);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(scaled_jacobian);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(unknowns, unknowns);
  square.topRows(rows) = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(square, Eigen::ComputeFullV);
  out.singular_values = svd.singularValues();
  out.directions = svd.matrixV();
  count_rank(out, relative, absolute);
  return out;
}

Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& wanted,
                                 const std::vector<Eigen::Index>& nuisance) {
  for (const std::vector<Eigen::Index>* indices : {&wanted, &nuisance}) {
    for (const Eigen::Index index : *indices) {
      if (index < 0 || index >= information.rows() || index >= information.cols()) {
        throw std::invalid_argument("unknown " + std::to_string(index) + " does not exist, expected 0 to " +
                                    std::to_string(std::min(information.rows(), information.cols()) - 1));
      }
    }
  }
  Eigen::MatrixXd out = information(wanted, wanted);
  if (nuisance.empty()) return out;
  const Eigen::MatrixXd cross = information(wanted, nuisance);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(information(nuisance, nuisance));
  const double floor = kNuisanceRank * kNuisanceRank * own.eigenvalues().maxCoeff();
  for (Eigen::Index k = 0; k < own.eigenvalues().size(); ++k) {
    if (own.eigenvalues()[k] <= floor) continue;
    const Eigen::VectorXd shared = cross * own.eigenvectors().col(k);
    out -= shared * shared.transpose() / own.eigenvalues()[k];
  }
  return out;
}

Identifiability identifiability_of(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& wanted,
                                   const std::vector<Eigen::Index>& nuisance, double relative, double absolute) {
  Identifiability out;
  if (wanted.empty()) return out;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(schur_complement(information, wanted, nuisance));
  out.singular_values = principal.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
  out.directions = principal.eigenvectors().rowwise().reverse();
  count_rank(out, relative, absolute);
  return out;
}

RowMajorMatrix project_out(const RowMajorMatrix& jacobian, const RowMajorMatrix& nuisance) {
  if (nuisance.cols() != 0 && nuisance.rows() != jacobian.rows()) {
    throw std::invalid_argument("nuisance has " + std::to_string(nuisance.rows()) + " rows, jacobian " +
                                std::to_string(jacobian.rows()) + "; expected the same number");
  }
  if (nuisance.cols() == 0 || jacobian.cols() == 0) return jacobian;
  // Nuisance columns that are linear combinations of the others within a millionth must not remove a direction of
  // rounding.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kNuisanceRank);
  qr.compute(nuisance);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(nuisance.rows(), qr.rank());
  return jacobian - basis * (basis.transpose() * jacobian);
}

}  // namespace hexdbb
