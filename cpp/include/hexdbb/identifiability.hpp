// Identifiability: which combinations of unknowns a set of readings determines.
//
// The Jacobian of the readings, each column scaled by the prior standard deviation of its unknown, is factored as U S
// V'. Directions V with a singular value near zero are the null space: moving along them changes no reading. The others
// are identifiable, best determined first. Scaled unknowns z = value / scale.
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

struct Identifiability {
  Eigen::VectorXd singular_values;  // descending, of the scaled Jacobian
  Eigen::MatrixXd directions;       // columns V, scaled unknowns
  int rank = 0;
  double condition = 0.0;  // largest over smallest singular value of the identifiable directions, 0 where rank is 0

  Eigen::MatrixXd identifiable() const { return directions.leftCols(rank); }
  Eigen::MatrixXd unidentifiable() const { return directions.rightCols(directions.cols() - rank); }
};

/// Factor a scaled Jacobian. The rank counts singular values above `relative` times the largest and above `absolute`.
Identifiability identifiability(const RowMajorMatrix& scaled_jacobian, double relative, double absolute);

/// Return J'J of the unknowns `wanted`, what the unknowns `nuisance` can explain projected out: the Schur complement,
/// with the pseudo-inverse where the nuisance unknowns are redundant. Indices into `information`; std::invalid_argument
/// where one is out of range.
Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& wanted,
                                 const std::vector<Eigen::Index>& nuisance);

/// Compute the same from J'J alone, for the unknowns `wanted`, what the unknowns `nuisance` can explain projected out.
/// Singular values below about 1e-8 of the largest are lost in rounding, so `relative` should stay well above.
Identifiability identifiability_of(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& wanted,
                                   const std::vector<Eigen::Index>& nuisance, double relative, double absolute);

/// Return the part of `jacobian` that `nuisance` columns (unknowns of no interest, such as the cup's position) cannot
/// explain. Throws std::invalid_argument where the numbers of rows differ.
RowMajorMatrix project_out(const RowMajorMatrix& jacobian, const RowMajorMatrix& nuisance);

}  // namespace hexdbb
