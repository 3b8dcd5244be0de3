#include "columns.hpp"

#include "multiversion.hpp"

namespace hexdbb::effects {

// Plain loops, which the compiler vectorizes for each processor the functions are compiled for.

HEXDBB_MULTIVERSION
void set_scaled(Eigen::Index rows, double factor, const double* x, double* out) noexcept {
  for (Eigen::Index row = 0; row < rows; ++row) out[row] = factor * x[row];
}

HEXDBB_MULTIVERSION
void add_scaled(Eigen::Index rows, double factor, const double* x, double* out) noexcept {
  for (Eigen::Index row = 0; row < rows; ++row) out[row] += factor * x[row];
}

HEXDBB_MULTIVERSION
void add_affine(Eigen::Index rows, double constant, double slope, const double* x, double* out) noexcept {
  for (Eigen::Index row = 0; row < rows; ++row) out[row] += constant + slope * x[row];
}

HEXDBB_MULTIVERSION
void add_affine_times(Eigen::Index rows, double constant, double slope, const double* x, const double* times,
                      double* out) noexcept {
  for (Eigen::Index row = 0; row < rows; ++row) out[row] += (constant + slope * x[row]) * times[row];
}

}  // namespace hexdbb::effects
