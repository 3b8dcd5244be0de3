// What a set of readings can say about a set of unknowns.
//
// The Jacobian of the readings, each column scaled by the size its unknown is expected to have, is factored as U S V'.
// Directions V with a singular value near zero cannot be known: moving along them changes no reading. Columns of the
// identifiable basis are the others, best known first. Scaled unknowns z = value / scale.
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

/// Rank counts singular values above `relative` times the largest and above `absolute`.
Identifiability identifiability(const RowMajorMatrix& scaled_jacobian, double relative, double absolute);

/// The same from J'J alone, for the unknowns `wanted` after all that the unknowns `nuisance` can explain is taken out.
/// Singular values below about 1e-8 of the largest drown in rounding, so `relative` should stay well above.
Identifiability identifiability_of(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& wanted,
                                   const std::vector<Eigen::Index>& nuisance, double relative, double absolute);

/// The part of `jacobian` that `nuisance` columns (unknowns of no interest, such as the cup's position) cannot explain.
RowMajorMatrix project_out(const RowMajorMatrix& jacobian, const RowMajorMatrix& nuisance);

}  // namespace hexdbb
