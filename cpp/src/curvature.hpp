// Covariance of a fit beyond first order.
#pragma once

#include "posterior.hpp"

namespace hexdbb {

/// Contribution of the readings' curvature along weakly determined directions to the covariance of the others.
///
/// Along a direction that no reading determines to first order (the cup's height under horizontal circles: its square
/// shortens the bar) the truth may be a whole prior standard deviation away, and its second-order effect on the
/// readings is attributed to other values. With steps s_k of one standard deviation along the weak directions,
///   reading(x + sum t_k s_k) = ... + sum h_kl t_k t_l,   t standard normal;
/// the estimate is off by P sum h_kl t_k t_l, P = C J' / noise^2, whose second moment is
///   m m' + 2 sum p_kl p_kl',   p_kl = P h_kl,   m = sum p_kk.
/// Evenly spaced rows suffice: h is smooth along a circle. Learned functions bend no readings: their values only follow
/// the others.
/// `solved` has passed over the samples; `spread` is the covariance of the scaled unknowns to first order.
Eigen::MatrixXd spread_of_curvature(const Model& model, const Samples& samples, const Accumulator& solved,
                                    const Unknowns& unknowns, const Eigen::MatrixXd& spread, double noise_mm);

}  // namespace hexdbb
