// Prior standard deviations and limits of the thesis' 33 geometric errors.
#pragma once

#include <string>

#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

// Parts of this size are made and fitted to about a tenth of a millimetre; beyond 5 mm a part is a different one.
constexpr double kLengthPrior_mm = 0.1;
constexpr double kLengthLimit_mm = 5.0;
// The rotation that moves the end of a guideway as far as the length prior: lever arm about 300 mm.
constexpr double kAnglePrior_rad = kLengthPrior_mm / 300.0;
constexpr double kAngleLimit_rad = 0.02;

inline ParameterInfo length(const std::string& name) {
  return {.name = name, .unit = "mm", .prior_sigma = kLengthPrior_mm, .limit = kLengthLimit_mm};
}
inline ParameterInfo angle(const std::string& name) {
  return {.name = name, .unit = "rad", .prior_sigma = kAnglePrior_rad, .limit = kAngleLimit_rad};
}

}  // namespace hexdbb::effects
