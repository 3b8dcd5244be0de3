// Tail probabilities of the distributions that tests of residuals and evidence rest on.
//
// With I the regularized incomplete beta function and Q the upper regularized incomplete gamma function (Abramowitz and
// Stegun 26.6.2, 26.4.2):
//   F with m and n degrees of freedom beyond x      I_{n / (n + m x)}(n / 2, m / 2)
//   chi-square with k degrees of freedom beyond x   Q(k / 2, x / 2)
// Both are Eigen's, after the Cephes library.
#pragma once

namespace hexdbb {

/// Return the probability that F with these degrees of freedom (above 0) exceeds a value; nan where it has none.
double f_tail(double numerator, double denominator, double value);

/// Return the probability that chi-square with these degrees of freedom (above 0) exceeds a value; nan where it has
/// none.
double chi_square_tail(double freedom, double value);

/// Return the logarithm of the probability that a standard normal value lies below a value, however small.
double log_normal_below(double value);

}  // namespace hexdbb
