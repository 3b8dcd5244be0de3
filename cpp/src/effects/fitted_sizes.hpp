// Prior standard deviation and limit of a ball's position that is fitted by hand.
#pragma once

#include <string>

#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

/// Two balls on one pin, or a ball returned to its magnetic holder: hundredths of a millimetre.
inline ParameterInfo fitted_by_hand(const std::string& axis) {
  return {.name = axis, .unit = "mm", .prior_sigma = 0.05, .limit = 2.0};
}

}  // namespace hexdbb::effects
