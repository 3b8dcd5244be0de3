// Arithmetic on columns of a block, row by row.
#pragma once

#include <Eigen/Core>

namespace hexdbb::effects {

/// Set out = factor x.
void set_scaled(Eigen::Index rows, double factor, const double* x, double* out) noexcept;

/// Add factor x.
void add_scaled(Eigen::Index rows, double factor, const double* x, double* out) noexcept;

/// Add constant + slope x.
void add_affine(Eigen::Index rows, double constant, double slope, const double* x, double* out) noexcept;

/// Add (constant + slope x) times.
void add_affine_times(Eigen::Index rows, double constant, double slope, const double* x, const double* times,
                      double* out) noexcept;

}  // namespace hexdbb::effects
