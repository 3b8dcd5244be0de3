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
void add_affine_times(Eigen::Index rows, const double (&constant)[3], const double (&slope)[3], const double* x,
                      const double* times, Eigen::Index stride, double* out) noexcept {
  const double *one = times, *two = times + stride, *three = two + stride;
  const double c0 = constant[0], c1 = constant[1], c2 = constant[2], s0 = slope[0], s1 = slope[1], s2 = slope[2];
  for (Eigen::Index row = 0; row < rows; ++row) {
    out[row] += (c0 + s0 * x[row]) * one[row] + (c1 + s1 * x[row]) * two[row] + (c2 + s2 * x[row]) * three[row];
  }
}

}  // namespace hexdbb::effects
