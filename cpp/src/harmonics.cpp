#include "hexdbb/harmonics.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

namespace hexdbb {

namespace {

// Added to the mean square of a column: the harmonics of a short arc depend on each other to rounding.
constexpr double kRidge = 1e-9;

}  // namespace

Eigen::MatrixXd orthonormal_harmonics(const Eigen::Ref<const Eigen::VectorXd>& angle_rad, int highest) {
  if (highest < 0) throw std::invalid_argument("highest: " + std::to_string(highest) + " (expected 0 or more)");
  const Eigen::Index rows = angle_rad.size();
  Eigen::MatrixXd basis(rows, 1 + 2 * highest);
  basis.col(0).setOnes();
  const Eigen::ArrayXd c = angle_rad.array().cos(), s = angle_rad.array().sin();
  for (int order = 1; order <= highest; ++order) {
    auto cosine = basis.col(order).array(), sine = basis.col(highest + order).array();
    if (order == 1) {
      cosine = c;
      sine = s;
    } else {  // one turn further than the harmonic before
      const auto cosine_before = basis.col(order - 1).array(), sine_before = basis.col(highest + order - 1).array();
      cosine = cosine_before * c - sine_before * s;
      sine = sine_before * c + cosine_before * s;
    }
  }
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(basis.cols(), basis.cols());
  products.selfadjointView<Eigen::Lower>().rankUpdate(basis.transpose());
  products.diagonal().array() += kRidge * static_cast<double>(rows);
  const Eigen::LLT<Eigen::MatrixXd> factor(products);
  factor.matrixU().solveInPlace<Eigen::OnTheRight>(basis);
  return basis;
}

}  // namespace hexdbb
