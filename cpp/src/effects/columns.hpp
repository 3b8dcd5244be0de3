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

/// Add the scalar product of constant + slope x and times, vectors of three: `times` are three columns, `stride` numbers
/// from one to the next.
void add_affine_times(Eigen::Index rows, const double (&constant)[3], const double (&slope)[3], const double* x,
                      const double* times, Eigen::Index stride, double* out) noexcept;

}  // namespace hexdbb::effects
