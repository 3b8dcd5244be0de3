// Prior standard deviation and limit of a coordinate of cup or ball.
#pragma once

#include <string>

#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

/// A magnetic mount set by hand: 1 mm; beyond 20 mm it is another mount.
inline ParameterInfo place(const std::string& axis) {
  return {.name = axis, .unit = "mm", .prior_sigma = 1.0, .limit = 20.0};
}

}  // namespace hexdbb::effects
