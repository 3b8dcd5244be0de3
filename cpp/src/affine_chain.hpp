// Chain rule of affine pushes over rows of samples.
#pragma once

#include <Eigen/Core>

#include "hexdbb/affine_push.hpp"

namespace hexdbb {

/// Columns of consecutive rows of samples, `stride` numbers from one column to the next.
template <class Number>
struct Columns {
  Number* data;
  Eigen::Index stride;

  Number* column(Eigen::Index at) const noexcept { return data + at * stride; }
};

/// Set derivatives of readings by values, a column of `derivative` per value: sums over the rates of a value of
/// (constant + slope s) times the sensitivity at its port. A value without rates gets zeros.
void chain_affine(const std::vector<AffineRate>& rates, Eigen::Index rows, Columns<const double> sliders_mm,
                  Columns<const double> sensitivity, Eigen::Index values, Columns<double> derivative) noexcept;

}  // namespace hexdbb
