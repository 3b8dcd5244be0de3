// Pushes that are affine in the sliders' coordinates, whatever else the state of a sample: at port p
//   push = constant[p] + slope[p] s,   s the coordinate of the slider of the port's leg.
// Geometric errors, cup, ball and bar push so. Such pushes of many effects are summed before any sample is read, and
// sums over samples of readings' derivatives by their values follow from two sums for each port.
#pragma once

#include <vector>

#include "hexdbb/ports.hpp"

namespace hexdbb {

/// A summand of the derivative of an affine push by one value, at one port.
struct AffineRate {
  int value;  // of the effect
  int port;
  double constant;
  double slope = 0.0;
};

struct AffinePush {
  Ports constant, slope;          // no slope at ports of no leg
  std::vector<AffineRate> rates;  // in order of their values
};

/// Return the leg of a port, 0-based, or -1 for those of ball, cup and reading.
constexpr int leg_of(int port) noexcept {
  if (port < port::kLeg) return port - port::kSlider;
  if (port < port::kSliderJoint) return port - port::kLeg;
  if (port < port::kPlatformJoint) return (port - port::kSliderJoint) / 3;
  return port < port::kBall ? (port - port::kPlatformJoint) / 3 : -1;
}

}  // namespace hexdbb
