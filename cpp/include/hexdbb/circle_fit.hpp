// Circles fitted to a nearly circular plane path: least squares and minimum zone.
//
// Points P_i of a closed path whose radial deviation is small against its radius (a ball bar's path: tens of micrometres
// on 100 mm); rho_i(c) = |P_i - c|.
//   least squares   min over c, R of sum (rho_i(c) - R)^2 (geometric, not algebraic), by Gauss-Newton from the algebraic
//                   fit of Kasa
//   minimum zone    min over c of max rho_i(c) - min rho_i(c): the two concentric circles of smallest radial separation
//                   that enclose the path
//
// The minimum zone is solved exactly, not by sampling centres. Linearised about a centre, with unit directions u_i, it is
// the linear programme min Ro - Ri subject to Ri <= rho_i - u_i . s <= Ro in the step s. Its dual has four equality
// constraints, so the revised simplex method on the dual keeps four contact points and exchanges one at a time for the
// point that violates the zone most; this is the exchange algorithm of Remez, without its difficulty where several points
// share one angle. The centre moves by s and the programme is repeated with the exact radii until it promises less than
// 1e-12 of the radius. rho_i - rho_j is linear in c up to |s|^2 / R, so two or three repetitions are enough and the local
// minimum is the global one for any path this is meant for.
#pragma once

#include <Eigen/Core>

namespace hexdbb {

using PlanePoints = Eigen::Matrix<double, Eigen::Dynamic, 2>;

struct FittedCircle {
  Eigen::Vector2d centre_mm;
  double radius_mm;
};

struct Zone {
  Eigen::Vector2d centre_mm;
  double inner_mm, outer_mm;
};

/// Fit the circle with the smallest sum of squared radial distances to the points. Throws std::invalid_argument for fewer
/// than three points, or all on one line.
FittedCircle least_squares_circle(const Eigen::Ref<const PlanePoints>& points_mm);

/// Find the two concentric circles of smallest radial separation that enclose the points. Throws std::invalid_argument
/// for fewer than four points at different angles, or all on one line; std::runtime_error where no zone was found within
/// the iteration limit.
Zone minimum_zone(const Eigen::Ref<const PlanePoints>& points_mm);

}  // namespace hexdbb
